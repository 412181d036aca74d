//! The likelihood ratio against a dense least-squares solution of the same linear system, which knows no filter.
use approx::assert_relative_eq;
use nalgebra::{DMatrix, DVector};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::StandardNormal;

use super::*;

const N: usize = 4;
const DT_S: f64 = 60.0;

/// Two exchanging bodies, a mass, and a constant offset; a temperature and a pressure-like sum are read.
struct System {
    phi: DMatrix<f64>,
    h: DMatrix<f64>,
    q: DMatrix<f64>,
    r: DMatrix<f64>,
    p0: DMatrix<f64>,
    /// Outputs that are read at each sample.
    outputs: Vec<Vec<usize>>,
}

impl System {
    fn new(samples: usize) -> Self {
        #[rustfmt::skip]
        let phi = DMatrix::from_row_slice(N, N, &[
            0.90, 0.08, 0.0, 0.0,
            0.05, 0.93, 0.0, 0.0,
            0.00, 0.00, 1.0, 0.0,
            0.00, 0.00, 0.0, 1.0,
        ]);
        let h = DMatrix::from_row_slice(2, N, &[1.0, 0.0, 0.0, 1.0, 0.3, 0.7, 0.5, 0.0]);
        let q = DMatrix::from_diagonal(&DVector::from_column_slice(&[0.04, 0.01, 1e-4, 0.0]));
        let r = DMatrix::from_row_slice(2, 2, &[0.09, 0.01, 0.01, 0.04]);
        let p0 = DMatrix::from_diagonal(&DVector::from_column_slice(&[1.0, 1.0, 0.5, 0.2]));
        let outputs = (0..samples).map(|k| match k % 7 {
            3 => vec![1],
            5 => vec![],
            _ => vec![0, 1],
        });
        Self { phi, h, q, r, p0, outputs: outputs.collect() }
    }

    fn rows(&self, k: usize) -> DMatrix<f64> {
        self.h.select_rows(&self.outputs[k])
    }

    fn noise(&self, k: usize) -> DMatrix<f64> {
        self.r.select_rows(&self.outputs[k]).select_columns(&self.outputs[k])
    }

    /// What is read, stacked, and the last state, with the given start, process noise and failure.
    fn course(
        &self,
        x0: &DVector<f64>,
        w: impl Fn(usize) -> DVector<f64>,
        b: impl Fn(usize) -> DVector<f64>,
    ) -> (DVector<f64>, DVector<f64>) {
        let mut x = x0.clone();
        let mut z = Vec::new();
        for k in 0..self.outputs.len() {
            x = &self.phi * x + w(k);
            let offset = b(k);
            let full = &self.h * &x + offset;
            z.extend(self.outputs[k].iter().map(|output| full[*output]));
        }
        (DVector::from_vec(z), x)
    }

    /// Readings and last state of a failure of unit size, straight from its definition.
    fn response(&self, failure: &Failure, onset: usize) -> (DVector<f64>, DVector<f64>) {
        let zero = DVector::zeros(N);
        let after = |k: usize| f64::from(u8::from(k >= onset));
        match failure {
            Failure::StateRamp(f) => {
                // The direction is one that the transition leaves alone: the state simply grows.
                let f = DVector::from_column_slice(f);
                self.course(&zero, |k| &f * (DT_S * after(k)), |_| DVector::zeros(2))
            }
            Failure::StateStep(f) => {
                let f = DVector::from_column_slice(f);
                let at = |k: usize| f64::from(u8::from(k == onset));
                self.course(&zero, |k| &f * at(k), |_| DVector::zeros(2))
            }
            Failure::OutputOffset(b) => {
                let b = DVector::from_column_slice(b);
                self.course(&zero, |_| DVector::zeros(N), |k| &b * after(k))
            }
        }
    }

    /// Covariance of the stacked readings and of the last state with them, from start, process and reading noise.
    fn dense_covariance(&self) -> (DMatrix<f64>, DMatrix<f64>) {
        let readings: usize = self.outputs.iter().map(Vec::len).sum();
        let (mut zz, mut xz) = (DMatrix::zeros(readings, readings), DMatrix::zeros(N, readings));
        let none = |_| DVector::zeros(N);
        let mut add = |z: DVector<f64>, x: DVector<f64>, variance: f64| {
            zz += &z * z.transpose() * variance;
            xz += x * z.transpose() * variance;
        };
        for i in 0..N {
            let unit = DVector::from_fn(N, |row, _| f64::from(u8::from(row == i)));
            let (z, x) = self.course(&unit, none, |_| DVector::zeros(2));
            add(z, x, self.p0[(i, i)]);
            for k in 0..self.outputs.len() {
                let pulse = |at: usize| &unit * f64::from(u8::from(at == k));
                let (z, x) = self.course(&DVector::zeros(N), pulse, |_| DVector::zeros(2));
                add(z, x, self.q[(i, i)]);
            }
        }
        let mut start = 0;
        for k in 0..self.outputs.len() {
            let m = self.outputs[k].len();
            let mut block = zz.view_mut((start, start), (m, m));
            block += self.noise(k);
            start += m;
        }
        (zz, xz)
    }
}

