//! Samples in any order against the same samples in order.
use cylwatch_estimator::filter::{
    CovarianceForm, ExtendedKalman, KalmanSettings, Placement, Refilter, SequentialFilter, StepError,
    UdFactors, Unscented, UnscentedSettings,
};
use nalgebra::{DMatrix, DVector, Dyn};
use rand::RngExt;
use rand::seq::SliceRandom;

use crate::linear_model::{LinearModel, covariance, covariance_difference, normal, rng, state_difference};

struct Case {
    model: LinearModel,
    x0: DVector<f64>,
    p0: DMatrix<f64>,
    /// Times and readings, in order.
    samples: Vec<(f64, Vec<f64>)>,
}

fn case(seed: u64) -> Case {
    let mut rng = rng(seed);
    let model = LinearModel::random(&mut rng, 6, 4, 3);
    let p0 = covariance(&mut rng, 6);
    let x0 = normal(&mut rng, 6);
    let dt_s: Vec<f64> = (0..40).map(|_| rng.random_range(0.05..1.0)).collect();
    let z = model.readings(&mut rng, &x0, &dt_s, 0.2);
    let times = dt_s.iter().scan(100.0, |time_s, dt_s| {
        *time_s += dt_s;
        Some(*time_s)
    });
    let samples = times.zip(z).collect();
    Case { model, x0, p0, samples }
}

impl Case {
    fn filter(&self) -> ExtendedKalman<LinearModel, UdFactors<Dyn>> {
        let form = UdFactors::from_covariance(&self.p0).unwrap();
        let settings = KalmanSettings::default();
        ExtendedKalman::try_new(self.model.clone(), self.x0.as_slice(), form, &settings).unwrap()
    }

    fn in_order(&self) -> ExtendedKalman<LinearModel, UdFactors<Dyn>> {
        let mut filter = self.filter();
        let mut time_s = 100.0;
        for (at_s, z) in &self.samples {
            filter.step(at_s - time_s, z).unwrap();
            time_s = *at_s;
        }
        filter
    }

    fn assert_as_in_order<F>(&self, late: &ExtendedKalman<LinearModel, F>)
    where
        F: CovarianceForm,
    {
        let expected = self.in_order();
        let p = expected.form().to_dense();
        assert!(state_difference(late.state(), &DVector::from_column_slice(expected.state()), &p) < 1e-12);
        assert!(covariance_difference(&late.form().to_dense(), &p) < 1e-12);
    }
}

#[test]
fn shuffled_samples_give_the_result_of_those_in_order() {
    let case = case(61);
    let mut shuffled = case.samples.clone();
    shuffled.shuffle(&mut rng(62));
    let mut ring = Refilter::new(case.filter(), 100.0, 40);
    for (time_s, z) in &shuffled {
        assert_ne!(ring.insert(*time_s, z).unwrap(), Placement::TooOld);
    }
    case.assert_as_in_order(ring.filter());
    assert_eq!((ring.time_s(), ring.horizon_s(), ring.len()), (case.samples[39].0, 100.0, 40));
}

#[test]
fn a_late_sample_reaches_back_as_far_as_the_ring_and_no_further() {
    let case = case(63);
    let mut ring = Refilter::new(case.filter(), 100.0, 5);
    for (k, (time_s, z)) in case.samples.iter().enumerate().filter(|(k, _)| *k != 35) {
        assert_eq!(ring.insert(*time_s, z).unwrap(), Placement::Appended, "sample {k}");
    }
    let state = ring.filter().state().to_vec();
    for time_s in [100.0, case.samples[20].0, case.samples[33].0] {
        assert_eq!(ring.insert(time_s, &[0.0; 3]).unwrap(), Placement::TooOld);
    }
    assert_eq!(ring.filter().state(), state);
    let (time_s, z) = &case.samples[35];
    assert_eq!(ring.insert(*time_s, z).unwrap(), Placement::Inserted { refiltered: 4 });
    case.assert_as_in_order(ring.filter());
    assert_eq!((ring.len(), ring.horizon_s()), (5, case.samples[34].0));
}

