//! Cost of one sample of every statistic, in the steady state of its memory.
//!
//! `cargo bench -p cylwatch-detector --bench statistic`
use criterion::{Criterion, criterion_group, criterion_main};
use cylwatch_detector::statistic::{
    Cusum, Ewma, EwmaLimits, Failure, FailureGlr, FilterStep, Glr, GlrSettings, Noise, Residual, Shape,
    Shewhart, ShiryaevRoberts, Side, Sprt, Statistic, TwoSidedCusum,
};
use nalgebra::{DMatrix, DVector};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::StandardNormal;

/// Residuals that come round again and again.
const LENGTH: usize = 4096;
const INTERVAL_S: f64 = 60.0;

fn residuals() -> Vec<f64> {
    let mut random = ChaCha8Rng::seed_from_u64(1);
    (0..LENGTH).map(|_| random.sample(StandardNormal)).collect()
}

fn bench<S: Statistic>(
    c: &mut Criterion,
    name: &str,
    mut statistic: S,
    sample: impl Fn(usize, f64) -> S::Sample,
) {
    let values = residuals();
    let mut n = 0;
    let mut step = || {
        n += 1;
        statistic.update(sample(n, values[n % LENGTH]))
    };
    (0..20_000).for_each(|_| {
        step();
    });
    c.bench_function(name, |b| b.iter(&mut step));
}

fn order_only(c: &mut Criterion) {
    let value = |_: usize, value: f64| value;
    let cusum = Cusum::try_new(0.5).expect("finite reference");
    bench(c, "shewhart", Shewhart::new(Side::Both), value);
    bench(c, "shewhart, 3 of 5", Shewhart::with_run(Side::Both, 3, 5).expect("3 of 5"), value);
    bench(c, "cusum", cusum, value);
    bench(c, "cusum, two-sided", TwoSidedCusum::new(cusum), value);
    bench(c, "ewma", Ewma::try_new(0.1, Side::Both, EwmaLimits::Exact).expect("sound weight"), value);
    bench(c, "shiryaev-roberts", ShiryaevRoberts::try_new(1.0).expect("sound shift"), value);
    bench(c, "sprt", Sprt::try_new(1.0, 1e300, 1e300).expect("far bounds"), value);
}

fn timed(c: &mut Criterion) {
    let residual = |n: usize, value: f64| Residual { time_s: n as f64 * INTERVAL_S, value };
    for (noise_name, noise) in
        [("white", Noise::white(1.0)), ("3 h", Noise::ornstein_uhlenbeck(1.0, 10_800.0))]
    {
        for shape in [Shape::Step, Shape::Ramp] {
            for per_octave in [4, 8] {
                let settings = GlrSettings { per_octave, ..GlrSettings::new(shape, noise) };
                let name = format!("glr, {shape:?}, {noise_name}, window 4096, {per_octave} per octave");
                bench(c, &name, Glr::try_new(settings).expect("sound settings"), residual);
            }
        }
    }
}

fn failures(c: &mut Criterion) {
    for n in [4, 16] {
        let (phi, h) = (DMatrix::identity(n, n) * 0.99, DMatrix::from_element(2, n, 0.1));
        let (gain, s) = (DMatrix::from_element(n, 2, 0.05), DMatrix::identity(2, 2));
        let innovations: Vec<_> = residuals().chunks(2).map(DVector::from_column_slice).collect();
        let failure = Failure::StateRamp(vec![1.0; n]);
        let mut glr = FailureGlr::try_new(failure, n, Side::Both, 4096, 4).expect("sound failure");
        let mut k = 0;
        let mut step = || {
            k += 1;
            let step = FilterStep {
                time_s: k as f64 * INTERVAL_S,
                interval_s: INTERVAL_S,
                transition: &phi,
                output: &h,
                gain: &gain,
                innovation: &innovations[k % innovations.len()],
                innovation_covariance: &s,
                outputs: &[0, 1],
            };
            glr.update(&step).expect("matrices fit")
        };
        (0..20_000).for_each(|_| {
            step();
        });
        c.bench_function(&format!("failure glr, {n} states, 2 outputs, window 4096"), |b| b.iter(&mut step));
    }
}

criterion_group!(benches, order_only, timed, failures);
criterion_main!(benches);
