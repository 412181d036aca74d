//! What is done to the gas beside a constant leak: refills, discharges, puffs, leaks that change, bottles that are exchanged.
//!
//! A [`Process`] becomes flows of the scenario. Its quantities are stated as losses of the pressure at 15 °C, and turned into masses
//! by the fill: `m = (rho(p, 15 °C) - rho(p - dp, 15 °C)) V`.
use cylwatch_thermal::flow::{Flow, FlowKind};
use cylwatch_thermal::scenario::{Scenario, Series};
use cylwatch_thermal::trajectory::Trajectory;
use cylwatch_thermal::units::{ATMOSPHERE_PA, BAR_PA, QUOTED_K};
use cylwatch_thermal::vessel::Fill;
use cylwatch_thermal::vessel::Vessel;
use serde::{Deserialize, Serialize};

use super::Truth;
use super::disturbance::Disturbance;
use crate::EvaluationError;

/// Interval at which a changing leak changes, s.
const STAIR_S: f64 = 1800.0;
/// Duration of a puff, s.
const PUFF_S: f64 = 2.0;
/// Bore through which a refill enters, m: that of a cylinder valve.
const INLET_M: f64 = 0.006;

/// What happens to a cylinder on top of its course.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Happenings {
    /// Pressure of the fill at 15 °C instead of 200 bar, Pa.
    pub fill_pa: Option<f64>,
    /// Exchanges of gas.
    pub processes: Vec<Process>,
    /// What the surroundings do.
    pub disturbances: Vec<Disturbance>,
}

/// An exchange of gas.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", tag = "process")]
pub enum Process {
    /// Gas is put in at a constant rate.
    Refill {
        /// Beginning, s.
        start_s: f64,
        /// Duration, s.
        lasting_s: f64,
        /// Rise of the pressure once it is at 15 °C, Pa.
        rise_pa: f64,
        /// Temperature of the source, K.
        source_k: f64,
    },
    /// Gas goes out through an orifice until a pressure is reached.
    Discharge {
        /// Beginning, s.
        start_s: f64,
        /// Longest duration, s.
        lasting_s: f64,
        /// Bore, m.
        diameter_m: f64,
        /// Pressure at which it closes, Pa.
        until_pa: f64,
    },
    /// Short puffs at even intervals.
    Puffs {
        /// The first one, s.
        start_s: f64,
        /// From one to the next, s.
        every_s: f64,
        /// How many.
        count: usize,
        /// Loss of pressure at 15 °C by each, Pa.
        drop_pa: f64,
    },
    /// A leak between two times.
    Leak {
        /// Beginning, s.
        start_s: f64,
        /// End, s.
        stop_s: f64,
        /// Loss of pressure at 15 °C, Pa/s.
        rate_pa_s: f64,
    },
    /// A leak that grows by a factor of two again and again, up to a largest rate.
    GrowingLeak {
        /// Beginning, s.
        start_s: f64,
        /// End, s.
        stop_s: f64,
        /// Rate at the beginning, Pa/s.
        rate_pa_s: f64,
        /// Time in which it doubles, s.
        doubling_s: f64,
        /// Largest rate, Pa/s.
        largest_pa_s: f64,
    },
    /// A leak that is open only while the air is colder than a temperature: a seal that shrinks.
    ColdLeak {
        /// Beginning, s.
        start_s: f64,
        /// End, s.
        stop_s: f64,
        /// Rate while it is open, Pa/s.
        rate_pa_s: f64,
        /// Air temperature below which it opens, K.
        below_k: f64,
    },
    /// Mass flows out as given, kg/s, constant between equally spaced times.
    Profile {
        /// Beginning, s.
        start_s: f64,
        /// Interval of the values, s.
        step_s: f64,
        /// Mass flows, kg/s.
        flow_kg_s: Vec<f64>,
    },
}

