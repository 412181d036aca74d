//! Cost of a reading of the detectors without an observer, and of a prognosis.
//!
//! `cargo bench -p cylwatch-detector --bench outlook`
use criterion::{Criterion, criterion_group, criterion_main};
use cylwatch_detector::baseline::{Filling, PressureError, Reading, Threshold, ThresholdSettings};
use cylwatch_detector::prognosis::{LossLaw, MassAndLeak, Prognosis};
use cylwatch_detector::statistic::Statistic;

fn baseline(c: &mut Criterion) {
    let filling = Filling { pressure_pa: 200e5, temperature_k: 288.15 };
    let error = PressureError::published(filling).expect("sound filling");
    let settings = ThresholdSettings { hold_s: 10_800.0, ..ThresholdSettings::default() };
    let mut detector = Threshold::try_new(error, settings).expect("sound settings");
    let mut n = 0_u32;
    let mut step = || {
        n += 1;
        let time_s = 10.0 * f64::from(n);
        let shoulder_k = 280.0 + 5.0 * (f64::from(n % 1000) * 0.006).sin();
        detector.update(Reading { time_s, shoulder_k, pressure_pa: 198e5 })
    };
    (0..5000).for_each(|_| {
        step();
    });
    c.bench_function("published threshold, held for 3 h", |b| b.iter(&mut step));
}

fn prognosis(c: &mut Criterion) {
    let sd = 1e-3 / 3600.0_f64;
    let state = MassAndLeak::try_new(4.46, 3.0 * sd, [[64e-6, 0.5 * 8e-3 * sd], [0.5 * 8e-3 * sd, sd * sd]]);
    let prognosis =
        Prognosis::try_new(state.expect("sound state"), 3.66, LossLaw::Choked).expect("sound limit");
    c.bench_function("probability within 30 d", |b| b.iter(|| prognosis.probability_within(30.0 * 86_400.0)));
    c.bench_function("5, 50 and 95 % quantile", |b| b.iter(|| prognosis.quantiles(3650.0 * 86_400.0)));
}

criterion_group!(benches, baseline, prognosis);
criterion_main!(benches);
