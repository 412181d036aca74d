//! A drawn climate as signals of time, and what they become for the simulation.
//!
//! On top of a climate's own air come turbulence, gusts and a difference between the air at the top and at the bottom, all
//! Ornstein-Uhlenbeck with correlation times of 2 min, 2 min and 1 h. The surface radiates to surroundings that follow the air with a
//! lag, less what a clear sky takes away. All signals are linear between the same knots.
use cylwatch_thermal::ThermalError;
use cylwatch_thermal::scenario::{AxialVariation, OutsideFilm, Series, Sun, Surroundings};
use cylwatch_thermal::units::{DAY_S, HOUR_S, ZERO_CELSIUS_K};

use super::Span;
use super::part::{Outside, Polyline, Stay, Trapezoid, sum_at};
use super::unrest::{DIFFERENCE_TIME_S, Unrest};
use crate::random::{OrnsteinUhlenbeck, Purpose, Random};

/// Outside film: what the flow of a climate is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Film {
    /// Coefficient by convection, W/(m² K).
    Coefficient,
    /// Wind, m/s; natural convection is added by the simulation.
    Wind,
}

/// A drawn climate.
pub(super) struct Weather {
    pub outside: Outside,
    /// Air without stays, °C, where it is not the outside air: a hall, a workshop, a chamber.
    pub inside: Option<Polyline>,
    /// In the order of time, not overlapping.
    pub stays: Vec<Stay>,
    pub film: Film,
    /// Film or wind at rest, and the variation of its logarithm with an hour's correlation.
    pub rest: f64,
    pub rest_variation: f64,
    /// Film or wind of trips on top, in the order of time.
    pub trips: Vec<Trapezoid>,
    /// Patches of sunshine in the order of time; their height is the day's peak, W/m².
    pub sun: Vec<Trapezoid>,
    /// Sunrise and sunset, s.
    pub daylight_s: (f64, f64),
    /// Lit stretch of the height, and whether the valve is lit.
    pub lit: (f64, f64, bool),
    /// Lag with which the surroundings follow the air, s.
    pub radiation_lag_s: f64,
    /// What a clear sky takes away from what the surface radiates to, K.
    pub sky_k: f64,
    pub unrest: Unrest,
    /// Times at which the air begins to jump beside the ends of stays, s.
    pub jumps_s: Vec<f64>,
    /// Times in which a heater is on, s.
    pub heated_s: Vec<(f64, f64)>,
}

/// What the surroundings are at one instant.
struct Sky {
    t_s: f64,
    air_k: f64,
    flow: f64,
    radiation_k: f64,
    irradiance_w_m2: f64,
    difference_k: f64,
}

impl Weather {
    /// Air of a place that knows neither sun, sky, trips nor stays: its film at rest, W/(m² K), and its unrest.
    pub(super) fn sheltered(outside: Outside, rest: f64, unrest: Unrest) -> Self {
        Self {
            outside,
            inside: None,
            stays: Vec::new(),
            film: Film::Coefficient,
            rest,
            rest_variation: 0.0,
            trips: Vec::new(),
            sun: Vec::new(),
            daylight_s: (8.0 * HOUR_S, 16.0 * HOUR_S),
            lit: (0.8, 1.0, false),
            radiation_lag_s: 0.0,
            sky_k: 0.0,
            unrest,
            jumps_s: Vec::new(),
            heated_s: Vec::new(),
        }
    }

    /// Stays that can be felt at a time.
    fn stay_at(&self, t_s: f64) -> Option<&Stay> {
        let next = self.stays.partition_point(|stay| stay.enter_s <= t_s);
        next.checked_sub(1).map(|last| &self.stays[last])
    }

    /// Air without turbulence, °C.
    pub(super) fn air_degc(&self, t_s: f64) -> f64 {
        let outside = self.outside.degc(t_s);
        let inside = self.inside.as_ref().map_or(outside, |inside| inside.at(t_s));
        self.stay_at(t_s).map_or(inside, |stay| stay.air_degc(t_s, inside, outside))
    }

    /// Film or wind without gusts.
    pub(super) fn flow(&self, t_s: f64, rest: f64) -> f64 {
        let flow = rest + sum_at(&self.trips, t_s);
        self.stay_at(t_s).map_or(flow, |stay| stay.flow(t_s, flow))
    }

    /// Irradiance, W/m².
    pub(super) fn irradiance_w_m2(&self, t_s: f64) -> f64 {
        let (rise_s, set_s) = self.daylight_s;
        let of_day = (t_s.rem_euclid(DAY_S) - rise_s) / (set_s - rise_s);
        let arch = (4.0 * of_day * (1.0 - of_day)).max(0.0);
        arch * sum_at(&self.sun, t_s) * self.stay_at(t_s).map_or(1.0, |stay| stay.light(t_s))
    }

