//! What correlation does to a design for independent samples.
use cylwatch_detector::statistic::{Cusum, Noise, Residual, Statistic, Whitener};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::StandardNormal;

use crate::monte_carlo::{Mean, run_length};

#[test]
fn correlated_samples_shorten_the_run_length_as_published() {
    // One-sided, k = 0.5: h, correlation of neighbours, published run length (simulated there too).
    let table = [
        (5.0, [(0.3, 192.0), (0.5, 104.0), (0.7, 68.0), (0.9, 75.0), (0.99, 225.0)]),
        (8.0, [(0.3, 1078.0), (0.5, 316.0), (0.7, 152.0), (0.9, 112.0), (0.99, 263.0)]),
        (13.62, [(0.3, 19_741.0), (0.5, 2481.0), (0.7, 462.0), (0.9, 197.0), (0.99, 335.0)]),
    ];
    for (h, row) in table {
        for (phi, published) in row {
            let runs = if published > 1e4 { 300 } else { 1000 };
            let found = run_length(|| Cusum::try_new(0.5).unwrap(), h, (0.0, phi), runs, 6);
            // The published value has an error of its own, taken to be as large as this one.
            let apart = (found.mean - published).abs() / (found.error * 2.0_f64.sqrt());
            println!(
                "h {h}, {phi}: {:.0} +- {:.0}, published {published}, {apart:.1}",
                found.mean, found.error
            );
            assert!(apart < 3.5, "h {h}, {phi}: {found:?}, published {published}");
        }
    }
}

/// A cumulative sum of whitened residuals as a statistic of raw ones.
#[derive(Clone)]
struct Whitened {
    whitener: Whitener,
    sum: Cusum,
    n: f64,
}

impl Statistic for Whitened {
    type Sample = f64;

    fn update(&mut self, value: f64) -> f64 {
        self.n += 1.0;
        match self.whitener.whiten(Residual { time_s: self.n, value }) {
            Some(whitened) => self.sum.update(whitened.value),
            None => self.sum.value(),
        }
    }

    fn value(&self) -> f64 {
        self.sum.value()
    }

    fn reset(&mut self) {
        self.whitener.reset();
        self.sum.reset();
    }
}

#[test]
fn whitening_gives_the_run_length_of_independent_samples_back() {
    for phi in [0.3, 0.9, 0.99] {
        let whitened = Whitened {
            whitener: Whitener::try_new(Noise::ar1(1.0, phi, 1.0)).unwrap(),
            sum: Cusum::try_new(0.5).unwrap(),
            n: 0.0,
        };
        let found = run_length(|| whitened.clone(), 5.0, (0.0, phi), 2500, 7);
        assert!(found.agrees(930.9, 0.1), "{phi}: {found:?}");
    }
}

#[test]
fn whitening_gives_it_back_at_uneven_intervals_with_gaps_too() {
    let noise = Noise::ornstein_uhlenbeck(0.3, 10_800.0);
    let mut random = ChaCha8Rng::seed_from_u64(8);
    let lengths: Vec<f64> = (0..2500)
        .map(|_| {
            let mut whitener = Whitener::try_new(noise).unwrap();
            let mut sum = Cusum::try_new(0.5).unwrap();
            let (mut time_s, mut e, mut n) = (0.0, 0.3 * random.sample::<f64, _>(StandardNormal), 1.0);
            while sum.update(whitener.whiten(Residual { time_s, value: e }).unwrap().value) < 5.0 {
                // Seconds to a quarter of an hour, and now and then a day without a sample.
                let gap = random.random::<f64>() < 0.01;
                let interval_s = if gap { 86_400.0 } else { 1.0 + 900.0 * random.random::<f64>() };
                let phi = noise.correlation(interval_s);
                e = phi * e + 0.3 * (1.0 - phi * phi).sqrt() * random.sample::<f64, _>(StandardNormal);
                time_s += interval_s;
                n += 1.0;
            }
            n
        })
        .collect();
    let found = Mean::of(&lengths);
    assert!(found.agrees(930.9, 0.1), "{found:?}");
}