#[test]
fn samples_of_one_time_merge() {
    let case = case(64);
    let mut ring = Refilter::new(case.filter(), 100.0, 10);
    let nan = f64::NAN;
    for (time_s, z) in &case.samples {
        ring.insert(*time_s, &[z[0], nan, 77.0]).unwrap();
        let merged = ring.insert(*time_s, &[nan, z[1], nan]).unwrap();
        assert_eq!(merged, Placement::Merged { replaced: 0, refiltered: 0 });
        // A corrected reading takes the place of the earlier one; a gap cannot.
        let third = if z[2].is_finite() { z[2] } else { 77.0 };
        let merged = ring.insert(*time_s, &[nan, nan, third]).unwrap();
        assert_eq!(merged, Placement::Merged { replaced: 1, refiltered: 0 });
    }
    let mut expected = case.filter();
    let mut time_s = 100.0;
    for (at_s, z) in &case.samples {
        let third = if z[2].is_finite() { z[2] } else { 77.0 };
        expected.step(at_s - time_s, &[z[0], z[1], third]).unwrap();
        time_s = *at_s;
    }
    assert_eq!(ring.filter().state(), expected.state());
    assert_eq!(ring.len(), 10);
}

#[test]
fn a_sample_at_the_start_is_used() {
    let case = case(65);
    let mut ring = Refilter::new(case.filter(), 100.0, 3);
    let mut expected = case.filter();
    assert!(ring.is_empty());
    assert_eq!(ring.insert(100.0, &case.samples[0].1).unwrap(), Placement::Appended);
    expected.update(&case.samples[0].1).unwrap();
    assert_eq!(ring.filter().state(), expected.state());
}

#[test]
fn a_refused_sample_leaves_everything_as_it_was() {
    let case = case(66);
    let mut ring = Refilter::new(case.filter(), 100.0, 20);
    for (time_s, z) in &case.samples[..10] {
        ring.insert(*time_s, z).unwrap();
    }
    let state = ring.filter().state().to_vec();
    let late_s = 0.5 * (case.samples[4].0 + case.samples[5].0);
    assert!(matches!(ring.insert(f64::NAN, &[0.0; 3]), Err(StepError::Filter(_))));
    assert!(matches!(ring.insert(late_s, &[0.0; 2]), Err(StepError::Filter(_))));
    // Readings so large that the next prediction is no finite number: the late sample is taken out again.
    let wild = [f64::MAX, -f64::MAX, f64::MAX];
    assert!(ring.insert(late_s, &wild).is_err());
    assert!(ring.insert(case.samples[4].0, &wild).is_err());
    assert_eq!((ring.filter().state(), ring.len()), (state.as_slice(), 10));
    let (time_s, z) = &case.samples[10];
    assert_eq!(ring.insert(*time_s, z).unwrap(), Placement::Appended);
    let mut expected = case.filter();
    let mut time_s = 100.0;
    for (at_s, z) in &case.samples[..=10] {
        expected.step(at_s - time_s, z).unwrap();
        time_s = *at_s;
    }
    assert_eq!(ring.filter().state(), expected.state());
}

#[test]
fn a_change_from_outside_closes_the_past() {
    let case = case(67);
    let mut ring = Refilter::new(case.filter(), 100.0, 20);
    let mut expected = case.filter();
    let mut time_s = 100.0;
    for (k, (at_s, z)) in case.samples.iter().enumerate() {
        ring.insert(*at_s, z).unwrap();
        expected.step(at_s - time_s, z).unwrap();
        time_s = *at_s;
        if k == 20 {
            ring.change(|filter| {
                filter.state_mut()[0] = 9.0;
                filter.form_mut().decorrelate_and_set(0, 4.0);
            });
            expected.state_mut()[0] = 9.0;
            expected.form_mut().decorrelate_and_set(0, 4.0);
            assert_eq!(ring.insert(*at_s, z).unwrap(), Placement::TooOld);
            assert_eq!(ring.insert(case.samples[19].0, z).unwrap(), Placement::TooOld);
        }
    }
    assert_eq!(ring.filter().state(), expected.state());
}

#[test]
fn any_sequential_filter_can_go_back() {
    let case = case(68);
    let filter = || {
        Unscented::try_new(case.model.clone(), case.x0.as_slice(), &case.p0, &UnscentedSettings::default())
    };
    let mut ring = Refilter::new(filter().unwrap(), 100.0, 40);
    let mut expected = filter().unwrap();
    let mut time_s = 100.0;
    for (at_s, z) in &case.samples[..20] {
        SequentialFilter::step(&mut expected, at_s - time_s, z).unwrap();
        time_s = *at_s;
    }
    for k in [3, 0, 1, 2, 7, 6, 5, 4, 11, 8, 9, 10, 19, 18, 12, 13, 15, 14, 17, 16] {
        ring.insert(case.samples[k].0, &case.samples[k].1).unwrap();
    }
    assert_eq!(ring.filter().state(), expected.state());
    assert_eq!(ring.filter().covariance(), expected.covariance());
}
