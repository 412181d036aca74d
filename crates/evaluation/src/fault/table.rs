//! The table of faults: what each row draws, and what must come of it.
use cylwatch_thermal::units::{BAR_PA, DAY_S, HOUR_S, MINUTE_S, YEAR_S};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde::{Deserialize, Serialize};

use super::{DeadCode, EPOCH_S, Fault, Snapshot, UnitConfusion};

/// Full scale of the transmitter that the relative errors of the table are of, Pa.
pub(crate) const TABLE_FULL_SCALE_PA: f64 = 250.0 * BAR_PA;
/// Noise of a typical transmitter, Pa, and of a typical thermometer, K.
const NOISE_PA: f64 = 1e3;
const NOISE_K: f64 = 0.05;

/// A row of the table of faults.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
pub enum TableRow {
    /// Pressure stuck for 6 h to 30 d.
    P1,
    /// Pressure offset jumps by 0.5, 2 or 5 bar.
    P2,
    /// Pressure drifts by 0.4, 2 or 10 bar a year.
    P3,
    /// Span off by 0.5 %, temperature coefficient of 0.15 % of full scale per 10 K.
    P4,
    /// Noise tenfold; or steps of 0.1 or 0.5 bar.
    P5,
    /// Spikes of 50 bar, 1 to 3 samples long, 0.1 to 5 % of samples.
    P6,
    /// Zero, full scale, NaN, infinity, -999, broken wire.
    P7,
    /// A thermometer stuck for 6 h to 30 d.
    T1,
    /// A thermometer's offset jumps by 1 or 5 K.
    T2,
    /// A thermometer drifts by 0.5 K a year.
    T3,
    /// A thermometer has spikes of 10 to 50 K.
    T4,
    /// Shoulder, valve or both lost.
    T5,
    /// Sensors swapped, or units mixed up.
    T6,
    /// A thermometer hangs in the air.
    T7,
    /// Tunnels, hourly.
    E1,
    /// A cold night, -20 K in 8 h.
    E2,
    /// Sun on the shoulder, +15 K for 2 h, with moving shade.
    E3,
    /// Rain or washing, -10 K on the skin, ice that melts at 0 °C.
    E4,
    /// Heater beside the bottle, air conditioning that cycles.
    E5,
    /// Standing, then 200 km/h.
    E6,
    /// Pulses of the pressure around a gauge transmitter, 0.1 bar.
    E7,
    /// Refill, fast and slow, and exchange of the bottle.
    G1,
    /// Discharge, full or partial, in 10 to 60 s.
    G2,
    /// Puffs of 0.5 to 2 bar.
    G3,
    /// A leak that grows, comes and goes, or stops.
    G4,
    /// A leak masked by warming.
    G5,
    /// Gaps of a minute to 60 d.
    D1,
    /// Duplicates, out of order, late, replayed.
    D2,
    /// Clock jumps and drift.
    D3,
    /// Irregular sampling, shifts between channels.
    D4,
    /// Power cycles.
    D5,
}

/// What must come of a row of the table. None of them may end in a panic, in NaN, or in the verdict that the cylinder is tight while
/// nothing usable says so.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Requirement {
    /// As if it had not been: no leak where there is none, and a leak is found.
    Survived,
    /// The sensor is named while it is at fault; no leak where there is none; a leak is found, or it is said that it cannot be known.
    Flagged,
    /// The jump is told from a leak: no leak where there is none; a leak is found.
    NotALeak,
    /// One cylinder alone cannot tell it from a leak, if it is large enough to be one: a leak may be said, or that it cannot be known; a
    /// leak is found or that is said.
    Undecidable,
    /// Less certain: no leak where there is none; a leak is found, or it is said that it cannot be known.
    Degraded,
    /// Statement at commissioning, or harmless: no leak where there is none; a leak is found, or there is a warning.
    Warned,
    /// Statement by an event of its kind: no leak where there is none.
    Recognised,
    /// Found as a leak.
    Found,
    /// The restart goes on as if it had not been, or says that it begins anew: never silent, no leak where there is none; a leak is found.
    Continued,
}

impl TableRow {
    /// All rows.
    pub const ALL: [Self; 31] = {
        use TableRow::*;
        [
            P1, P2, P3, P4, P5, P6, P7, T1, T2, T3, T4, T5, T6, T7, E1, E2, E3, E4, E5, E6, E7, G1, G2, G3,
            G4, G5, D1, D2, D3, D4, D5,
        ]
    };

