//! Truths that rows of data share, and what a monitor makes of them.
use std::fs::{self, File};
use std::io::{BufReader, BufWriter, Write as _};
use std::path::PathBuf;

use cylwatch_detector::monitor::MonitorSettings;
use cylwatch_estimator::observer::Commissioning;
use cylwatch_estimator::sensor::Sensor;
use cylwatch_estimator::thermal::vessel::presets;
use cylwatch_evaluation::fault::{
    Arrival, Case, CaseLeak, EPOCH_S, Fault, History, Missed, Record, Step, Subject, TableRow,
    allowed_delay_s,
};
use cylwatch_evaluation::truth::{Course, Happenings, Process, Truth, TruthSettings, generate_through};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use crate::Failure;

pub const HOUR_S: f64 = 3600.0;
pub const DAY_S: f64 = 86_400.0;
pub const BAR_PA: f64 = 1e5;
/// Leaks, bar/h at 15 °C.
pub const LEAKS_BAR_H: [f64; 4] = [0.0, 0.01, 0.1, 1.0];
pub const SENSORS: [&str; 3] = ["shoulder", "valve", "pressure"];
pub const SAMPLE_S: f64 = 60.0;
/// Time in which the monitor learns, d, and end of the record, d: with 1 bar/h before the bottle is empty.
const LEARNING_D: f64 = 10.0;
const END_D: [f64; 4] = [22.0, 22.0, 22.0, 16.0];
/// Time that is left after a gap at least, d.
const AFTER_GAP_D: [f64; 4] = [2.0, 7.0, 3.0, 1.5];

/// What all runs share.
pub struct Campaign {
    pub subject: Subject,
    pub truth: TruthSettings,
    cache: Option<PathBuf>,
}

impl Campaign {
    pub fn new(cache: Option<PathBuf>) -> Result<Self, Failure> {
        if let Some(folder) = &cache {
            fs::create_dir_all(folder)?;
        }
        let sensors = SENSORS.iter().map(|name| Sensor::typical(name)).collect::<Result<Vec<_>, _>>()?;
        let subject = Subject {
            vessel: presets::load("nitrogen-20l")?,
            sensors,
            commissioning: Commissioning { settled: false, ..Commissioning::filled(200.0 * BAR_PA, 288.15) },
            settings: MonitorSettings::default(),
        };
        Ok(Self { subject, truth: TruthSettings::fast(), cache })
    }

    /// A truth from the cache, or simulated and put there.
    pub fn truth(&self, name: &str, days: f64, seed: u64, happenings: &Happenings) -> Result<Truth, Failure> {
        let path = self.cache.as_ref().map(|folder| folder.join(format!("{name}-{seed}.csv")));
        if let Some(path) = path.as_ref().filter(|path| path.exists()) {
            return Ok(Truth::read_from(&mut BufReader::new(File::open(path)?))?);
        }
        let course = Course::RailwayWeeks { days };
        let truth = generate_through(&course, seed, SAMPLE_S, &self.truth, happenings)?;
        if let Some(path) = path {
            let unfinished = path.with_extension("unfinished");
            let mut out = BufWriter::new(File::create(&unfinished)?);
            truth.write_to(&mut out)?;
            out.flush()?;
            fs::rename(&unfinished, &path)?;
        }
        Ok(truth)
    }
}

/// A leak from a time on as a process, if it is one.
pub fn leak(leak: Option<CaseLeak>) -> Vec<Process> {
    let process =
        |leak: CaseLeak| Process::Leak { start_s: leak.onset_s, stop_s: 1e9, rate_pa_s: leak.rate_pa_s };
    leak.map(process).into_iter().collect()
}

/// What a run said, and what the same record without power cycles would have led to.
pub struct Histories {
    pub history: History,
    pub unbroken: Option<u64>,
}

/// The rows of a truth, with the air around the cylinder as a further channel, stamped from the epoch on.
pub fn record(truth: &Truth) -> Result<Record, Failure> {
    let mut record = Record::of_log(&truth.log, &SENSORS)?;
    record.sensors.push("ambient".into());
    for (row, air_k) in record.rows_mut().zip(&truth.ambient_k) {
        row.readings.push(*air_k);
        row.stamp_s += EPOCH_S;
        row.measured_s += EPOCH_S;
    }
    Ok(record)
}

/// A cylinder with a leak: its record and the state of the monitor after learning.
pub struct Base {
    seed: u64,
    leak_index: usize,
    leak: Option<CaseLeak>,
    /// From the beginning.
    record: Record,
    /// Number of rows of learning.
    learning: usize,
    learnt: Vec<u8>,
}

