//! Nonlinear problems: convergence to the optimum of the whole record, and steps that would lead astray.
use cylwatch_estimator::filter::horizon::{
    Constraint, HorizonEstimate, HorizonSettings, HorizonStatus, MovingHorizon,
};
use cylwatch_estimator::filter::{Dimensions, Linearisation, StateSpace};
use nalgebra::{DMatrix, DVector, Matrix3};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::StandardNormal;

/// Pendulum: angle, rate, and its unknown damping, a constant; a random torque; the sine of the angle is read.
#[derive(Clone)]
struct Pendulum;

const TORQUE_VARIANCE_RATE: f64 = 0.02;
const READING_SD: f64 = 0.05;

impl Pendulum {
    const STEPS: usize = 8;

    /// One semi-implicit Euler step and its Jacobian.
    fn small_step(x: &mut [f64], h: f64) -> Matrix3<f64> {
        let (theta, rate, damping) = (x[0], x[1], x[2]);
        x[1] = rate - h * (4.0 * theta.sin() + damping * rate);
        x[0] = theta + h * x[1];
        let (by_theta, by_rate, by_damping) = (-h * 4.0 * theta.cos(), 1.0 - h * damping, -h * rate);
        Matrix3::new(
            1.0 + h * by_theta,
            h * by_rate,
            h * by_damping,
            by_theta,
            by_rate,
            by_damping,
            0.0,
            0.0,
            1.0,
        )
    }
}

impl StateSpace for Pendulum {
    type Error = std::fmt::Error;

    fn dimensions(&self) -> Dimensions {
        Dimensions { states: 3, leading: 2, noises: 1, outputs: 1 }
    }

    fn propagate(
        &mut self,
        x: &mut [f64],
        dt_s: f64,
        linear: Option<&mut Linearisation>,
    ) -> Result<(), Self::Error> {
        let mut transition = Matrix3::identity();
        for _ in 0..Self::STEPS {
            transition = Self::small_step(x, dt_s / Self::STEPS as f64) * transition;
        }
        if let Some(linear) = linear {
            linear.phi.copy_from(&transition.fixed_rows::<2>(0));
            linear.g.copy_from_slice(&[0.0, 1.0]);
            linear.q[0] = TORQUE_VARIANCE_RATE * dt_s;
        }
        Ok(())
    }

    fn output(&mut self, _j: usize, x: &[f64], h: Option<&mut [f64]>) -> Result<f64, Self::Error> {
        if let Some(h) = h {
            h.copy_from_slice(&[x[0].cos(), 0.0, 0.0]);
        }
        Ok(x[0].sin())
    }

    fn noise_variance(&self, _j: usize, _x: &[f64]) -> f64 {
        READING_SD * READING_SD
    }
}

struct Record {
    mean: DVector<f64>,
    sd: DVector<f64>,
    samples: Vec<(f64, f64)>,
}

fn record(seed: u64) -> Record {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let normal = |rng: &mut ChaCha8Rng| rng.sample::<f64, _>(StandardNormal);
    let (mean, sd) = (DVector::from_vec(vec![0.3, 0.0, 0.5]), DVector::from_vec(vec![0.5, 1.0, 0.3]));
    let mut x: Vec<f64> = mean.iter().zip(&sd).map(|(m, s)| m + s * normal(&mut rng)).collect();
    let samples = (0..12)
        .map(|_| {
            let dt_s = rng.random_range(0.1..0.4);
            Pendulum.propagate(&mut x, dt_s, None).expect("no edge");
            x[1] += (TORQUE_VARIANCE_RATE * dt_s).sqrt() * normal(&mut rng);
            (dt_s, x[0].sin() + READING_SD * normal(&mut rng))
        })
        .collect();
    Record { mean, sd, samples }
}

/// The states over the record for `y = (xi, omega)`, and all residuals of unit weight.
fn shoot(record: &Record, y: &DVector<f64>) -> (Vec<Vec<f64>>, DVector<f64>) {
    let mut x: Vec<f64> = (0..3).map(|i| record.mean[i] + record.sd[i] * y[i]).collect();
    let (mut states, mut residuals) = (vec![x.clone()], y.as_slice().to_vec());
    for (i, (dt_s, z)) in record.samples.iter().enumerate() {
        Pendulum.propagate(&mut x, *dt_s, None).expect("no edge");
        x[1] += (TORQUE_VARIANCE_RATE * dt_s).sqrt() * y[3 + i];
        residuals.push((z - x[0].sin()) / READING_SD);
        states.push(x.clone());
    }
    (states, DVector::from_vec(residuals))
}

