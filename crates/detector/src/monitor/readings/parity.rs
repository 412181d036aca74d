//! Whether one end of the cylinder is warmed or cooled by itself, so that the thermometers do not stand for the gas.
//!
//! Sensors sit at the top. Something warm beside the bottom, a hall with warm air under the roof, sun: the mean of the wall is then not
//! what the shoulder says, the gas is some kelvin off, and pressure and mass with it, with no leak. It shows in the difference of the
//! two thermometers. In calm windows of ten minutes (neither moves by more than `5 e`) it stays within 0.1 to 0.2 K for weeks, tunnels
//! and all; with the air by 10 K warmer or colder at one end it is 0.5 to 3 K off within an hour or two. `e` is what the model misses of a temperature on the surface
//! ([`ModelError::surface_k`](crate::estimator::observer::ModelError), 0.12 K), or a thermometer's noise where that is more.
//!
//! `d` is the median of the last three calm windows less that of the two days before. What comes with every day is usual, as a morning's sun on one end in a
//! desert: with the deviation `s`, less `1.25 e`, that was exceeded for half an hour a day in the two days until yesterday, all limits below are those of `u = |d| - s`. The gas
//! may then be off by `g = 2 sqrt(u^2 - (2.5 e)^2)`: of 1 K at one end a well mixed gas takes a part, and one in layers hides as much again. What that is of the mass is considered
//! in the evidence for a leak, in the mass and in the gas temperature; it fades within six hours after it, as the observer needs its time to come back, within a day where nobody sees whether it
//! is over. Where `d` was above `5 e` for three hours, the evidence from then
//! counts for nothing once it is over.
//!
//! Which of the two is off the pressure says: with `T_p` the temperature at which the stated mass has this pressure,
//! `a_i = T_i - T_p` less its usual value, or less that of an hour before, is `d` for the one that is off and nothing for the other.
//! Sun, day and night, and a leak move both `a` alike (by 1 K from night to noon, as the thermometers sit outside), so it is named where
//! `|d| > 5 e`, its own `|a| > 0.4 |d|` and the other `|a| < 0.4 |d|` in three windows running. One end that is warmed by itself may look the same for hours.
//! What stays within `2.5 e` of itself for sixteen hours of the same one is an offset of that thermometer. A difference that nobody
//! could be named for is the usual one after a day: either may have shifted.
use alloc::collections::VecDeque;
use cylwatch_estimator::thermal::real::powi;

use serde::{Deserialize, Serialize};

use super::of_its_own;
use crate::DetectorError;
use crate::monitor::median::{median, quantile};
use crate::monitor::restored;
use crate::units::{DAY_S, HOUR_S};
use calm::Calm;

mod calm;

/// Length of a window, s, and its fewest rows.
const WINDOW_S: f64 = 600.0;
const FEWEST_ROWS: u32 = 2;
/// Difference that is usual, in errors of a surface temperature, and twice that: what may change within a window that is calm, and the difference from which a thermometer is off.
const HARMLESS: f64 = 2.5;
const OFF: f64 = 2.0 * HARMLESS;
/// Error of the gas temperature as a part of the difference beyond the usual one.
const PART: f64 = 2.0;
/// Time over which the usual difference is taken, s, and fewest windows.
const USUAL_S: f64 = 2.0 * DAY_S;
/// Windows that are kept at most, and one more.
const WINDOWS: usize = ((USUAL_S + DAY_S) / WINDOW_S) as usize + 2;
const FEWEST_USUAL: usize = 36;
/// Windows whose median is the present difference, and that agree on what is off; time without one after which nothing is known of it, and for which it is off until what was seen
/// counts for nothing, s.
const LATEST: usize = 3;
const STALE_S: f64 = 3.0 * HOUR_S;
/// Part of the windows of other days, those of yesterday and before, that deviates less than what is usual on some of them.
const OTHER_DAYS: f64 = 0.98;
/// Time constant with which it comes back, s.
const BACK_S: f64 = 6.0 * HOUR_S;
/// Part of the difference that the one that is off has left what the pressure stands for by, at least, and the other one at most.
const NAMED: f64 = 0.4;
/// Windows before the last ones in which a leak makes little of it.
const LATELY: usize = 6;
/// Time for which the same one is named until it is an offset, s.
const LASTING_S: f64 = 16.0 * HOUR_S;

