//! Distribution of a time that some runs ended before: Kaplan and Meier's, with Greenwood's interval.
//!
//! Of `n_i` that are still watched at the time `t_i`, `d_i` are found then: `S(t) = prod_{t_i <= t} (1 - d_i/n_i)` are left. The variance of
//! `ln S` is `sum d_i/[n_i (n_i - d_i)]`; the interval of `S` is taken on `ln(-ln S)`, so that it stays between 0 and 1. A quantile is the first
//! time at which no more than its complement is left, and its interval the times at which the bounds of `S` reach it.
//!
//! Assumes that a run ends for reasons of its own, not because an alarm is near.
//!
//! Source: E. L. Kaplan and P. Meier, J. Am. Stat. Assoc. 53 (1958) 457; M. Greenwood (1926); R. Brookmeyer and J. Crowley,
//! Biometrics 38 (1982) 29.
use serde::{Deserialize, Serialize};

use super::normal_quantile;

/// A time to an event, or how long none came.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) enum Observed {
    /// The event came after so many s.
    After(f64),
    /// It had not come after so many s, and nobody knows what came then.
    NotUntil(f64),
}

/// What is left against time: a staircase.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Survival {
    /// Times of events, increasing.
    steps: Vec<Step>,
}

/// The staircase from one event on.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct Step {
    time_s: f64,
    left: f64,
    /// Variance of `ln left`, as the sum of Greenwood.
    variance: f64,
}

impl Survival {
    /// From observations in any order.
    pub(crate) fn of(observations: &[Observed]) -> Self {
        let mut events: Vec<f64> = Vec::new();
        let mut ends: Vec<f64> = Vec::new();
        for observed in observations {
            match *observed {
                Observed::After(time_s) => events.push(time_s),
                Observed::NotUntil(time_s) => ends.push(time_s),
            }
        }
        events.sort_by(f64::total_cmp);
        let mut survival = Self::default();
        let (mut left, mut variance, mut gone) = (1.0, 0.0, 0);
        for same in events.chunk_by(|a, b| a == b) {
            let time_s = same[0];
            let ended = ends.iter().filter(|end_s| **end_s < time_s).count();
            let watched = (observations.len() - gone - ended) as f64;
            let found = same.len() as f64;
            left *= 1.0 - found / watched;
            variance += found / (watched * (watched - found));
            gone += same.len();
            survival.steps.push(Step { time_s, left, variance });
        }
        survival
    }

    /// Time, s, by which the event has come in the part `probability`; `None` if it was not seen to.
    pub(crate) fn quantile_s(&self, probability: f64) -> Option<f64> {
        // Products of fractions are exact to rounding only: 1/2 must count as reached.
        let reached = |step: &&Step| step.left <= (1.0 - probability) * (1.0 + 1e-12);
        self.steps.iter().find(reached).map(|step| step.time_s)
    }

    /// Interval of a quantile, s, at a level such as 0.95; `None` where a bound of the staircase does not come so far.
    pub(crate) fn quantile_interval_s(&self, probability: f64, level: f64) -> (Option<f64>, Option<f64>) {
        let (z, left) = (normal_quantile(level), 1.0 - probability);
        let first = |bound: &dyn Fn(&Step) -> f64| {
            self.steps.iter().find(|step| bound(step) <= left).map(|step| step.time_s)
        };
        (first(&|step| step.bound(z)), first(&|step| step.bound(-z)))
    }
}

impl Step {
    /// Bound of what is left, `z` standard deviations of `ln(-ln S)` below (above for negative `z`); nothing left has no
    /// interval.
    fn bound(&self, z: f64) -> f64 {
        if self.left <= 0.0 {
            return 0.0;
        }
        let log = self.left.ln();
        self.left.powf((z * self.variance.sqrt() / log.abs()).exp())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::{assert_abs_diff_eq, assert_relative_eq};

    /// Weeks of remission under 6-mercaptopurine.
    fn remissions() -> Survival {
        let relapsed = [6.0, 6.0, 6.0, 7.0, 10.0, 13.0, 16.0, 22.0, 23.0].map(Observed::After);
        let watched = [6.0, 9.0, 10.0, 11.0, 17.0, 19.0, 20.0, 25.0, 32.0, 32.0, 34.0, 35.0];
        let all = relapsed.into_iter().chain(watched.map(Observed::NotUntil));
        Survival::of(&all.collect::<Vec<_>>())
    }

    /// The step that holds at `time_s`, if one has come.
    fn step_at(survival: &Survival, time_s: f64) -> Option<Step> {
        let reached = survival.steps.partition_point(|step| step.time_s <= time_s);
        reached.checked_sub(1).map(|index| survival.steps[index])
    }

    /// Part of which the event has not come by `time_s`.
    fn left_at(survival: &Survival, time_s: f64) -> f64 {
        step_at(survival, time_s).map_or(1.0, |step| step.left)
    }

    /// Its standard deviation.
    fn left_sd(survival: &Survival, time_s: f64) -> f64 {
        step_at(survival, time_s).map_or(0.0, |step| step.left * step.variance.sqrt())
    }

    #[test]
    fn remissions_are_as_published() {
        // E. J. Freireich et al., Blood 21 (1963) 699; S and its standard error in D. R. Cox and D. Oakes, Analysis of Survival
        // Data, 1984, and every textbook since.
        let published = [
            (6.0, 0.8571, 0.0764),
            (7.0, 0.8067, 0.0869),
            (10.0, 0.7529, 0.0963),
            (13.0, 0.6902, 0.1068),
            (16.0, 0.6275, 0.1141),
            (22.0, 0.5378, 0.1282),
            (23.0, 0.4482, 0.1346),
        ];
        let survival = remissions();
        for (weeks, left, sd) in published {
            assert_abs_diff_eq!(left_at(&survival, weeks), left, epsilon = 6e-5);
            assert_abs_diff_eq!(left_sd(&survival, weeks), sd, epsilon = 6e-5);
        }
        assert_eq!((left_at(&survival, 5.9), left_at(&survival, 100.0)), (1.0, left_at(&survival, 23.0)));
        assert_eq!(survival.quantile_s(0.5), Some(23.0));
        assert_eq!(survival.quantile_s(0.75), None);
        // By hand: the lower bound of S is 0.503 after 10 weeks and 0.432 after 13; the upper one never falls to a half.
        assert_eq!(survival.quantile_interval_s(0.5, 0.95), (Some(13.0), None));
    }

    #[test]
    fn without_runs_that_end_early_quantiles_are_order_statistics() {
        let times: Vec<Observed> = [5.0, 1.0, 4.0, 2.0, 3.0].map(Observed::After).to_vec();
        let survival = Survival::of(&times);
        assert_relative_eq!(left_at(&survival, 3.5), 0.4, max_relative = 1e-12);
        assert_eq!([0.2, 0.5, 0.95].map(|q| survival.quantile_s(q)), [Some(1.0), Some(3.0), Some(5.0)]);
        assert_eq!(Survival::of(&[]).quantile_s(0.5), None);
    }
}
