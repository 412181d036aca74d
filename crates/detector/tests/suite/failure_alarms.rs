//! Mean time between false alarms of a failure in a filter's innovations, and what an alarm finds.
use std::cell::RefCell;

use cylwatch_detector::calibrate::{CalibrationSettings, ResidualSource, calibrate_threshold, count_alarms};
use cylwatch_detector::statistic::{Failure, FailureGlr, FilterStep, Side};
use nalgebra::{DMatrix, DVector};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::StandardNormal;

/// Standard deviations of the reading and of a step of the level that wanders.
const READING_SD: f64 = 1.0;
const STEP_SD: f64 = 0.2;

/// A wandering level, a reading of it, and the stationary filter: `P = (q + sqrt(q^2 + 4 q r))/2` before a reading.
struct World {
    random: ChaCha8Rng,
    level: f64,
    estimate: f64,
    /// What fails: the level falls by this much per sample.
    leak: f64,
}

impl World {
    fn new(leak: f64) -> Self {
        Self { random: ChaCha8Rng::seed_from_u64(0), level: 0.0, estimate: 0.0, leak }
    }

    fn variance() -> f64 {
        let (q, r) = (STEP_SD * STEP_SD, READING_SD * READING_SD);
        0.5 * (q + (q * q + 4.0 * q * r).sqrt())
    }

    fn innovation_variance() -> f64 {
        Self::variance() + READING_SD * READING_SD
    }

    fn gain() -> f64 {
        Self::variance() / Self::innovation_variance()
    }

    fn normal(&mut self) -> f64 {
        self.random.sample(StandardNormal)
    }
}

impl ResidualSource for World {
    type Sample = f64;

    fn begin(&mut self, run: u64) {
        self.random = ChaCha8Rng::seed_from_u64(77);
        self.random.set_stream(run);
        // The error of the estimate after a reading, in its stationary distribution.
        let error_sd = (Self::variance() * (1.0 - Self::gain())).sqrt();
        self.estimate = 0.0;
        self.level = error_sd * self.normal();
    }

    /// The innovation of the filter, which knows nothing of the leak.
    fn next_residual(&mut self) -> f64 {
        self.level += STEP_SD * self.normal() - self.leak;
        let innovation = self.level + READING_SD * self.normal() - self.estimate;
        self.estimate += Self::gain() * innovation;
        innovation
    }
}

fn detector() -> FailureGlr {
    FailureGlr::try_new(Failure::StateRamp(vec![-1.0]), 1, Side::Above, 200, 4).unwrap()
}

/// The detector fed with innovations, a sample per second.
fn fed(glr: &RefCell<FailureGlr>) -> impl FnMut(f64) -> f64 {
    let one = DMatrix::from_element(1, 1, 1.0);
    let gain = DMatrix::from_element(1, 1, World::gain());
    let covariance = DMatrix::from_element(1, 1, World::innovation_variance());
    let mut time_s = 0.0;
    move |innovation| {
        time_s += 1.0;
        let step = FilterStep {
            time_s,
            interval_s: 1.0,
            transition: &one,
            output: &one,
            gain: &gain,
            innovation: &DVector::from_element(1, innovation),
            innovation_covariance: &covariance,
            outputs: &[0],
        };
        glr.borrow_mut().update(&step).unwrap()
    }
}

#[test]
fn a_threshold_by_simulation_gives_the_requested_mean_time_and_alarms_find_the_leak() {
    let wished = 300.0;
    let glr = RefCell::new(detector());
    let anew = || {
        glr.borrow_mut().reset();
        fed(&glr)
    };
    let settings = CalibrationSettings::new(wished);
    let calibrated = calibrate_threshold(&mut World::new(0.0), anew, &settings).unwrap();
    let found = count_alarms(&mut World::new(0.0), anew, calibrated.threshold, 120_000);
    println!("threshold {:.2}, achieved {:.0} of {wished}", calibrated.threshold, found.mean());
    assert!((found.mean() / wished - 1.0).abs() < 0.25, "{found:?}");

    // A leak from the start on: its rate within the stated error, and the estimate that runs behind put right.
    let (leak, samples, runs) = (0.15, 80, 200);
    let (mut squares, mut behind, mut corrected) = (0.0, 0.0, 0.0);
    for run in 0..runs {
        let mut world = World::new(leak);
        world.begin(run);
        let mut update = anew();
        (0..samples).for_each(|_| {
            update(world.next_residual());
        });
        let finding = glr.borrow().finding().unwrap();
        squares += (finding.size - leak).powi(2);
        behind += world.level - world.estimate;
        corrected += world.level - world.estimate - finding.state_correction()[0];
    }
    let runs = runs as f64;
    let rms = (squares / runs).sqrt();
    println!(
        "leak {leak}: rms error {rms:.3}; behind {:.3}, put right {:.3}",
        behind / runs,
        corrected / runs
    );
    assert!(rms < 0.35 * leak, "{rms}");
    // Without noise the estimate lags by leak (1 - K)/K.
    let lag = leak * (1.0 - World::gain()) / World::gain();
    assert!((behind / runs + lag).abs() < 0.1 * lag, "{}", behind / runs);
    assert!((corrected / runs).abs() < 0.2 * lag, "{}", corrected / runs);
}
