//! One decision: from what is known of a row to verdict, probability of a leak, alarm, reaction and exit code.
//!
//! Whatever is said of a row is said here, so that nothing of it can disagree:
//!
//! | what is known, the first that holds | verdict | outcome |
//! |---|---|---|
//! | gas goes out fast, or did a while ago, and that was announced | discharge | no loss, unless a leak is found |
//! | gas goes out fast, or did a while ago | discharge | loss |
//! | a leak is found | leak | loss |
//! | gas comes in, or did a while ago | refill | no loss |
//! | something stands in the way of an answer | unknown | unknown |
//! | a leak is more likely than not, but not found at the stated rate of false alarms | unknown | unknown |
//! | a sensor is at fault, the others tell the gas | sensor fault | no loss |
//! | none of these | tight | no loss |
//!
//! The leak alarm is raised by a loss and by nothing else. The probability of a leak is that of the evidence where there is any; a
//! prior is none ([`Decision::leak_probability`] is `None`). A loss is at least as likely as not, and demands a reaction.
use serde::{Deserialize, Serialize};

use super::{Reason, Verdict};
use crate::prognosis::Reaction;

/// Probability from which a leak counts as more likely than not: a tight cylinder is below it, one that loses gas at or above it.
pub const LIKELY: f64 = 0.5;

/// What is known of a row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Known {
    /// Gas that flows, or did a while ago.
    pub exchange: Option<KnownExchange>,
    /// Whether a leak is found.
    pub leak_found: bool,
    /// What stands in the way of an answer.
    pub doubt: Option<Reason>,
    /// Whether a sensor is at fault.
    pub sensor_fault: bool,
    /// Probability of a leak by the evidence; `None`: there is none yet.
    pub leak_probability: Option<f64>,
    /// What is due by the time that is left; `None`: it is not known.
    pub reaction: Option<Reaction>,
}

/// Gas that flows fast, or did a while ago.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct KnownExchange {
    /// Whether it goes out.
    pub out: bool,
    /// Whether somebody said so.
    pub announced: bool,
}

/// What a row says of the gas in one word, and to a caller in one number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Outcome {
    /// No gas is being lost.
    NoLoss,
    /// Gas is being lost.
    Loss,
    /// It cannot be told.
    Unknown,
}

/// What is said of a row.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Decision {
    /// What is happening to the gas.
    pub verdict: Verdict,
    /// Whether gas is being lost.
    pub outcome: Outcome,
    /// Probability that gas is being lost; `None`: not known yet.
    pub leak_probability: Option<f64>,
    /// What is due; `None`: not known yet.
    pub reaction: Option<Reaction>,
}

impl Outcome {
    /// Exit code of a program that ends with it: 0, 1 for a loss, 3 where it cannot be told.
    pub fn exit_code(self) -> u8 {
        match self {
            Self::NoLoss => 0,
            Self::Loss => 1,
            Self::Unknown => 3,
        }
    }
}

impl Decision {
    /// Whether the leak alarm is due; `None`: it cannot be told, and changes nothing.
    pub(crate) fn leak_alarm(&self) -> Option<bool> {
        match self.outcome {
            Outcome::Loss => Some(true),
            Outcome::NoLoss => Some(false),
            Outcome::Unknown => None,
        }
    }

    /// Whether all that it says agrees, and the leak alarm, active or not, with it.
    pub fn is_consistent(&self, leak_alarm_active: bool) -> bool {
        let likely = self.leak_probability.is_some_and(|probability| probability >= LIKELY);
        match self.outcome {
            Outcome::Loss => {
                let verdict = matches!(self.verdict, Verdict::Leak | Verdict::Discharge);
                let due = self.reaction.is_some_and(|reaction| reaction > Reaction::None);
                verdict && likely && due && leak_alarm_active
            }
            Outcome::NoLoss => self.verdict != Verdict::Leak && self.verdict.reason().is_none() && !likely,
            Outcome::Unknown => self.verdict.reason().is_some(),
        }
    }
}

/// Decide.
pub fn decide(known: &Known) -> Decision {
    let likely = known.leak_probability.is_some_and(|probability| probability >= LIKELY);
    let verdict = match known.exchange {
        Some(KnownExchange { out: true, .. }) => Verdict::Discharge,
        _ if known.leak_found => Verdict::Leak,
        Some(_) => Verdict::Refill,
        None => match known.doubt {
            Some(reason) => Verdict::Unknown(reason),
            None if likely => Verdict::Unknown(Reason::Suspected),
            None if known.sensor_fault => Verdict::SensorFault,
            None => Verdict::Tight,
        },
    };
    let announced = known.exchange.is_some_and(|exchange| exchange.announced);
    let outcome = match verdict {
        Verdict::Leak => Outcome::Loss,
        Verdict::Discharge if !announced || known.leak_found => Outcome::Loss,
        Verdict::Unknown(_) => Outcome::Unknown,
        _ => Outcome::NoLoss,
    };
    let least = match (outcome, verdict) {
        (Outcome::Loss, Verdict::Discharge) => Some(Reaction::AsSoonAsPossible),
        (Outcome::Loss, _) => Some(Reaction::NextInterval),
        _ => None,
    };
    Decision {
        verdict,
        outcome,
        leak_probability: said(known.leak_probability, verdict, outcome),
        reaction: known.reaction.max(least),
    }
}

