//! Words of the monitor as values of an enumeration.
use cylwatch_detector::monitor::{Outcome, Reason, Verdict};
use cylwatch_detector::prognosis::Reaction;

use crate::variable::Enumeration;

pub(super) static VERDICT: Enumeration = Enumeration {
    name: "Verdict",
    description: "What is happening to the gas",
    items: &[
        ("tight", "no gas is being lost that could be seen"),
        ("leak", "gas is being lost steadily"),
        ("discharge", "gas was let out fast, or is being"),
        ("refill", "gas was put in, or is being"),
        ("sensor_fault", "a sensor is at fault; what is said of the gas rests on the others"),
        ("unknown", "it cannot be told: see reason"),
    ],
};

pub(super) fn verdict(verdict: Verdict) -> u8 {
    match verdict {
        Verdict::Tight => 1,
        Verdict::Leak => 2,
        Verdict::Discharge => 3,
        Verdict::Refill => 4,
        Verdict::SensorFault => 5,
        Verdict::Unknown(_) => 6,
    }
}

pub(super) static REASON: Enumeration = Enumeration {
    name: "Reason",
    description: "Why the verdict is unknown",
    items: &[
        ("none", "the verdict is not unknown"),
        ("learning", "still learning the sensors"),
        ("filling", "the readings do not fit the filling that was stated"),
        ("no_pressure", "no usable pressure"),
        ("no_temperature", "no usable temperature"),
        ("gap", "no rows for too long"),
        ("jump", "the pressure jumped: gas or transmitter"),
        ("settling", "gas was exchanged and has not settled"),
        ("disturbed", "one end of the cylinder is warmed or cooled by itself"),
        ("stuck", "a reading stands still"),
        ("clock", "the clock jumped"),
        ("restarted", "the estimate had to begin again"),
        ("suspected", "a leak is likely, but not certain yet"),
        ("empty", "the cylinder is nearly empty: no leak would show"),
    ],
};

pub(super) fn reason(reason: Option<Reason>) -> u8 {
    match reason {
        None => 1,
        Some(Reason::Learning) => 2,
        Some(Reason::Filling) => 3,
        Some(Reason::NoPressure) => 4,
        Some(Reason::NoTemperature) => 5,
        Some(Reason::Gap) => 6,
        Some(Reason::Jump) => 7,
        Some(Reason::Settling) => 8,
        Some(Reason::Disturbed) => 9,
        Some(Reason::Stuck) => 10,
        Some(Reason::Clock) => 11,
        Some(Reason::Restarted) => 12,
        Some(Reason::Suspected) => 13,
        Some(Reason::Empty) => 14,
    }
}

pub(super) static OUTCOME: Enumeration = Enumeration {
    name: "Outcome",
    description: "Whether gas is being lost",
    items: &[
        ("no_loss", "no gas is being lost"),
        ("loss", "gas is being lost"),
        ("unknown", "it cannot be told"),
    ],
};

pub(super) fn outcome(outcome: Outcome) -> u8 {
    match outcome {
        Outcome::NoLoss => 1,
        Outcome::Loss => 2,
        Outcome::Unknown => 3,
    }
}

pub(super) static REACTION: Enumeration = Enumeration {
    name: "Reaction",
    description: "What is due",
    items: &[
        ("unknown", "not known yet"),
        ("none", "nothing"),
        ("next_interval", "refill or replace at the next service"),
        ("as_soon_as_possible", "maintenance before the next service"),
        ("shutdown", "stop using the vehicle"),
    ],
};

pub(super) fn reaction(reaction: Option<Reaction>) -> u8 {
    match reaction {
        None => 1,
        Some(Reaction::None) => 2,
        Some(Reaction::NextInterval) => 3,
        Some(Reaction::AsSoonAsPossible) => 4,
        Some(Reaction::Shutdown) => 5,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_number_has_its_word() {
        let word = |of: &Enumeration, number: u8| of.items[usize::from(number) - 1].0;
        for one in [Verdict::Tight, Verdict::Leak, Verdict::Discharge, Verdict::Refill, Verdict::SensorFault]
        {
            assert_eq!(word(&VERDICT, verdict(one)), one.as_str().replace(' ', "_"));
        }
        assert_eq!(word(&VERDICT, verdict(Verdict::Unknown(Reason::Gap))), "unknown");
        for (of, number) in Reason::ALL.into_iter().zip(2..) {
            assert_eq!(usize::from(reason(Some(of))), number);
            let debug = format!("{of:?}").to_lowercase();
            assert_eq!(REASON.items[number - 1].0.replace('_', ""), debug);
            assert_eq!(REASON.items[number - 1].1, of.as_str());
        }
        let outcomes = [Outcome::NoLoss, Outcome::Loss, Outcome::Unknown];
        assert_eq!(outcomes.map(|one| word(&OUTCOME, outcome(one))), ["no_loss", "loss", "unknown"]);
        let reactions =
            [Reaction::None, Reaction::NextInterval, Reaction::AsSoonAsPossible, Reaction::Shutdown];
        assert_eq!(
            reactions.map(|one| word(&REACTION, reaction(Some(one)))),
            ["none", "next_interval", "as_soon_as_possible", "shutdown"]
        );
    }
}
