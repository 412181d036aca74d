//! Scores the observer, and the paper's transfer function beside it, on a set of truths.
//!
//! `cargo run --release -p cylwatch-evaluation --example score_truths -- <folder> [sensors] [setting=value ...]`
//!
//! `folder`: files `seed-<n>.csv` of the example `truth_set`. `sensors`: comma-separated, `shoulder,valve,pressure` by default.
//! Settings change the default observer, as JSON paths: `/model_error/surface_k=0.1`.
use std::error::Error;
use std::fs::{self, File};
use std::io::{BufReader, Write as _};
use std::path::PathBuf;

use cylwatch_estimator::identify::published::TransferFunction;
use cylwatch_estimator::observer::ObserverSettings;
use cylwatch_estimator::thermal::vessel::presets;
use cylwatch_evaluation::truth::Truth;
use cylwatch_evaluation::truth::score::{Score, score, score_transfer_function};
use rayon::prelude::*;

type Fault = Box<dyn Error + Send + Sync>;

fn changed(settings: ObserverSettings, changes: &[&String]) -> Result<ObserverSettings, Fault> {
    let mut document = serde_json::to_value(settings)?;
    for change in changes {
        let (path, value) = change.split_once('=').ok_or("a change is path=value")?;
        *document.pointer_mut(path).ok_or_else(|| format!("no setting {path}"))? =
            serde_json::from_str(value)?;
    }
    Ok(serde_json::from_value(document)?)
}

fn judge(path: &PathBuf, sensors: &[&str], settings: &ObserverSettings) -> Result<[Score; 3], Fault> {
    let truth = Truth::read_from(&mut BufReader::new(File::open(path)?))?;
    let nominal = presets::load("nitrogen-20l")?;
    Ok([
        score(&truth, &nominal, sensors, settings)?,
        score_transfer_function(&truth, &nominal, TransferFunction::PUBLISHED)?,
        score_transfer_function(&truth, &nominal, TransferFunction::new(1.0, 0.002988))?,
    ])
}

/// Mean over the runs with a 95 % interval of that mean, and the worst run.
fn spread(scores: &[Score], value: impl Fn(&Score) -> f64) -> String {
    let n = scores.len() as f64;
    let mean = scores.iter().map(&value).sum::<f64>() / n;
    let sd = (scores.iter().map(|s| (value(s) - mean).powi(2)).sum::<f64>() / (n - 1.0).max(1.0)).sqrt();
    let worst = scores.iter().map(&value).fold(f64::NEG_INFINITY, f64::max);
    format!("{mean:9.4} ± {:.4} (worst {worst:.4})", 1.96 * sd / n.sqrt())
}

fn main() -> Result<(), Fault> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let (changes, plain): (Vec<&String>, Vec<&String>) = arguments.iter().partition(|a| a.contains('='));
    let folder = plain.first().ok_or("usage: score_truths <folder> [sensors] [setting=value ...]")?;
    let sensors: Vec<&str> =
        plain.get(1).map_or("shoulder,valve,pressure", |s| s.as_str()).split(',').collect();
    let settings = changed(ObserverSettings::default(), &changes)?;
    let mut paths: Vec<PathBuf> = fs::read_dir(folder)?
        .filter_map(|entry| Some(entry.ok()?.path()))
        .filter(|path| path.extension().is_some_and(|ending| ending == "csv"))
        .collect();
    paths.sort();
    let all: Vec<[Score; 3]> =
        paths.par_iter().map(|path| judge(path, &sensors, &settings)).collect::<Result<_, _>>()?;
    let mut out = std::io::stdout();
    writeln!(out, "{folder}: {} runs, {} samples each judged", all.len(), all[0][0].samples)?;
    for (index, name) in
        ["observer", "transfer function as published", "transfer function, gain 1"].iter().enumerate()
    {
        let of: Vec<Score> = all.iter().map(|scores| scores[index]).collect();
        let pooled = (of.iter().map(|s| s.gas_rms_k.powi(2)).sum::<f64>() / of.len() as f64).sqrt();
        writeln!(out, "{name}")?;
        writeln!(out, "  gas rms K          {}  pooled {pooled:.4}", spread(&of, |s| s.gas_rms_k))?;
        writeln!(
            out,
            "  gas sd K           {}",
            spread(&of, |s| (s.gas_rms_k.powi(2) - s.gas_bias_k.powi(2)).max(0.0).sqrt())
        )?;
        writeln!(out, "  gas max K          {}", spread(&of, |s| s.gas_max_k))?;
        writeln!(out, "  mass sd g          {}", spread(&of, |s| 1e3 * s.mass_sd_kg))?;
        writeln!(out, "  mass rel. rms g    {}", spread(&of, |s| 1e3 * s.mass_rms_kg))?;
        writeln!(out, "  mass bias, abs., g {}", spread(&of, |s| 1e3 * s.mass_bias_kg.abs()))?;
        if index == 0 {
            writeln!(out, "  stated gas sd K    {}", spread(&of, |s| s.gas_stated_k))?;
            writeln!(out, "  stated mass sd g   {}", spread(&of, |s| 1e3 * s.mass_stated_kg))?;
            writeln!(out, "  gas in 95 % band   {}", spread(&of, |s| s.gas_coverage))?;
            writeln!(out, "  mass in 95 % band  {}", spread(&of, |s| s.mass_coverage))?;
            writeln!(out, "  leak sd g/h        {}", spread(&of, |s| 3.6e6 * s.leak_sd_kg_s))?;
            writeln!(out, "  NIS                {}", spread(&of, |s| s.nis))?;
        }
    }
    Ok(())
}
