//! Evidence for a leak on five time scales in parallel, from an hour to a month.
//!
//! The observer's member that holds the mass has the signature of a leak in its innovations, for every possible onset at once ([`Observer::onsets`]): with
//! rate `r`, standard deviation `s` and age `A` of each,
//!
//! `z = max(0, r - (p min(1, 3 tau/A) + q)/A) / (s F D)`.
//!
//! A scale's statistic is the largest `z` of its onsets:
//!
//! | scale | age of the onset | finds within |
//! |---|---|---|
//! | [`Scale::Hour`] | up to 66 min | an hour |
//! | [`Scale::HalfDay`] | up to 12 h | a day |
//! | [`Scale::Day`] | up to 2 d | three days |
//! | [`Scale::Week`] | up to 10 d | a week |
//! | [`Scale::Month`] | up to 60 d | a month |
//!
//! * `p` is what the observer considers of the mass for what the surroundings do now ([`Flow::considered_sd_kg`]). It fades with `tau`, and weighs on onsets that
//!   have seen little else.
//! * `q` is what else the mass may be off by now, for as long as it may: the gas is not what the thermometers say.
//! * `F` is the cylinder's own: innovations are coloured, and how much depends on vessel, climate and sensors. The rates of two onsets, of which the older one rests on all that the
//!   younger one does, differ by `s_i^2 - s_k^2` in their variance if the innovations are independent; `F^2` is the running mean of the square of their difference
//!   over that (`restless`), of onsets 1.5, 8 and 32 h old, where the younger one has the lower rate. Where it has the higher one, that may be a leak: what one that began before
//!   has made of the filter's error is the larger a rate, the shorter the time that it is put down to.
//! * `D`, at least 1, is what else is in doubt: a thermometer is missing.
//!
//! What the statistics reach without a leak is measured ([`Tails`]).
//!
//! An exchange of gas or a restart of the observer ends all onsets; what is usual is kept. Constant time and memory per sample; the state can be saved and
//! restored at any sample.
//!
//! Source: generalised likelihood ratio of a jump of unknown onset, Willsky, Jones, IEEE Trans. Autom. Control 21 (1976) 108; variance of a difference of estimates,
//! J. A. Hausman, Econometrica 46 (1978) 1251; normalisation by the series itself, X. Shao, J. R. Stat. Soc. B 72 (2010) 343.
//!
//! [`Flow::considered_sd_kg`]: cylwatch_estimator::observer::Flow::considered_sd_kg
mod restless;
mod tail;
mod thresholds;

use cylwatch_estimator::observer::{LeakHypothesis, Observer, ObserverSettings, Onset};
use cylwatch_estimator::thermal::real::powi;
use serde::{Deserialize, Serialize};

use crate::units::{DAY_S, HOUR_S};
pub(crate) use restless::Restless;
pub use tail::{Tail, Tails};
pub use thresholds::Thresholds;

