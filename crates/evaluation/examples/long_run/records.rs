//! What a detector said in a run, kept so that alarms at any threshold can be read off again.
use std::collections::HashSet;
use std::fs::{self, File, OpenOptions};
use std::io::Write as _;
use std::path::{Path, PathBuf};

use crate::Fault;

/// A value is kept when it is above the last one kept by so much, relative.
const STEP: f64 = 0.01;
const HEAD: &str = "run,detector,rate_bar_h,onset_s,end_s,before,rises";

/// New largest values of a statistic, with their times, from an onset on.
#[derive(Clone, Debug, PartialEq)]
pub struct Rises {
    onset_s: f64,
    /// Largest value before the onset.
    pub before: f64,
    /// Times, s, and values, both increasing.
    pub values: Vec<(f64, f64)>,
}

impl Rises {
    /// None yet.
    pub fn since(onset_s: f64) -> Self {
        Self { onset_s, before: f64::NEG_INFINITY, values: Vec::new() }
    }

    /// Take the value at a time.
    pub fn update(&mut self, time_s: f64, value: f64) {
        if time_s < self.onset_s {
            self.before = self.before.max(value);
        } else if self.values.last().map_or(value.is_finite(), |(_, last)| value > last + STEP * last.abs()) {
            self.values.push((time_s, value));
        }
    }

    /// First time at which a threshold was reached, s.
    pub fn alarm_s(&self, threshold: f64) -> Option<f64> {
        self.values.iter().find(|(_, value)| *value >= threshold).map(|(time_s, _)| *time_s)
    }

    /// Largest value.
    pub fn largest(&self) -> f64 {
        self.values.last().map_or(f64::NEG_INFINITY, |(_, value)| *value)
    }
}

/// One detector in one run.
#[derive(Clone, Debug, PartialEq)]
pub struct Record {
    pub run: String,
    pub detector: String,
    /// 0 without a leak.
    pub rate_bar_h: f64,
    /// Begin of the leak, s; 0 without one.
    pub onset_s: f64,
    pub end_s: f64,
    pub rises: Rises,
}

impl Record {
    fn line(&self) -> String {
        let rises: Vec<String> = self.rises.values.iter().map(|(t, v)| format!("{t:.0}:{v:.6}")).collect();
        format!(
            "{},{},{},{:.0},{:.0},{:.6},{}",
            self.run,
            // The name of a detector has a comma of its own.
            self.detector.replace(", ", ";"),
            self.rate_bar_h,
            self.onset_s,
            self.end_s,
            self.rises.before,
            rises.join(" ")
        )
    }

    fn parse(line: &str) -> Option<Self> {
        let cells: Vec<&str> = line.split(',').collect();
        let [run, detector, rate, onset, end, before, rises] = cells[..] else { return None };
        let pair = |text: &str| {
            let (time, value) = text.split_once(':')?;
            Some((time.parse().ok()?, value.parse().ok()?))
        };
        let onset_s = onset.parse().ok()?;
        Some(Self {
            run: run.to_owned(),
            detector: detector.replace(';', ", "),
            rate_bar_h: rate.parse().ok()?,
            onset_s,
            end_s: end.parse().ok()?,
            rises: Rises {
                onset_s,
                before: before.parse().ok()?,
                values: rises.split_whitespace().map(pair).collect::<Option<_>>()?,
            },
        })
    }
}

fn path(folder: &Path, part: &str) -> PathBuf {
    folder.join(format!("{part}.csv"))
}

/// The records of a part so far.
pub fn load(folder: &Path, part: &str) -> Vec<Record> {
    let text = fs::read_to_string(path(folder, part)).unwrap_or_default();
    text.lines().filter_map(Record::parse).collect()
}

/// Names of the runs of a part that are done.
pub fn done(folder: &Path, part: &str) -> HashSet<String> {
    load(folder, part).into_iter().map(|record| record.run).collect()
}

/// The file of a part, to add to.
pub fn file(folder: &Path, part: &str) -> Result<File, Fault> {
    let path = path(folder, part);
    let new = !path.exists();
    let mut file = OpenOptions::new().create(true).append(true).open(path)?;
    if new {
        writeln!(file, "{HEAD}")?;
    }
    Ok(file)
}

/// Add the records of one run at once, so that an interrupted program leaves whole runs.
pub fn add(file: &mut File, records: &[Record]) -> Result<(), Fault> {
    let text: String = records.iter().map(|record| record.line() + "\n").collect();
    file.write_all(text.as_bytes())?;
    Ok(())
}
