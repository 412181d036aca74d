//! The likelihood ratio against a dense computation over all onsets, its standard errors against many seeds.
use approx::assert_relative_eq;
use nalgebra::{DMatrix, DVector};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::StandardNormal;

use super::*;

const HOUR_S: f64 = 3600.0;

/// Ornstein-Uhlenbeck residuals at the given times, drawn through the dense covariance.
struct World {
    time_s: Vec<f64>,
    covariance: DMatrix<f64>,
}

impl World {
    fn new(time_s: Vec<f64>, noise: Noise) -> Self {
        let n = time_s.len();
        let covariance = DMatrix::from_fn(n, n, |i, j| {
            let apart_s: f64 = time_s[i] - time_s[j];
            let white = f64::from(u8::from(i == j));
            let tau = noise.correlation_time_s;
            noise.sd.powi(2) * if tau > 0.0 { (-apart_s.abs() / tau).exp() } else { white }
        });
        Self { time_s, covariance }
    }

    fn uneven(n: usize, noise: Noise, random: &mut ChaCha8Rng) -> Self {
        let mut time_s = 0.0;
        let times = (0..n).map(|_| {
            time_s += HOUR_S * (0.1 + 2.0 * random.random::<f64>());
            time_s
        });
        Self::new(times.collect(), noise)
    }

    fn draw(&self, random: &mut ChaCha8Rng) -> DVector<f64> {
        let normal = DVector::from_fn(self.time_s.len(), |_, _| random.sample::<f64, _>(StandardNormal));
        self.covariance.clone().cholesky().unwrap().l() * normal
    }

    fn signal(&self, shape: Shape, onset_s: f64) -> DVector<f64> {
        DVector::from_iterator(
            self.time_s.len(),
            self.time_s.iter().map(|t| match shape {
                Shape::Step => f64::from(u8::from(*t >= onset_s)),
                Shape::Ramp => (t - onset_s).max(0.0),
            }),
        )
    }

    /// Onset, size and log-likelihood ratio of the best onset among the sample times, by generalised least squares.
    fn brute_force(&self, shape: Shape, e: &DVector<f64>) -> (f64, f64, f64) {
        let factor = self.covariance.clone().cholesky().unwrap();
        let weighted = factor.solve(e);
        let onsets = match shape {
            Shape::Step => &self.time_s[..],
            Shape::Ramp => &self.time_s[..self.time_s.len() - 1],
        };
        onsets
            .iter()
            .map(|onset_s| {
                let s = self.signal(shape, *onset_s);
                let (a, b) = (s.dot(&factor.solve(&s)), s.dot(&weighted));
                (*onset_s, b / a, 0.5 * b * b / a)
            })
            .max_by(|left, right| left.2.total_cmp(&right.2))
            .unwrap()
    }
}

fn run(settings: GlrSettings, time_s: &[f64], values: &[f64]) -> Glr {
    let mut glr = Glr::try_new(settings).unwrap();
    for (time_s, value) in time_s.iter().zip(values) {
        glr.update(Residual { time_s: *time_s, value: *value });
    }
    glr
}

#[test]
fn with_all_onsets_kept_it_is_the_dense_likelihood_ratio_over_all_onsets() {
    let mut random = ChaCha8Rng::seed_from_u64(1);
    for noise in [Noise::white(0.3), Noise::ornstein_uhlenbeck(0.3, 3.0 * HOUR_S)] {
        for (shape, size) in [(Shape::Step, -0.5), (Shape::Ramp, 0.08 / HOUR_S)] {
            let world = World::uneven(70, noise, &mut random);
            let e = world.draw(&mut random) + world.signal(shape, world.time_s[40]) * size;
            let (onset_s, size, ratio) = world.brute_force(shape, &e);
            let settings = GlrSettings { per_octave: 100, ..GlrSettings::new(shape, noise) };
            let glr = run(settings, &world.time_s, e.as_slice());
            let finding = glr.finding().unwrap();
            assert_relative_eq!(finding.log_likelihood_ratio, ratio, max_relative = 1e-9);
            assert_relative_eq!(finding.size, size, max_relative = 1e-9);
            assert_eq!(finding.onset_s, onset_s);
            assert_eq!(glr.value(), finding.log_likelihood_ratio);
        }
    }
}