/// Optimum of the whole record by Levenberg and Marquardt's method over initial state and noises, with derivatives from
/// central differences, started at `y`.
fn batch(record: &Record, mut y: DVector<f64>) -> (Vec<Vec<f64>>, DMatrix<f64>) {
    let (mut damping, h) = (1e-3, 1e-5);
    let mut normal = DMatrix::zeros(y.len(), y.len());
    for _ in 0..200 {
        let residuals = shoot(record, &y).1;
        let columns: Vec<_> = (0..y.len())
            .map(|k| {
                let moved = |s: f64| {
                    let mut y = y.clone();
                    y[k] += s;
                    shoot(record, &y).1
                };
                (moved(h) - moved(-h)) / (2.0 * h)
            })
            .collect();
        let jacobian = DMatrix::from_columns(&columns);
        normal = jacobian.tr_mul(&jacobian);
        let gradient = jacobian.tr_mul(&residuals);
        let damped = &normal + DMatrix::identity(y.len(), y.len()) * damping;
        let next = &y - damped.cholesky().expect("positive definite").solve(&gradient);
        if shoot(record, &next).1.norm_squared() <= residuals.norm_squared() {
            let small = (&next - &y).amax() < 1e-11;
            (y, damping) = (next, damping * 0.2);
            if small {
                break;
            }
        } else {
            damping *= 10.0;
        }
    }
    // Covariance of the newest state: its derivative with y times the inverse normal matrix.
    let newest = |y: &DVector<f64>| DVector::from_vec(shoot(record, y).0.pop().expect("twelve states"));
    let columns: Vec<_> = (0..y.len())
        .map(|k| {
            let mut step = DVector::zeros(y.len());
            step[k] = h;
            (newest(&(&y + &step)) - newest(&(&y - &step))) / (2.0 * h)
        })
        .collect();
    let map = DMatrix::from_columns(&columns);
    let covariance = &map * normal.try_inverse().expect("positive definite") * map.transpose();
    (shoot(record, &y).0, covariance)
}

fn run(record: &Record, settings: HorizonSettings) -> (HorizonEstimate, MovingHorizon<Pendulum>) {
    let prior = DMatrix::from_diagonal(&record.sd.component_mul(&record.sd));
    let mut horizon =
        MovingHorizon::try_new(Pendulum, &record.mean, &prior, Vec::new(), settings).expect("sound problem");
    let estimates = record.samples.iter().map(|(dt_s, z)| horizon.step(*dt_s, &[*z]).expect("no edge"));
    let estimate = estimates.last().expect("twelve samples");
    (estimate, horizon)
}

