//! Time of the reduced model's right-hand side: alone and with its exact Jacobian, N = 1, 2, 4, 8 wall nodes.
use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use cylwatch_thermal::reduced::{ReducedModel, Unknowns};
use cylwatch_thermal::vessel::presets;
use nalgebra::DMatrix;
use std::hint::black_box;

fn rates(criterion: &mut Criterion) {
    let vessel = presets::load("nitrogen-20l").expect("a preset");
    let mut group = criterion.benchmark_group("reduced");
    for nodes in [1, 2, 4, 8] {
        let mut model = ReducedModel::new(&vessel, nodes, 14.0);
        let n = model.states();
        let mut x = vec![281.0; n];
        x[0] = 279.0;
        x[n - 2] = 280.0;
        x[n - 1] = 4.4;
        let unknowns = Unknowns::still(270.0);
        let mut rate = vec![0.0; n];
        let mut jacobian = DMatrix::zeros(n, n + Unknowns::COUNT);
        group.bench_function(BenchmarkId::new("rates", nodes), |bencher| {
            bencher.iter(|| model.rates(black_box(&x), &unknowns, &mut rate, None).expect("a gas state"));
        });
        group.bench_function(BenchmarkId::new("rates and Jacobian", nodes), |bencher| {
            bencher.iter(|| {
                model.rates(black_box(&x), &unknowns, &mut rate, Some(&mut jacobian)).expect("a gas state");
            });
        });
        group.bench_function(BenchmarkId::new("pressure", nodes), |bencher| {
            bencher.iter(|| model.pressure(black_box(&x)).expect("a gas state"));
        });
    }
    group.finish();
}

criterion_group!(benches, rates);
criterion_main!(benches);