    fn knots_s(&self, span: &Span) -> Vec<f64> {
        let corners = self.trips.iter().chain(&self.sun).flat_map(|trapezoid| trapezoid.corners_s);
        let inside = self.inside.iter().flat_map(|inside| inside.time_s.iter().copied());
        let own = self.stays.iter().flat_map(Stay::knots_s).chain(corners).chain(inside);
        let count = (span.duration_s / span.spacing_s).ceil() as usize;
        let grid = (0..=count).map(|knot| span.start_s + knot as f64 * span.spacing_s);
        let end_s = span.start_s + count as f64 * span.spacing_s;
        let mut knots: Vec<f64> = own.filter(|&t| t > span.start_s && t < end_s).chain(grid).collect();
        knots.sort_by(f64::total_cmp);
        // Knots that are a rounding apart are one.
        knots.dedup_by(|b, a| *b - *a < 1e-3);
        knots
    }

    fn skies(&self, span: &Span) -> Vec<Sky> {
        let (spacing_s, duration_s) = (span.spacing_s, span.duration_s + span.spacing_s);
        let streams = [Purpose::WorldTurbulence, Purpose::WorldGusts, Purpose::WorldDifference];
        let unrest = self.unrest.draw((span.seed, streams), spacing_s, duration_s);
        let random = &mut Random::new(span.seed, Purpose::WorldWind);
        let wind = OrnsteinUhlenbeck::draw(random, DIFFERENCE_TIME_S, spacing_s, duration_s);
        let mut lag = Lag::settled(span.start_s, self.air_degc(span.start_s), self.radiation_lag_s);
        self.knots_s(span)
            .into_iter()
            .map(|clock_s| {
                let t_s = clock_s - span.start_s;
                let air_degc = self.air_degc(clock_s);
                let varied = (self.rest_variation * wind.at(t_s) - 0.5 * self.rest_variation.powi(2)).exp();
                Sky {
                    t_s,
                    air_k: air_degc + ZERO_CELSIUS_K + unrest.air_k(t_s),
                    flow: self.flow(clock_s, self.rest * varied) * unrest.gust(t_s),
                    radiation_k: lag.follow(clock_s, air_degc) + ZERO_CELSIUS_K - self.sky_k,
                    irradiance_w_m2: self.irradiance_w_m2(clock_s),
                    difference_k: unrest.difference_k(t_s),
                }
            })
            .collect()
    }

    /// The surroundings of a simulation, with a cylinder's own factor on the film and its change along the axis.
    pub(super) fn surroundings(
        &self,
        span: &Span,
        film: f64,
        film_slope: f64,
    ) -> Result<Surroundings, ThermalError> {
        let skies = self.skies(span);
        let time_s: Vec<f64> = skies.iter().map(|sky| sky.t_s).collect();
        let series =
            |value: &dyn Fn(&Sky) -> f64| Series::try_new(time_s.clone(), skies.iter().map(value).collect());
        let (from_fraction, to_fraction, valve) = self.lit;
        Ok(Surroundings {
            air_k: series(&|sky| sky.air_k)?,
            film: match self.film {
                Film::Coefficient => {
                    OutsideFilm::Coefficient { film_w_m2_k: series(&|sky| film * sky.flow)? }
                }
                Film::Wind => {
                    OutsideFilm::Convection { wind_m_s: series(&|sky| sky.flow)?, multiplier: film }
                }
            },
            radiation_k: Some(series(&|sky| sky.radiation_k)?),
            sun: Some(Sun {
                irradiance_w_m2: series(&|sky| sky.irradiance_w_m2)?,
                from_fraction,
                to_fraction,
                valve,
            }),
            axial: AxialVariation { film_slope, air_difference_k: Some(series(&|sky| sky.difference_k)?) },
        })
    }

    /// Beginnings of all jumps of the air by the clock of the simulation, s, in the order of time.
    pub(super) fn all_jumps_s(&self, span: &Span) -> Vec<f64> {
        let ends = self.stays.iter().flat_map(|stay| [stay.enter_s, stay.leave_s]);
        let mut jumps: Vec<f64> =
            ends.chain(self.jumps_s.iter().copied()).map(|clock_s| clock_s - span.start_s).collect();
        jumps.sort_by(f64::total_cmp);
        jumps
    }
}

/// First-order lag of an input that is linear between the times it is followed to.
pub(in crate::world) struct Lag {
    time_s: f64,
    t_s: f64,
    input: f64,
    output: f64,
}

impl Lag {
    pub(in crate::world) fn settled(t_s: f64, at: f64, time_s: f64) -> Self {
        Self { time_s, t_s, input: at, output: at }
    }

    pub(in crate::world) fn follow(&mut self, t_s: f64, input: f64) -> f64 {
        let dt_s = t_s - self.t_s;
        if self.time_s <= 0.0 {
            self.output = input;
        } else if dt_s > 0.0 {
            let behind = self.time_s * (input - self.input) / dt_s;
            let fading = (-dt_s / self.time_s).exp();
            self.output = input - behind + (self.output - self.input + behind) * fading;
        }
        (self.t_s, self.input) = (t_s, input);
        self.output
    }
}
