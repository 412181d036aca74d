//! Rows of the fault table that happen to the cylinder: what the surroundings do (E) and what is done to the gas (G).
//!
//! They are [`Disturbance`]s and [`Process`]es, their parameters drawn by the seed. Pressures of the table, which is written for
//! 200 bar, are parts of the fill here. Where the film follows from a wind, films of the table become winds: 0.3 m/s standing, 15 m/s
//! fast, 0.5 m/s in the sun, 40 m/s for running water, whose film is as large as a wind can make it.
use cylwatch_thermal::scenario::{OutsideFilm, Scenario, Surroundings};
use cylwatch_thermal::simulate::{SimulationSettings, simulate};
use cylwatch_thermal::trajectory::Trajectory;
use cylwatch_thermal::units::{BAR_PA, HOUR_S};
use cylwatch_thermal::vessel::Vessel;

use super::WorldError;
use super::disturbance::{Disturbance, Surrounding};
use super::overlay::FaultRow;
use super::process::{Process, Settled};
use crate::random::{Purpose, Random};

/// Fill that the pressures of the table are written for, Pa.
const TABLE_FILL_PA: f64 = 200.0 * BAR_PA;
/// Part of the fill that a cylinder to be refilled begins with.
pub(super) const BEFORE_REFILL: f64 = 0.8;
/// Time that a bottle is away to be filled elsewhere, s.
const AWAY_S: f64 = HOUR_S;
const WIND_STANDING_M_S: f64 = 0.3;
const WIND_FAST_M_S: f64 = 15.0;
const WIND_SUN_M_S: f64 = 0.5;
const WIND_MOST_M_S: f64 = 40.0;

/// A row of the table, to be put into a simulation.
pub(super) struct CylinderFault<'a> {
    pub row: FaultRow,
    /// Bore through which it is filled, m.
    pub inlet_m: f64,
    pub vessel: &'a Vessel,
    pub seed: u64,
    /// Pressure of the fill at 15 °C, Pa.
    pub fill_pa: f64,
    /// Onset by the clock of the simulation, s.
    pub onset_s: f64,
}

/// What a row does to a scenario.
#[derive(Clone, Debug, Default)]
struct Effect {
    disturbance: Option<Disturbance>,
    process: Option<Process>,
}

/// Whether a row begins with less gas than the fill.
pub(super) const fn begins_low(row: FaultRow) -> bool {
    matches!(row, FaultRow::G1)
}

/// When a bottle is away, s after the onset: without rows.
pub(super) fn away_s(row: FaultRow, seed: u64) -> Option<f64> {
    let is_away = row == FaultRow::G1 && Random::new(seed, Purpose::WorldFault).whole((0, 2)) == 2;
    is_away.then_some(AWAY_S)
}

