//! Innovations of the pressure, by what the surroundings do: size and whiteness.
//!
//! NIS is the mean of `nu^2/S`, 1 where `S` is right. Autocorrelation of `z = nu/sqrt(S)` at a lag of time:
//! `rho = sum z_k z_j / sqrt(sum z_k^2 sum z_j^2)` over pairs that are the lag apart, within a quarter of it; the regime is that of the later
//! one. Rows farther apart than the lag have none.
use std::collections::VecDeque;

use serde::{Deserialize, Serialize};

use crate::judge::statement::Innovation;
use crate::world::Regime;

/// Lags, s.
pub(crate) const LAGS_S: [f64; 2] = [60.0, 600.0];
/// How far two innovations may be from the lag, in parts of it.
const LAG_TOLERANCE: f64 = 0.25;

/// Sums over pairs of one lag.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Pairs {
    /// Sum of products.
    pub products: f64,
    /// Sum of squares of the earlier ones.
    pub before: f64,
    /// Sum of squares of the later ones.
    pub after: f64,
    /// Pairs.
    pub count: u64,
}

/// Sums of one regime.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct RegimeSums {
    /// Innovations.
    pub count: u64,
    /// Sum of `nu^2/S`.
    pub nis: f64,
    /// By lag.
    pub lags: [Pairs; 2],
}

/// Sums by regime, in the order of [`Regime::ALL`].
pub(crate) type Innovations = [RegimeSums; 5];

impl Pairs {
    /// Autocorrelation; `None` without pairs.
    pub(crate) fn correlation(&self) -> Option<f64> {
        let scale = (self.before * self.after).sqrt();
        (self.count > 0 && scale > 0.0).then(|| self.products / scale)
    }

    /// Add other sums.
    pub(crate) fn add(&mut self, other: &Self) {
        self.products += other.products;
        self.before += other.before;
        self.after += other.after;
        self.count += other.count;
    }
}

impl RegimeSums {
    /// Add other sums.
    pub(crate) fn add(&mut self, other: &Self) {
        self.count += other.count;
        self.nis += other.nis;
        self.lags.iter_mut().zip(&other.lags).for_each(|(lag, other)| lag.add(other));
    }

    /// Mean of `nu^2/S`; `None` without innovations.
    pub(crate) fn mean_nis(&self) -> Option<f64> {
        (self.count > 0).then(|| self.nis / self.count as f64)
    }
}

/// The last innovations: time, s, and `z`.
#[derive(Clone, Debug, Default)]
pub(crate) struct Whiteness {
    last: VecDeque<(f64, f64)>,
}

impl Whiteness {
    /// Take an innovation.
    pub(crate) fn take(
        &mut self,
        sums: &mut Innovations,
        time_s: f64,
        regime: Regime,
        innovation: Option<Innovation>,
    ) {
        let Some(Innovation { nu, s }) = innovation else { return };
        let z = nu / s.sqrt();
        let later = self.last.back().is_none_or(|(last_s, _)| time_s > *last_s);
        if !(z.is_finite() && later) {
            return;
        }
        let sums = &mut sums[regime as usize];
        sums.count += 1;
        sums.nis += z * z;
        for (lag_s, pairs) in LAGS_S.into_iter().zip(&mut sums.lags) {
            let Some(before) = self.nearest(time_s - lag_s, LAG_TOLERANCE * lag_s) else { continue };
            pairs.products += before * z;
            pairs.before += before * before;
            pairs.after += z * z;
            pairs.count += 1;
        }
        self.last.push_back((time_s, z));
        let oldest_s = time_s - (1.0 + LAG_TOLERANCE) * LAGS_S[1];
        while self.last.front().is_some_and(|(at_s, _)| *at_s < oldest_s) {
            self.last.pop_front();
        }
    }

    /// `z` of the innovation nearest to a time, if it is near enough.
    fn nearest(&self, wanted_s: f64, within_s: f64) -> Option<f64> {
        let next = self.last.partition_point(|(at_s, _)| *at_s < wanted_s);
        let candidates = [next.checked_sub(1), Some(next)].into_iter().flatten();
        candidates
            .filter_map(|index| self.last.get(index))
            .map(|(at_s, z)| ((at_s - wanted_s).abs(), *z))
            .filter(|(apart_s, _)| *apart_s <= within_s)
            .min_by(|a, b| a.0.total_cmp(&b.0))
            .map(|(_, z)| z)
    }
}