/// A hypothesis that only knows when it began; what survives is left to chance.
struct Chance {
    onset: usize,
    evidence: f64,
}

impl OnsetHypothesis for Chance {
    fn evidence(&self) -> f64 {
        self.evidence
    }
}

#[test]
fn no_onset_is_farther_from_the_thinned_grid_than_the_stated_share_of_its_age() {
    let mut random = ChaCha8Rng::seed_from_u64(5);
    for per_octave in [2, 4, 8, 16] {
        let mut grid = OnsetGrid::new(1000, per_octave);
        let mut worst = 0.0_f64;
        for n in 0..3000 {
            grid.push(Chance { onset: n, evidence: random.random() }, drop);
            let onsets: Vec<usize> = grid.iter().map(|hypothesis| hypothesis.onset).collect();
            for pair in onsets.windows(2) {
                // The onset that is worst off lies in the middle of the gap.
                let (apart, age) = ((pair[1] - pair[0]) as f64, (n + 1 - pair[0]) as f64);
                let nearest = ((apart / 2.0).floor() / (age - (apart / 2.0).floor())).max(0.0);
                worst = worst.max(nearest);
            }
        }
        println!("{per_octave} per octave: an onset is missed by {worst:.3} of its age at worst");
        assert!(worst <= 2.0 / per_octave as f64, "{worst} with {per_octave} per octave");
    }
}

#[test]
fn an_onset_wrong_by_a_share_of_the_age_loses_what_the_grid_says_it_loses() {
    let n = 20_000_i32;
    // Expected log-likelihood ratio of the signal at onset 0 for a hypothesis at `late`, against that at onset 0.
    let kept = |shape: Shape, late: i32| {
        let value = |since: i32| if shape == Shape::Step { 1.0 } else { f64::from(since) };
        let (mut own, mut cross, mut other) = (0.0, 0.0, 0.0);
        for t in 0..n {
            let (s, h) = (value(t), if t >= late { value(t - late) } else { 0.0 });
            own += s * s;
            cross += s * h;
            other += h * h;
        }
        cross * cross / (own * other)
    };
    for eps in [0.05, 0.1, 0.2] {
        let late = (eps / (1.0 + eps) * f64::from(n)) as i32;
        assert_relative_eq!(kept(Shape::Step, late), 1.0 / (1.0 + eps), max_relative = 1e-3);
        let loss = 1.0 - kept(Shape::Ramp, late);
        assert!((0.6..1.0).contains(&(loss / (0.75 * eps * eps))), "ramp: {loss} at {eps}");
    }
}

#[test]
fn on_noisy_residuals_the_thinned_grid_loses_little_of_the_maximum_over_all_onsets() {
    let mut random = ChaCha8Rng::seed_from_u64(2);
    for noise in [Noise::white(1.0), Noise::ornstein_uhlenbeck(1.0, 3.0)] {
        for (shape, size) in [(Shape::Step, 1.0), (Shape::Ramp, 0.03)] {
            let (mut thinned, mut full) = (0.0, 0.0);
            for _ in 0..40 {
                let mut e = 0.0;
                let time_s: Vec<f64> = (0..500).map(f64::from).collect();
                let values: Vec<f64> = (0..500)
                    .map(|n| {
                        let phi = noise.correlation(1.0);
                        e = phi * e + (1.0 - phi * phi).sqrt() * random.sample::<f64, _>(StandardNormal);
                        let since = f64::from(n) - 400.0;
                        e + if since < 0.0 {
                            0.0
                        } else if shape == Shape::Step {
                            size
                        } else {
                            size * since
                        }
                    })
                    .collect();
                let settings = GlrSettings::new(shape, noise);
                thinned += run(settings, &time_s, &values).value();
                full += run(GlrSettings { per_octave: 600, ..settings }, &time_s, &values).value();
            }
            let loss = 1.0 - thinned / full;
            println!("{shape:?}, {noise:?}: loss {loss:.4}");
            assert!((0.0..0.03).contains(&loss), "{shape:?} in {noise:?}: {loss}");
        }
    }
}