/// What changed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::monitor) enum Disturbance {
    /// For an hour the difference has been off, now by so much, K, that small leaks are not seen.
    Begun(f64),
    /// It is over, and what was seen meanwhile counts for nothing. The difference that is usual now is by so much another one, K.
    Over(f64),
    /// It was an offset of the thermometer of this index, by so much, K.
    Shifted(usize, f64),
}

/// A thermometer that is off while the other one agrees with the pressure.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct Named {
    which: usize,
    since_s: f64,
    windows: u32,
    /// Mean of the difference since, K.
    mean_k: f64,
    /// Whether the difference has stayed what it was.
    steady: bool,
}

/// Watches the difference of two thermometers.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(in crate::monitor) struct Parity {
    /// What the model misses of a temperature on the surface, K.
    error_k: f64,
    window: Option<Window>,
    #[serde(with = "calm")]
    calm: VecDeque<Calm>,
    /// Present difference less the usual one, K; `None` where either is not known.
    off_k: Option<f64>,
    /// How far the difference deviated from its median on other days, K, beyond the harmless.
    spread_k: f64,
    named: Option<Named>,
    /// Usual difference before it was off, K.
    usual_k: f64,
    /// What the gas may be off by, K.
    doubt_k: f64,
    last_s: f64,
    disturbed_s: f64,
    told: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct Window {
    begun_s: f64,
    lowest: [f64; 2],
    highest: [f64; 2],
    sum_k: [f64; 2],
    sum_pa: f64,
    rows: u32,
}

impl Window {
    fn new(begun_s: f64) -> Self {
        let infinity = [f64::INFINITY; 2];
        Self {
            begun_s,
            lowest: infinity,
            highest: infinity.map(|high| -high),
            sum_k: [0.0; 2],
            sum_pa: 0.0,
            rows: 0,
        }
    }

    fn push(&mut self, readings: [f64; 2], pressure_pa: f64) {
        self.lowest = [0, 1].map(|i| self.lowest[i].min(readings[i]));
        self.highest = [0, 1].map(|i| self.highest[i].max(readings[i]));
        self.sum_k = [0, 1].map(|i| self.sum_k[i] + readings[i]);
        self.sum_pa += pressure_pa;
        self.rows += 1;
    }

    /// Means, if it was calm: neither moved by more than so much, K. `gas_k` gives the temperature that a pressure, Pa, stands for near one, K.
    fn close(&self, most_k: f64, gas_k: impl Fn(f64, f64) -> f64) -> Option<Calm> {
        let calm = (0..2).all(|i| self.highest[i] - self.lowest[i] < most_k);
        if !calm || self.rows < FEWEST_ROWS {
            return None;
        }
        let mean_k = self.sum_k.map(|sum_k| sum_k / f64::from(self.rows));
        let gas_k = gas_k(self.sum_pa / f64::from(self.rows), 0.5 * (mean_k[0] + mean_k[1]));
        Some(Calm::new(self.begun_s, self.rows, self.sum_k, gas_k))
    }
}

impl Parity {
    /// Checks one that was saved.
    pub(crate) fn validate(&self) -> Result<(), DetectorError> {
        if let Some(Named { which, windows, .. }) = self.named {
            restored::one_of_two("parity.named", which)?;
            restored::count("parity.named.windows", windows.into())?;
        }
        restored::count("parity.window.rows", self.window.map_or(0, |window| window.rows.into()))?;
        restored::require(
            self.calm.len() <= WINDOWS,
            "parity.calm",
            self.calm.len() as f64,
            "those of three days",
        )
    }

