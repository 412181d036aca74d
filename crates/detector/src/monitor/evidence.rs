//! Evidence for a leak: the rates of the bank over their standard deviations.
use serde::{Deserialize, Serialize};

use crate::estimator::observer::{Estimate, Leak};

/// Standard deviations of a rate that are a leak, and below which nothing speaks for one.
const ALARM_SD: f64 = 6.0;
const CALM_SD: f64 = 2.0;

/// What speaks for a leak.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Evidence {}

pub(super) struct Evidenced {
    pub alarm: bool,
    pub calm: bool,
}

impl Evidence {
    pub fn update(&mut self, _time_s: f64, leaks: &[Leak], _estimate: &Estimate) -> Evidenced {
        let z = leaks.iter().filter(|l| l.sd_kg_s > 0.0).map(|l| l.rate_kg_s / l.sd_kg_s).fold(0.0, f64::max);
        Evidenced { alarm: z > ALARM_SD, calm: z < CALM_SD }
    }

    pub fn restart(&mut self) {}
}
