//! Smoothed estimates against the truth and against the filter's.
use super::*;
use cylwatch_estimator::observer::{Quality, Smoother};

fn smooth(case: &Case, mut smoother: Smoother) -> Vec<Estimate> {
    let mut out = Vec::new();
    for (t, readings) in &case.rows {
        out.extend(smoother.push(*t, readings).unwrap());
    }
    out.extend(smoother.finish());
    out
}

#[test]
fn smoothing_is_more_certain_than_the_filter_and_ends_at_it() {
    for (engine, case) in [(Engine::Extended, Case::shock()), (Engine::Unscented, &Case::ramp().until(2.0))] {
        // The smoother has no flowing member: in a shock that takes a part in what the filter says.
        let mut settings = ObserverSettings { engine, ..ObserverSettings::default() };
        settings.suppose_no_flow();
        let filtered = case.run(&mut observer_with(&SENSORS, &settings));
        let smoothed = smooth(case, Smoother::new(observer(engine)).unwrap());
        assert_eq!(smoothed.len(), filtered.len());
        for (s, f) in smoothed.iter().zip(&filtered) {
            assert_eq!((s.time_s, s.quality, s.pressure_pa), (f.time_s, f.quality, f.pressure_pa));
            assert!(s.gas_mean_sd_k <= f.gas_mean_sd_k * (1.0 + 1e-6), "at {} s", s.time_s);
            assert!(s.mass_sd_kg <= f.mass_sd_kg * (1.0 + 1e-6), "at {} s", s.time_s);
            assert!(s.leak_sd_kg_s <= f.leak_sd_kg_s * (1.0 + 1e-6), "at {} s", s.time_s);
        }
        let (last, end) = (smoothed.last().unwrap(), filtered.last().unwrap());
        assert!(
            (last.gas_mean_k - end.gas_mean_k).abs() < 1e-9 && (last.mass_kg - end.mass_kg).abs() < 1e-12
        );
    }
}

/// Constant errors of the sensors shift filter and smoother alike; what varies is what later samples correct best.
#[test]
fn smoothing_lowers_the_errors_over_several_cylinders() {
    // Whole and varying error of the temperature, K², varying error of the mass, kg².
    let (mut filtered, mut smoothed) = ([0.0; 3], [0.0; 3]);
    for seed in 1..5 {
        let case = Case::new(Chamber::SCENARIOS[0], seed, 60.0);
        let add = |sums: &mut [f64; 3], estimates: &[Estimate]| {
            let gas = estimates.iter().zip(&case.truth.gas_mean_k).map(|(e, k)| e.gas_mean_k - k);
            let mass = estimates.iter().zip(&case.truth.mass_kg).map(|(e, kg)| e.mass_kg - kg);
            let errors = [case.gas_rms_k(estimates), spread(gas), spread(mass)];
            sums.iter_mut().zip(errors).for_each(|(sum, error)| *sum += error * error);
        };
        add(&mut filtered, &case.run(&mut observer(Engine::Extended)));
        add(&mut smoothed, &smooth(&case, Smoother::new(observer(Engine::Extended)).unwrap()));
    }
    for (part, (filtered, smoothed)) in [0.9, 0.5, 0.5].into_iter().zip(filtered.into_iter().zip(smoothed)) {
        assert!(smoothed < part * filtered, "{smoothed} of {filtered}");
    }
}

fn spread(errors: impl Iterator<Item = f64>) -> f64 {
    let errors: Vec<f64> = errors.collect();
    let count = errors.len() as f64;
    let mean = errors.iter().sum::<f64>() / count;
    (errors.iter().map(|e| (e - mean).powi(2)).sum::<f64>() / count).sqrt()
}

/// Half the record, two and a half hours, is most of what later samples can say about the gas.
#[test]
fn a_short_record_smooths_blockwise_nearly_as_well_as_the_whole_log() {
    let case = Case::ramp();
    let whole = smooth(case, Smoother::new(observer(Engine::Extended)).unwrap());
    let blocks = smooth(case, Smoother::with_rows(observer(Engine::Extended), 300).unwrap());
    assert_eq!(whole.len(), blocks.len());
    for (w, b) in whole.iter().zip(&blocks) {
        assert_eq!(w.time_s, b.time_s);
        assert!((w.gas_mean_k - b.gas_mean_k).abs() < w.gas_mean_sd_k, "at {} s", w.time_s);
        assert!(b.gas_mean_sd_k >= w.gas_mean_sd_k * (1.0 - 1e-6), "at {} s", w.time_s);
    }
    let error = |e: &[Estimate]| spread(e.iter().zip(&case.truth.gas_mean_k).map(|(e, k)| e.gas_mean_k - k));
    assert!(error(&blocks) < error(&case.run(&mut observer(Engine::Extended))));
}

#[test]
fn rows_come_out_once_and_in_order_whatever_the_room() {
    let case = Case::ramp().until(0.5);
    for rows in [2, 3, 7, 30, 31, 32, 1000] {
        let out = smooth(&case, Smoother::with_rows(observer(Engine::Extended), rows).unwrap());
        let times: Vec<f64> = out.iter().map(|e| e.time_s).collect();
        let expected: Vec<f64> = case.rows.iter().map(|(t, _)| *t).collect();
        assert_eq!(times, expected, "{rows} rows");
    }
}

#[test]
fn an_error_leaves_the_smoother_as_it_was() {
    let case = Case::ramp().until(0.5);
    let mut smoother = Smoother::new(observer(Engine::Extended)).unwrap();
    for (t, readings) in &case.rows {
        smoother.push(*t, readings).unwrap();
        assert!(smoother.push(*t - 1.0, readings).is_err());
    }
    assert_eq!(smoother.finish(), smooth(&case, Smoother::new(observer(Engine::Extended)).unwrap()));
}

#[test]
fn a_sample_without_readings_is_smoothed_from_both_sides() {
    let mut case = Case::ramp().until(4.0);
    for (t, readings) in &mut case.rows {
        if (3600.0..3.0 * 3600.0).contains(t) {
            *readings = [f64::NAN; 3];
        }
    }
    let filtered = case.run(&mut observer(Engine::Extended));
    let smoothed = smooth(&case, Smoother::new(observer(Engine::Extended)).unwrap());
    let end = filtered.iter().rposition(|e| e.quality == Quality::Predicted).unwrap();
    assert!(smoothed[end].gas_mean_sd_k < 0.3 * filtered[end].gas_mean_sd_k);
    let error = |estimates: &[Estimate]| (estimates[end].gas_mean_k - case.truth.gas_mean_k[end]).abs();
    assert!(error(&smoothed) < 0.5 * error(&filtered));
}
