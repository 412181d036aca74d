//! Which reaction is due: by the probability that a limit is reached before something can be done, not by a point estimate.
//!
//! In this order:
//! 1. shutdown, if an operational limit is reached within the time to a safe state, more likely than not;
//! 2. maintenance as soon as possible, if it is reached before the next service with 5 %;
//! 3. maintenance at the next interval, if the maintenance limit is reached before the service after the next with 5 %;
//! 4. none.
//!
//! The defaults and why: at half, the shutdown comes when the estimated mass itself is at the limit, and a full cylinder on the coldest
//! night, where 160 bar are right at the limit, does not stop a train; 5 % against a failure between services; a service interval
//! of six months, which ISO 14520 demands of the checks. To weigh a false shutdown against a missing extinguisher, set
//! a probability to (cost of acting in vain)/(cost of acting in vain + cost of not acting).
use serde::{Deserialize, Serialize};

use super::Prognosis;
use crate::units::DAY_S;
use crate::{DetectorError, error::positive};

/// What to do, the least urgent first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Reaction {
    /// Nothing.
    None,
    /// Refill or replace at the next service.
    NextInterval,
    /// Maintenance as soon as possible, before the next service.
    AsSoonAsPossible,
    /// Stop using the vehicle: the system is not operational, or will not be before a safe state.
    Shutdown,
}

/// When a reaction is due.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ReactionSettings {
    /// Time to a safe state, s.
    pub safe_state_s: f64,
    /// Time until the next service, s.
    pub next_service_s: f64,
    /// Time between services, s.
    pub service_interval_s: f64,
    /// Probability from which on a shutdown is due.
    pub shutdown_probability: f64,
    /// Probability from which on maintenance is due as soon as possible.
    pub soon_probability: f64,
    /// Probability from which on maintenance is due at the next service.
    pub interval_probability: f64,
}

impl Default for ReactionSettings {
    /// An hour, a month, six months; 50 %, 5 %, 5 %.
    fn default() -> Self {
        Self {
            safe_state_s: 3600.0,
            next_service_s: 30.0 * DAY_S,
            service_interval_s: 182.5 * DAY_S,
            shutdown_probability: 0.5,
            soon_probability: 0.05,
            interval_probability: 0.05,
        }
    }
}

/// A reaction and what it rests on.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Advice {
    /// What to do.
    pub reaction: Reaction,
    /// Probability that an operational limit is reached before a safe state.
    pub before_safe_state: f64,
    /// Probability that it is reached before the next service.
    pub before_next_service: f64,
    /// Probability that the maintenance limit is reached before the service after the next.
    pub before_following_service: f64,
}

impl ReactionSettings {
    /// # Errors
    /// A time is not positive, or a probability not between 0 and 1.
    pub(crate) fn validate(&self) -> Result<(), DetectorError> {
        positive("safe_state_s", self.safe_state_s)?;
        positive("next_service_s", self.next_service_s)?;
        positive("service_interval_s", self.service_interval_s)?;
        let probabilities = [
            ("shutdown_probability", self.shutdown_probability),
            ("soon_probability", self.soon_probability),
            ("interval_probability", self.interval_probability),
        ];
        for (setting, value) in probabilities {
            if !(value > 0.0 && value <= 1.0) {
                let bound = "above 0 and at most 1";
                return Err(DetectorError::Setting { setting, value, bound });
            }
        }
        Ok(())
    }

    /// What is due. Of several operational limits (at 15 °C, on the coldest night) the first to be reached counts.
    ///
    /// # Errors
    /// As `ReactionSettings::validate`.
    pub fn decide(
        &self,
        operational: &[Prognosis],
        maintenance: &Prognosis,
    ) -> Result<Advice, DetectorError> {
        self.validate()?;
        // Limits of one mass: whoever reaches the lower one has reached the higher one before.
        let within = |time_s: f64| {
            operational.iter().map(|limit| limit.probability_within(time_s)).fold(0.0, f64::max)
        };
        let before_safe_state = within(self.safe_state_s);
        let before_next_service = within(self.next_service_s);
        let before_following_service =
            maintenance.probability_within(self.next_service_s + self.service_interval_s);
        let reaction = if before_safe_state >= self.shutdown_probability {
            Reaction::Shutdown
        } else if before_next_service >= self.soon_probability {
            Reaction::AsSoonAsPossible
        } else if before_following_service >= self.interval_probability {
            Reaction::NextInterval
        } else {
            Reaction::None
        };
        Ok(Advice { reaction, before_safe_state, before_next_service, before_following_service })
    }
}
