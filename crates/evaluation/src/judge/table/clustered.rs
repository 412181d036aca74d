//! Counts over time or over rows, with intervals that take simulations as independent, not worlds.
//!
//! Worlds that share a simulation share cylinder and weather: two sets of sensors over one simulation that both alarm are not two
//! observations. With the sums `n_g` and `t_g` of each of `G` simulations and `r = sum n/sum t`:
//!
//! * a rate: `phi = max(1, G/(G-1) sum (n_g - r t_g)^2/sum n)` is how many times more the counts vary than Poisson's; the interval is
//!   Garwood's of `n/phi` in `t/phi`. Without any count the worlds of a simulation are taken as one: `phi` = worlds per simulation. With one
//!   simulation all counts are one.
//! * a share: variance `G/(G-1) sum (n_g - r t_g)^2/t^2`, which `r (1 - r)/n_e` turns into a number of independent trials; the interval is
//!   Wilson's of it. Where the shares of all simulations are equal `n_e = G`.
//!
//! Source: F. Garwood, Biometrika 28 (1936) 437; P. McCullagh and J. A. Nelder, Generalized Linear Models, 1989, chapter 9; W. G. Cochran,
//! Sampling Techniques, 1977, section 6.3.
use cylwatch_thermal::units::YEAR_S;
use serde::{Deserialize, Serialize};
use statrs::distribution::{ChiSquared, ContinuousCDF};

use crate::judge::statement::BAND_95;
use crate::world::SimulationKey;

/// Sums over simulations; what belongs to one simulation must come together.
#[derive(Clone, Debug, Default)]
pub(crate) struct Clustered {
    open: Option<(SimulationKey, f64, f64)>,
    simulations: u64,
    with_any: u64,
    n: f64,
    t: f64,
    nn: f64,
    nt: f64,
    tt: f64,
    additions: u64,
}

impl Clustered {
    /// Add counts and time of a world.
    pub(crate) fn add(&mut self, simulation: SimulationKey, count: f64, time: f64) {
        if self.open.is_some_and(|(open, ..)| open != simulation) {
            self.close();
        }
        self.additions += 1;
        let (_, n, t) = self.open.get_or_insert((simulation, 0.0, 0.0));
        *n += count;
        *t += time;
    }

    fn close(&mut self) {
        let Some((_, n, t)) = self.open.take() else { return };
        self.simulations += 1;
        self.with_any += u64::from(n > 0.0);
        self.n += n;
        self.t += t;
        self.nn += n * n;
        self.nt += n * t;
        self.tt += t * t;
    }

    fn closed(&self) -> Self {
        let mut closed = self.clone();
        closed.close();
        closed
    }

    /// `G/(G-1) sum (n_g - r t_g)^2`; `None` with one simulation.
    fn spread(&self) -> Option<f64> {
        let g = self.simulations as f64;
        let r = self.n / self.t;
        let squares = (self.nn - 2.0 * r * self.nt + r * r * self.tt).max(0.0);
        (g > 1.5).then(|| squares * g / (g - 1.0))
    }

    /// As counts in a time, s; `None` without both. What is said all the time is said infinitely often in the time without it.
    pub(crate) fn rate(&self) -> Option<Rate> {
        let all = self.closed();
        if all.t <= 0.0 && all.n == 0.0 {
            return None;
        }
        let phi = match all.spread() {
            _ if all.n == 0.0 => all.additions as f64 / all.simulations as f64,
            Some(spread) if all.t > 0.0 => (spread / all.n).max(1.0),
            _ => all.n.max(1.0),
        };
        let tens = all.t / (10.0 * YEAR_S);
        Some(Rate {
            count: all.n.round() as u64,
            cylinder_years: all.t / YEAR_S,
            per_ten_years: all.n / tens,
            poisson: garwood(all.n, tens),
            simulations: all.simulations,
            simulations_with: all.with_any,
            by_simulation: garwood(all.n / phi, tens / phi),
        })
    }

