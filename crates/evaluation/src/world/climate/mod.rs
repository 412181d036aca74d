//! Climates: what surrounds a cylinder, drawn from a seed, from a quarter of an hour to a year.
//!
//! Each climate is a file with its law. It is made of [`part`]s, and a [`weather::Weather`] turns it into the surroundings of a
//! simulation. To add one: a file beside this one, a line in [`draw`], and a kind in [`super::Climate`].
mod arctic;
mod chamber;
mod desert;
mod draw;
mod hall;
mod metro;
mod parked;
mod part;
mod railway;
mod showers;
mod switching;
#[cfg(test)]
mod tests;
pub(super) mod unrest;
mod weather;
mod workshop;

use cylwatch_thermal::ThermalError;
use cylwatch_thermal::scenario::Surroundings;
use cylwatch_thermal::units::DAY_S;

use super::Climate;
use crate::random::{Purpose, Random};
pub(super) use weather::Lag;
use weather::Weather;

/// What a climate is drawn for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Span {
    pub seed: u64,
    /// Time of the first midnight's clock at which the simulation begins, s.
    pub start_s: f64,
    /// Duration of the simulation, s.
    pub duration_s: f64,
    /// Spacing of the knots of turbulence and gusts, s.
    pub spacing_s: f64,
}

impl Span {
    /// A span whose log begins at a drawn time of the day, the simulation `lead_s` before it.
    pub(super) fn draw(seed: u64, lead_s: f64, length_s: f64, spacing_s: f64) -> Self {
        let of_day_s = Random::new(seed, Purpose::WorldClock).uniform((0.0, DAY_S)).floor();
        // One day more in front, so that the clock is positive when the simulation begins.
        Self { seed, start_s: DAY_S + of_day_s - lead_s, duration_s: lead_s + length_s, spacing_s }
    }

    /// End by the clock with a margin for the last knots, s.
    fn clock_end_s(&self) -> f64 {
        self.start_s + self.duration_s + 2.0 * self.spacing_s
    }

    fn days(&self) -> usize {
        (self.clock_end_s() / DAY_S).ceil() as usize
    }
}

/// What the climate of a simulation is.
pub(super) struct Drawn {
    pub surroundings: Surroundings,
    /// Times of the simulation at which the air begins to jump, s.
    pub jumps_s: Vec<f64>,
    /// Times of the simulation in which a heater is on, s.
    pub heated_s: Vec<(f64, f64)>,
    /// Film or wind below which it is calm.
    pub calm_flow: f64,
}

fn draw(climate: Climate, span: &Span) -> Weather {
    match climate {
        Climate::Railway => railway::draw(span),
        Climate::Switching => switching::draw(span),
        Climate::Metro => metro::draw(span),
        Climate::Desert => desert::draw(span),
        Climate::Arctic => arctic::draw(span),
        Climate::Parked => parked::draw(span),
        Climate::Hall => hall::draw(span),
        Climate::Workshop => workshop::draw(span),
        Climate::Chamber => chamber::draw(span),
        Climate::Showers => showers::draw(span),
    }
}

/// The surroundings of a cylinder with its own factor on the film and the change of that along the axis.
pub(super) fn surroundings(
    climate: Climate,
    span: &Span,
    film: f64,
    film_slope: f64,
) -> Result<Drawn, ThermalError> {
    let weather = draw(climate, span);
    Ok(Drawn {
        surroundings: weather.surroundings(span, film, film_slope)?,
        jumps_s: weather.all_jumps_s(span),
        heated_s: weather.heated_s.iter().map(|(a, b)| (a - span.start_s, b - span.start_s)).collect(),
        calm_flow: 1.5 * weather.rest,
    })
}
