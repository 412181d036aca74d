//! The time that is left: until the pressure at 15 °C, and until the pressure at a stated temperature, reach a limit.
//!
//! * [`Contents`] turns a limit of the pressure at a temperature into a limit of the mass, by the equation of state in the vessel's volume:
//!   160 bar at 15 °C or on the coldest night, 5 % of the pressure lost (`Contents::limit_after_loss_kg`).
//! * [`MassAndLeak`] is what an observer knows: mass and leak rate, jointly normal.
//! * [`Prognosis`] is the distribution of the time until the limit. The leak rate is not negative, so the normal
//!   distribution is cut off there; the ratio of the two has no mean, so what is reported are quantiles ([`Passage`]),
//!   probabilities, and "beyond the horizon" where there is nothing to tell.
//! * [`Reaction`] follows from the probabilities that a limit is reached before the vehicle is safe, before the next service, before the
//!   one after.
//!
//! ```
//! use cylwatch_detector::prognosis::{Contents, LossLaw, MassAndLeak, Passage, Prognosis};
//! use cylwatch_detector::estimator::thermal::vessel::presets;
//!
//! let contents = Contents::of(&presets::load("nitrogen-20l")?);
//! let operational_kg = contents.mass_kg(160e5, 288.15)?;
//! let full_kg = contents.mass_kg(200e5, 288.15)?;
//! // 10 g/h, known to 1 g/h, mass to 5 g.
//! let state = MassAndLeak::try_new(full_kg, 10e-3 / 3600.0, [[25e-6, 0.0], [0.0, (1e-3 / 3600.0_f64).powi(2)]])?;
//! let left = Prognosis::try_new(state, operational_kg, LossLaw::Choked)?.quantiles(365.0 * 86400.0);
//! let days = |passage| match passage {
//!     Passage::In(time_s) => time_s / 86400.0,
//!     Passage::Reached | Passage::BeyondHorizon | Passage::Unknown => f64::NAN,
//! };
//! assert!(days(left.p5) > 2.8 && days(left.p50) < 3.8 && days(left.p95) < 4.6);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Source: ratio of normal variables: D. V. Hinkley, Biometrika 56 (1969) 635; loss of 5 %: ISO 14520-1, as quoted by
//! makers of its instruments.
mod contents;
mod distribution;
mod lambert;
mod quadrature;
mod reaction;
mod state;
#[cfg(test)]
mod tests;

pub use contents::{Contents, ISO_14520_LOSS};
pub use distribution::{Passage, Prognosis, Quantiles};
pub(crate) use distribution::{normal_probability, root};
pub use lambert::lambert_w;
pub use reaction::{Advice, Reaction, ReactionSettings};
pub use state::{LossLaw, MassAndLeak};
