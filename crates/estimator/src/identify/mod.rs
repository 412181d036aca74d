//! Identification: continuous-time transfer functions of one input and one output from sampled data.
//!
//! `y = e^(-s delta) B(s)/A(s) u + free response + offset`, orders one to three, from regular or irregular samples. The
//! response is exact for an input that is held or straight between its samples, with any dead time.
//!
//! | [`Method`] | what it is | assumes |
//! |---|---|---|
//! | output error | least squares of the simulation's error (what MATLAB's `tfest` does) | noise on the output alone |
//! | refined instrumental variables | SRIVC: filters and instruments from the model, repeated | the same, of any colour |
//! | bias-compensated | least squares through the model's filters, less what sensor noise adds to the moments | white noise of known variances |
//! | compensated instruments | refined instruments, less what the input's noise adds to the moments | white input noise of known variance |
//! | second sensor | instruments from another sensor of the input | noises of both sensors independent |
//! | maximum likelihood | Kalman filter of model and input together | white noise of known variances, a random walk as input |
//!
//! The last four are for noise on the input too (errors in variables), which slows the pole that the others find. Without knowledge of
//! the noise or a second sensor such a model cannot be identified at all (Söderström 2007).
//!
//! The record is brought to units of its own before anything is estimated, so that no result depends on the units it came in.
//!
//! Source: Garnier and Wang 2008, Ljung 1999, Söderström 2007.
mod checks;
mod comparison;
mod compensation;
mod data;
mod equations;
mod error;
mod identified;
mod likelihood;
mod method;
mod model;
mod parametrisation;
mod problem;
mod propagator;
pub mod published;
mod report;
mod response;
mod run;
mod schedule;
mod solve;
mod start;
mod statistics;
mod structure;
mod uncertainty;

pub use comparison::Comparison;
pub use data::{Data, Hold};
pub use error::IdentifyError;
pub use identified::{Caution, Derived, Estimate, Identified, Interval, Pole};
pub use method::{ErrorModel, InputModel, Method, Settings, StartMethod};
pub use model::Model;
pub use run::{identify, identify_until};
pub(crate) use statistics::fit_percent;
pub use statistics::{Residuals, Statistics};
pub use structure::{DeadTime, Gain, InitialState, Parameter, Structure};