/// Ages of the onsets whose rates are compared, s, and how far an onset may be from one, as a ratio.
const COMPARED_S: [f64; 3] = [1.5 * HOUR_S, 8.0 * HOUR_S, 32.0 * HOUR_S];
const NEAR: f64 = 1.5;
/// `F` of a typical cylinder, before its own is known.
const USUAL: f64 = 0.5;
/// Memories of what is considered after which it is over.
const FADED: f64 = 3.0;

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

    /// Age of the oldest onset that it is about, s.
    fn oldest_s(self) -> f64 {
        match self {
            Self::Hour => 1.1 * HOUR_S,
            Self::HalfDay => 12.0 * HOUR_S,
            Self::Day => 2.0 * DAY_S,
            Self::Week => 10.0 * DAY_S,
            Self::Month => f64::INFINITY,
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

/// One number per scale, in the order of [`Scale::ALL`]: the larger, the more speaks for a loss; 0: nothing does.
pub type Statistics = [f64; Scale::ALL.len()];

/// Settings of the observer that the evidence is taken from: the usual ones, but for the bank. In place of the members with a leak rate one holds the mass, and tells leaks of
/// any onset by their signature. It and the freest one trust the pressure less while wall and gas differ: in tunnels and in the sun the stratified gas is not the reduced
/// model's, always to the same side. The first member, which gives mass and gas temperature, trusts it as usual.
pub fn observer_settings() -> ObserverSettings {
    let bank = vec![
        LeakHypothesis::walking_mass(1.5).considering_offset(),
        LeakHypothesis::walking_mass(0.1).cautious(0.5e5),
        LeakHypothesis::walking_mass(30.0).cautious(2e5),
    ];
    let usual = ObserverSettings::default();
    let flowing = usual.bank.iter().filter(|member| member.is_flowing()).copied();
    ObserverSettings { bank: bank.into_iter().chain(flowing).collect(), ..usual }
}

/// The evidence so far.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Evidence {
    /// Memory of what is considered, s.
    memory_s: f64,
    last_s: Option<f64>,
    usual: Restless,
    divisor: f64,
    /// What is considered of the mass, and what else it may be off by, standard deviations, kg.
    considered_kg: f64,
    off_kg: f64,
    statistics: Statistics,
}

impl Evidence {
    /// None yet, of an observer with such settings.
    pub fn new(settings: &ObserverSettings) -> Self {
        Self {
            memory_s: settings.flow_doubt.memory_s,
            last_s: None,
            usual: Restless::with_prior(USUAL),
            divisor: 1.0,
            considered_kg: 0.0,
            off_kg: 0.0,
            statistics: [0.0; Scale::ALL.len()],
        }
    }

    /// Take what the observer says after a sample at a time, s, with rates less certain by a divisor, at least 1, and a mass that may be off by so much, kg; the statistics
    /// after it. Samples not later than the last one change nothing.
    pub fn update(&mut self, observer: &Observer, time_s: f64, (divisor, off_kg): (f64, f64)) -> Statistics {
        let interval_s = self.last_s.map_or(0.0, |last_s| time_s - last_s);
        if self.last_s.is_some() && interval_s <= 0.0 {
            return self.statistics;
        }
        self.last_s = Some(time_s);
        (self.divisor, self.off_kg) = (divisor, off_kg);
        self.considered_kg = observer.flow().map_or(0.0, |flow| flow.considered_sd_kg);
        self.compare(observer, time_s, interval_s);
        self.statistics = [0.0; Scale::ALL.len()];
        let error_sd = self.error_sd();
        for onset in observer.onsets() {
            let age_s = time_s - onset.since_s;
            let Some(scale) = Scale::ALL.into_iter().find(|scale| age_s <= scale.oldest_s()) else {
                continue;
            };
            let rate_kg_s = onset.rate_kg_s - self.considered_kg_s(age_s);
            let score = rate_kg_s / (onset.sd_kg_s * error_sd);
            let statistic = &mut self.statistics[scale as usize];
            *statistic = statistic.max(score);
        }
        self.statistics
    }

    /// Learn by how much the rates of neighbouring onsets differ, from what no leak makes of them.
    fn compare(&mut self, observer: &Observer, time_s: f64, interval_s: f64) {
        let of_age = |wanted_s: f64| {
            let away = |onset: &Onset| libm::log((time_s - onset.since_s) / wanted_s).abs();
            let nearest = observer.onsets().min_by(|a, b| away(a).total_cmp(&away(b)));
            nearest.filter(|onset| away(onset) < libm::log(NEAR))
        };
        let compared = COMPARED_S.map(of_age);
        for pair in compared.windows(2) {
            let [Some(young), Some(old)] = pair else { continue };
            let variance = powi(young.sd_kg_s, 2) - powi(old.sd_kg_s, 2);
            let gained_kg_s = old.rate_kg_s - young.rate_kg_s;
            if variance > 0.0 && gained_kg_s > 0.0 {
                self.usual.update(interval_s, powi(gained_kg_s, 2) / variance);
            }
        }
    }

    /// What the rate of an onset of an age, s, may be off by for what the surroundings do now, standard deviation, kg/s.
    pub(crate) fn considered_kg_s(&self, age_s: f64) -> f64 {
        (self.considered_kg * (FADED * self.memory_s / age_s).min(1.0) + self.off_kg) / age_s
    }

    /// What the standard deviations of the rates are larger by than if innovations were independent and nothing else were in doubt.
    pub(crate) fn error_sd(&self) -> f64 {
        self.usual.sd() * self.divisor
    }

    /// The statistics after the last sample; 0 before the first and after an exchange of gas.
    pub(crate) fn statistics(&self) -> Statistics {
        self.statistics
    }

    /// Begin anew, as after an exchange of gas.
    pub(crate) fn forget(&mut self) {
        self.statistics = [0.0; Scale::ALL.len()];
    }
}

#[cfg(test)]
mod tests;
