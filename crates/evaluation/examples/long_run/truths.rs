//! Readings of many cylinders, simulated once and kept in the folder.
//!
//! One simulated cylinder is read by four sets of sensors with offsets, couplings, coefficient and noise of their own: four
//! cylinders of one train. A file holds the readings of every other minute as 32-bit numbers; their rounding is 2 Pa and
//! 0.03 mK.
use std::fs::{self, File};
use std::io::{Read as _, Write as _};
use std::path::{Path, PathBuf};

use cylwatch_evaluation::truth::{Course, Truth, TruthLeak, TruthSettings, generate_sets};

use crate::Fault;

/// Interval of the readings, s.
pub const INTERVAL_S: f64 = 120.0;
/// Sets of sensors on each simulated cylinder.
pub const SETS: u64 = 4;

/// A cylinder: where its readings are kept and how they are made.
#[derive(Clone, Debug)]
pub struct Run {
    /// Name of the file without its ending.
    pub name: String,
    /// What it goes through.
    pub course: Course,
    /// Seed of the cylinder and its weather.
    pub seed: u64,
    /// Which set of sensors reads it.
    pub set: u64,
    /// Its truth.
    pub settings: TruthSettings,
}

impl Run {
    /// A cylinder of a course.
    pub fn new(course: Course, seed: u64, set: u64, settings: TruthSettings) -> Self {
        let days = course.duration_s() / 86_400.0;
        let leak = settings.leak.map_or(String::new(), |leak: TruthLeak| format!("-{:.6e}", leak.rate_kg_s));
        Self { name: format!("{}-{days}-{seed}-{set}{leak}", course.name()), course, seed, set, settings }
    }
}

/// Readings of shoulder, K, valve, K, and pressure, Pa, every [`INTERVAL_S`].
pub struct Readings(Vec<[f32; 3]>);

impl Readings {
    /// Time, s, and readings.
    pub fn rows(&self) -> impl Iterator<Item = (f64, [f64; 3])> + '_ {
        self.0.iter().enumerate().map(|(n, row)| (n as f64 * INTERVAL_S, row.map(f64::from)))
    }
}

fn path(folder: &Path, name: &str) -> PathBuf {
    folder.join("readings").join(format!("{name}.bin"))
}

/// The readings of the cylinders of one simulation, which is run if they are not kept yet.
pub fn readings(folder: &Path, group: &[Run]) -> Result<Vec<Readings>, Fault> {
    let kept: Result<Vec<Readings>, _> = group.iter().map(|run| read(&path(folder, &run.name))).collect();
    if let Ok(kept) = kept {
        return Ok(kept);
    }
    let simulated: Vec<Readings> = simulate(group)?;
    for (run, readings) in group.iter().zip(&simulated) {
        keep(folder, &run.name, readings)?;
    }
    Ok(simulated)
}

fn read(path: &Path) -> Result<Readings, std::io::Error> {
    let mut bytes = Vec::new();
    File::open(path)?.read_to_end(&mut bytes)?;
    Ok(decode(&bytes))
}

fn simulate(group: &[Run]) -> Result<Vec<Readings>, Fault> {
    let Some(Run { course, seed, settings, .. }) = group.first() else { return Ok(Vec::new()) };
    let truths = generate_sets(course, *seed, INTERVAL_S, settings, group.iter().map(|run| run.set))?;
    truths.map(|truth| Ok(Readings(rows(&truth?).collect()))).collect()
}

fn rows(truth: &Truth) -> impl Iterator<Item = [f32; 3]> + '_ {
    let column = |name| truth.log.channels.iter().position(|channel| channel.name == name);
    let columns = ["shoulder", "valve", "pressure"].map(column);
    truth
        .log
        .rows()
        .map(move |(_, row)| columns.map(|column| column.map_or(f32::NAN, |column| row[column] as f32)))
}

fn keep(folder: &Path, name: &str, readings: &Readings) -> Result<(), Fault> {
    let path = path(folder, name);
    // Under another name until it is complete, so that an interrupted run leaves no half file.
    let unfinished = path.with_extension("unfinished");
    let bytes: Vec<u8> = readings.0.iter().flatten().flat_map(|value| value.to_le_bytes()).collect();
    File::create(&unfinished)?.write_all(&bytes)?;
    fs::rename(&unfinished, &path)?;
    Ok(())
}

fn decode(bytes: &[u8]) -> Readings {
    let number = |bytes: &[u8]| bytes.try_into().map_or(f32::NAN, f32::from_le_bytes);
    Readings(bytes.chunks_exact(12).map(|row| [0, 4, 8].map(|at| number(&row[at..at + 4]))).collect())
}
