//! Evidence for a leak on five time scales in parallel, from an hour to a month.
//!
//! Fed with what the members of the observer's bank say after every sample ([`Observer::leaks`]). The bank is the observer's
//! usual one, cautious with the pressure ([`observer_settings`]); three of its members matter:
//!
//! | member | its part |
//! |---|---|
//! | the fastest with a leak rate `r`, standard deviation `s` | rate in standard deviations, `z = r/s`, cut at 3 either way so that no single sample decides |
//! | the slowest with a leak rate, mass `m` | the mass that there should be |
//! | the freest, mass `m_free` | the mass that there is |
//!
//! | scale | statistic | finds within |
//! |---|---|---|
//! | [`Scale::Hour`] | missing mass `(m - m_free)/sd` over a quarter of an hour (`rapid`) | an hour |
//! | [`Scale::HalfDay`] | low-pass of `z`, 4 h | a day |
//! | [`Scale::Day`] | low-pass of `z`, 24 h | three days |
//! | [`Scale::Week`] | low-pass of `z`, 96 h | a week |
//! | [`Scale::Month`] | low-pass of that, 168 h | a month |
//!
//! The members' standard deviations make the statistics alike from cylinder to cylinder, wide before the sensors are learnt and after a
//! gap, and narrow once they are: they scale, they are no normal numbers, because errors are daily and heavy-tailed. What they
//! reach without a leak is measured ([`Tails`]). A low-pass of a rate over a time tells the mass lost in it and averages what
//! comes and goes with the day; each begins at zero, so that nothing counts for more than it has lasted. Slower members of the bank
//! find no smaller leaks than low-passes of the fastest one, which know no surprise after a false alarm.
//!
//! A member that began anew (see the observer) has a wide leak rate, so `z` says nothing until it is known again. An exchange of
//! gas or a restart of the observer makes all statistics begin anew; a reading that was taken after many rejections frees the
//! mass, so only the missing mass does.
//!
//! Constant time and memory per sample; the state can be saved and restored at any sample.
//!
//! [`Observer::leaks`]: cylwatch_estimator::observer::Observer::leaks
mod peaks;
mod rapid;
mod tail;
mod thresholds;

use cylwatch_estimator::observer::{Estimate, Leak, LeakHypothesis, ObserverSettings, Quality};
use serde::{Deserialize, Serialize};

use crate::DetectorError;
pub use peaks::Peaks;
use rapid::MissingMass;
pub use tail::{Tail, Tails};
pub use thresholds::Thresholds;

const HOUR_S: f64 = 3600.0;
/// Time constants of the low-passes of the rate, s.
const LOW_PASS_S: [f64; 3] = [4.0 * HOUR_S, 24.0 * HOUR_S, 96.0 * HOUR_S];
/// Time constant of the low-pass behind the slowest of them, s.
const BEHIND_S: f64 = 168.0 * HOUR_S;
/// A rate in standard deviations counts so much at most: one that is far beyond any threshold must not be remembered for months.
const MOST: f64 = 3.0;

/// Time scale of a statistic.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Scale {
    /// Gas that is missing now.
    Hour,
    /// Leaks found within a day.
    HalfDay,
    /// Within three days.
    Day,
    /// Within a week.
    Week,
    /// Within a month.
    Month,
}

impl Scale {
    /// All, from short to long, in the order of [`Statistics`].
    pub const ALL: [Self; 5] = [Self::Hour, Self::HalfDay, Self::Day, Self::Week, Self::Month];

    /// Its name in a table.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Hour => "hour",
            Self::HalfDay => "half-day",
            Self::Day => "day",
            Self::Week => "week",
            Self::Month => "month",
        }
    }

    /// Time after which the statistic is a new one, s: what lies closer is one excursion.
    pub fn memory_s(self) -> f64 {
        HOUR_S
            * match self {
                Self::Hour => 12.0,
                Self::HalfDay => 48.0,
                Self::Day => 96.0,
                Self::Week => 336.0,
                Self::Month => 720.0,
            }
    }
}

/// One number per scale, in the order of [`Scale::ALL`]; positive: gas is being lost.
pub type Statistics = [f64; Scale::ALL.len()];

/// Error of the pressure per kelvin between mean wall and gas in the eyes of the members that matter here, Pa/K: 2 bar/K.
const CAUTION_PA_K: f64 = 2e5;

