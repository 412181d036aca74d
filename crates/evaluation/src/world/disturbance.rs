//! What surroundings do beside a climate's own weather: tunnels, cold nights, sun, rain, heaters, air conditioning, speed.
//!
//! A [`Disturbance`] changes the series of a scenario during windows with ramps: with the window's share `s(t)` of 0 to 1 the air is
//! `T + s (T_target - T)` or `T + s dT`, the film `h + s (h_target - h)`. What the surface radiates to follows a change of the air
//! with a lag of 30 min. The series must be continuous, as those of climates are: a jump becomes a ramp to the next knot.
use cylwatch_thermal::ThermalError;
use cylwatch_thermal::scenario::{OutsideFilm, Series, Surroundings};

use super::climate::Lag;

const MELTING_K: f64 = 273.15;
/// Rate at which the air changes at the portals of a tunnel, K/s.
const PORTAL_K_S: f64 = 3.0;
/// Knots with which a ramp of the share is followed.
const RAMP_S: f64 = 60.0;
/// Film of water that runs down, and of ice that melts, W/(m² K): the skin all but has their temperature.
const FILM_WET_W_M2_K: f64 = 150.0;
/// Share of the time in which moving shade leaves the sun, and its period, s.
const SHADE_PERIOD_S: f64 = 900.0;
const SUNLIT: f64 = 0.75;
/// Lag of what the surface radiates to behind the air, s.
const RADIATION_LAG_S: f64 = 1800.0;
/// Distance of knots while radiation falls behind, s.
const KNOTS_S: f64 = 300.0;

/// Something that the surroundings do for a while.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Disturbance {
    /// Beginning, s.
    pub start_s: f64,
    /// Duration, s.
    pub lasting_s: f64,
    /// What they do.
    pub kind: Surrounding,
}

/// What surroundings do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Surrounding {
    /// One tunnel after the other, entered and left at 3 K/s.
    Tunnels {
        /// Air in the tunnel, K.
        air_k: f64,
        /// Time in a tunnel, s.
        stay_s: f64,
        /// From one entrance to the next, s.
        every_s: f64,
    },
    /// The air becomes colder or warmer, evenly within a time, and comes back as slowly at the end.
    Air {
        /// By so much, K.
        by_k: f64,
        /// Within so long, s.
        within_s: f64,
    },
    /// Sun on the shoulder and the valve, with shade that moves over it four times an hour.
    Sun {
        /// Irradiance normal to the rays, W/m².
        irradiance_w_m2: f64,
        /// Film by convection meanwhile, W/(m² K): a train in the sun stands.
        film_w_m2_k: f64,
    },
    /// Water of a temperature runs over the bottle; if it is that of melting ice, it stays at 0 °C until the ice has gone.
    Wet {
        /// Water against the air, K; never below 0 °C.
        by_k: f64,
        /// Time at 0 °C afterwards, s.
        melting_s: f64,
    },
    /// Something warm or cold beside the bottle: more at one end than at the other.
    Heater {
        /// Difference of the air from bottom to top, K.
        difference_k: f64,
    },
    /// A hall of constant temperature.
    Hall {
        /// Air, K.
        air_k: f64,
    },
    /// Air conditioning that switches: the air rises and falls evenly.
    Cycling {
        /// To either side, K.
        by_k: f64,
        /// Period, s.
        period_s: f64,
    },
    /// Standing and fast travel by turns.
    Speed {
        /// Film by convection at a stand, W/(m² K).
        standing_w_m2_k: f64,
        /// Film by convection at speed, W/(m² K).
        fast_w_m2_k: f64,
        /// Period, s.
        period_s: f64,
    },
}

impl Disturbance {
    /// Change the surroundings.
    pub(super) fn apply(&self, around: &mut Surroundings) -> Result<(), ThermalError> {
        match self.kind {
            Surrounding::Tunnels { air_k, .. } => {
                self.change_air(around, |t_s, air| air + self.share(t_s, air) * (air_k - air))
            }
            Surrounding::Air { by_k, .. } => {
                self.change_air(around, |t_s, air| air + self.share(t_s, air) * by_k)
            }
            Surrounding::Hall { air_k } => {
                self.change_air(around, |t_s, air| air + self.share(t_s, air) * (air_k - air))
            }
            Surrounding::Cycling { by_k, period_s } => self.change_air(around, |t_s, air| {
                air + self.share(t_s, air) * by_k * triangle((t_s - self.start_s) / period_s)
            }),
            Surrounding::Sun { irradiance_w_m2, film_w_m2_k } => {
                self.change_film(around, |t_s| (self.share(t_s, 0.0), film_w_m2_k))?;
                self.add_sun(around, irradiance_w_m2)
            }
            Surrounding::Wet { by_k, .. } => {
                self.change_air(around, |t_s, air| {
                    let water_k = if self.is_melting(t_s) { MELTING_K } else { (air + by_k).max(MELTING_K) };
                    air + self.share(t_s, air) * (water_k - air)
                })?;
                self.change_film(around, |t_s| (self.share(t_s, 0.0), FILM_WET_W_M2_K))
            }
            Surrounding::Heater { difference_k } => {
                let edges = self.edges_s();
                let before = around.axial.air_difference_k.clone().unwrap_or_else(|| Series::constant(0.0));
                let heated =
                    changed(&before, &edges, |t_s, value| value + self.share(t_s, 0.0) * difference_k)?;
                around.axial.air_difference_k = Some(heated);
                Ok(())
            }
            Surrounding::Speed { standing_w_m2_k, fast_w_m2_k, period_s } => {
                self.change_film(around, |t_s| {
                    let share =
                        0.5 + 0.5 * (4.0 * triangle((t_s - self.start_s) / period_s)).clamp(-1.0, 1.0);
                    (self.share(t_s, 0.0), standing_w_m2_k + share * (fast_w_m2_k - standing_w_m2_k))
                })
            }
        }
    }

