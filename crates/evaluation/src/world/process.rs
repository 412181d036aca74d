//! What is done to the gas beside a constant leak: refills, discharges, puffs, leaks that change.
//!
//! A [`Process`] becomes flows of the scenario. Its quantities are stated as losses of the pressure at 15 °C, and turned into masses
//! by the fill: `m = (rho(p, 15 °C) - rho(p - dp, 15 °C)) V`.
use cylwatch_thermal::ThermalError;
use cylwatch_thermal::flow::{Flow, FlowKind};
use cylwatch_thermal::scenario::Series;
use cylwatch_thermal::trajectory::Trajectory;
use cylwatch_thermal::units::{ATMOSPHERE_PA, BAR_PA, QUOTED_K};
use cylwatch_thermal::vessel::Vessel;

use super::flows::flow;

/// Interval at which a changing leak changes, s.
const STAIR_S: f64 = 1800.0;
/// Duration of a puff, s.
const PUFF_S: f64 = 2.0;
/// Bore through which a refill enters, m: that of a cylinder valve.
const INLET_M: f64 = 0.006;

/// An exchange of gas.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Process {
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

/// Masses of pressures at 15 °C.
pub(super) struct Settled<'a> {
    pub vessel: &'a Vessel,
    /// Pressure of the fill, Pa.
    pub filled_pa: f64,
}

impl Settled<'_> {
    fn mass_kg(&self, pressure_pa: f64) -> Result<f64, ThermalError> {
        let density = self.vessel.fluid.density_from_pressure_temperature(pressure_pa, QUOTED_K)?;
        Ok(density * self.vessel.volume.volume_m3(QUOTED_K, pressure_pa))
    }

    /// Mass of a change of the pressure from the fill on, kg.
    fn change_kg(&self, by_pa: f64) -> Result<f64, ThermalError> {
        Ok(self.mass_kg(self.filled_pa + by_pa)? - self.mass_kg(self.filled_pa)?)
    }

    /// Mass flow of a loss of pressure at the fill, kg/s.
    fn flow_kg_s(&self, rate_pa_s: f64) -> Result<f64, ThermalError> {
        Ok(-self.change_kg(-BAR_PA)? / BAR_PA * rate_pa_s)
    }
}

impl Process {
    /// Its flows, with the air of the scenario, K.
    pub(super) fn flows(&self, settled: &Settled<'_>, air_k: &Series) -> Result<Vec<Flow>, ThermalError> {
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
    pub(super) fn masked(
        vessel: &Vessel,
        course: &Trajectory,
        (start_s, stop_s): (f64, f64),
        step_s: f64,
    ) -> Result<Self, ThermalError> {
        let nearest = |t_s: f64| course.time_s.partition_point(|&t| t < t_s).min(course.time_s.len() - 1);
        let pressure_pa = course.pressure_pa[nearest(start_s)];
        let mass = |t_s: f64| -> Result<f64, ThermalError> {
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
