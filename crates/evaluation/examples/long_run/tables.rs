//! Tables from the records.
use std::collections::BTreeMap;
use std::io::Write as _;
use std::path::Path;

use cylwatch_detector::evidence::{Scale, Tails, Thresholds};
use cylwatch_evaluation::performance::{AlarmRate, YEAR_S};

use crate::Fault;
use crate::bench::{PUBLISHED, REFITTED};
use crate::campaign::{Part, RATES_BAR_H};
use crate::records::{Record, load};

const HOUR_S: f64 = 3600.0;
/// Mean time between false alarms, years.
const YEARS: f64 = 10.0;
const COLUMNS: [(&str, f64); 4] = [("1 h", 1.0), ("24 h", 24.0), ("7 d", 168.0), ("30 d", 720.0)];
const FOUND: f64 = 0.95;
const OWN: &str = "evidence";
const BEST: &str = "refitted, best of all holds";

/// The records of one run, by detector.
type RunRecords = BTreeMap<String, Record>;

fn by_run(records: Vec<Record>) -> Vec<RunRecords> {
    let mut runs: BTreeMap<String, RunRecords> = BTreeMap::new();
    for record in records {
        runs.entry(record.run.clone()).or_default().insert(record.detector.clone(), record);
    }
    runs.into_values().collect()
}

/// Thresholds of everything.
struct Levels {
    own: Thresholds,
    others: BTreeMap<String, f64>,
}

impl Levels {
    /// Time of the first alarm of a detector in a run, s; `None` without one.
    fn alarm_s(&self, run: &RunRecords, detector: &str) -> Option<f64> {
        self.each(run, detector, |record, level| record.rises.alarm_s(level))
            .into_iter()
            .min_by(f64::total_cmp)
    }

    /// Whether there was an alarm before the leak.
    fn too_early(&self, run: &RunRecords, detector: &str) -> bool {
        !self.each(run, detector, |record, level| (record.rises.before >= level).then_some(0.0)).is_empty()
    }

    fn each(&self, run: &RunRecords, detector: &str, ask: impl Fn(&Record, f64) -> Option<f64>) -> Vec<f64> {
        if detector == OWN {
            let scale = |scale: &Scale| ask(run.get(scale.as_str())?, self.own.of(*scale));
            return Scale::ALL.iter().filter_map(scale).collect();
        }
        let level = self.others.get(detector).copied().unwrap_or(f64::INFINITY);
        run.get(detector).and_then(|record| ask(record, level)).into_iter().collect()
    }
}

/// The threshold that as many training runs exceed as the mean time makes.
fn level_of(train: &[RunRecords], detector: &str) -> f64 {
    let mut largest: Vec<f64> =
        train.iter().filter_map(|run| Some(run.get(detector)?.rises.largest())).collect();
    largest.sort_by(f64::total_cmp);
    let years: f64 = train.iter().filter_map(|run| Some(run.get(detector)?.end_s)).sum::<f64>() / YEAR_S;
    let exceeding = (years / YEARS) as usize;
    // Just above the largest of the runs that must not exceed it: those that do stay.
    largest.len().checked_sub(exceeding + 1).map_or(f64::INFINITY, |index| largest[index] * (1.0 + 1e-9))
}

/// All tables that the records allow.
pub fn print(folder: &Path) -> Result<(), Fault> {
    let train = by_run(load(folder, Part::Train.name()));
    let detectors: Vec<String> = train
        .first()
        .map(|run| run.keys().filter(|name| Scale::ALL.iter().all(|scale| scale.as_str() != *name)).cloned())
        .ok_or("there are no records of `train` yet")?
        .collect();
    let others = detectors.iter().map(|name| (name.clone(), level_of(&train, name))).collect();
    let levels = Levels { own: Tails::usual(200e5).thresholds(YEARS * YEAR_S)?, others };
    thresholds(&levels)?;
    let names: Vec<&str> = std::iter::once(OWN).chain(detectors.iter().map(String::as_str)).collect();
    false_alarms(folder, &levels, &names)?;
    let leaks = by_run(load(folder, Part::Leaks.name()));
    detection(&leaks, &levels, &names)
}

fn thresholds(levels: &Levels) -> Result<(), Fault> {
    let mut out = std::io::stdout();
    writeln!(out, "Thresholds for one false alarm in {YEARS} years\n\n| statistic | threshold |\n|---|---|")?;
    for scale in Scale::ALL {
        writeln!(out, "| {} | {:.3} |", scale.as_str(), levels.own.of(scale))?;
    }
    for (name, level) in &levels.others {
        writeln!(out, "| {name} | {:.3} bar |", level / 1e5)?;
    }
    Ok(())
}

fn false_alarms(folder: &Path, levels: &Levels, names: &[&str]) -> Result<(), Fault> {
    let mut out = std::io::stdout();
    writeln!(out, "\nFalse alarms (95 % interval of the rate)\n")?;
    writeln!(
        out,
        "| part | detector | alarms | years | per 10 years | simulations with one | by scale |\n|---|---|---|---|---|---|---|"
    )?;
    for part in [Part::Train, Part::Test, Part::Stratified, Part::Seasons] {
        let runs = by_run(load(folder, part.name()));
        for name in names.iter().filter(|_| !runs.is_empty()) {
            let mut found = AlarmRate::default();
            // Four sets of sensors read one simulated cylinder.
            let mut with_one = BTreeMap::new();
            for run in &runs {
                let alarm_s = levels.alarm_s(run, name);
                let end_s = run.values().next().map_or(0.0, |record| record.end_s);
                found.alarms += u64::from(alarm_s.is_some());
                let simulation = run.values().next().and_then(|record| record.run.rsplit_once('-'));
                *with_one.entry(simulation.map(|(name, _)| name)).or_insert(false) |= alarm_s.is_some();
                found.at_risk_s += alarm_s.unwrap_or(end_s);
            }
            let (low, high) = found.per_year_interval(0.95);
            writeln!(
                out,
                "| {} | {name} | {} | {:.1} | {:.2} ({:.2} to {:.2}) | {} of {} | {} |",
                part.name(),
                found.alarms,
                found.cylinder_years(),
                YEARS * found.per_year(),
                YEARS * low,
                YEARS * high,
                with_one.values().filter(|one| **one).count(),
                with_one.len(),
                if *name == OWN { by_scale(&runs, levels) } else { String::new() }
            )?;
        }
    }
    Ok(())
}