    /// As trials that succeeded; `None` without trials.
    pub(crate) fn share(&self) -> Option<Share> {
        let all = self.closed();
        if all.t <= 0.0 {
            return None;
        }
        let share = (all.n / all.t).clamp(0.0, 1.0);
        let variance = all.spread().map(|spread| spread / (all.t * all.t));
        let trials = match variance {
            // Rounding leaves some of nothing.
            Some(variance) if variance > 1e-15 => share * (1.0 - share) / variance,
            _ => all.simulations as f64,
        };
        Some(Share {
            share,
            by_simulation: wilson(share, trials),
            simulations: all.simulations,
            trials: all.t,
        })
    }
}

/// A rate of rare events.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Rate {
    /// How many.
    pub count: u64,
    /// In how many cylinder-years at risk.
    pub cylinder_years: f64,
    /// In ten years.
    pub per_ten_years: f64,
    /// 95 % interval of that, as if worlds were independent.
    pub poisson: (f64, f64),
    /// Independent simulations.
    pub simulations: u64,
    /// Simulations with at least one.
    pub simulations_with: u64,
    /// 95 % interval that takes simulations as independent.
    pub by_simulation: (f64, f64),
}

/// A part of trials.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Share {
    /// The part.
    pub share: f64,
    /// 95 % interval that takes simulations as independent.
    pub by_simulation: (f64, f64),
    /// Independent simulations.
    pub simulations: u64,
    /// Trials, or time of all of them.
    pub trials: f64,
}

/// Garwood's 95 % interval of a rate, for counts that need not be whole.
fn garwood(count: f64, time: f64) -> (f64, f64) {
    let quantile = |freedom: f64, probability: f64| {
        ChiSquared::new(freedom).map_or(f64::NAN, |chi_square| chi_square.inverse_cdf(probability))
    };
    // Below a thousandth of an event the bound is 0 to any digit.
    let low = if count < 1e-3 { 0.0 } else { 0.5 * quantile(2.0 * count, 0.025) / time };
    (low, 0.5 * quantile(2.0 * count + 2.0, 0.975) / time)
}

/// Wilson's 95 % interval, for trials that need not be whole.
fn wilson(share: f64, trials: f64) -> (f64, f64) {
    let (p, n, z) = (share, trials, BAND_95);
    let middle = p + z * z / (2.0 * n);
    let half = z * (p * (1.0 - p) / n + z * z / (4.0 * n * n)).sqrt();
    let all = 1.0 + z * z / n;
    let (low, high) = ((middle - half) / all, (middle + half) / all);
    // What is left of 0 and of 1 by rounding.
    (if low < 1e-12 { 0.0 } else { low }, if high > 1.0 - 1e-12 { 1.0 } else { high })
}

#[cfg(test)]
mod tests {
    use approx::assert_relative_eq;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    use super::*;
    use crate::world::{Family, Request};

    fn key(seed: u64) -> SimulationKey {
        SimulationKey::of(&Request::tight(Family::usual(), seed, 1.0))
    }

    #[test]
    fn intervals_of_counts_are_garwoods_table() {
        // Garwood 1936, limits of the mean for 0, 1, 10 and 20 events.
        for (count, low, high) in
            [(0.0, 0.0, 3.689), (1.0, 0.0253, 5.572), (10.0, 4.795, 18.390), (20.0, 12.217, 30.888)]
        {
            let (found_low, found_high) = garwood(count, 1.0);
            assert!((found_low - low).abs() < 6e-4 && (found_high - high).abs() < 6e-4, "{count}");
        }
    }

