//! Faults of how rows arrive: missing, twice, out of order, with a wrong clock; and of the power.
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::StandardNormal;

use super::{Arrival, Fault, Record, Snapshot, Step};
use crate::EvaluationError;

/// Time within which a row comes for the second time, s.
const DUPLICATE_WITHIN_S: f64 = 600.0;

/// Time after a connection stands again at which the store is replayed, s: live rows come first.
const REPLAYED_AFTER_S: f64 = 300.0;

/// 1 January 2026 in seconds since 1970: a clock that falls back to 1970 loses this and what has passed since.
pub(crate) const EPOCH_S: f64 = 1_767_225_600.0;

impl Fault {
    /// Change how rows arrive.
    pub(super) fn change_arrival(
        &self,
        record: &mut Record,
        onset_s: f64,
        seed: u64,
    ) -> Result<(), EvaluationError> {
        let random = ChaCha8Rng::seed_from_u64(seed);
        let until_s = onset_s + self.lasting_s();
        match self {
            Self::Gap { .. } => record
                .steps
                .retain(|step| step.row().is_none_or(|row| row.stamp_s < onset_s || row.stamp_s >= until_s)),
            Self::Duplicates { share } => twice(record, onset_s, *share, random),
            Self::OutOfOrder { by_s, share } => disorder(record, onset_s, (*by_s, *share), random),
            Self::Replay { again, historical, .. } => {
                replay(record, onset_s..until_s, *again, *historical);
            }
            Self::ClockJump { by_s, .. } => {
                let wrong = |row: &&mut Arrival| row.stamp_s >= onset_s && row.stamp_s < until_s;
                record.rows_mut().filter(wrong).for_each(|row| row.stamp_s += by_s);
            }
            Self::ClockDrift { rate } => {
                let after = |row: &&mut Arrival| row.stamp_s >= onset_s;
                record.rows_mut().filter(after).for_each(|row| row.stamp_s += rate * (row.stamp_s - onset_s));
            }
            Self::Irregular { shortest_s, longest_s, noise_k, noise_pa } => {
                let noise: Vec<f64> = record
                    .sensors
                    .iter()
                    .map(|s| if s == "pressure" { *noise_pa } else { *noise_k })
                    .collect();
                irregular(record, onset_s, (*shortest_s, *longest_s), &noise, random);
            }
            Self::Shifted { sensor, by_s } => shift(record, record.sensor(sensor)?, *by_s),
            Self::PowerCycles { mean_s, snapshot } => power(record, onset_s, *mean_s, *snapshot, random),
            _ => {}
        }
        Ok(())
    }
}

/// Power cycles at exponentially distributed intervals, each right after a row.
fn power(record: &mut Record, onset_s: f64, mean_s: f64, snapshot: Snapshot, mut random: ChaCha8Rng) {
    let mut due_s = onset_s;
    let mut steps = Vec::with_capacity(record.steps.len());
    for (time_s, step) in timed(record) {
        steps.push(step);
        if time_s >= due_s {
            steps.push(Step::PowerCycle(snapshot));
            let uniform: f64 = random.random();
            due_s = time_s - mean_s * (1.0 - uniform).ln();
        }
    }
    record.steps = steps;
}

/// Steps in the order of keys, the first of equal ones first.
fn in_order(mut keyed: Vec<(f64, Step)>) -> Vec<Step> {
    keyed.sort_by(|a, b| a.0.total_cmp(&b.0));
    keyed.into_iter().map(|(_, step)| step).collect()
}

/// Steps with the times at which they come, s.
fn timed(record: &mut Record) -> impl Iterator<Item = (f64, Step)> {
    let mut latest_s = f64::NEG_INFINITY;
    std::mem::take(&mut record.steps).into_iter().map(move |step| {
        latest_s = step.row().map_or(latest_s, |row| row.stamp_s);
        (latest_s, step)
    })
}