/// Runs in which each statistic exceeded its threshold.
fn by_scale(runs: &[RunRecords], levels: &Levels) -> String {
    let count = |scale: &Scale| {
        let above = |run: &&RunRecords| {
            run.get(scale.as_str()).is_some_and(|r| r.rises.largest() >= levels.own.of(*scale))
        };
        runs.iter().filter(above).count().to_string()
    };
    Scale::ALL.iter().map(count).collect::<Vec<_>>().join(" ")
}

/// Delays of a detector at a rate, s, infinite without an alarm; runs with an alarm before the leak are left out.
fn delays(leaks: &[RunRecords], levels: &Levels, name: &str, rate: f64) -> Vec<f64> {
    let at_rate = |run: &&RunRecords| run.values().next().is_some_and(|record| record.rate_bar_h == rate);
    let delay = |run: &RunRecords| {
        let onset_s = run.values().next().map_or(0.0, |record| record.onset_s);
        levels.alarm_s(run, name).map_or(f64::INFINITY, |alarm_s| alarm_s - onset_s)
    };
    leaks.iter().filter(at_rate).filter(|run| !levels.too_early(run, name)).map(delay).collect()
}

fn part_within(delays: &[f64], hours: f64) -> f64 {
    delays.iter().filter(|delay| **delay <= hours * HOUR_S).count() as f64 / delays.len() as f64
}

/// Smallest rate from which on so many leaks are found, interpolated in its logarithm.
fn smallest(parts: &[(f64, f64)]) -> f64 {
    let Some(last_below) = parts.iter().rposition(|(_, part)| *part < FOUND) else {
        return parts.first().map_or(f64::NAN, |(rate, _)| *rate);
    };
    let Some((above, part_above)) = parts.get(last_below + 1) else { return f64::INFINITY };
    let (below, part_below) = parts[last_below];
    let weight = (FOUND - part_below) / (part_above - part_below);
    (below.ln() + weight * (above / below).ln()).exp()
}

fn detection(leaks: &[RunRecords], levels: &Levels, names: &[&str]) -> Result<(), Fault> {
    let mut out = std::io::stdout();
    let mut least: Vec<(String, [f64; 4])> = Vec::new();
    for name in names.iter().filter(|_| !leaks.is_empty()) {
        writeln!(out, "\n{name}\n")?;
        writeln!(out, "| bar/h | runs | median delay, h | within 1 h | 24 h | 7 d | 30 d |")?;
        writeln!(out, "|---|---|---|---|---|---|---|")?;
        let mut columns: [Vec<(f64, f64)>; 4] = Default::default();
        for rate in RATES_BAR_H {
            let mut delays = delays(leaks, levels, name, rate);
            if delays.is_empty() {
                continue;
            }
            delays.sort_by(f64::total_cmp);
            let parts = COLUMNS.map(|(_, hours)| part_within(&delays, hours));
            columns.iter_mut().zip(parts).for_each(|(column, part)| column.push((rate, part)));
            let median_h = delays[delays.len() / 2] / HOUR_S;
            let [a, b, c, d] = parts;
            let runs = delays.len();
            writeln!(out, "| {rate} | {runs} | {median_h:.1} | {a:.2} | {b:.2} | {c:.2} | {d:.2} |")?;
        }
        least.push(((*name).to_owned(), columns.map(|column| smallest(&column))));
    }
    let best = |column: usize| {
        let held = least.iter().filter(|(name, _)| REFITTED.iter().any(|(held, _)| held == name));
        held.map(|(_, rates)| rates[column]).fold(f64::INFINITY, f64::min)
    };
    least.push((BEST.to_owned(), [0, 1, 2, 3].map(best)));
    ratios(&least)
}

fn ratios(least: &[(String, [f64; 4])]) -> Result<(), Fault> {
    let mut out = std::io::stdout();
    writeln!(out, "\nSmallest leak found with 95 %, bar/h\n\n| detector | 1 h | 24 h | 7 d | 30 d |")?;
    writeln!(out, "|---|---|---|---|---|")?;
    let row = |rates: &[f64; 4]| rates.map(|rate| format!("{rate:.4}")).join(" | ");
    for (name, rates) in least {
        writeln!(out, "| {name} | {} |", row(rates))?;
    }
    let of = |wanted: &str| least.iter().find(|(name, _)| name == wanted).map(|(_, rates)| *rates);
    if let (Some(own), Some(published), Some(best)) = (of(OWN), of(PUBLISHED), of(BEST)) {
        for (name, other) in [(PUBLISHED, published), (BEST, best)] {
            let ratio = [0, 1, 2, 3].map(|column| format!("{:.1}", other[column] / own[column]));
            writeln!(out, "| {name} over {OWN} | {} |", ratio.join(" | "))?;
        }
    }
    Ok(())
}