    fn is_melting(&self, t_s: f64) -> bool {
        match self.kind {
            Surrounding::Wet { melting_s, .. } => t_s > self.start_s + self.lasting_s - melting_s,
            _ => false,
        }
    }

    /// Windows in which it acts: beginning, end and ramp, s, for an air temperature before, K.
    fn windows(&self, air: f64) -> Vec<(f64, f64, f64)> {
        let end_s = self.start_s + self.lasting_s;
        match self.kind {
            Surrounding::Tunnels { air_k, stay_s, every_s } => {
                let count = (self.lasting_s / every_s).ceil().max(1.0) as usize;
                let ramp_s = ((air_k - air).abs() / PORTAL_K_S).clamp(1.0, 0.5 * stay_s);
                let begin = |k: usize| self.start_s + k as f64 * every_s;
                (0..count).map(|k| (begin(k), begin(k) + stay_s, ramp_s)).collect()
            }
            Surrounding::Air { within_s, .. } => {
                vec![(self.start_s, end_s, within_s.min(0.5 * self.lasting_s))]
            }
            _ => vec![(self.start_s, end_s, RAMP_S.min(0.5 * self.lasting_s))],
        }
    }

    /// Share with which it acts at a time with the air as it was, K.
    fn share(&self, t_s: f64, air: f64) -> f64 {
        let trapezoid = |&(from, to, ramp): &(f64, f64, f64)| {
            ((t_s - from) / ramp).min((to - t_s) / ramp).clamp(0.0, 1.0)
        };
        self.windows(air).iter().map(trapezoid).fold(0.0, f64::max)
    }

    /// Knots that the change needs, s.
    fn edges_s(&self) -> Vec<f64> {
        // The ramps of portals depend on the air: knots for the shortest and the longest of them.
        let mut edges: Vec<f64> = [260.0, 270.0, 280.0, 290.0]
            .iter()
            .flat_map(|&air| self.windows(air))
            .flat_map(|(from, to, ramp)| [from, from + ramp, to - ramp, to])
            .collect();
        let period_s = match self.kind {
            Surrounding::Cycling { period_s, .. } => 0.25 * period_s,
            Surrounding::Speed { period_s, .. } => period_s / 16.0,
            Surrounding::Sun { .. } => 0.05 * SHADE_PERIOD_S,
            _ => KNOTS_S,
        };
        let count = (self.lasting_s / period_s) as usize;
        edges.extend((0..=count).map(|k| self.start_s + k as f64 * period_s));
        if let Surrounding::Wet { melting_s, .. } = self.kind {
            let melts_s = self.start_s + self.lasting_s - melting_s;
            edges.extend([melts_s, melts_s + RAMP_S]);
        }
        edges
    }

    fn change_air(
        &self,
        around: &mut Surroundings,
        change: impl Fn(f64, f64) -> f64,
    ) -> Result<(), ThermalError> {
        let before = around.air_k.clone();
        around.air_k = changed(&before, &self.edges_s(), change)?;
        let Some(radiation_k) = &around.radiation_k else { return Ok(()) };
        // The lag outlasts the disturbance by a few hours.
        let mut edges = self.edges_s();
        edges.extend((1..48).map(|k| self.start_s + self.lasting_s + f64::from(k) * KNOTS_S));
        let mut lag = Lag::settled(self.start_s, 0.0, RADIATION_LAG_S);
        around.radiation_k = Some(changed(radiation_k, &edges, |t_s, value| {
            let by_k = around.air_k.at(t_s) - before.at(t_s);
            if t_s < self.start_s { value } else { value + lag.follow(t_s, by_k) }
        })?);
        Ok(())
    }

    fn change_film(
        &self,
        around: &mut Surroundings,
        target: impl Fn(f64) -> (f64, f64),
    ) -> Result<(), ThermalError> {
        if let OutsideFilm::Coefficient { film_w_m2_k } = &mut around.film {
            *film_w_m2_k = changed(film_w_m2_k, &self.edges_s(), |t_s, film| {
                let (share, target) = target(t_s);
                film + share * (target - film)
            })?;
        }
        Ok(())
    }

    fn add_sun(&self, around: &mut Surroundings, irradiance_w_m2: f64) -> Result<(), ThermalError> {
        if let Some(sun) = &mut around.sun {
            sun.irradiance_w_m2 = changed(&sun.irradiance_w_m2, &self.edges_s(), |t_s, value| {
                let phase = ((t_s - self.start_s) / SHADE_PERIOD_S).rem_euclid(1.0);
                let lit = if phase < SUNLIT { irradiance_w_m2 } else { 0.0 };
                value + self.share(t_s, 0.0) * (lit - value)
            })?;
        }
        Ok(())
    }
}

/// A triangle between -1 and 1 of period 1 that begins at 0 and rises.
fn triangle(phase: f64) -> f64 {
    let phase = (phase + 0.25).rem_euclid(1.0);
    1.0 - 4.0 * (phase - 0.5).abs()
}

/// A series with more knots, its values changed by a function of time, s, and value.
fn changed(
    series: &Series,
    edges_s: &[f64],
    mut change: impl FnMut(f64, f64) -> f64,
) -> Result<Series, ThermalError> {
    let mut knots: Vec<f64> =
        series.edges_s().chain(edges_s.iter().copied()).filter(|&t_s| t_s >= 0.0).collect();
    knots.sort_by(f64::total_cmp);
    knots.dedup();
    let values = knots.iter().map(|&t_s| change(t_s, series.at(t_s))).collect();
    Series::try_new(knots, values)
}