    #[test]
    fn wilsons_intervals_are_those_of_the_tables() {
        // Newcombe, Stat. Med. 17 (1998) 857, table I, method 3.
        let published = [
            ((81.0, 263.0), (0.2553, 0.3662)),
            ((15.0, 148.0), (0.0624, 0.1605)),
            ((0.0, 20.0), (0.0, 0.1611)),
            ((1.0, 29.0), (0.0061, 0.1718)),
        ];
        for ((hits, trials), expected) in published {
            let found = wilson(hits / trials, trials);
            assert!((found.0 - expected.0).abs() < 6e-5 && (found.1 - expected.1).abs() < 6e-5, "{found:?}");
        }
    }

    #[test]
    fn worlds_of_one_simulation_count_as_one_where_nothing_happened() {
        let mut clustered = Clustered::default();
        for seed in 0..10 {
            (0..4).for_each(|_| clustered.add(key(seed), 0.0, YEAR_S));
        }
        let rate = clustered.rate().unwrap();
        assert_eq!((rate.count, rate.simulations, rate.simulations_with), (0, 10, 0));
        assert_relative_eq!(rate.poisson.1, 3.689 / 4.0, max_relative = 1e-3);
        assert_relative_eq!(rate.by_simulation.1, 3.689, max_relative = 1e-3);
    }

    #[test]
    fn the_interval_by_simulation_holds_the_rate_where_poissons_does_not() {
        // Every simulation has a rate of its own (exponential about 1), and four worlds that all do the same.
        let (mut held, mut held_poisson) = (0, 0);
        let runs = 400;
        for run in 0..runs {
            let mut random = ChaCha8Rng::seed_from_u64(run);
            let mut clustered = Clustered::default();
            for seed in 0..40 {
                let rate = -(1.0 - random.random::<f64>()).ln();
                let mut waited = -(1.0 - random.random::<f64>()).ln() / rate;
                let mut count = 0.0;
                while waited < 1.0 {
                    count += 1.0;
                    waited -= (1.0 - random.random::<f64>()).ln() / rate;
                }
                (0..4).for_each(|_| clustered.add(key(seed), count, YEAR_S));
            }
            let found = clustered.rate().unwrap();
            held += u32::from((found.by_simulation.0..=found.by_simulation.1).contains(&10.0));
            held_poisson += u32::from((found.poisson.0..=found.poisson.1).contains(&10.0));
        }
        // 95 % of 400 within four standard deviations of the binomial.
        assert!((362..=397).contains(&held), "{held}");
        assert!(held_poisson < 250, "{held_poisson}");
    }

    #[test]
    fn the_interval_of_a_share_holds_it_where_rows_of_a_simulation_hang_together() {
        let (mut held, mut held_rows) = (0, 0);
        for run in 0..400 {
            let mut random = ChaCha8Rng::seed_from_u64(run);
            let mut clustered = Clustered::default();
            let (mut inside, mut rows) = (0.0, 0.0);
            for seed in 0..40 {
                // Each simulation has a share of its own between 0.6 and 1.
                let share = 0.6 + 0.4 * random.random::<f64>();
                let hits = (0..500).filter(|_| random.random::<f64>() < share).count();
                clustered.add(key(seed), hits as f64, 500.0);
                (inside, rows) = (inside + hits as f64, rows + 500.0);
            }
            let found = clustered.share().unwrap();
            held += u32::from((found.by_simulation.0..=found.by_simulation.1).contains(&0.8));
            let (low, high) = wilson(inside / rows, rows);
            held_rows += u32::from((low..=high).contains(&0.8));
        }
        assert!((362..=397).contains(&held), "{held}");
        assert!(held_rows < 200, "{held_rows}");
    }

    #[test]
    fn all_of_all_is_not_certain() {
        let mut clustered = Clustered::default();
        (0..20).for_each(|seed| clustered.add(key(seed), 1000.0, 1000.0));
        let share = clustered.share().unwrap();
        assert_eq!(share.share, 1.0);
        // As none of 20, seen from the other side.
        assert!((share.by_simulation.0 - (1.0 - 0.1611)).abs() < 6e-5);
        assert!(Clustered::default().share().is_none() && Clustered::default().rate().is_none());
    }
}