impl Happenings {
    /// Put into a scenario of a vessel what happens.
    ///
    /// # Errors
    /// The fill is no state of the fluid.
    pub fn apply(&self, vessel: &Vessel, scenario: &mut Scenario) -> Result<(), EvaluationError> {
        if let Some(pressure_pa) = self.fill_pa {
            scenario.initial.fill = Fill::Settled { pressure_pa, temperature_k: QUOTED_K };
        }
        for disturbance in &self.disturbances {
            disturbance.apply(&mut scenario.surroundings)?;
        }
        let filled_pa = match scenario.initial.fill {
            Fill::Settled { pressure_pa, .. } | Fill::Pressure { pressure_pa } => pressure_pa,
            Fill::Mass { .. } => return Ok(()),
        };
        let settled = Settled { vessel, filled_pa };
        for process in &self.processes {
            let flows = process.flows(&settled, &scenario.surroundings.air_k)?;
            scenario.flows.extend(flows);
        }
        Ok(())
    }
}

/// Masses of pressures at 15 °C.
struct Settled<'a> {
    vessel: &'a Vessel,
    filled_pa: f64,
}

impl Settled<'_> {
    fn mass_kg(&self, pressure_pa: f64) -> Result<f64, EvaluationError> {
        let density = self.vessel.fluid.density_from_pressure_temperature(pressure_pa, QUOTED_K)?;
        Ok(density * self.vessel.volume.volume_m3(QUOTED_K, pressure_pa))
    }

    /// Mass of a change of the pressure from the fill on, kg.
    fn change_kg(&self, by_pa: f64) -> Result<f64, EvaluationError> {
        Ok(self.mass_kg(self.filled_pa + by_pa)? - self.mass_kg(self.filled_pa)?)
    }

    /// Mass flow of a loss of pressure at the fill, kg/s.
    fn flow_kg_s(&self, rate_pa_s: f64) -> Result<f64, EvaluationError> {
        Ok(-self.change_kg(-BAR_PA)? / BAR_PA * rate_pa_s)
    }
}

impl Process {
    fn flows(&self, settled: &Settled<'_>, air_k: &Series) -> Result<Vec<Flow>, EvaluationError> {
        let out = |start_s: f64, stop_s: f64, mass_flow_kg_s: f64| {
            flow("leak", (start_s, stop_s), FlowKind::Leak { mass_flow_kg_s })
        };
        Ok(match self {
            Self::Refill { start_s, lasting_s, rise_pa, source_k } => {
                let kind = FlowKind::Refill {
                    mass_flow_kg_s: settled.change_kg(*rise_pa)? / lasting_s,
                    source_temperature_k: *source_k,
                    source_pressure_pa: settled.filled_pa + rise_pa,
                    inlet_diameter_m: Some(INLET_M),
                };
                vec![flow("refill", (*start_s, start_s + lasting_s), kind)]
            }
            Self::Discharge { start_s, lasting_s, diameter_m, until_pa } => {
                let kind = FlowKind::Orifice {
                    diameter_m: *diameter_m,
                    discharge_coefficient: 0.8,
                    back_pressure_pa: ATMOSPHERE_PA,
                };
                let open = flow("discharge", (*start_s, start_s + lasting_s), kind);
                vec![Flow { closes_below_pa: Some(*until_pa), ..open }]
            }
            Self::Puffs { start_s, every_s, count, drop_pa } => {
                let rate = -settled.change_kg(-drop_pa)? / PUFF_S;
                let begin = |k: usize| start_s + k as f64 * every_s;
                (0..*count).map(|k| out(begin(k), begin(k) + PUFF_S, rate)).collect()
            }
            Self::Leak { start_s, stop_s, rate_pa_s } => {
                vec![out(*start_s, *stop_s, settled.flow_kg_s(*rate_pa_s)?)]
            }
            Self::GrowingLeak { start_s, stop_s, rate_pa_s, doubling_s, largest_pa_s } => {
                let full = settled.flow_kg_s(1.0)?;
                let rate = |t_s: f64| (rate_pa_s * ((t_s - start_s) / doubling_s).exp2()).min(*largest_pa_s);
                let stairs = stairs(*start_s, *stop_s);
                stairs.map(|(from, to)| out(from, to, full * rate(0.5 * (from + to)))).collect()
            }
            Self::ColdLeak { start_s, stop_s, rate_pa_s, below_k } => {
                let rate = settled.flow_kg_s(*rate_pa_s)?;
                let is_cold = |&(from, to): &(f64, f64)| air_k.at(0.5 * (from + to)) < *below_k;
                stairs(*start_s, *stop_s).filter(is_cold).map(|(from, to)| out(from, to, rate)).collect()
            }
            Self::Profile { start_s, step_s, flow_kg_s } => {
                let begin = |k: usize| start_s + k as f64 * step_s;
                let steps = flow_kg_s.iter().enumerate().filter(|(_, rate)| **rate > 0.0);
                steps.map(|(k, &rate)| out(begin(k), begin(k + 1), rate)).collect()
            }
        })
    }