/// The probability that can be said: what the evidence says, unless the verdict rests on more than that.
fn said(by_evidence: Option<f64>, verdict: Verdict, outcome: Outcome) -> Option<f64> {
    match (outcome, verdict) {
        (Outcome::Loss, Verdict::Discharge) => Some(1.0),
        (Outcome::Loss, _) => Some(by_evidence.map_or(LIKELY, |probability| probability.max(LIKELY))),
        (Outcome::Unknown, Verdict::Unknown(Reason::Suspected)) => by_evidence,
        (Outcome::NoLoss, Verdict::Tight | Verdict::SensorFault) => by_evidence,
        // Gas that was exchanged, or an answer that something stands in the way of: the masses of before tell nothing.
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Everything that can be known of a row.
    fn all() -> impl Iterator<Item = Known> {
        let exchange = |out, announced| Some(KnownExchange { out, announced });
        let exchanges = [
            None,
            exchange(true, true),
            exchange(true, false),
            exchange(false, true),
            exchange(false, false),
        ];
        let doubts = [None, Some(Reason::Learning), Some(Reason::Jump)];
        let probabilities = [None, Some(0.0), Some(0.3), Some(LIKELY), Some(0.999)];
        let reactions = [None, Some(Reaction::None), Some(Reaction::Shutdown)];
        exchanges.into_iter().flat_map(move |exchange| {
            doubts.into_iter().flat_map(move |doubt| {
                probabilities.into_iter().flat_map(move |leak_probability| {
                    reactions.into_iter().flat_map(move |reaction| {
                        [false, true].into_iter().flat_map(move |leak_found| {
                            [false, true].map(|sensor_fault| Known {
                                exchange,
                                leak_found,
                                doubt,
                                sensor_fault,
                                leak_probability,
                                reaction,
                            })
                        })
                    })
                })
            })
        })
    }

    #[test]
    fn nothing_that_can_be_known_leads_to_words_that_disagree() {
        let mut outcomes = std::collections::HashSet::new();
        for known in all() {
            let decision = decide(&known);
            assert!(
                decision.is_consistent(decision.leak_alarm() == Some(true)),
                "{known:?} gives {decision:?}"
            );
            outcomes.insert(decision.outcome);
        }
        assert_eq!(outcomes.len(), 3);
    }

    #[test]
    fn a_disagreement_is_seen() {
        let sound = Decision {
            verdict: Verdict::Tight,
            outcome: Outcome::NoLoss,
            leak_probability: Some(0.01),
            reaction: Some(Reaction::None),
        };
        assert!(sound.is_consistent(false));
        assert!(!Decision { leak_probability: Some(0.99), ..sound }.is_consistent(false));
        assert!(!Decision { outcome: Outcome::Unknown, ..sound }.is_consistent(false));
        let loss = Decision {
            verdict: Verdict::Leak,
            outcome: Outcome::Loss,
            leak_probability: Some(0.99),
            reaction: Some(Reaction::NextInterval),
        };
        assert!(loss.is_consistent(true) && !loss.is_consistent(false));
        assert!(!Decision { reaction: Some(Reaction::None), ..loss }.is_consistent(true));
        assert!(!Decision { leak_probability: None, ..loss }.is_consistent(true));
    }

    #[test]
    fn gas_that_goes_out_fast_is_a_loss_unless_it_was_announced() {
        let nothing = Known {
            exchange: None,
            leak_found: false,
            doubt: Some(Reason::Learning),
            sensor_fault: false,
            leak_probability: None,
            reaction: None,
        };
        let out = |announced| Known { exchange: Some(KnownExchange { out: true, announced }), ..nothing };
        let lost = decide(&out(false));
        assert_eq!((lost.verdict, lost.outcome.exit_code()), (Verdict::Discharge, 1));
        assert_eq!(lost.reaction, Some(Reaction::AsSoonAsPossible));
        assert_eq!(decide(&out(true)).outcome.exit_code(), 0);
        assert_eq!(decide(&Known { leak_found: true, ..out(true) }).outcome, Outcome::Loss);
        let refilled = Some(KnownExchange { out: false, announced: false });
        let leaking = decide(&Known { exchange: refilled, leak_found: true, ..nothing });
        assert_eq!((leaking.verdict, leaking.outcome), (Verdict::Leak, Outcome::Loss));
        assert_eq!(decide(&Known { exchange: refilled, ..nothing }).verdict, Verdict::Refill);
        assert_eq!(decide(&nothing).outcome.exit_code(), 3);
    }

    #[test]
    fn a_tight_cylinder_is_never_likely_to_leak_and_a_prior_is_not_said() {
        let known = Known {
            exchange: None,
            leak_found: false,
            doubt: None,
            sensor_fault: false,
            leak_probability: Some(0.99),
            reaction: Some(Reaction::None),
        };
        assert_eq!(decide(&known).verdict, Verdict::Unknown(Reason::Suspected));
        let calm = decide(&Known { leak_probability: Some(0.2), ..known });
        assert_eq!((calm.verdict, calm.leak_probability), (Verdict::Tight, Some(0.2)));
        let learning = decide(&Known { doubt: Some(Reason::Learning), ..known });
        assert_eq!((learning.leak_probability, learning.outcome), (None, Outcome::Unknown));
    }
}