impl CylinderFault<'_> {
    /// Simulate a scenario with what this row does to it.
    pub(super) fn simulate(
        &self,
        mut scenario: Scenario,
        settings: &SimulationSettings,
    ) -> Result<Trajectory, WorldError> {
        let random = &mut Random::new(self.seed, Purpose::WorldFault);
        let disturbance = self.surrounding(random, &scenario.surroundings);
        let effect = match disturbance {
            _ if self.row == FaultRow::G5 => self.masked(&scenario, settings)?,
            Some(_) => Effect { disturbance, process: None },
            None => Effect { disturbance, process: self.process(random, scenario.duration_s) },
        };
        self.apply(&effect, &mut scenario)?;
        Ok(simulate(self.vessel, &scenario, settings, &mut |_| ())?)
    }

    /// Winds pass through the law of films as if they were films, and come back.
    fn apply(&self, effect: &Effect, scenario: &mut Scenario) -> Result<(), WorldError> {
        let film = scenario.surroundings.film.clone();
        if let OutsideFilm::Convection { wind_m_s, .. } = &film {
            scenario.surroundings.film = OutsideFilm::Coefficient { film_w_m2_k: wind_m_s.clone() };
        }
        if let Some(disturbance) = &effect.disturbance {
            disturbance.apply(&mut scenario.surroundings)?;
        }
        if let Some(process) = &effect.process {
            let settled = Settled { vessel: self.vessel, filled_pa: self.fill_pa };
            scenario.flows.extend(process.flows(&settled, &scenario.surroundings.air_k)?);
        }
        if let (OutsideFilm::Convection { multiplier, .. }, OutsideFilm::Coefficient { film_w_m2_k }) =
            (film, &scenario.surroundings.film)
        {
            let wind_m_s = film_w_m2_k.mapped(|wind_m_s| wind_m_s.min(WIND_MOST_M_S))?;
            scenario.surroundings.film = OutsideFilm::Convection { wind_m_s, multiplier };
        }
        Ok(())
    }

    fn surrounding(&self, random: &mut Random, around: &Surroundings) -> Option<Disturbance> {
        let is_wind = matches!(around.film, OutsideFilm::Convection { .. });
        let flow = |film: f64, wind: f64| if is_wind { wind } else { film };
        let (lasting_s, kind) = match self.row {
            FaultRow::E1 => {
                let air_k = 273.15 + random.uniform((32.0, 42.0));
                let stay_s = random.uniform((1200.0, 2100.0));
                (12.0 * HOUR_S, Surrounding::Tunnels { air_k, stay_s, every_s: HOUR_S })
            }
            FaultRow::E2 => (18.0 * HOUR_S, Surrounding::Air { by_k: -20.0, within_s: 8.0 * HOUR_S }),
            // More than the sun gives to a clean bottle: it makes the shoulder of the 20 L cylinder some 15 K warmer.
            FaultRow::E3 => {
                let film_w_m2_k = flow(5.0, WIND_SUN_M_S);
                (2.0 * HOUR_S, Surrounding::Sun { irradiance_w_m2: 2500.0, film_w_m2_k })
            }
            FaultRow::E4 => {
                let lasting_s = random.uniform((2.0, 5.0)) * HOUR_S;
                (lasting_s, Surrounding::Wet { by_k: -10.0, melting_s: HOUR_S })
            }
            FaultRow::E5 => {
                let kind = match random.whole((0, 2)) {
                    0 => Surrounding::Heater { difference_k: random.uniform((-20.0, 20.0)) },
                    1 => Surrounding::Hall { air_k: 293.15 },
                    _ => Surrounding::Cycling { by_k: 5.0, period_s: 900.0 },
                };
                (random.uniform((6.0, 24.0)) * HOUR_S, kind)
            }
            FaultRow::E6 => {
                let period_s = random.uniform((1.0, 3.0)) * HOUR_S;
                let (standing_w_m2_k, fast_w_m2_k) =
                    (flow(5.0, WIND_STANDING_M_S), flow(50.0, WIND_FAST_M_S));
                (24.0 * HOUR_S, Surrounding::Speed { standing_w_m2_k, fast_w_m2_k, period_s })
            }
            _ => return None,
        };
        Some(Disturbance { start_s: self.onset_s, lasting_s, kind })
    }

    fn process(&self, random: &mut Random, end_s: f64) -> Option<Process> {
        let start_s = self.onset_s;
        let of_fill = |table_bar: f64| table_bar * BAR_PA * self.fill_pa / TABLE_FILL_PA;
        let rate = |table_bar_h: f64| of_fill(table_bar_h) / HOUR_S;
        Some(match self.row {
            FaultRow::G1 => {
                let way = random.whole((0, 2));
                let lasting_s = match way {
                    0 => random.uniform((120.0, 300.0)),
                    1 => random.uniform((1800.0, 5400.0)),
                    _ => 300.0,
                };
                let start_s = if way == 2 { start_s + 0.5 * AWAY_S } else { start_s };
                let rise_pa = (1.0 / BEFORE_REFILL - 1.0) * self.fill_pa;
                Process::Refill { start_s, lasting_s, rise_pa, source_k: 288.15 }
            }
            FaultRow::G2 => {
                let is_full = random.happens(0.5);
                let until = if is_full { 0.1 } else { random.uniform((0.75, 0.92)) };
                let until_pa = (until * self.fill_pa).max(1.5 * BAR_PA);
                let diameter_m = self.inlet_m * if is_full { 1.0 } else { 0.42 };
                Process::Discharge { start_s, lasting_s: 60.0, diameter_m, until_pa }
            }
            FaultRow::G3 => {
                let drop_pa = of_fill(random.uniform((0.5, 2.0)));
                Process::Puffs { start_s, every_s: 8.0 * HOUR_S, count: 3, drop_pa }
            }
            FaultRow::G4 => match random.whole((0, 2)) {
                0 => Process::GrowingLeak {
                    start_s,
                    stop_s: end_s,
                    rate_pa_s: rate(0.01),
                    doubling_s: 24.0 * HOUR_S,
                    largest_pa_s: rate(1.0),
                },
                1 => Process::ColdLeak { start_s, stop_s: end_s, rate_pa_s: rate(0.2), below_k: 276.15 },
                _ => Process::Leak { start_s, stop_s: start_s + 24.0 * HOUR_S, rate_pa_s: rate(0.2) },
            },
            _ => return None,
        })
    }

    /// Warming by 20 K within ten hours, and the leak that hides it: found from the simulation without it, then once more.
    fn masked(&self, scenario: &Scenario, settings: &SimulationSettings) -> Result<Effect, WorldError> {
        let kind = Surrounding::Air { by_k: 20.0, within_s: 10.0 * HOUR_S };
        let warming = Disturbance { start_s: self.onset_s, lasting_s: 30.0 * HOUR_S, kind };
        let mut effect = Effect { disturbance: Some(warming), process: None };
        let (from_s, until_s) = (self.onset_s + HOUR_S, self.onset_s + 10.0 * HOUR_S);
        for _ in 0..2 {
            let mut until = scenario.clone();
            until.duration_s = (self.onset_s + 11.0 * HOUR_S).min(scenario.duration_s);
            self.apply(&effect, &mut until)?;
            let warm = simulate(self.vessel, &until, settings, &mut |_| ())?;
            let window_s = (from_s, until_s.min(until.duration_s));
            effect.process = Some(Process::masked(self.vessel, &warm, window_s, 600.0)?);
        }
        Ok(effect)
    }
}
