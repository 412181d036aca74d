//! What was said against what was: a matrix of classes.
use std::fmt;

use serde::{Deserialize, Serialize};

use super::Proportion;
use crate::detector::monitor::Verdict;

/// What can happen to a cylinder, or be said about it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Class {
    /// Nothing is lost.
    Tight,
    /// A steady loss.
    Leak,
    /// A loss at once.
    Discharge,
    /// A gain.
    Refill,
    /// A sensor at fault.
    SensorFault,
    /// It cannot be told.
    Unknown,
}

impl Class {
    /// All of them, in the order of the matrix.
    pub const ALL: [Self; 6] =
        [Self::Tight, Self::Leak, Self::Discharge, Self::Refill, Self::SensorFault, Self::Unknown];
}

impl fmt::Display for Class {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::Tight => "tight",
            Self::Leak => "leak",
            Self::Discharge => "discharge",
            Self::Refill => "refill",
            Self::SensorFault => "sensor fault",
            Self::Unknown => "unknown",
        })
    }
}

impl From<Verdict> for Class {
    fn from(verdict: Verdict) -> Self {
        match verdict {
            Verdict::Tight => Self::Tight,
            Verdict::Leak => Self::Leak,
            Verdict::Discharge => Self::Discharge,
            Verdict::Refill => Self::Refill,
            Verdict::SensorFault => Self::SensorFault,
            Verdict::Unknown(_) => Self::Unknown,
        }
    }
}

/// Counts by truth (row) and statement (column).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Confusion {
    counts: [[u64; 6]; 6],
}

impl Confusion {
    /// Count a case.
    pub fn add(&mut self, truth: Class, said: Class) {
        self.counts[truth as usize][said as usize] += 1;
    }

    /// How often `said` was said where `truth` was.
    pub fn count(&self, truth: Class, said: Class) -> u64 {
        self.counts[truth as usize][said as usize]
    }

    /// Part of the cases of a class that was called so.
    pub fn recall(&self, class: Class) -> Proportion {
        let of = |said: &Class| self.count(class, *said);
        Proportion { hits: self.count(class, class), trials: Class::ALL.iter().map(of).sum() }
    }

    /// Part of the cases called so that were.
    pub fn precision(&self, class: Class) -> Proportion {
        let of = |truth: &Class| self.count(*truth, class);
        Proportion { hits: self.count(class, class), trials: Class::ALL.iter().map(of).sum() }
    }

    /// Part of all cases that were called what they were.
    pub fn correct(&self) -> Proportion {
        let recalls = Class::ALL.map(|class| self.recall(class));
        Proportion {
            hits: recalls.iter().map(|recall| recall.hits).sum(),
            trials: recalls.iter().map(|recall| recall.trials).sum(),
        }
    }
}

impl FromIterator<(Class, Class)> for Confusion {
    fn from_iter<I: IntoIterator<Item = (Class, Class)>>(cases: I) -> Self {
        cases.into_iter().fold(Self::default(), |mut confusion, (truth, said)| {
            confusion.add(truth, said);
            confusion
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::detector::monitor::Reason;

    #[test]
    fn rows_are_truths_and_columns_are_statements() {
        use Class::{Discharge, Leak, SensorFault, Tight, Unknown};
        let cases =
            [(Leak, Leak), (Leak, Tight), (Leak, Unknown), (Tight, Leak), (Tight, Tight), (Discharge, Leak)];
        let confusion: Confusion = cases.into_iter().collect();
        assert_eq!(confusion.recall(Leak), Proportion { hits: 1, trials: 3 });
        assert_eq!(confusion.precision(Leak), Proportion { hits: 1, trials: 3 });
        assert_eq!(confusion.correct(), Proportion { hits: 2, trials: 6 });
        assert_eq!(confusion.recall(SensorFault), Proportion::default());
        assert_eq!((confusion.count(Leak, Tight), confusion.count(Tight, Leak)), (1, 1));
    }

    #[test]
    fn classes_are_in_the_order_of_the_matrix_and_every_verdict_has_one() {
        assert!(Class::ALL.iter().enumerate().all(|(index, class)| *class as usize == index));
        assert_eq!(Class::from(Verdict::Unknown(Reason::Gap)), Class::Unknown);
        for verdict in
            [Verdict::Tight, Verdict::Leak, Verdict::Discharge, Verdict::Refill, Verdict::SensorFault]
        {
            assert_eq!(Class::from(verdict).to_string(), verdict.as_str());
        }
    }
}
