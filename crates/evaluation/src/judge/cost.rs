//! What a cylinder-year costs, split into truth, candidates and bookkeeping.
//!
//! Times are those of one core ([`super::clock`]). They stand in `times.jsonl`, one line for each world and run, apart from the results: they
//! differ from run to run.
use cylwatch_thermal::units::YEAR_S;
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs::{File, OpenOptions};
use std::io::Write;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::JudgeError;

/// Name of the file of times.
pub(super) const TIMES: &str = "times.jsonl";
/// Names of the files of costs.
pub(super) const COST: [&str; 2] = ["cost.md", "cost.json"];

/// Times of one world, s.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Times {
    /// Index of the world.
    pub world: usize,
    /// Length of the log.
    pub cylinder_s: f64,
    /// Rows.
    pub rows: u64,
    /// Simulation; with the first of the worlds that share it.
    pub simulate_s: f64,
    /// Sensors, rows, leaks and faults laid over it.
    pub lay_over_s: f64,
    /// Each candidate.
    pub candidates_s: Vec<(String, f64)>,
    /// Scoring.
    pub scoring_s: f64,
    /// Journal and partial tables.
    pub journal_s: f64,
}

/// What a cylinder-year costs, s.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub(super) struct CostOfYear {
    /// Cylinder-years.
    pub cylinder_years: f64,
    /// Rows of a year on average.
    pub rows_per_year: f64,
    /// Simulation and what is laid over it, s.
    pub truth_s: f64,
    /// Each candidate, s of the years that it watched.
    pub candidates_s: BTreeMap<String, f64>,
    /// Scoring, journal, partial tables, s.
    pub bookkeeping_s: f64,
    /// All of it, s.
    pub all_s: f64,
}

/// The file of times.
#[derive(Debug)]
pub(super) struct Costs {
    path: PathBuf,
    file: File,
}

impl Costs {
    /// Go on with the file of a folder.
    ///
    /// # Errors
    /// It cannot be written.
    pub(crate) fn open(folder: &Path) -> Result<Self, JudgeError> {
        let path = folder.join(TIMES);
        let file = OpenOptions::new().append(true).create(true).open(&path);
        let mut file = file.map_err(|source| JudgeError::File { path: path.clone(), source })?;
        // A line that a kill has torn ends here.
        file.write_all(b"\n").map_err(|source| JudgeError::File { path: path.clone(), source })?;
        Ok(Self { path, file })
    }

    /// Write the times of a world down.
    ///
    /// # Errors
    /// The file cannot be written.
    pub(crate) fn enter(&mut self, times: Times) -> Result<(), JudgeError> {
        let line = format!("{}\n", serde_json::to_string(&times)?);
        let written = self.file.write_all(line.as_bytes());
        written.map_err(|source| JudgeError::File { path: self.path.clone(), source })
    }

    /// Write the costs of a year of all runs so far.
    ///
    /// # Errors
    /// A file cannot be read or written.
    pub(crate) fn write(&self, folder: &Path) -> Result<CostOfYear, JudgeError> {
        let failed = |path: PathBuf| move |source| JudgeError::File { path, source };
        let text = std::fs::read_to_string(&self.path).map_err(failed(self.path.clone()))?;
        let times = text.lines().filter_map(|line| serde_json::from_str(line).ok());
        let cost = CostOfYear::of(times);
        let [markdown, json] = COST.map(|name| folder.join(name));
        std::fs::write(&markdown, cost.to_markdown()).map_err(failed(markdown))?;
        let text = serde_json::to_string_pretty(&cost)? + "\n";
        std::fs::write(&json, text).map_err(failed(json))?;
        Ok(cost)
    }
}

impl CostOfYear {
    /// From the times of worlds.
    pub(crate) fn of(times: impl IntoIterator<Item = Times>) -> Self {
        let (mut all, mut truth_s, mut bookkeeping_s, mut rows) = (0.0, 0.0, 0.0, 0.0);
        let mut candidates: BTreeMap<String, (f64, f64)> = BTreeMap::new();
        for of in times {
            let years = of.cylinder_s / YEAR_S;
            all += years;
            rows += of.rows as f64;
            truth_s += of.simulate_s + of.lay_over_s;
            bookkeeping_s += of.scoring_s + of.journal_s;
            for (name, taken_s) in of.candidates_s {
                let sum = candidates.entry(name).or_default();
                *sum = (sum.0 + taken_s, sum.1 + years);
            }
        }
        let taken_s: f64 = candidates.values().map(|(taken_s, _)| taken_s).sum();
        Self {
            cylinder_years: all,
            rows_per_year: rows / all,
            truth_s: truth_s / all,
            candidates_s: candidates.into_iter().map(|(name, (s, years))| (name, s / years)).collect(),
            bookkeeping_s: bookkeeping_s / all,
            all_s: (truth_s + bookkeeping_s + taken_s) / all,
        }
    }

    fn to_markdown(&self) -> String {
        let mut text = format!(
            "# What a cylinder-year costs\n\n{:.2} cylinder-years, {:.0} rows each; seconds of one core for each.\n\n\
             | part | s |\n|---|---:|\n| truth: simulation, sensors, rows | {:.3} |\n",
            self.cylinder_years, self.rows_per_year, self.truth_s
        );
        for (name, taken_s) in &self.candidates_s {
            let _ = writeln!(text, "| {name} | {taken_s:.3} |");
        }
        let _ =
            writeln!(text, "| bookkeeping: scoring, journal, partial tables | {:.3} |", self.bookkeeping_s);
        let _ = writeln!(text, "| all | {:.3} |", self.all_s);
        text
    }
}
