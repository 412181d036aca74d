//! One judge for monitors and estimators: worlds in, a table by family out.
//!
//! | part | what |
//! |---|---|
//! | [`plan`] | a TOML file, written before a run: which families tune and which judge, candidates, groups of worlds |
//! | [`candidate`] | what can be judged, as two traits: this project's monitor and observer, the paper's detector, others |
//! | [`watch`](mod@watch) | a candidate watches a world row by row |
//! | `score` | what it achieved there, as sums |
//! | `journal` | a line for each finished world, so that a run that was killed goes on |
//! | [`run`](mod@run) | all of it, on all threads |
//! | [`table`] | from the journal to the table, as Markdown and JSON |
//! | `cost` | what a cylinder-year costs, apart from the table |
//!
//! The table depends on the plan and the program alone: not on threads, the order of finishing, or kills.
pub mod candidate;
mod clock;
mod cost;
mod entry;
mod error;
mod journal;
pub mod measures;
pub mod plan;
pub mod run;
mod score;
pub mod statement;
pub mod table;
pub mod watch;

pub use error::JudgeError;

#[cfg(test)]
mod fixture;
#[cfg(test)]
mod tests;
