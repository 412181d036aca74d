//! Judging an estimator: whether its errors are as large, as independent and as normal as its covariances say.
//!
//! | question | statistic | holds for |
//! |---|---|---|
//! | are the innovations as large as stated? | [`NisAccumulator`]: mean of `nu^2/S` | one run, over time |
//! | are they independent? | [`Whiteness`]: autocorrelation | one run, over time |
//! | are they normal? | `Normality`: Lilliefors' test | one run, over time |
//! | are the errors as large as stated? | [`EnsembleNees`]: mean of `e^T P^-1 e` | many runs, at fixed times |
//! | does the band hold the truth? | [`Coverage`] | either, with independent samples only |
//!
//! Innovations of a correct filter are independent, so that their squares may be summed over time. Errors are not: a filter
//! that is right is wrong in the same direction for long, and the sum of its `e^T P^-1 e` over one run is no chi-square.
//! Judged as one it rejects a perfect filter about every second time; so errors are judged over independent runs, at
//! fixed times, each time on its own.
//!
//! All accumulators of a run have a fixed size, whatever the length of the log.
//!
//! Source: Bar-Shalom, Li, Kirubarajan 2001 (section 5.4).
mod band;
mod coverage;
mod nees;
mod nis;
mod normality;
mod report;
mod run;
mod whiteness;

pub use band::{Band, Significance};
pub use coverage::Coverage;
pub use nees::{EnsembleNees, NeesAt, NeesJudgement, normalised_error_squared};
pub use nis::NisAccumulator;
pub use normality::Lilliefors;
pub(crate) use normality::Normality;
#[cfg(test)]
pub(crate) use normality::lilliefors;
pub use report::{ConsistencyReport, Finding, NisReport, OutputReport};
pub use run::RunConsistency;
pub use whiteness::Whiteness;

#[cfg(test)]
mod tests;
