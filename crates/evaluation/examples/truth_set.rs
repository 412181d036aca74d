//! Generates a set of truths in parallel and writes one file for each seed, `seed-<n>.csv`.
//!
//! `cargo run --release -p cylwatch-evaluation --example truth_set -- <course> <seeds> <days> <out-dir>`
//!
//! `course`: scenario1 to scenario4, tunnel or week, with `-learnt` after it for ten days of operation before.
//! `seeds`: a count from 1 on, or `first..end`. `days`: length of the weeks, ignored by other courses. Weeks are sampled
//! every minute, the others every 10 s. A seed whose file exists is left as it is.
use std::error::Error;
use std::fs::{self, File};
use std::io::{BufWriter, Write as _};
use std::ops::Range;
use std::path::Path;
use std::time::Instant;

use cylwatch_evaluation::truth::{Course, generate};
use rayon::prelude::*;

type Fault = Box<dyn Error + Send + Sync>;

fn seeds(text: &str) -> Result<Range<u64>, Fault> {
    Ok(match text.split_once("..") {
        Some((first, end)) => first.parse()?..end.parse()?,
        None => 1..text.parse::<u64>()? + 1,
    })
}

fn write(course: &Course, seed: u64, folder: &Path) -> Result<(), Fault> {
    let path = folder.join(format!("seed-{seed}.csv"));
    if path.exists() {
        return Ok(());
    }
    let sample_time_s = if matches!(course, Course::RailwayWeeks { .. }) { 60.0 } else { 10.0 };
    let begin = Instant::now();
    let truth = generate(course, seed, sample_time_s)?;
    // Under another name until it is complete, so that an interrupted run leaves no half file.
    let unfinished = path.with_extension("unfinished");
    let mut out = BufWriter::new(File::create(&unfinished)?);
    truth.write_to(&mut out)?;
    out.flush()?;
    fs::rename(&unfinished, &path)?;
    writeln!(std::io::stderr(), "{} in {:.1} s", path.display(), begin.elapsed().as_secs_f64())?;
    Ok(())
}

fn main() -> Result<(), Fault> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [course, count, days, folder] = &arguments[..] else {
        return Err("usage: truth_set <course> <seeds> <days> <out-dir>".into());
    };
    let course = Course::named(course, days.parse()?)
        .ok_or("the course is scenario1 to scenario4, tunnel or week, or one of them with -learnt")?;
    let folder = Path::new(folder);
    fs::create_dir_all(folder)?;
    seeds(count)?.into_par_iter().try_for_each(|seed| write(&course, seed, folder))
}
