//! What varies on top of a climate: turbulence of the air, gusts, layers of the air.
use crate::random::{OrnsteinUhlenbeck, Purpose, Random};

const TURBULENCE_TIME_S: f64 = 120.0;
const GUST_TIME_S: f64 = 120.0;
pub(super) const DIFFERENCE_TIME_S: f64 = 3600.0;
/// Smallest factor of a gust: three standard deviations and more never stop the film.
const GUST_LEAST: f64 = 0.5;

/// Standard deviations of what varies on top.
#[derive(Clone, Copy, Debug)]
pub(in crate::world) struct Unrest {
    /// Air, K.
    pub turbulence_k: f64,
    /// Film or wind, relative.
    pub gust: f64,
    /// Air at the top against the bottom, K.
    pub difference_k: f64,
}

/// What varies on top, drawn.
pub(in crate::world) struct DrawnUnrest {
    sd: Unrest,
    turbulence: OrnsteinUhlenbeck,
    gusts: OrnsteinUhlenbeck,
    difference: OrnsteinUhlenbeck,
}

impl Unrest {
    /// The draw of a seed with a stream each for turbulence, gusts and difference, its knots so far apart, s.
    pub(in crate::world) fn draw(
        self,
        (seed, streams): (u64, [Purpose; 3]),
        spacing_s: f64,
        duration_s: f64,
    ) -> DrawnUnrest {
        let process = |stream: usize, time_s| {
            OrnsteinUhlenbeck::draw(&mut Random::new(seed, streams[stream]), time_s, spacing_s, duration_s)
        };
        DrawnUnrest {
            sd: self,
            turbulence: process(0, TURBULENCE_TIME_S),
            gusts: process(1, GUST_TIME_S),
            difference: process(2, DIFFERENCE_TIME_S),
        }
    }
}

impl DrawnUnrest {
    /// Turbulence of the air, K.
    pub(in crate::world) fn air_k(&self, t_s: f64) -> f64 {
        self.sd.turbulence_k * self.turbulence.at(t_s)
    }

    /// Factor of a gust on film or wind.
    pub(in crate::world) fn gust(&self, t_s: f64) -> f64 {
        (1.0 + self.sd.gust * self.gusts.at(t_s)).max(GUST_LEAST)
    }

    /// Air at the top against the bottom, K.
    pub(in crate::world) fn difference_k(&self, t_s: f64) -> f64 {
        self.sd.difference_k * self.difference.at(t_s)
    }
}
