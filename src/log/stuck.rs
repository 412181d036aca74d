//! Readings that stand still.
//!
//! A temperature or pressure that keeps its last digit for an hour is normal at rest. It is not while a thermometer on
//! the same cylinder moves by several kelvins: then either the sensor or its wire is dead. The witness must be a
//! thermometer, since a pressure can fall for another reason (a leak) with every temperature at rest.
use crate::estimator::log::Quantity;

/// Rows that a value must repeat.
const ROWS: u32 = 30;
/// Time that it must stand still, s.
const DURATION_S: f64 = 3600.0;
/// How far another thermometer must have moved meanwhile, K.
const MOVED_K: f64 = 5.0;

/// Watches every column of readings.
#[derive(Debug)]
pub(super) struct StuckWatch {
    is_temperature: Vec<bool>,
    runs: Vec<Run>,
}

/// A value since it last changed.
#[derive(Clone, Debug)]
struct Run {
    value: f64,
    since_s: f64,
    rows: u32,
    /// The other readings at the first repetition.
    others: Vec<f64>,
    stuck: bool,
}

impl StuckWatch {
    pub(super) fn new(quantities: impl Iterator<Item = Quantity>) -> Self {
        let is_temperature: Vec<bool> = quantities.map(|q| q == Quantity::Temperature).collect();
        let run = Run { value: f64::NAN, since_s: 0.0, rows: 0, others: Vec::new(), stuck: false };
        let runs = vec![run; is_temperature.len()];
        Self { is_temperature, runs }
    }

    /// Looks at a row; `on_stuck` gets every column whose reading stands still while others move.
    pub(super) fn push(&mut self, time_s: f64, readings: &[f64], mut on_stuck: impl FnMut(usize)) {
        for (column, &value) in readings.iter().enumerate() {
            let run = &mut self.runs[column];
            // An exact comparison on purpose: the last digit counts.
            if value.is_nan() {
                continue;
            }
            if value != run.value {
                (run.value, run.since_s, run.rows, run.stuck) = (value, time_s, 1, false);
                continue;
            }
            run.rows += 1;
            if run.rows == 2 {
                run.others.clear();
                run.others.extend_from_slice(readings);
            } else if !run.stuck && run.rows >= ROWS && time_s - run.since_s >= DURATION_S {
                let moved = |k: usize| {
                    k != column && self.is_temperature[k] && (readings[k] - run.others[k]).abs() > MOVED_K
                };
                run.stuck = (0..readings.len()).any(moved);
            }
            if run.stuck {
                on_stuck(column);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// First row at which the first of two columns counts as stuck, a row a minute.
    fn first_stuck(second: Quantity, rows: impl Fn(u32) -> [f64; 2]) -> Option<u32> {
        let mut watch = StuckWatch::new([Quantity::Temperature, second].into_iter());
        (0..1000).find(|&k| {
            let mut stuck = false;
            watch.push(f64::from(k) * 60.0, &rows(k), |column| stuck |= column == 0);
            stuck
        })
    }

    #[test]
    fn a_thermometer_that_keeps_its_digits_while_another_moves_is_stuck_after_an_hour() {
        let first = first_stuck(Quantity::Temperature, |k| [288.15, 288.15 - 0.1 * f64::from(k)]);
        assert_eq!(first, Some(60));
    }

    #[test]
    fn a_coarse_thermometer_at_rest_is_not_stuck() {
        let noise = |k: u32| if k.is_multiple_of(2) { 0.2 } else { -0.2 };
        assert_eq!(first_stuck(Quantity::Temperature, |k| [288.15, 288.15 + noise(k)]), None);
    }

    #[test]
    fn a_falling_pressure_is_no_witness_since_a_leak_lets_it_fall_at_rest() {
        assert_eq!(first_stuck(Quantity::Pressure, |k| [288.15, 2e7 - 1e4 * f64::from(k)]), None);
    }

    #[test]
    fn a_last_digit_that_moves_is_enough_to_be_alive() {
        let alive =
            |k: u32| [288.15 + if k.is_multiple_of(50) { 0.01 } else { 0.0 }, 288.15 - 0.1 * f64::from(k)];
        assert_eq!(first_stuck(Quantity::Temperature, alive), None);
    }
}
