//! Thresholds, false alarms and detection of the evidence and of detectors without an observer, over hundreds of
//! cylinder-years.
//!
//! `cargo run --release -p cylwatch-evaluation --example long_run -- FOLDER train test stratified seasons leaks`
//!
//! Each part can be named alone and interrupted at any time: simulated readings and what every detector said of them are kept in FOLDER
//! (`readings/`, `<part>.csv`), and the next call goes on from there. `accuracy` runs the monitor on the leaks and prints how often its intervals hold rate and onset. Without a part, the tables are made from what is there. The truth is [`TruthSettings::fast`], in `stratified` and in half
//! of `train` with four layers of gas; winters of 122 days, years of 365.
//!
//! A false alarm is the first one of a run; time counts up to it. Detectors without an observer have the threshold that as many runs of
//! `train` exceed as one in ten years makes; the evidence has the thresholds of the library.
//!
//! [`TruthSettings::fast`]: cylwatch_evaluation::truth::TruthSettings::fast
mod accuracy;
mod bench;
mod campaign;
mod records;
mod tables;
mod truths;

use std::io::Write as _;
use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::prelude::*;

use campaign::Part;
use truths::Run;

type Fault = Box<dyn std::error::Error + Send + Sync>;

fn main() -> Result<(), Fault> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let (folder, parts) = arguments.split_first().ok_or("usage: long_run FOLDER [PART ...]")?;
    let folder = Path::new(folder);
    std::fs::create_dir_all(folder.join("readings"))?;
    if parts == ["accuracy"] {
        return accuracy::print(folder);
    }
    for name in parts {
        let part = Part::named(name).ok_or_else(|| format!("no part {name}"))?;
        run(folder, part)?;
    }
    tables::print(folder)
}

/// Run what is not done yet of a part.
fn run(folder: &Path, part: Part) -> Result<(), Fault> {
    let done = records::done(folder, part.name());
    let open: Vec<Vec<Run>> =
        part.groups().into_iter().filter(|group| group.iter().any(|run| !done.contains(&run.name))).collect();
    let file = Mutex::new(records::file(folder, part.name())?);
    let (count, finished) = (open.len(), AtomicUsize::new(0));
    open.par_iter().with_max_len(1).try_for_each(|group| -> Result<(), Fault> {
        let readings = truths::readings(folder, group)?;
        for (run, readings) in group.iter().zip(&readings).filter(|(run, _)| !done.contains(&run.name)) {
            let said = bench::judge(run, readings)?;
            records::add(&mut *file.lock().map_err(|_| "another thread failed")?, &said)?;
        }
        let n = finished.fetch_add(1, Ordering::Relaxed) + 1;
        writeln!(std::io::stderr(), "{} {n}/{count} {}", part.name(), group[0].name)?;
        Ok(())
    })
}
