//! Cost of a prognosis.
//!
//! `cargo bench -p cylwatch-benches --bench outlook`
use criterion::{Criterion, criterion_group, criterion_main};
use cylwatch_detector::prognosis::{LossLaw, MassAndLeak, Prognosis};

fn prognosis(c: &mut Criterion) {
    let sd = 1e-3 / 3600.0_f64;
    let state = MassAndLeak::try_new(4.46, 3.0 * sd, [[64e-6, 0.5 * 8e-3 * sd], [0.5 * 8e-3 * sd, sd * sd]]);
    let prognosis =
        Prognosis::try_new(state.expect("sound state"), 3.66, LossLaw::Choked).expect("sound limit");
    c.bench_function("probability within 30 d", |b| b.iter(|| prognosis.probability_within(30.0 * 86_400.0)));
    c.bench_function("5, 50 and 95 % quantile", |b| b.iter(|| prognosis.quantiles(3650.0 * 86_400.0)));
}

criterion_group!(benches, prognosis);
criterion_main!(benches);
