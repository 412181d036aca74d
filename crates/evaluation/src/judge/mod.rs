//! The judge.
pub mod candidate;
pub mod cost;
mod error;
pub mod journal;
pub mod measures;
pub mod plan;
pub mod said;
pub mod run;
pub mod score;
pub mod table;
pub mod watch;

pub use error::JudgeError;
