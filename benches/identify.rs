//! Cost of an identification by every method, and of refined instruments beside the crate `dsmc`.
//!
//! `cargo bench -p cylwatch-benches --bench identify`
use std::time::Duration;

use criterion::{BatchSize, Criterion, criterion_group, criterion_main};
use cylwatch_estimator::identify::{
    Data, Hold, InitialState, InputModel, Method, Settings, StartMethod, Structure, identify,
};
use dsmc::system_identification::iv::srivc;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

const NUMERATOR: f64 = 0.003121;
const POLE: f64 = 0.003021;

/// A noisy record of the published system from rest: levels of half an hour, every `interval_s` or about that.
fn record(samples: usize, interval_s: f64, regular: bool) -> Data {
    let mut random = ChaCha8Rng::seed_from_u64(1);
    let mut normal = || -> f64 { StandardNormal.sample(&mut random) };
    let mut time_s = vec![0.0];
    for k in 1..samples {
        let stretch = if regular { 1.0 } else { 1.0 + 0.3 * normal().clamp(-2.0, 2.0) };
        time_s.push(if regular { k as f64 * interval_s } else { time_s[k - 1] + stretch * interval_s });
    }
    let (mut level, mut since_s, mut gas) = (0.0, 0.0, 0.0);
    let (mut input, mut output) = (Vec::new(), Vec::new());
    for k in 0..samples {
        if k > 0 {
            let decay = (-POLE * (time_s[k] - time_s[k - 1])).exp();
            gas = decay * gas + (1.0 - decay) * NUMERATOR / POLE * level;
        }
        if time_s[k] - since_s > 1800.0 || k == 0 {
            (level, since_s) = (15.0 * normal(), time_s[k]);
        }
        input.push(level);
        output.push(gas + 0.3 * normal());
    }
    Data::try_new(time_s, input, output, Hold::Zero).expect("columns fit")
}

fn run(
    c: &mut Criterion,
    name: &str,
    data: &Data,
    structure: &Structure,
    method: &Method,
    start: StartMethod,
) {
    let settings = Settings { start, ..Settings::default() };
    c.bench_function(name, |b| {
        b.iter_batched(
            || (data.clone(), method.clone()),
            |(data, method)| identify(&data, structure, &method, &settings).expect("data determine it"),
            BatchSize::LargeInput,
        );
    });
}

fn long_records(c: &mut Criterion) {
    let usual = StartMethod::default();
    let (regular, irregular) = (record(100_000, 10.0, true), record(100_000, 10.0, false));
    let known = Method::CompensatedInstruments { input_variance: 1e-4 };
    for (order, zeros) in [(1, 0), (2, 1)] {
        let structure = Structure::new(order, zeros);
        if order == 1 {
            run(c, "100000 regular samples, output error", &regular, &structure, &Method::OutputError, usual);
            run(
                c,
                "100000 irregular samples, output error",
                &irregular,
                &structure,
                &Method::OutputError,
                usual,
            );
            run(
                c,
                "100000 regular samples, refined",
                &regular,
                &structure,
                &Method::RefinedInstruments,
                usual,
            );
            run(c, "100000 regular samples, compensated", &regular, &structure, &known, usual);
        }
    }
}

/// The record and settings of both programs: 600 samples from rest, refined instruments from a state-variable filter.
fn beside_dsmc(c: &mut Criterion) {
    let data = record(600, 60.0, true);
    let structure = Structure::new(1, 0).with_initial(InitialState::Zero);
    let plain = StartMethod::StateVariableFilter;
    run(c, "600 samples, refined", &data, &structure, &Method::RefinedInstruments, plain);
    let free = Structure::new(1, 0);
    run(c, "600 samples, refined, free start", &data, &free, &Method::RefinedInstruments, plain);
    run(c, "600 samples, output error", &data, &free, &Method::OutputError, plain);
    let likely = Method::MaximumLikelihood {
        input_variance: 1e-4,
        output_variance: 0.09,
        input_model: InputModel::RandomWalk,
    };
    run(c, "600 samples, likelihood", &data, &free, &likely, plain);
    let start = srivc::Initialization::StateVariableFilter(0.005);
    let options = srivc::SrivcOptions::default();
    c.bench_function("600 samples, refined, dsmc", |b| {
        b.iter(|| {
            srivc::identify(data.input(), data.output(), 60.0, 1, 0, &start, &options).expect("identified")
        });
    });
}

criterion_group! {
    name = benches;
    config = Criterion::default()
        .sample_size(10)
        .warm_up_time(Duration::from_millis(500))
        .measurement_time(Duration::from_secs(3));
    targets = beside_dsmc, long_records
}
criterion_main!(benches);