/// A square root of the covariance of the stacked readings.
fn root(system: &System) -> DMatrix<f64> {
    system.dense_covariance().0.cholesky().unwrap().l()
}

/// A textbook Kalman filter over the readings, each step handed on; gives the last estimate.
fn filter(system: &System, z: &DVector<f64>, mut each: impl FnMut(&FilterStep)) -> DVector<f64> {
    let (mut x, mut p, mut start) = (DVector::zeros(N), system.p0.clone(), 0);
    for (k, outputs) in system.outputs.iter().enumerate() {
        x = &system.phi * x;
        p = &system.phi * p * system.phi.transpose() + &system.q;
        let h = system.rows(k);
        let s = &h * &p * h.transpose() + system.noise(k);
        let innovation = z.rows(start, outputs.len()).into_owned() - &h * &x;
        let gain = &p * h.transpose() * s.clone().try_inverse().unwrap();
        x += &gain * &innovation;
        p = (DMatrix::identity(N, N) - &gain * &h) * p;
        start += outputs.len();
        each(&FilterStep {
            time_s: DT_S * (k + 1) as f64,
            interval_s: DT_S,
            transition: &system.phi,
            output: &h,
            gain: &gain,
            innovation: &innovation,
            innovation_covariance: &s,
            outputs,
        });
    }
    x
}

fn failures() -> [(Failure, f64); 3] {
    [
        (Failure::StateRamp(vec![0.0, 0.0, -1.0, 0.0]), 0.004),
        (Failure::StateStep(vec![0.3, 0.0, -1.0, 0.0]), 2.0),
        (Failure::OutputOffset(vec![1.0, 0.2]), -1.0),
    ]
}

fn readings(
    system: &System,
    root: &DMatrix<f64>,
    (failure, size): (&Failure, f64),
    onset: usize,
    seed: u64,
) -> DVector<f64> {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let normal = DVector::from_fn(root.nrows(), |_, _| random.sample::<f64, _>(StandardNormal));
    root * normal + system.response(failure, onset).0 * size
}

#[test]
fn it_is_the_dense_least_squares_solution_over_all_onsets() {
    let samples = 50;
    let system = System::new(samples);
    let (zz, xz) = system.dense_covariance();
    let factor = zz.cholesky().unwrap();
    for (seed, (failure, size)) in (10..).zip(failures()) {
        let z = readings(&system, &root(&system), (&failure, size), 30, seed);
        let solve = |onset: usize| {
            let (h, _) = system.response(&failure, onset);
            let (a, b) = (h.dot(&factor.solve(&h)), h.dot(&factor.solve(&z)));
            (onset, a, b)
        };
        let ratio = |(_, a, b): &(usize, f64, f64)| if *a > 1e-12 { 0.5 * b * b / a } else { 0.0 };
        let best = (0..samples).map(solve).max_by(|l, r| ratio(l).total_cmp(&ratio(r))).unwrap();
        let (onset, a, b) = best;
        let theta = b / a;

        let mut glr = FailureGlr::try_new(failure.clone(), N, Side::Both, 100, 100).unwrap();
        let estimate = filter(&system, &z, |step| {
            glr.update(step).unwrap();
        });
        let finding = glr.finding().unwrap();
        assert_relative_eq!(finding.log_likelihood_ratio, ratio(&best), max_relative = 1e-8);
        assert_relative_eq!(finding.size, theta, max_relative = 1e-8);
        assert_relative_eq!(finding.size_variance, 1.0 / a, max_relative = 1e-8);
        let ramp = matches!(failure, Failure::StateRamp(_));
        assert_relative_eq!(finding.onset_s, DT_S * (onset as f64 + f64::from(u8::from(!ramp))));

        // The estimate put right is the batch estimate of a system that has the failure.
        let (h, x_failed) = system.response(&failure, onset);
        let batch = &xz * factor.solve(&(&z - h * theta)) + x_failed * theta;
        let corrected = estimate + DVector::from_vec(finding.state_correction());
        assert_relative_eq!(corrected, batch, max_relative = 1e-7, epsilon = 1e-9);
    }
}

