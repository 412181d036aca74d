//! Surroundings of a course as a scenario.
//!
//! On top of a course's own air come turbulence (0.4 K, 2 min), gusts of the film (10 %, 2 min) and a difference between
//! the air at the top and at the bottom (0.5 K, 1 h), all Ornstein-Uhlenbeck. The surface radiates to surroundings that follow
//! the air of the railway with a lag of 30 min, and the air of the chamber at once. The chamber's film is 16 W/(m² K) by
//! convection, about 20 with radiation. All signals are linear between the same knots, 2 min apart or closer
//! ([`super::TruthSettings::weather_spacing_s`] spaces them wider; the disturbances keep their variance).
use cylwatch_thermal::scenario::{AxialVariation, Initial, OutsideFilm, Scenario, Series, Sun, Surroundings};
use cylwatch_thermal::units::ZERO_CELSIUS_K;
use cylwatch_thermal::vessel::Fill;

use super::course::{Chamber, Course, TRANSFER_S};
use super::railway::{APPROACH, Railway};
use crate::EvaluationError;
use crate::random::{OrnsteinUhlenbeck, Purpose, Random};

/// Spacing of the knots of turbulence, gusts and axial difference, s.
pub(super) const SPACING_S: f64 = 120.0;
const TURBULENCE_K: f64 = 0.4;
const TURBULENCE_TIME_S: f64 = 120.0;
const GUST: f64 = 0.1;
const GUST_TIME_S: f64 = 120.0;
const DIFFERENCE_K: f64 = 0.5;
const DIFFERENCE_TIME_S: f64 = 3600.0;
const RADIATION_LAG_S: f64 = 1800.0;
const FILM_CHAMBER_W_M2_K: f64 = 16.0;
/// Smallest factor of a gust: three standard deviations and more never stop the film.
const GUST_LEAST: f64 = 0.5;
/// The lit stretch is the shoulder.
const LIT_FROM_FRACTION: f64 = 0.8;
const FILL_PA: f64 = 200e5;
const FILL_K: f64 = 288.15;

/// What the surroundings are at one instant.
#[derive(Clone, Copy)]
struct Sky {
    t_s: f64,
    air_k: f64,
    film_w_m2_k: f64,
    radiation_k: f64,
    irradiance_w_m2: f64,
    difference_k: f64,
}

/// What varies on top of every course.
struct Disturbances {
    turbulence: OrnsteinUhlenbeck,
    gusts: OrnsteinUhlenbeck,
    difference: OrnsteinUhlenbeck,
}

impl Disturbances {
    fn draw(seed: u64, duration_s: f64, spacing_s: f64) -> Self {
        let process = |purpose, time_s| {
            OrnsteinUhlenbeck::draw(&mut Random::new(seed, purpose), time_s, spacing_s, duration_s)
        };
        Self {
            turbulence: process(Purpose::Turbulence, TURBULENCE_TIME_S),
            gusts: process(Purpose::Gusts, GUST_TIME_S),
            difference: process(Purpose::AxialDifference, DIFFERENCE_TIME_S),
        }
    }

    fn apply(&self, sky: Sky) -> Sky {
        let t_s = sky.t_s;
        Sky {
            air_k: sky.air_k + TURBULENCE_K * self.turbulence.at(t_s),
            film_w_m2_k: sky.film_w_m2_k * (1.0 + GUST * self.gusts.at(t_s)).max(GUST_LEAST),
            difference_k: DIFFERENCE_K * self.difference.at(t_s),
            ..sky
        }
    }
}

/// The surroundings of a course, the fill of 200 bar at 15 °C, no flows, samples every minute.
///
/// # Errors
/// None for a course of positive length; otherwise the thermal model's.
pub fn draw_weather(course: &Course, seed: u64) -> Result<Scenario, EvaluationError> {
    draw_spaced(course, seed, SPACING_S)
}

/// The same with other knots, s apart.
pub(super) fn draw_spaced(course: &Course, seed: u64, spacing_s: f64) -> Result<Scenario, EvaluationError> {
    let duration_s = course.duration_s();
    let grid = Grid(spacing_s);
    let mut skies = railway(course, seed, grid);
    if let Some(chamber) = course.chamber() {
        add_chamber(&mut skies, course, &chamber, grid);
    }
    let disturbances = Disturbances::draw(seed, duration_s, spacing_s);
    for sky in &mut skies {
        *sky = disturbances.apply(*sky);
    }
    let settled_k = course
        .chamber()
        .filter(|_| course.railway_s() == 0.0)
        .map_or(skies[0].air_k, |chamber| chamber.start_degc + ZERO_CELSIUS_K);
    Ok(Scenario {
        name: course.name(),
        initial: Initial {
            fill: Fill::Settled { pressure_pa: FILL_PA, temperature_k: FILL_K },
            wall_temperature_k: settled_k,
            gas_temperature_k: settled_k,
        },
        surroundings: surroundings(&skies)?,
        flows: Vec::new(),
        pressure_limits_pa: Vec::new(),
        sensors: Vec::new(),
        duration_s,
        sample_time_s: 60.0,
    })
}

fn surroundings(skies: &[Sky]) -> Result<Surroundings, EvaluationError> {
    let series = |value: fn(&Sky) -> f64| {
        Series::try_new(skies.iter().map(|sky| sky.t_s).collect(), skies.iter().map(value).collect())
    };
    Ok(Surroundings {
        air_k: series(|sky| sky.air_k)?,
        film: OutsideFilm::Coefficient { film_w_m2_k: series(|sky| sky.film_w_m2_k)? },
        radiation_k: Some(series(|sky| sky.radiation_k)?),
        sun: Some(Sun {
            irradiance_w_m2: series(|sky| sky.irradiance_w_m2)?,
            from_fraction: LIT_FROM_FRACTION,
            to_fraction: 1.0,
            valve: true,
        }),
        axial: AxialVariation { film_slope: 0.0, air_difference_k: Some(series(|sky| sky.difference_k)?) },
    })
}

