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
//! | scale | deviation | finds within |
//! |---|---|---|
//! | [`Scale::Hour`] | `L_0`: low-pass of the missing mass over its doubt, 450 s (`rapid`) | an hour |
//! | [`Scale::HalfDay`] | `L_1`: low-pass of `z`, 4 h | a day |
//! | [`Scale::Day`] | `L_2`: low-pass of `z`, 24 h | three days |
//! | [`Scale::Week`] | `L_3`: low-pass of `z`, 96 h | a week |
//! | [`Scale::Month`] | low-pass of `L_3`, 168 h | a month |
//!
//! The members' standard deviations make the deviations alike from cylinder to cylinder only in part: errors are coloured, and how large they are
//! depends on vessel, climate and sensors. In a workshop `L_1` has a standard deviation of 0.02, in a metro of 0.3. So each statistic is its
//! deviation over what it does there without a leak (self-normalisation), learnt by `restless` from the differences between neighbouring time scales,
//! `(L_1 - L_2)^2 + (L_2 - L_3)^2` for those of the rate and `(L_0 - L_h)^2`, with a low-pass `L_h` of a day, for the missing mass. A leak shifts
//! the level of `z` and, but for its first days, not these differences. What the statistics reach without a leak is measured ([`Tails`]).
//!
//! A low-pass of a rate over a time tells the mass lost in it and averages what comes and goes with the day; each begins at zero, so that nothing
//! counts for more than it has lasted. Slower members of the bank find no smaller leaks than low-passes of the fastest one, which know no surprise after
//! a false alarm.
//!
//! A member that began anew (see the observer) has a wide leak rate, so `z` says nothing until it is known again. An exchange of
//! gas or a restart of the observer makes all deviations begin anew; a reading that was taken after many rejections frees the
//! mass, so only the missing mass does. What is usual is kept.
//!
//! Constant time and memory per sample; the state can be saved and restored at any sample.
//!
//! Source of the normalisation by the series itself: X. Shao, J. R. Stat. Soc. B 72 (2010) 343.
//!
//! [`Observer::leaks`]: cylwatch_estimator::observer::Observer::leaks
mod rapid;
mod restless;
mod tail;
mod thresholds;

use cylwatch_estimator::observer::{Estimate, Leak, LeakHypothesis, Observer, ObserverSettings, Quality};
use serde::{Deserialize, Serialize};

use crate::DetectorError;
use crate::units::HOUR_S;
use rapid::MissingMass;
pub(crate) use restless::Restless;
pub use tail::{Tail, Tails};
pub use thresholds::Thresholds;

/// Time constants of the low-passes of the rate, s.
const LOW_PASS_S: [f64; 3] = [4.0 * HOUR_S, 24.0 * HOUR_S, 96.0 * HOUR_S];
/// Time constant of the low-pass behind the slowest of them, s.
const BEHIND_S: f64 = 168.0 * HOUR_S;
/// A rate in standard deviations counts so much at most: one that is far beyond any threshold must not be remembered for months.
const MOST: f64 = 3.0;

/// What the low-passes of the rate and the missing mass do in a typical cylinder, before its own is known.
const USUAL_RATE: f64 = 0.2;
const USUAL_MISSING: f64 = 0.1;

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

/// One number per scale, in usual deviations and in the order of [`Scale::ALL`]; positive: gas is being lost.
pub type Statistics = [f64; Scale::ALL.len()];

/// Error of the pressure per kelvin between mean wall and gas in the eyes of the members that matter here, Pa/K: 2 bar/K.
const CAUTION_PA_K: f64 = 2e5;

/// What else is in doubt after a sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Doubt {
    /// What of a mass that follows the pressure comes and goes without gas, standard deviation, kg.
    pub passing_kg: f64,
    /// Error of the freest mass against the slow one by what has been learnt of the sensors, standard deviation, kg.
    pub learnt_kg: f64,
    /// What all statistics are divided by, at least 1: the thermometers stand for the gas less than usual.
    pub divisor: f64,
}

impl Doubt {
    /// Nothing else.
    pub const NONE: Self = Self { passing_kg: 0.0, learnt_kg: 0.0, divisor: 1.0 };

    /// Of what an observer says, with everything divided by so much.
    pub fn of(observer: &Observer, evidence: &Evidence, divisor: f64) -> Self {
        let Members { slowest, freest, .. } = evidence.members;
        Self {
            passing_kg: observer.flow().map_or(0.0, |flow| flow.passing_sd_kg),
            learnt_kg: observer.learnt_apart_kg(freest, slowest),
            divisor,
        }
    }

    /// Error of the freest mass against the slow one, standard deviation, kg.
    fn mass_kg(&self) -> f64 {
        self.passing_kg.hypot(self.learnt_kg)
    }
}

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
    /// What the low-passes of the rate, and the missing mass, do without a leak.
    usual: Restless,
    usual_missing: Restless,
    divisor: f64,
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
            usual: Restless::with_prior(USUAL_RATE),
            usual_missing: Restless::with_prior(USUAL_MISSING),
            divisor: 1.0,
        })
    }

    /// Take what the observer says after a sample, [`Observer::leaks`] in the order of its bank; the statistics after it.
    /// Samples not later than the last one, and members that are none of this bank, change nothing.
    ///
    /// [`Observer::leaks`]: cylwatch_estimator::observer::Observer::leaks
    pub fn update(&mut self, estimate: &Estimate, leaks: &[Leak], doubt: Doubt) -> Statistics {
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
        self.divisor = doubt.divisor;
        let open = estimate.quality == Quality::Open;
        // An exchange takes the rate back to its prior, which is no leak; a reading taken after many rejections does not.
        if estimate.quality == Quality::Restarted || (open && fastest.rate_kg_s == 0.0) {
            self.forget();
        }
        if open {
            self.missing = MissingMass::default();
        } else {
            self.missing.update(interval_s, slowest, freest, doubt.mass_kg());
        }
        let rate = standardised(fastest);
        for (output, time_constant_s) in self.low_passes.iter_mut().zip(LOW_PASS_S) {
            *output += -(-interval_s / time_constant_s).exp_m1() * (rate - *output);
        }
        self.behind += -(-interval_s / BEHIND_S).exp_m1() * (self.low_passes[2] - self.behind);
        let [half_day, day, week] = self.low_passes;
        self.usual.update(interval_s, (half_day - day).powi(2) + (day - week).powi(2));
        self.usual_missing.update(interval_s, self.missing.deviation().powi(2));
        self.statistics()
    }

    /// The statistics after the last sample; 0 before the first and after an exchange of gas.
    pub fn statistics(&self) -> Statistics {
        let rate = (self.divisor * self.usual.sd()).recip();
        let missing = (self.divisor * self.usual_missing.sd()).recip();
        let [half_day, day, week] = self.low_passes;
        [missing * self.missing.value(), rate * half_day, rate * day, rate * week, rate * self.behind]
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