#[test]
fn sizes_are_unbiased_with_the_stated_variance_and_the_kind_with_most_evidence_is_the_true_one() {
    let system = System::new(60);
    let root = root(&system);
    let onset = 25;
    for (failure, size) in failures() {
        let (mut squares, mut right) = (0.0, 0);
        let seeds = 300;
        for seed in 0..seeds {
            let z = readings(&system, &root, (&failure, 1.5 * size), onset, 100 + seed);
            let mut bank =
                failures().map(|(kind, _)| FailureGlr::try_new(kind, N, Side::Both, 100, 100).unwrap());
            filter(&system, &z, |step| {
                for glr in &mut bank {
                    glr.update(step).unwrap();
                }
            });
            let best = bank.iter().max_by(|l, r| l.value().total_cmp(&r.value())).unwrap();
            right += i32::from(best.failure() == &failure);
            let glr = bank.iter().find(|glr| glr.failure() == &failure).unwrap();
            // The variance is that for a known onset: look at the hypothesis of the true one.
            let known = glr.onsets.iter().nth(onset).unwrap();
            let miss = known.correlation / known.information - 1.5 * size;
            squares += miss * miss * known.information;
        }
        let variance = squares / seeds as f64;
        println!("{failure:?}: variance over stated {variance:.3}, right kind {right} of {seeds}");
        assert!((0.75..1.3).contains(&variance), "{failure:?}: {variance}");
        assert!(right >= 285, "{failure:?}: {right}");
    }
}

#[test]
fn a_thinned_grid_finds_nearly_as_much_in_bounded_memory() {
    let system = System::new(140);
    let (failure, size) = failures()[0].clone();
    let z = readings(&system, &root(&system), (&failure, size), 50, 7);
    let mut thin = FailureGlr::try_new(failure.clone(), N, Side::Above, 100, 4).unwrap();
    let mut full = FailureGlr::try_new(failure, N, Side::Above, 200, 200).unwrap();
    filter(&system, &z, |step| {
        thin.update(step).unwrap();
        full.update(step).unwrap();
    });
    assert!(thin.value() <= full.value() && thin.value() > 0.95 * full.value());
    assert!(thin.onsets.iter().count() <= 5 * 5);
    // Columns of onsets that are gone are used again.
    assert!(
        serde_json::to_value(&thin).unwrap()["signatures"]["deviation"].as_array().unwrap().len() <= 26 * N
    );
}

#[test]
fn a_restored_state_goes_on_bit_for_bit() {
    let system = System::new(60);
    for (failure, size) in failures() {
        let z = readings(&system, &root(&system), (&failure, size), 20, 8);
        let mut glr = FailureGlr::try_new(failure, N, Side::Both, 50, 4).unwrap();
        let mut restored = glr.clone();
        filter(&system, &z, |step| {
            restored = serde_json::from_str(&serde_json::to_string(&restored).unwrap()).unwrap();
            assert_eq!(glr.update(step).unwrap(), restored.update(step).unwrap());
        });
        assert_eq!(glr.finding(), restored.finding());
    }
}

#[test]
fn steps_and_failures_that_do_not_fit_are_refused_and_change_nothing() {
    let direction = |length| Failure::StateStep(vec![1.0; length]);
    assert!(FailureGlr::try_new(direction(3), N, Side::Both, 10, 4).is_err());
    assert!(FailureGlr::try_new(Failure::StateRamp(vec![0.0; N]), N, Side::Both, 10, 4).is_err());
    assert!(FailureGlr::try_new(direction(N), N, Side::Both, 0, 4).is_err());
    let system = System::new(3);
    let z = DVector::from_element(6, 1.0);
    let mut glr = FailureGlr::try_new(direction(N), N, Side::Both, 10, 4).unwrap();
    filter(&system, &z, |step| {
        let before = glr.clone();
        let zero = DMatrix::zeros(2, 2);
        let nan = DVector::from_element(2, f64::NAN);
        let wrong = [
            FilterStep { innovation_covariance: &zero, ..*step },
            FilterStep { innovation: &nan, ..*step },
            FilterStep { gain: &zero, ..*step },
            FilterStep { outputs: &[0], ..*step },
        ];
        for step in &wrong {
            assert!(glr.update(step).is_err());
            assert_eq!(glr, before);
        }
        glr.update(step).unwrap();
    });
}