#[test]
fn standard_errors_of_rate_and_onset_are_those_over_many_seeds() {
    let noise = Noise::ornstein_uhlenbeck(0.3, 3.0 * HOUR_S);
    let (rate, onset_s) = (0.05 / HOUR_S, 100.3 * HOUR_S);
    let time_s: Vec<f64> = (0..160).map(|n| f64::from(n) * HOUR_S).collect();
    let world = World::new(time_s, noise);
    let mut random = ChaCha8Rng::seed_from_u64(3);
    let settings = GlrSettings { side: Side::Above, ..GlrSettings::new(Shape::Ramp, noise) };
    let (mut rates, mut onsets, mut covered) = (0.0, 0.0, 0);
    let seeds = 400;
    for _ in 0..seeds {
        let e = world.draw(&mut random) + world.signal(Shape::Ramp, onset_s) * rate;
        let glr = run(settings, &world.time_s, e.as_slice());
        let finding = glr.finding().unwrap();
        let refined = finding.refined.unwrap();
        rates += ((refined.size - rate) / refined.size_sd).powi(2);
        onsets += ((refined.onset_s - onset_s) / refined.onset_sd_s).powi(2);
        let (oldest, newest) = glr.onsets_within(1.92).unwrap();
        covered += i32::from((oldest..=newest).contains(&onset_s));
    }
    let (rates, onsets) = (rates / f64::from(seeds), onsets / f64::from(seeds));
    println!("variances in units of the stated ones: rate {rates:.3}, onset {onsets:.3}; covered {covered}");
    assert!((0.8..1.25).contains(&rates), "{rates}");
    assert!((0.8..1.3).contains(&onsets), "{onsets}");
    assert!((370..=400).contains(&covered), "{covered} of {seeds}");
}

#[test]
fn one_sample_of_a_ramp_determines_size_and_onset_together_only() {
    let settings = GlrSettings::new(Shape::Ramp, Noise::white(1.0));
    let finding = run(settings, &[0.0, 10.0], &[0.0, 5.0]).finding().unwrap();
    assert_relative_eq!(finding.size, 0.5);
    assert_eq!(finding.refined, None);
}

#[test]
fn a_restored_state_goes_on_bit_for_bit() {
    let noise = Noise::ornstein_uhlenbeck(1.0, 5.0);
    let mut random = ChaCha8Rng::seed_from_u64(4);
    let mut glr = Glr::try_new(GlrSettings::new(Shape::Ramp, noise)).unwrap();
    let mut restored = glr.clone();
    for n in 0..300 {
        let sample = Residual { time_s: f64::from(n), value: random.sample(StandardNormal) };
        restored = serde_json::from_str(&serde_json::to_string(&restored).unwrap()).unwrap();
        assert_eq!(glr.update(sample), restored.update(sample));
    }
    assert_eq!(glr, restored);
}

#[test]
fn memory_stays_bounded_and_the_window_is_kept() {
    let settings = GlrSettings { window: 1000, ..GlrSettings::new(Shape::Step, Noise::white(1.0)) };
    let mut glr = Glr::try_new(settings).unwrap();
    let mut most = 0;
    for n in 0..20_000_u32 {
        glr.update(Residual { time_s: f64::from(n), value: f64::from(n % 7) - 3.0 });
        most = most.max(glr.hypotheses());
    }
    let oldest = glr.onsets.iter().next().unwrap().onset_s;
    assert!(most <= 8 * 9, "{most}");
    assert!((1000.0..4000.0).contains(&(19_999.0 - oldest)), "{oldest}");
}

#[test]
fn samples_that_are_none_change_nothing_and_settings_out_of_bounds_are_refused() {
    let settings = GlrSettings::new(Shape::Step, Noise::white(1.0));
    let mut glr = run(settings, &[0.0, 1.0], &[1.0, 2.0]);
    let before = glr.clone();
    for (time_s, value) in [(2.0, f64::NAN), (1.0, 9.0), (f64::INFINITY, 9.0)] {
        glr.update(Residual { time_s, value });
        assert_eq!(glr, before);
    }
    for wrong in [
        GlrSettings { window: 0, ..settings },
        GlrSettings { per_octave: 1, ..settings },
        GlrSettings { noise: Noise::white(0.0), ..settings },
        GlrSettings { noise: Noise::ornstein_uhlenbeck(1.0, -1.0), ..settings },
    ] {
        assert!(Glr::try_new(wrong).is_err(), "{wrong:?}");
    }
}