    /// Its name, e.g. `P1`.
    pub fn name(self) -> String {
        format!("{self:?}")
    }

    /// What must come of it.
    pub fn requirement(self) -> Requirement {
        use TableRow::*;
        match self {
            P1 | P7 | T1 | T2 | T7 => Requirement::Flagged,
            P2 => Requirement::NotALeak,
            P3 => Requirement::Undecidable,
            T5 | E3 | E5 => Requirement::Degraded,
            T6 => Requirement::Warned,
            G1 | G2 | G3 => Requirement::Recognised,
            G4 | G5 => Requirement::Found,
            D5 => Requirement::Continued,
            P4 | P5 | P6 | T3 | T4 | E1 | E2 | E4 | E6 | E7 | D1 | D2 | D3 | D4 => Requirement::Survived,
        }
    }

    /// Whether it happens to the data, else to the cylinder: then [`TableRow::draw`] has nothing.
    pub fn is_of_data(self) -> bool {
        use TableRow::*;
        !matches!(self, E1 | E2 | E3 | E4 | E5 | E6 | G1 | G2 | G3 | G4 | G5)
    }

    /// A fault of this row, its parameters drawn from a seed over what the table states; `None` for what happens to the cylinder itself.
    pub fn draw(self, seed: u64) -> Option<Fault> {
        let mut draw = Draw(ChaCha8Rng::seed_from_u64(seed));
        draw.0.set_stream(self as u64);
        match self {
            Self::P1 | Self::P2 | Self::P3 | Self::P4 | Self::P5 | Self::P6 | Self::P7 | Self::E7 => {
                draw.of_pressure(self)
            }
            Self::T1 | Self::T2 | Self::T3 | Self::T4 | Self::T5 | Self::T6 | Self::T7 => {
                draw.of_temperature(self)
            }
            _ => draw.of_arrival(self),
        }
    }
}

/// Draws of one row.
struct Draw(ChaCha8Rng);

impl Draw {
    fn one<T: Copy>(&mut self, of: &[T]) -> T {
        of[self.0.random_range(0..of.len())]
    }

    fn signed(&mut self, of: &[f64]) -> f64 {
        let sign = self.one(&[-1.0, 1.0]);
        sign * self.one(of)
    }

    /// Evenly by the logarithm.
    fn between(&mut self, low: f64, high: f64) -> f64 {
        low * (high / low).powf(self.0.random::<f64>())
    }

    fn thermometer(&mut self) -> String {
        self.one(&["shoulder", "valve"]).to_owned()
    }

    fn of_pressure(&mut self, row: TableRow) -> Option<Fault> {
        let sensor = String::from("pressure");
        Some(match row {
            TableRow::P1 => Fault::Stuck { sensor, lasting_s: self.between(6.0 * HOUR_S, 30.0 * DAY_S) },
            TableRow::P2 => Fault::Offset { sensor, by: self.signed(&[0.5, 2.0, 5.0]) * BAR_PA },
            TableRow::P3 => Fault::Drift { sensor, per_s: self.signed(&[0.4, 2.0, 10.0]) * BAR_PA / YEAR_S },
            TableRow::P4 => Fault::Span {
                sensor,
                share: self.signed(&[0.005]),
                per_k: self.signed(&[0.0015]) * TABLE_FULL_SCALE_PA / 10.0,
            },
            TableRow::P5 => match self.0.random_range(0..3) {
                // Ten times the noise: 99 times the variance on top.
                0 => Fault::Noise { sensor, sd: 99_f64.sqrt() * NOISE_PA },
                1 => Fault::Quantised { sensor, step: 0.1 * BAR_PA },
                _ => Fault::Quantised { sensor, step: 0.5 * BAR_PA },
            },
            TableRow::P6 => {
                Fault::Spikes { sensor, height: 50.0 * BAR_PA, longest: 3, share: self.between(0.001, 0.05) }
            }
            TableRow::P7 => {
                let lasting_s = self.between(HOUR_S, 4.0 * DAY_S);
                let code = self.one(&DeadCode::ALL);
                Fault::Dead { sensor, code, full_scale_pa: TABLE_FULL_SCALE_PA, lasting_s }
            }
            TableRow::E7 => {
                Fault::Pulses { sensor, height_pa: 0.1 * BAR_PA, mean_s: self.between(20.0, 1200.0) }
            }
            _ => return None,
        })
    }