#[test]
fn a_window_over_the_whole_record_converges_to_the_batch_optimum() {
    let mut worst_of_filter = 0.0_f64;
    for seed in 0..10 {
        let record = record(seed);
        let settings = HorizonSettings {
            samples: 12,
            iterations_max: 100,
            tolerance: 1e-7,
            ..HorizonSettings::default()
        };
        let (estimate, horizon) = run(&record, settings);
        assert!(estimate.converged, "seed {seed}");
        let (states, covariance) = batch(&record, DVector::zeros(15));
        for (x, expected) in horizon.trajectory().iter().zip(&states) {
            let error = x.iter().zip(expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(error < 1e-5, "seed {seed}: {error}");
        }
        let scale = covariance.amax();
        assert!((&estimate.covariance - &covariance).amax() < 1e-4 * scale, "seed {seed}");
        let filter = HorizonSettings { samples: 1, iterations_max: 1, ..HorizonSettings::default() };
        let (filtered, _) = run(&record, filter);
        let newest = DVector::from_column_slice(states.last().expect("states"));
        worst_of_filter = worst_of_filter.max((filtered.x - newest).amax());
    }
    assert!(worst_of_filter > 0.02, "a filter does not get there: {worst_of_filter}");
}

#[test]
fn constants_stay_the_same_over_a_nonlinear_window() {
    let (_, horizon) = run(&record(3), HorizonSettings { samples: 7, ..HorizonSettings::default() });
    let states = horizon.trajectory();
    assert_eq!(states.len(), 8);
    assert!(states.iter().all(|x| x[2] == states[0][2]));
}

/// A constant state read through a curve.
#[derive(Clone)]
struct Curve {
    value: fn(f64) -> f64,
    slope: fn(f64) -> f64,
}

impl StateSpace for Curve {
    type Error = std::fmt::Error;

    fn dimensions(&self) -> Dimensions {
        Dimensions { states: 1, leading: 1, noises: 0, outputs: 1 }
    }

    fn propagate(
        &mut self,
        _x: &mut [f64],
        _dt_s: f64,
        linear: Option<&mut Linearisation>,
    ) -> Result<(), Self::Error> {
        if let Some(linear) = linear {
            linear.phi[(0, 0)] = 1.0;
        }
        Ok(())
    }

    fn output(&mut self, _j: usize, x: &[f64], h: Option<&mut [f64]>) -> Result<f64, Self::Error> {
        let value = (self.value)(x[0]);
        if let Some(h) = h {
            h[0] = (self.slope)(x[0]);
        }
        if value.is_nan() { Err(std::fmt::Error) } else { Ok(value) }
    }

    fn noise_variance(&self, _j: usize, _x: &[f64]) -> f64 {
        1e-4
    }
}

/// Lowest cost over a fine grid about the whole prior.
fn grid_search(curve: &Curve, (mean, sd): (f64, f64), z: f64, bound: f64) -> f64 {
    let cost = |x: f64| ((x - mean) / sd).powi(2) + (z - (curve.value)(x)).powi(2) / 1e-4;
    let points = (0..4_000_000).map(|i| -20.0 + 1e-5 * f64::from(i)).filter(|x| *x >= bound);
    let costs = points.filter(|x| cost(*x).is_finite());
    costs.min_by(|a, b| cost(*a).total_cmp(&cost(*b))).expect("the curve has values")
}

fn settle(curve: &Curve, (mean, sd): (f64, f64), z: f64, bounds: Vec<Constraint>) -> HorizonEstimate {
    let settings = HorizonSettings { iterations_max: 100, tolerance: 1e-6, ..HorizonSettings::default() };
    let (mean, prior) = (DVector::from_element(1, mean), DMatrix::from_element(1, 1, sd * sd));
    let mut horizon =
        MovingHorizon::try_new(curve.clone(), &mean, &prior, bounds, settings).expect("sound problem");
    horizon.step(1.0, &[z]).expect("the prior is inside the domain")
}

#[test]
fn steps_that_overshoot_are_shortened() {
    // Newton's method on the arc tangent diverges from beyond 1.39.
    let curve = Curve { value: f64::atan, slope: |x| 1.0 / (1.0 + x * x) };
    let estimate = settle(&curve, (5.0, 10.0), 0.1, Vec::new());
    let expected = grid_search(&curve, (5.0, 10.0), 0.1, f64::NEG_INFINITY);
    assert!(estimate.converged && estimate.iterations > 3, "{} iterations", estimate.iterations);
    assert!((estimate.x[0] - expected).abs() < 2e-5, "{} {expected}", estimate.x[0]);
}

#[test]
fn steps_out_of_the_domain_are_shortened() {
    let curve = Curve { value: f64::ln, slope: |x| 1.0 / x };
    let estimate = settle(&curve, (1.0, 3.0), -3.0, Vec::new());
    let expected = grid_search(&curve, (1.0, 3.0), -3.0, f64::NEG_INFINITY);
    assert!(estimate.converged);
    assert!((estimate.x[0] - expected).abs() < 2e-5, "{} {expected}", estimate.x[0]);
}

#[test]
fn a_nonlinear_optimum_on_a_bound_is_found_there() {
    let curve = Curve { value: |x| x * x * x, slope: |x| 3.0 * x * x };
    let estimate = settle(&curve, (2.0, 1.0), -1.0, vec![Constraint::at_least(0, 0.5)]);
    let expected = grid_search(&curve, (2.0, 1.0), -1.0, 0.5);
    assert_eq!((expected * 1e4).round(), 5e3, "the bound is active");
    assert!(estimate.converged && estimate.status == HorizonStatus::Solved);
    assert_eq!(estimate.x[0], 0.5);
    // Multiplier: derivative of the cost there, (x - 2) + (x^3 + 1) 3 x^2 / R.
    let slope = -1.5 + (0.125 + 1.0) * 0.75 / 1e-4;
    assert!(
        (estimate.active[0].multiplier - slope).abs() < 1e-6 * slope,
        "{}",
        estimate.active[0].multiplier
    );
}
