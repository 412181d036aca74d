//! Speed of the fluid properties that every step of a simulation needs: nitrogen at 200 bar, 280 to 300 K.
//!
//! Bars (median, release build): pressure 100 ns, pressure with derivatives 150 ns, state 250 ns, density from
//! pressure and temperature 600 ns. Each iteration takes the next of 21 temperatures, so that nothing can be hoisted.
use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use cylwatch_thermal::fluid::Fluid;

const PRESSURE_PA: f64 = 200e5;

/// Densities and temperatures along the isobar, taken in turn.
struct Turn {
    points: Vec<(f64, f64)>,
    next: usize,
}

impl Turn {
    fn new(fluid: &Fluid) -> Self {
        let density = |t: f64| {
            fluid
                .density_from_pressure_temperature(PRESSURE_PA, t)
                .expect("200 bar and 280 to 300 K is in the domain")
        };
        let points = (280..=300).map(|t| (density(f64::from(t)), f64::from(t))).collect();
        Self { points, next: 0 }
    }

    fn next(&mut self) -> (f64, f64) {
        self.next = if self.next + 1 == self.points.len() { 0 } else { self.next + 1 };
        black_box(self.points[self.next])
    }
}

fn nitrogen(c: &mut Criterion) {
    let fluid = Fluid::named("nitrogen").expect("a known fluid");
    let mut group = c.benchmark_group("nitrogen");
    let mut turn = Turn::new(&fluid);
    group.bench_function("pressure_pa", |b| {
        b.iter(|| {
            let (rho, t) = turn.next();
            fluid.pressure_pa(rho, t)
        });
    });
    group.bench_function("pressure_with_derivatives", |b| {
        b.iter(|| {
            let (rho, t) = turn.next();
            fluid.pressure_with_derivatives(rho, t)
        });
    });
    group.bench_function("state", |b| {
        b.iter(|| {
            let (rho, t) = turn.next();
            fluid.state(rho, t)
        });
    });
    group.bench_function("density_from_pressure_temperature", |b| {
        b.iter(|| {
            let (_, t) = turn.next();
            fluid.density_from_pressure_temperature(PRESSURE_PA, t)
        });
    });
    group.bench_function("viscosity_pa_s", |b| {
        b.iter(|| {
            let (rho, t) = turn.next();
            fluid.viscosity_pa_s(rho, t)
        });
    });
    group.bench_function("conductivity_w_m_k", |b| {
        b.iter(|| {
            let (rho, t) = turn.next();
            fluid.conductivity_w_m_k(rho, t)
        });
    });
    group.finish();
}

criterion_group!(benches, nitrogen);
criterion_main!(benches);