    fn of_temperature(&mut self, row: TableRow) -> Option<Fault> {
        let sensor = self.thermometer();
        Some(match row {
            TableRow::T1 => Fault::Stuck { sensor, lasting_s: self.between(6.0 * HOUR_S, 30.0 * DAY_S) },
            TableRow::T2 => Fault::Offset { sensor, by: self.signed(&[1.0, 5.0]) },
            TableRow::T3 => Fault::Drift { sensor, per_s: self.signed(&[0.5]) / YEAR_S },
            TableRow::T4 => Fault::Spikes {
                sensor,
                height: self.between(10.0, 50.0),
                longest: 3,
                share: self.between(0.001, 0.05),
            },
            TableRow::T5 => {
                let lost: &[&str] = self.one(&[&["shoulder"][..], &["valve"], &["shoulder", "valve"]]);
                let lasting_s = self.between(HOUR_S, 30.0 * DAY_S);
                Fault::Lost { sensors: lost.iter().map(|name| (*name).to_owned()).collect(), lasting_s }
            }
            TableRow::T6 => self.mistake(),
            TableRow::T7 => Fault::Detached { sensor, noise_k: 0.3 },
            _ => return None,
        })
    }

    /// One time in nine the thermometers have each other's place, else a unit is wrong.
    fn mistake(&mut self) -> Fault {
        let Some(&mix_up) = UnitConfusion::ALL.get(self.0.random_range(0..=UnitConfusion::ALL.len())) else {
            return Fault::Swapped { first: "shoulder".into(), second: "valve".into() };
        };
        let sensors: &[&str] = if mix_up.is_of_pressure() { &["pressure"] } else { &["shoulder", "valve"] };
        Fault::Units { sensors: sensors.iter().map(|name| (*name).to_owned()).collect(), mix_up }
    }

    fn of_arrival(&mut self, row: TableRow) -> Option<Fault> {
        Some(match row {
            TableRow::D1 => Fault::Gap { lasting_s: self.between(MINUTE_S, 60.0 * DAY_S) },
            TableRow::D2 => match self.0.random_range(0..5) {
                0 => Fault::Duplicates { share: self.between(0.01, 0.5) },
                1 => Fault::OutOfOrder { by_s: 600.0, share: self.between(0.01, 1.0) },
                2 => Fault::OutOfOrder { by_s: 6.0 * HOUR_S, share: self.between(0.001, 0.05) },
                _ => {
                    let length_s = self.between(HOUR_S, DAY_S);
                    Fault::Replay { length_s, again: self.0.random(), historical: self.0.random() }
                }
            },
            TableRow::D3 => self.clock(),
            TableRow::D4 => {
                if self.0.random() {
                    let sensor = self.one(&["shoulder", "valve", "pressure"]).to_owned();
                    Fault::Shifted { sensor, by_s: 120.0 * self.0.random::<f64>() }
                } else {
                    Fault::Irregular {
                        shortest_s: 1.0,
                        longest_s: 600.0,
                        noise_k: NOISE_K,
                        noise_pa: NOISE_PA,
                    }
                }
            }
            TableRow::D5 => {
                use Snapshot::{Corrupted, Current, Foreign, Old, Truncated};
                let snapshot = self.one(&[Current, Current, Old, Truncated, Corrupted, Foreign]);
                // What cannot be taken up begins anew: once, so that there is a time after it.
                let mean_s = if matches!(snapshot, Current | Old) { 6.0 * HOUR_S } else { 1e3 * YEAR_S };
                Fault::PowerCycles { mean_s, snapshot }
            }
            _ => return None,
        })
    }

    fn clock(&mut self) -> Fault {
        let while_s = self.between(10.0 * MINUTE_S, DAY_S);
        let lasting_s = self.one(&[None, Some(while_s)]);
        match self.0.random_range(0..6) {
            0 => Fault::ClockJump { by_s: self.signed(&[HOUR_S]), lasting_s: None },
            1 => Fault::ClockJump { by_s: self.signed(&[30.0]), lasting_s: None },
            2 => Fault::ClockJump { by_s: -EPOCH_S, lasting_s },
            3 => Fault::ClockJump { by_s: 10.0 * YEAR_S, lasting_s },
            4 => Fault::ClockDrift { rate: self.signed(&[1e-4]) },
            _ => Fault::ClockJump { by_s: self.signed(&[1.0]), lasting_s: None },
        }
    }
}
