//! Time by verdict, and statements without a cause.
//!
//! A statement counts for the time until the next one, an hour at most. An episode is a leak, an exchange of gas or a sensor at fault that
//! is said although there is none; it begins where it was not said for an hour before, so that a statement that flickers counts once. The
//! time at risk is that in which it is not being said.
use serde::{Deserialize, Serialize};

use super::{Gas, Moment};
use crate::judge::measures::Class;
use crate::judge::statement::Decision;

/// Time without a statement after which it counts anew, s.
const EPISODE_GAP_S: f64 = 3600.0;

/// Time by verdict in the order of `Class::ALL`, s.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Shares {
    /// While nothing has happened to the gas: first day, later.
    pub tight_s: [[f64; 6]; 2],
    /// Since gas was lost: first day, later.
    pub lost_s: [[f64; 6]; 2],
}

/// Episodes of a false statement.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Episode {
    /// How often: first day, later.
    pub count: [u64; 2],
    /// Time in which it was not said, s: first day, later.
    pub at_risk_s: [f64; 2],
}

/// All false statements.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Episodes {
    /// A loss, whatever it is called.
    pub loss: Episode,
    /// A leak.
    pub leak: Episode,
    /// A discharge or a refill.
    pub exchange: Episode,
    /// The verdict of a sensor at fault.
    pub sensor_fault: Episode,
}

/// Episodes while they are counted.
#[derive(Clone, Copy, Debug, Default)]
struct EpisodeCounter {
    episode: Episode,
    said_until_s: Option<f64>,
}

impl EpisodeCounter {
    fn take(&mut self, moment: &Moment<'_>, said: bool) {
        if !said {
            self.episode.at_risk_s[moment.period] += moment.step_s;
            return;
        }
        let fresh = self.said_until_s.is_none_or(|until_s| moment.now_s - until_s > EPISODE_GAP_S);
        self.episode.count[moment.period] += u64::from(fresh);
        self.said_until_s = Some(moment.now_s);
    }
}

/// Verdicts while they are counted.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Verdicts {
    shares: Shares,
    last: Option<Class>,
    loss: EpisodeCounter,
    leak: EpisodeCounter,
    exchange: EpisodeCounter,
    sensor_fault: EpisodeCounter,
}

impl Verdicts {
    /// Take a decision.
    pub(crate) fn take(&mut self, moment: &Moment<'_>, decision: &Decision) {
        if let Some(class) = self.last {
            let seconds = match moment.gas {
                Gas::Tight => &mut self.shares.tight_s,
                Gas::Lost | Gas::Exchanged => &mut self.shares.lost_s,
            };
            seconds[moment.period][class as usize] += moment.step_s;
        }
        self.last = Some(decision.class);
        self.loss.take(moment, decision.loss || decision.says_leak());
        self.leak.take(moment, decision.says_leak());
        self.exchange.take(moment, decision.exchange);
        self.sensor_fault.take(moment, decision.class == Class::SensorFault);
    }

    /// Whether anything was decided.
    pub(crate) fn any(&self) -> bool {
        self.last.is_some()
    }

    /// After the last decision.
    pub(crate) fn finish(self) -> (Shares, Episodes) {
        let episodes = Episodes {
            loss: self.loss.episode,
            leak: self.leak.episode,
            exchange: self.exchange.episode,
            sensor_fault: self.sensor_fault.episode,
        };
        (self.shares, episodes)
    }
}
