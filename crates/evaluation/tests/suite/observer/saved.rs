//! An observer that is saved and goes on in another process is the same observer, to the last digit.
use super::*;
use cylwatch_estimator::EstimatorError;
use cylwatch_estimator::observer::Snapshot;

fn bits(estimate: &Estimate) -> Vec<u64> {
    let Estimate { time_s, gas_mean_k, gas_mean_sd_k, mass_kg, mass_sd_kg, leak_kg_s, leak_sd_kg_s, .. } =
        *estimate;
    let rest = [estimate.pressure_expected_pa, estimate.p15_pa];
    let all = [time_s, gas_mean_k, gas_mean_sd_k, mass_kg, mass_sd_kg, leak_kg_s, leak_sd_kg_s];
    all.iter().chain(&rest).map(|value| value.to_bits()).collect()
}

/// A new process: another observer, and nothing but the bytes.
fn reborn(observer: &Observer) -> Observer {
    let bytes = postcard::to_allocvec(&observer.snapshot()).unwrap();
    let mut other = observer_with(&SENSORS, &ObserverSettings::default());
    other.try_restore(&postcard::from_bytes::<Snapshot>(&bytes).unwrap()).unwrap();
    other
}

#[test]
fn an_observer_saved_at_every_sample_goes_on_as_if_it_had_not_been() {
    let rows = Case::shock().until(1.0).rows;
    let mut through = observer_with(&SENSORS, &ObserverSettings::default());
    let mut killed = observer_with(&SENSORS, &ObserverSettings::default());
    for (index, (t, readings)) in rows.iter().enumerate() {
        let mut readings = *readings;
        if index % 7 == 3 {
            readings[index % 3] = f64::NAN;
        }
        match index {
            40 => [&mut through, &mut killed].into_iter().for_each(Observer::begin_exchange),
            50 => [&mut through, &mut killed].into_iter().for_each(Observer::end_exchange),
            _ => {}
        }
        let expected = through.step(*t, &readings).unwrap();
        killed = reborn(&killed);
        assert_eq!(bits(&killed.step(*t, &readings).unwrap()), bits(&expected), "sample {index}");
    }
}

#[test]
fn a_snapshot_of_another_observer_is_refused() {
    let (t, readings) = Case::shock().rows[0];
    let mut observer = observer_with(&SENSORS, &ObserverSettings::default());
    observer.step(t, &readings).unwrap();
    let snapshot = observer.snapshot();
    let mut fewer = observer_with(&SENSORS[..2], &ObserverSettings::default());
    assert!(matches!(fewer.try_restore(&snapshot), Err(EstimatorError::SnapshotForeign)));
    let mut single = observer_with(&SENSORS, &ObserverSettings::single());
    assert!(matches!(single.try_restore(&snapshot), Err(EstimatorError::SnapshotForeign)));
    assert!(observer_with(&SENSORS, &ObserverSettings::default()).try_restore(&snapshot).is_ok());
}
