//! The time that is left and the reaction that is due, in words.
use crate::detector::prognosis::{Advice, Passage, Reaction};
use crate::thermal::units::YEAR_S;

use crate::report::estimate::duration;

/// When a limit is reached, in words.
pub(crate) fn passage_text(passage: Passage, horizon_s: f64) -> String {
    match passage {
        Passage::Reached => "reached".to_owned(),
        Passage::In(time_s) => long(time_s),
        Passage::Unknown => "not known yet".to_owned(),
        Passage::BeyondHorizon => format!("beyond {}", long(horizon_s)),
    }
}

/// A duration, years in years.
fn long(duration_s: f64) -> String {
    let years = duration_s / YEAR_S;
    match years {
        y if y < 0.99 => duration(duration_s),
        y if y < 1.01 => "a year".to_owned(),
        y => format!("{} years", crate::report::number(y, 2)),
    }
}

/// A reaction as one word for a table.
pub(crate) fn reaction_word(reaction: Reaction) -> &'static str {
    match reaction {
        Reaction::None => "none",
        Reaction::NextInterval => "next-interval",
        Reaction::AsSoonAsPossible => "as-soon-as-possible",
        Reaction::Shutdown => "shutdown",
    }
}

/// What to do.
pub(crate) fn reaction_text(reaction: Reaction) -> &'static str {
    match reaction {
        Reaction::None => "none",
        Reaction::NextInterval => "refill or replace at the next service",
        Reaction::AsSoonAsPossible => "maintenance as soon as possible",
        Reaction::Shutdown => "take out of service",
    }
}

/// Why it is due.
pub(crate) fn reaction_reason(advice: &Advice, next_service_s: f64) -> String {
    let service = duration(next_service_s);
    match advice.reaction {
        Reaction::None => format!(
            "an operational limit is reached before the service in {service} with {}, the maintenance limit before the \
             one after with {}",
            percent(advice.before_next_service),
            percent(advice.before_following_service)
        ),
        Reaction::NextInterval => format!(
            "the maintenance limit is reached before the service after the next with {}",
            percent(advice.before_following_service)
        ),
        Reaction::AsSoonAsPossible => format!(
            "an operational limit is reached before the service in {service} with {}",
            percent(advice.before_next_service)
        ),
        Reaction::Shutdown => format!(
            "an operational limit is reached, or will be before a safe state is, with {}",
            percent(advice.before_safe_state)
        ),
    }
}

/// A probability in percent, never a certainty that it is not.
pub(super) fn percent(probability: f64) -> String {
    match 100.0 * probability {
        p if p.is_nan() => "unknown probability".to_owned(),
        p if p < 1.0 => "less than 1 %".to_owned(),
        p if p > 99.0 => "more than 99 %".to_owned(),
        p => format!("{p:.0} %"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_lies_beyond_the_horizon_is_not_a_number_of_days() {
        let year_s = 365.0 * 86_400.0;
        assert_eq!(passage_text(Passage::BeyondHorizon, year_s), "beyond a year");
        assert_eq!(passage_text(Passage::BeyondHorizon, 10.0 * year_s), "beyond 10 years");
        assert_eq!(passage_text(Passage::BeyondHorizon, 10.0 * 86_400.0), "beyond 10 d");
        assert_eq!(passage_text(Passage::Reached, year_s), "reached");
        assert_eq!(passage_text(Passage::In(5.5 * 86_400.0), year_s), "5.5 d");
    }

    #[test]
    fn no_probability_is_said_to_be_none_or_all() {
        assert_eq!(
            [0.0, 0.004, 0.42, 0.999, 1.0].map(percent),
            ["less than 1 %", "less than 1 %", "42 %", "more than 99 %", "more than 99 %"]
        );
    }
}
