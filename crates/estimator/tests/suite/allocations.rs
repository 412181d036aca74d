//! No filter allocates in a step, from the first one on.
use cylwatch_allocations::allocations;
use cylwatch_estimator::filter::{
    CovarianceForm, ExtendedKalman, FixedLag, GateSettings, Information, Joseph, KalmanSettings, Placement,
    Refilter, SequentialFilter, SquareRoot, Stationary, StationarySettings, UdFactors, Unscented,
    UnscentedSettings,
};
use nalgebra::{Const, DMatrix, Dyn, SMatrix};

use crate::copying_model::CopyingModel;

const STATES: usize = 12;
const OUTPUTS: usize = 3;

/// Eight of twelve states move, driven by ten noise sources.
fn model() -> CopyingModel {
    CopyingModel::new(STATES, 8, 10, OUTPUTS)
}

/// Complete and incomplete samples, and one that no gate lets pass.
const SAMPLES: [[f64; OUTPUTS]; 5] = [
    [0.1, 0.2, -0.1],
    [f64::NAN, 0.3, 0.0],
    [f64::NAN, f64::NAN, f64::NAN],
    [0.0, 1e6, 0.1],
    [0.2, 0.0, f64::NAN],
];

fn assert_no_step_allocates<F: SequentialFilter>(mut filter: F) {
    let counted = allocations(|| {
        for (k, z) in SAMPLES.iter().cycle().take(100).enumerate() {
            let dt_s = if k % 17 == 16 { 0.5 } else { 1.0 };
            assert!(filter.step(dt_s, z).is_ok());
        }
    });
    assert_eq!(counted, 0);
}

fn kalman<F: CovarianceForm>(form: F, settings: &KalmanSettings) -> ExtendedKalman<CopyingModel, F> {
    ExtendedKalman::try_new(model(), &[0.0; STATES], form, settings).unwrap()
}

fn prior() -> DMatrix<f64> {
    DMatrix::identity(STATES, STATES)
}

fn gated() -> KalmanSettings {
    KalmanSettings { gate: Some(GateSettings::default()), ..KalmanSettings::default() }
}

#[test]
fn no_step_of_a_kalman_filter_allocates_in_any_form() {
    let fixed = SMatrix::<f64, STATES, STATES>::identity();
    let all = KalmanSettings { iterations: 3, consider: vec![9, 11], ..gated() };
    for settings in [KalmanSettings::default(), gated(), all.clone()] {
        assert_no_step_allocates(kalman(UdFactors::<Dyn>::from_covariance(&prior()).unwrap(), &settings));
        assert_no_step_allocates(kalman(
            UdFactors::<Const<STATES>>::from_covariance(&fixed).unwrap(),
            &settings,
        ));
        assert_no_step_allocates(kalman(SquareRoot::<Dyn>::from_covariance(&prior()).unwrap(), &settings));
        assert_no_step_allocates(kalman(Joseph::<Dyn>::from_covariance(&prior()).unwrap(), &settings));
    }
    assert_no_step_allocates(kalman(Information::<Dyn>::from_covariance(&prior()).unwrap(), &gated()));
}

#[test]
fn no_step_of_an_unscented_or_stationary_filter_allocates() {
    for redraw in [false, true] {
        let settings =
            UnscentedSettings { gate: Some(GateSettings::default()), redraw, ..UnscentedSettings::default() };
        assert_no_step_allocates(Unscented::try_new(model(), &[0.0; STATES], &prior(), &settings).unwrap());
    }
    let settings = StationarySettings { gate: Some(GateSettings::default()), ..StationarySettings::new(1.0) };
    let start = [0.0; STATES];
    assert_no_step_allocates(Stationary::try_new(model(), &start, &start, &settings).unwrap());
}

#[test]
fn a_full_ring_takes_samples_without_allocating_late_ones_too() {
    let filter = kalman(UdFactors::<Dyn>::from_covariance(&prior()).unwrap(), &gated());
    let mut ring = Refilter::new(filter, 0.0, 8);
    for k in 0..9 {
        ring.insert(f64::from(k), &SAMPLES[0]).unwrap();
    }
    let counted = allocations(|| {
        for k in 9..100 {
            assert!(ring.insert(f64::from(k), &SAMPLES[k as usize % 5]).is_ok());
            let late = ring.insert(f64::from(k) - 3.5, &SAMPLES[0]);
            assert!(matches!(late, Ok(Placement::Inserted { .. })));
        }
    });
    assert_eq!(counted, 0);
}

#[test]
fn a_full_fixed_lag_smoother_does_not_allocate() {
    let mut filter = kalman(UdFactors::<Dyn>::from_covariance(&prior()).unwrap(), &gated());
    let mut smoother = FixedLag::try_new(6, &filter).unwrap();
    let mut run = |steps: usize| {
        for z in SAMPLES.iter().cycle().take(steps) {
            assert!(filter.step(1.0, z).is_ok());
            assert!(smoother.push(&filter).is_ok());
        }
    };
    run(7);
    assert_eq!(allocations(|| run(50)), 0);
}