fn twice(record: &mut Record, onset_s: f64, share: f64, mut random: ChaCha8Rng) {
    let mut keyed = Vec::new();
    for (time_s, step) in timed(record) {
        if time_s >= onset_s && random.random::<f64>() < share {
            keyed.push((time_s + DUPLICATE_WITHIN_S * random.random::<f64>(), step.clone()));
        }
        keyed.push((time_s, step));
    }
    record.steps = in_order(keyed);
}

/// A row that would come after the last one is not delayed: there, nothing but late rows would come any more.
fn disorder(record: &mut Record, onset_s: f64, (by_s, share): (f64, f64), mut random: ChaCha8Rng) {
    let end_s = record.rows().map(|row| row.stamp_s).fold(f64::NEG_INFINITY, f64::max);
    let mut keyed = Vec::new();
    for (time_s, step) in timed(record) {
        let delayed = time_s >= onset_s && random.random::<f64>() < share;
        let delay_s = if delayed { by_s * random.random::<f64>() } else { 0.0 };
        keyed.push((if time_s + delay_s <= end_s { time_s + delay_s } else { time_s }, step));
    }
    record.steps = in_order(keyed);
}

/// The rows of a while after it, when live ones come again.
fn replay(record: &mut Record, during_s: std::ops::Range<f64>, again: bool, historical: bool) {
    let mut keyed = Vec::new();
    for (time_s, step) in timed(record) {
        match step {
            Step::Row(row) if during_s.contains(&time_s) => {
                if again {
                    keyed.push((time_s, Step::Row(row.clone())));
                }
                keyed.push((during_s.end + REPLAYED_AFTER_S, Step::Row(Arrival { historical, ..row })));
            }
            step => keyed.push((time_s, step)),
        }
    }
    record.steps = in_order(keyed);
}

/// Rows at intervals drawn evenly by their logarithm, linear between neighbours.
fn irregular(
    record: &mut Record,
    onset_s: f64,
    (shortest_s, longest_s): (f64, f64),
    noise: &[f64],
    mut random: ChaCha8Rng,
) {
    let mut steps = Vec::new();
    let mut due_s = onset_s;
    let mut before: Option<Arrival> = None;
    for step in std::mem::take(&mut record.steps) {
        let Step::Row(row) = step else {
            steps.push(step);
            continue;
        };
        if row.stamp_s < onset_s {
            before = Some(row.clone());
            steps.push(Step::Row(row));
            continue;
        }
        let from = before.get_or_insert_with(|| row.clone());
        while due_s <= row.stamp_s {
            let readings = between(from, &row, due_s)
                .zip(noise)
                .map(|(reading, sd)| reading + sd * random.sample::<f64, _>(StandardNormal))
                .collect();
            steps.push(Step::Row(Arrival::live(due_s, readings)));
            let share: f64 = random.random();
            due_s += shortest_s * (longest_s / shortest_s).powf(share);
        }
        before = Some(row);
    }
    record.steps = steps;
}

/// Readings on the straight line between two rows.
fn between<'a>(from: &'a Arrival, to: &'a Arrival, time_s: f64) -> impl Iterator<Item = f64> + 'a {
    let span_s = to.stamp_s - from.stamp_s;
    let weight = if span_s > 0.0 { (time_s - from.stamp_s) / span_s } else { 1.0 };
    from.readings.iter().zip(&to.readings).map(move |(a, b)| a + weight * (b - a))
}

/// One sensor's readings as they were before; linear between rows, none before the first.
fn shift(record: &mut Record, sensor: usize, by_s: f64) {
    let known: Vec<(f64, f64)> = record.rows().map(|row| (row.stamp_s, row.readings[sensor])).collect();
    for row in record.rows_mut() {
        let at_s = row.stamp_s - by_s;
        let next = known.partition_point(|(time_s, _)| *time_s <= at_s);
        row.readings[sensor] = match (next.checked_sub(1).map(|before| known[before]), known.get(next)) {
            (Some((_, value)), None) => value,
            (Some((a_s, a)), Some((b_s, b))) => a + (at_s - a_s) / (b_s - a_s) * (b - a),
            (None, _) => f64::NAN,
        };
    }
}
