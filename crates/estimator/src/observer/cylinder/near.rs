//! How near two states must be for one linearisation to hold for both.
//!
//! The second-order remainder of the equations is bilinear above all: film times the difference of air and wall. With the limits
//! below it is at most `0.1 x 2 K`, beside half the square of the film's, `0.1^2 / 2 x 40 K`, of what drives the wall, which follows
//! with 20 minutes: 2 mK in 10 s. Sensors' couplings bend a reading by `0.02 x 2 K`; gas and mass bend the pressure by 2 mbar.
use super::super::settings::LeakHypothesis;
use super::super::states::StateKind;
use super::Cylinder;
use crate::sensor::ParameterKind;

impl Cylinder {
    /// Whether one linearisation holds for two states, each under its hypothesis. Not where a number is none.
    pub(in crate::observer) fn is_near(
        &self,
        (reference, a): (&LeakHypothesis, &[f64]),
        (other, b): (&LeakHypothesis, &[f64]),
    ) -> bool {
        let one_leak = other.rate.is_known() || other.rate.decay_per_s() == reference.rate.decay_per_s();
        one_leak && a.iter().zip(b).zip(&self.near).all(|((a, b), limit)| (a - b).abs() <= *limit)
    }

    /// Largest difference of a state at which a linearisation is shared.
    pub(super) fn near_limit(&self, kind: &StateKind) -> f64 {
        match kind {
            StateKind::Wall(_) | StateKind::Valve | StateKind::Gas => 1.0,
            StateKind::Mass => 0.05,
            StateKind::Air => 2.0,
            StateKind::OutsideFilm => 0.1,
            StateKind::Sun => 20.0,
            StateKind::InsideFilm | StateKind::Capacity | StateKind::FilmSlope => 0.1,
            // Linear.
            StateKind::Leak | StateKind::Lag { .. } => f64::MAX,
            StateKind::Parameter { sensor, parameter } => {
                match self.sensors[*sensor].parameters()[*parameter].kind {
                    ParameterKind::Coupling => 0.02,
                    _ => f64::MAX,
                }
            }
        }
    }
}