    /// The leak that holds the pressure of a course at its value while the gas becomes warmer: exactly masked.
    /// It is open where `rho(p_0, T(t)) V(T(t), p_0)` falls, and lets out just that; `step_s` is its resolution, s. Such a leak cools the
    /// gas itself: after one simulation with the leak of a leak-free course, that of the result is all but exact.
    ///
    /// # Errors
    /// The pressure is no state of the fluid at a temperature of the course.
    pub fn masked(
        vessel: &Vessel,
        course: &Trajectory,
        (start_s, stop_s): (f64, f64),
        step_s: f64,
    ) -> Result<Self, EvaluationError> {
        let nearest = |t_s: f64| course.time_s.partition_point(|&t| t < t_s).min(course.time_s.len() - 1);
        let pressure_pa = course.pressure_pa[nearest(start_s)];
        let mass = |t_s: f64| -> Result<f64, EvaluationError> {
            let index = nearest(t_s);
            let density =
                vessel.fluid.density_from_pressure_temperature(pressure_pa, course.gas_mean_k[index])?;
            Ok(density * vessel.volume.volume_m3(course.wall_mean_k[index], pressure_pa))
        };
        let mut least_kg = mass(start_s)?;
        let mut flow_kg_s = Vec::new();
        for step in 1..=((stop_s - start_s) / step_s).floor() as usize {
            let now_kg = mass(start_s + step as f64 * step_s)?;
            flow_kg_s.push((least_kg - now_kg).max(0.0) / step_s);
            least_kg = least_kg.min(now_kg);
        }
        Ok(Self::Profile { start_s, step_s, flow_kg_s })
    }
}

/// Intervals between two times in which a changing leak is constant, s.
fn stairs(start_s: f64, stop_s: f64) -> impl Iterator<Item = (f64, f64)> {
    let count = ((stop_s - start_s) / STAIR_S).ceil().max(0.0) as usize;
    (0..count).map(move |k| {
        let from_s = start_s + k as f64 * STAIR_S;
        (from_s, (from_s + STAIR_S).min(stop_s))
    })
}

fn flow(name: &str, (start_s, stop_s): (f64, f64), kind: FlowKind) -> Flow {
    let closes = None;
    Flow {
        name: name.into(),
        kind,
        start_s,
        stop_s,
        opens_above_pa: closes,
        closes_below_pa: closes,
        closes_above_pa: closes,
    }
}

impl Truth {
    /// This truth until its bottle is taken away, then, after a while without rows, another bottle: what the place on the
    /// vehicle goes through. Both must have been sampled at the same times.
    pub fn exchanged(&self, by: &Self, at_s: f64, away_s: f64) -> Self {
        let (end, begin) =
            (self.time_s.partition_point(|&t| t < at_s), by.time_s.partition_point(|&t| t < at_s + away_s));
        let join = |a: &[f64], b: &[f64]| [&a[..end], &b[begin..]].concat();
        let width = self.log.channels.len();
        let mut truth = self.clone();
        truth.time_s = join(&self.time_s, &by.time_s);
        truth.gas_mean_k = join(&self.gas_mean_k, &by.gas_mean_k);
        truth.mass_kg = join(&self.mass_kg, &by.mass_kg);
        truth.pressure_pa = join(&self.pressure_pa, &by.pressure_pa);
        truth.ambient_k = join(&self.ambient_k, &by.ambient_k);
        truth.wall_mean_k = join(&self.wall_mean_k, &by.wall_mean_k);
        truth.shoulder_k = join(&self.shoulder_k, &by.shoulder_k);
        truth.valve_k = join(&self.valve_k, &by.valve_k);
        truth.middle_k = join(&self.middle_k, &by.middle_k);
        truth.bottom_k = join(&self.bottom_k, &by.bottom_k);
        truth.log.time_s.clone_from(&truth.time_s);
        truth.log.values = [&self.log.values[..end * width], &by.log.values[begin * width..]].concat();
        truth
    }
}