/// Knots of the railway part, undisturbed; none without one.
fn railway(course: &Course, seed: u64, grid: Grid) -> Vec<Sky> {
    let end_s = course.railway_s();
    if end_s == 0.0 {
        return Vec::new();
    }
    let weeks = Railway::draw(seed, end_s, course.climate());
    let mut knots: Vec<f64> =
        grid.between(0.0, end_s).chain(weeks.knots_s().filter(|&t| t < end_s)).collect();
    knots.sort_by(f64::total_cmp);
    knots.dedup();
    let mut lag = Lag { t_s: 0.0, input: weeks.air_degc(0.0), output: weeks.air_degc(0.0) };
    knots
        .into_iter()
        .map(|t_s| {
            let air_degc = weeks.air_degc(t_s);
            Sky {
                t_s,
                air_k: air_degc + ZERO_CELSIUS_K,
                film_w_m2_k: weeks.film_w_m2_k(t_s),
                radiation_k: lag.follow(t_s, air_degc) + ZERO_CELSIUS_K,
                irradiance_w_m2: weeks.irradiance_w_m2(t_s),
                difference_k: 0.0,
            }
        })
        .collect()
}

/// Knots of the disturbances, s apart.
#[derive(Clone, Copy)]
struct Grid(f64);

impl Grid {
    /// Evenly spaced times, ends included.
    fn between(self, from_s: f64, to_s: f64) -> impl Iterator<Item = f64> {
        let (first, last) = ((from_s / self.0).floor() as usize + 1, (to_s / self.0).ceil() as usize);
        std::iter::once(from_s)
            .chain((first..last).map(move |knot| knot as f64 * self.0))
            .chain(std::iter::once(to_s))
    }
}

/// Append the transfer to the chamber, the rest, and the chamber's course.
fn add_chamber(skies: &mut Vec<Sky>, course: &Course, chamber: &Chamber, grid: Grid) {
    let begin_s = course.railway_s();
    let transfer_s = if skies.is_empty() { 0.0 } else { TRANSFER_S };
    let sky = |t_s: f64, degc: f64| Sky {
        t_s,
        air_k: degc + ZERO_CELSIUS_K,
        film_w_m2_k: FILM_CHAMBER_W_M2_K,
        radiation_k: degc + ZERO_CELSIUS_K,
        irradiance_w_m2: 0.0,
        difference_k: 0.0,
    };
    let (change_s, end_s) = (course.change_s(), course.duration_s());
    if let Some(last) = skies.pop() {
        // From the railway's air, film and surroundings to the chamber's.
        let (from, to) = (last, sky(begin_s + transfer_s, chamber.start_degc));
        skies.extend(grid.between(begin_s, begin_s + transfer_s).map(|t_s| between(&from, &to, t_s)));
        skies.pop();
    }
    skies.extend(grid.between(begin_s + transfer_s, change_s).map(|t_s| sky(t_s, chamber.start_degc)));
    if chamber.ramp_s > 0.0 || chamber.lag_s > 0.0 {
        // The change begins without a jump.
        skies.pop();
    }
    let mut after: Vec<f64> = grid
        .between(change_s, end_s)
        .chain(APPROACH.map(|n| change_s + n * chamber.lag_s))
        .chain([change_s + chamber.ramp_s])
        .collect();
    after.sort_by(f64::total_cmp);
    after.dedup();
    skies.extend(after.into_iter().map(|t_s| sky(t_s, chamber.air_degc(t_s - change_s))));
}

/// On the straight line from one sky to another.
fn between(from: &Sky, to: &Sky, t_s: f64) -> Sky {
    let weight = (t_s - from.t_s) / (to.t_s - from.t_s);
    let mix = |a: f64, b: f64| a + weight * (b - a);
    Sky {
        t_s,
        air_k: mix(from.air_k, to.air_k),
        film_w_m2_k: mix(from.film_w_m2_k, to.film_w_m2_k),
        radiation_k: mix(from.radiation_k, to.radiation_k),
        irradiance_w_m2: mix(from.irradiance_w_m2, to.irradiance_w_m2),
        difference_k: mix(from.difference_k, to.difference_k),
    }
}

impl Chamber {
    /// Air temperature a time after the beginning of the change, °C.
    fn air_degc(&self, since_s: f64) -> f64 {
        let share = if self.ramp_s > 0.0 {
            (since_s / self.ramp_s).min(1.0)
        } else if self.lag_s > 0.0 && since_s < APPROACH[APPROACH.len() - 1] * self.lag_s {
            1.0 - (-since_s / self.lag_s).exp()
        } else {
            1.0
        };
        self.start_degc + share * (self.end_degc - self.start_degc)
    }
}

/// First-order lag of an input that is linear between the times it is followed to.
pub(super) struct Lag {
    t_s: f64,
    input: f64,
    output: f64,
}

impl Lag {
    /// At rest at zero.
    pub(super) fn at_rest(t_s: f64) -> Self {
        Self { t_s, input: 0.0, output: 0.0 }
    }

    pub(super) fn follow(&mut self, t_s: f64, input: f64) -> f64 {
        let dt_s = t_s - self.t_s;
        if dt_s > 0.0 {
            let behind = RADIATION_LAG_S * (input - self.input) / dt_s;
            let fading = (-dt_s / RADIATION_LAG_S).exp();
            self.output = input - behind + (self.output - self.input + behind) * fading;
        }
        (self.t_s, self.input) = (t_s, input);
        self.output
    }
}
