//! Where sensors should sit: the best layouts out of many, with a proof that none better was missed.
//!
//! A layout is a set of candidates. What it is worth is a number that falls with every sensor more, e.g. the variance
//! `V = w^T P w` of a functional `w` of the state in the steady state of the filter that reads them ([`LinearProblem`]). With weights
//! `0 <= z_j <= 1` on the information of the candidates, `G(z) = sum_j z_j h_j h_j^T / sigma_j^2`, `V(z)` is convex, and
//!
//! `dV/dz_j = -h_j^T P Y P h_j / sigma_j^2`, `Y = L^T Y L + w w^T`, `L = (I - K H) F`.
//!
//! | part | what it does |
//! |---|---|
//! | [`InstrumentedCylinder`] | the observer's own equations with every candidate on the cylinder |
//! | [`LinearProblem`], [`GroupedProblem`] | value, relaxed value and gradient; candidates with states of their own |
//! | [`Constraints`] | how many, at what cost, which together |
//! | [`search`] | every layout; branch and bound; greedy with swaps |
//! | [`certificate`] | what no layout can fall below |
//! | [`Candidates`] | places on a vessel with sensors, costs and rules |
//! | [`SteadyAnalysis`], [`Response`] | a layout at rest: accuracy, smallest leak, delay, biases, faults |
//! | [`signature_threshold_sd`] | when a leak counts as found, from the rate of false alarms |
//! | [`ScenarioAnalysis`] | a layout along a scenario, with model error as consider parameters |
//! | [`study`] | the study that puts all of it together |
//! | [`published_scores`] | each position by itself, by the paper's own measure |
//!
//! The gap between the best that was found and the bound is part of every result: greedy search can be arbitrarily bad for this
//! criterion (Ye, Roy and Sundaram 2017), and says nothing about it.
//!
//! Sources: Joshi and Boyd 2009 (relaxation and gap); Sagnol 2011 (optimal design as a second-order cone program).
mod candidate;
pub mod certificate;
mod constraints;
mod criterion;
pub mod cylinder;
mod grouped;
mod objective;
mod problem;
mod published;
mod response;
pub mod scenario;
pub mod search;
mod steady;
pub mod study;
mod threshold;

pub use candidate::{Candidate, Candidates, Status, candidates_schema, read_candidates};
pub use constraints::{Constraints, Group};
pub use criterion::Criterion;
pub use cylinder::{Conditions, InstrumentedCylinder, Quantity};
pub use grouped::GroupedProblem;
pub use objective::{Objective, Relaxed};
pub use problem::{CandidateOutput, LinearProblem};
pub use published::{
    PublishedDuel, PublishedMerit, PublishedRecord, PublishedScore, PublishedScores, PublishedSettings,
    Specimens, Spread, published_scores,
};
pub use response::{DetectionSettings, Disturbance, Response};
pub use scenario::{ScenarioAccuracy, ScenarioAnalysis, ScenarioMeasure, Variant};
pub use steady::{SteadyAccuracy, SteadyAnalysis, SteadySettings};
pub use threshold::signature_threshold_sd;