    /// Of thermometers where the model misses so much of a temperature on the surface, K.
    pub(crate) fn new(error_k: f64) -> Self {
        Self { error_k, ..Self::default() }
    }

    /// Memory for all windows that are kept.
    pub(crate) fn make_room(&mut self) {
        self.calm.reserve(WINDOWS.saturating_sub(self.calm.len()));
    }

    fn harmless_k(&self) -> f64 {
        HARMLESS * self.error_k
    }

    /// Take in both thermometers, K, and the pressure, Pa; those that are none count for nothing. `gas_k` gives the temperature that a pressure,
    /// Pa, stands for near one, K.
    pub(crate) fn push(
        &mut self,
        time_s: f64,
        readings: [f64; 2],
        pressure_pa: f64,
        gas_k: impl Fn(f64, f64) -> f64,
    ) -> Option<Disturbance> {
        let elapsed_s = (time_s - self.last_s).max(0.0);
        self.last_s = time_s;
        let window = self.window.get_or_insert(Window::new(time_s));
        let completed = if time_s - window.begun_s >= WINDOW_S {
            core::mem::replace(window, Window::new(time_s)).close(OFF * self.error_k, gas_k)
        } else {
            None
        };
        if readings.iter().all(|reading| reading.is_finite()) {
            window.push(readings, pressure_pa);
        }
        if let Some(calm) = completed {
            self.compare(calm);
        }
        if self.calm.back().is_some_and(|calm| time_s - calm.begun_s() > STALE_S) {
            (self.off_k, self.named) = (None, None);
        }
        let now_k = PART * libm::sqrt((powi(self.unusual_k(), 2) - powi(self.harmless_k(), 2)).max(0.0));
        let memory_s = if self.off_k.is_some() { BACK_S } else { DAY_S };
        self.doubt_k = now_k.max(self.doubt_k * libm::exp(-elapsed_s / memory_s));
        self.tell(elapsed_s)
    }

    /// What has changed with a row so long after the last one, s.
    fn tell(&mut self, elapsed_s: f64) -> Option<Disturbance> {
        if self.unusual_k() > OFF * self.error_k {
            self.disturbed_s += elapsed_s;
        }
        if let Some(named) =
            self.named.filter(|named| named.steady && self.last_s - named.since_s > LASTING_S)
        {
            return Some(Disturbance::Shifted(named.which, of_its_own(named.which, named.mean_k)));
        }
        if self.disturbed_s > HOUR_S && !self.told {
            self.told = true;
            return Some(Disturbance::Begun(self.off_k()));
        }
        if self.unusual_k() >= self.harmless_k() {
            return None;
        }
        let forgotten = core::mem::take(&mut self.disturbed_s) > STALE_S;
        self.told = false;
        forgotten.then(|| Disturbance::Over(self.latest_k(|calm| calm.apart_k()) - self.usual_k))
    }

    fn compare(&mut self, calm: Calm) {
        self.calm.push_back(calm);
        let older = |than_s: f64| move |of: &Calm| of.begun_s() < calm.begun_s() - than_s;
        while self.calm.front().is_some_and(older(USUAL_S + DAY_S)) {
            self.calm.pop_front();
        }
        let usual = self.calm.len() - self.calm.partition_point(older(USUAL_S));
        if usual < FEWEST_USUAL + LATEST {
            // What was found against other days is no finding of these.
            (self.off_k, self.named) = (None, None);
            return;
        }
        let before = self.calm.iter().rev().take(usual).skip(LATEST);
        let usual_k = median(before.map(|calm| calm.apart_k()));
        let yesterday = self.calm.partition_point(older(DAY_S));
        let other_days = self.calm.range(..yesterday).map(|calm| (calm.apart_k() - usual_k).abs());
        self.off_k = Some(self.latest_k(|calm| calm.apart_k()) - usual_k);
        self.spread_k = (quantile(OTHER_DAYS, other_days) - self.harmless_k() / 2.0).max(0.0);
        if self.disturbed_s == 0.0 {
            self.usual_k = usual_k;
        }
        self.name(calm.begun_s());
    }