impl Base {
    pub fn generate(campaign: &Campaign, seed: u64, leak_index: usize) -> Result<Self, Failure> {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        // The leak begins on the second day after learning.
        let onset_s = (LEARNING_D + 0.5 + random.random::<f64>()) * DAY_S;
        let rate_pa_s = LEAKS_BAR_H[leak_index] * BAR_PA / HOUR_S;
        let in_truth = (rate_pa_s > 0.0).then_some(CaseLeak { rate_pa_s, onset_s });
        let happenings = Happenings { processes: leak(in_truth), ..Happenings::default() };
        let truth = campaign.truth(&format!("base{leak_index}"), END_D[leak_index], seed, &happenings)?;
        let record = record(&truth)?;
        let learning = truth.time_s.partition_point(|&time_s| time_s < LEARNING_D * DAY_S);
        let first = part(&record, 0..learning).without("ambient");
        let learnt = campaign.subject.state_after(&first)?;
        let leak = in_truth.map(|leak| CaseLeak { onset_s: leak.onset_s + EPOCH_S, ..leak });
        Ok(Self { seed, leak_index, leak, record, learning, learnt })
    }

    /// Run a row of data, or none.
    pub fn run(
        &self,
        campaign: &Campaign,
        row: Option<TableRow>,
        what: &mut String,
    ) -> Result<Vec<Missed>, Failure> {
        let mut random = ChaCha8Rng::seed_from_u64(self.seed);
        random.set_stream(1 + row.map_or(0, |row| row as u64));
        let onset_s = EPOCH_S + (LEARNING_D + 0.25 + 1.5 * random.random::<f64>()) * DAY_S;
        let fault = row.and_then(|row| row.draw(self.seed)).map(|fault| self.fitted(fault, onset_s));
        if let Some(fault) = &fault {
            *what = serde_json::to_string(fault)?;
        }
        let case = Case {
            row: row.unwrap_or(TableRow::D4),
            onset_s,
            leak: self.leak,
            exchanges: Vec::new(),
            from_s: EPOCH_S + LEARNING_D * DAY_S,
            until_s: EPOCH_S + self.until_s(fault.as_ref(), onset_s),
            fault,
        };
        Ok(crate::missed(&case, &self.histories(campaign, &case)?))
    }

    /// A gap that leaves time after it.
    fn fitted(&self, fault: Fault, onset_s: f64) -> Fault {
        let longest_s = (END_D[self.leak_index] - AFTER_GAP_D[self.leak_index]) * DAY_S + EPOCH_S - onset_s;
        match fault {
            Fault::Gap { lasting_s } => Fault::Gap { lasting_s: lasting_s.min(longest_s) },
            other => other,
        }
    }

    /// End of the record that this case needs, s from its beginning.
    fn until_s(&self, fault: Option<&Fault>, onset_s: f64) -> f64 {
        let end_s = END_D[self.leak_index] * DAY_S;
        let lasting_s = fault.map_or(0.0, Fault::lasting_s);
        let lasting_s = if lasting_s.is_finite() { lasting_s } else { 0.0 };
        let after_s = match self.leak {
            None => 7.0 * DAY_S,
            Some(leak) => {
                let since_s = (leak.onset_s - onset_s - lasting_s).max(0.0);
                since_s + allowed_delay_s(leak.rate_pa_s) + HOUR_S
            }
        };
        (onset_s - EPOCH_S + lasting_s + after_s).min(end_s)
    }

    fn histories(&self, campaign: &Campaign, case: &Case) -> Result<Histories, Failure> {
        let always = matches!(
            case.fault,
            Some(
                Fault::Span { .. }
                    | Fault::Quantised { .. }
                    | Fault::Swapped { .. }
                    | Fault::Units { .. }
                    | Fault::Shifted { .. }
            )
        );
        let first = if always { 0 } else { self.learning };
        let end = self.record.rows().take_while(|row| row.measured_s <= case.until_s).count();
        let good = part(&self.record, first..end);
        let begin = (!always).then_some(&self.learnt[..]);
        let subject = &campaign.subject;
        let Some(fault) = &case.fault else {
            let history = subject.run(begin, &good.without("ambient"))?;
            return Ok(Histories { history, unbroken: None });
        };
        let faulty = fault.inject(&good, case.onset_s, self.seed)?.without("ambient");
        let history = subject.run(begin, &faulty)?;
        let unbroken = match fault {
            Fault::PowerCycles { .. } => Some(subject.run(begin, &good.without("ambient"))?.digest),
            _ => None,
        };
        Ok(Histories { history, unbroken })
    }
}

/// Some of the rows.
pub fn part(record: &Record, rows: std::ops::Range<usize>) -> Record {
    let rows: Vec<&Arrival> = record.rows().skip(rows.start).take(rows.len()).collect();
    Record { sensors: record.sensors.clone(), steps: rows.into_iter().cloned().map(Step::Row).collect() }
}