/// Settings of the observer whose members the evidence is taken from: the usual ones, but for a bank whose members trust the pressure far
/// less while wall and gas differ. In tunnels and in the sun the stratified gas is not the reduced model's, always to the same
/// side; what counts is the mass from one calm hour to the next. That nearly halves the smallest leak found, from an hour to
/// a month. The first member, which gives mass and gas temperature, trusts it as usual.
pub fn observer_settings() -> ObserverSettings {
    let bank = vec![
        LeakHypothesis::walking_mass(1.5),
        LeakHypothesis::walking_rate(0.02).cautious(CAUTION_PA_K),
        LeakHypothesis::walking_rate(0.005).cautious(CAUTION_PA_K),
        LeakHypothesis::walking_mass(30.0).cautious(CAUTION_PA_K),
    ];
    let usual = ObserverSettings::default();
    let flowing = usual.bank.iter().filter(|member| member.is_flowing()).copied();
    ObserverSettings { bank: bank.into_iter().chain(flowing).collect(), ..usual }
}

/// The members that matter, by their place in the bank.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
struct Members {
    fastest: usize,
    slowest: usize,
    freest: usize,
}

impl Members {
    fn of(settings: &ObserverSettings) -> Option<Self> {
        let bank = &settings.bank;
        let rated = || (0..bank.len()).filter(|&index| bank[index].is_slow());
        let speed = |a: &usize, b: &usize| bank[*a].rate.per_sqrt_s.total_cmp(&bank[*b].rate.per_sqrt_s);
        let freedom = |a: &usize, b: &usize| {
            bank[*a].mass_walk_kg_per_sqrt_s.total_cmp(&bank[*b].mass_walk_kg_per_sqrt_s)
        };
        let freest = (0..bank.len()).rev().max_by(freedom)?;
        let members = Self { fastest: rated().max_by(speed)?, slowest: rated().min_by(speed)?, freest };
        (bank[freest].mass_walk_kg_per_sqrt_s > 0.0 && members.fastest != freest && members.slowest != freest)
            .then_some(members)
    }
}

/// The evidence so far.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Evidence {
    members: Members,
    last_s: Option<f64>,
    missing: MissingMass,
    low_passes: [f64; LOW_PASS_S.len()],
    behind: f64,
}

impl Evidence {
    /// None yet, of an observer with such settings.
    ///
    /// # Errors
    /// The bank has no member with a leak rate that walks, or none whose mass walks.
    pub fn try_new(settings: &ObserverSettings) -> Result<Self, DetectorError> {
        let members = Members::of(settings).ok_or(DetectorError::Bank)?;
        Ok(Self {
            members,
            last_s: None,
            missing: MissingMass::default(),
            low_passes: [0.0; LOW_PASS_S.len()],
            behind: 0.0,
        })
    }

    /// Take what the observer says after a sample, [`Observer::leaks`] in the order of its bank; the statistics after it.
    /// Samples not later than the last one, and members that are none of this bank, change nothing.
    ///
    /// [`Observer::leaks`]: cylwatch_estimator::observer::Observer::leaks
    pub fn update(&mut self, estimate: &Estimate, leaks: &[Leak]) -> Statistics {
        let Members { fastest, slowest, freest } = self.members;
        let member = |index: usize| leaks.get(index);
        let (Some(fastest), Some(slowest), Some(freest)) = (member(fastest), member(slowest), member(freest))
        else {
            return self.statistics();
        };
        let interval_s = self.last_s.map_or(0.0, |last_s| estimate.time_s - last_s);
        if self.last_s.is_some() && interval_s <= 0.0 {
            return self.statistics();
        }
        self.last_s = Some(estimate.time_s);
        let open = estimate.quality == Quality::Open;
        // An exchange takes the rate back to its prior, which is no leak; a reading taken after many rejections does not.
        if estimate.quality == Quality::Restarted || (open && fastest.rate_kg_s == 0.0) {
            self.forget();
        }
        if open {
            self.missing = MissingMass::default();
        } else {
            self.missing.update(interval_s, slowest, freest);
        }
        let rate = standardised(fastest);
        for (output, time_constant_s) in self.low_passes.iter_mut().zip(LOW_PASS_S) {
            *output += -(-interval_s / time_constant_s).exp_m1() * (rate - *output);
        }
        self.behind += -(-interval_s / BEHIND_S).exp_m1() * (self.low_passes[2] - self.behind);
        self.statistics()
    }

    /// The statistics after the last sample; 0 before the first and after an exchange of gas.
    pub fn statistics(&self) -> Statistics {
        let [half_day, day, week] = self.low_passes;
        [self.missing.value(), half_day, day, week, self.behind]
    }

    /// Begin anew, as after an exchange of gas.
    pub fn forget(&mut self) {
        self.missing = MissingMass::default();
        self.low_passes = [0.0; LOW_PASS_S.len()];
        self.behind = 0.0;
    }
}

/// Leak rate in standard deviations, bounded; 0 where nothing is known.
fn standardised(leak: &Leak) -> f64 {
    if leak.sd_kg_s > 0.0 { (leak.rate_kg_s / leak.sd_kg_s).clamp(-MOST, MOST) } else { 0.0 }
}

#[cfg(test)]
mod tests;