    fn name(&mut self, time_s: f64) {
        if self.unusual_k() < self.harmless_k() {
            self.named = None;
            return;
        }
        let off = [usize::MAX, LATELY].map(|against| self.which_is_off(against));
        let is_off = |which: usize| off.contains(&Some(which));
        self.named = match self.named {
            // Once it is named, what the night makes of it names nobody else.
            Some(named) if is_off(named.which) || named.windows as usize >= LATEST => {
                Some(named.goes_on(self.off_k(), self.harmless_k()))
            }
            _ if self.unusual_k() < OFF * self.error_k => None,
            _ => off[0].or(off[1]).map(|which| Named::new(which, time_s, self.off_k())),
        };
    }

    /// Which one has left what the pressure stands for, against so many windows before, while the other one has not.
    fn which_is_off(&self, against: usize) -> Option<usize> {
        let above_k = [0, 1].map(|i| self.change_k(against, |calm| calm.above_k()[i]));
        let which = usize::from(above_k[1].abs() > above_k[0].abs());
        // Not so without a pressure.
        let agrees = above_k[1 - which].abs() < NAMED * self.off_k().abs();
        (agrees && above_k[which].abs() > NAMED * self.off_k().abs()).then_some(which)
    }

    /// Median over the last windows less that over so many before them.
    fn change_k(&self, against: usize, of: impl Fn(&Calm) -> f64 + Copy) -> f64 {
        self.latest_k(of) - median(self.calm.iter().rev().skip(LATEST).take(against).map(of))
    }

    /// Median over the last windows.
    fn latest_k(&self, of: impl Fn(&Calm) -> f64 + Copy) -> f64 {
        median(self.calm.iter().rev().take(LATEST).map(of))
    }

    /// A thermometer that is off while the other one agrees with the pressure, and by how much, K.
    pub(crate) fn deviating(&self) -> Option<(usize, f64)> {
        let named = self.named.filter(|named| named.windows as usize >= LATEST)?;
        Some((named.which, of_its_own(named.which, self.off_k())))
    }

    /// How far the present difference is from the usual one beyond the usual deviations, K.
    fn unusual_k(&self) -> f64 {
        (self.off_k().abs() - self.spread_k).max(0.0)
    }

    fn off_k(&self) -> f64 {
        self.off_k.unwrap_or_default()
    }

    /// Whether the difference is the usual one, and has been for a while.
    pub(crate) fn is_usual(&self) -> bool {
        self.unusual_k() < self.harmless_k() && self.doubt_k < OFF * self.error_k
    }

    /// What the mean gas temperature may be off by, as one end is warmed or cooled by itself, K.
    pub(crate) fn doubt_k(&self) -> f64 {
        self.doubt_k
    }

    /// Another offset of a thermometer is taken off from now on: the difference is learnt anew.
    pub(crate) fn forget(&mut self) {
        let Self { doubt_k, last_s, .. } = *self;
        self.begin_anew();
        (self.doubt_k, self.last_s) = (doubt_k, last_s);
    }

    /// Nothing has been seen yet.
    pub(crate) fn begin_anew(&mut self) {
        let mut calm = core::mem::take(&mut self.calm);
        calm.clear();
        *self = Self { error_k: self.error_k, calm, ..Self::default() };
    }
}

impl Named {
    /// Named for the first time, with the difference then, K.
    fn new(which: usize, since_s: f64, mean_k: f64) -> Self {
        Self { which, since_s, windows: 1, mean_k, steady: true }
    }

    /// After a further window, with the difference in it, K, which is steady within so much, K.
    fn goes_on(self, off_k: f64, within_k: f64) -> Self {
        let windows = self.windows + 1;
        let mean_k = self.mean_k + (off_k - self.mean_k) / f64::from(windows);
        Self { windows, mean_k, steady: self.steady && (off_k - mean_k).abs() < within_k, ..self }
    }
}

#[cfg(test)]
mod tests;
