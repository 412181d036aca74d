//! exploration
use cylwatch_thermal::flow::{Flow, FlowKind};
use cylwatch_thermal::fluid::Fluid;
use cylwatch_thermal::scenario::{Fill, Scenario};
use cylwatch_thermal::trajectory::Trajectory;
use cylwatch_thermal::vessel::{GasResolution, InsideFilm, Stratification, Vessel};
use cylwatch_thermal::wall::geometry::{End, EndShape, Geometry, Layer};

use crate::support::{MCADAMS, closed_bottle, rigid, run, solid, still};

pub fn vessel(gas: GasResolution, film: InsideFilm) -> Vessel {
    let end = End { shape: EndShape::Flat, thickness_m: 0.025, cells: 1 };
    let base = closed_bottle();
    let geometry = Geometry {
        inner_diameter_m: 0.273,
        cylinder_length_m: 1.524,
        cylinder_cells: 6,
        bottom: end,
        shoulder: end,
        layers: vec![Layer { material: solid(7800.0, 500.0, 45.0), thickness_m: 0.025, cells: 6 }],
        lumped: false,
        ..base.geometry
    };
    Vessel {
        fluid: Fluid::named("nitrogen").unwrap(),
        volume: rigid(geometry.contour_volume_m3()),
        geometry,
        gas,
        inside_film: film,
        ..base
    }
}

pub fn scenario(cd: f64) -> Scenario {
    let mut s = still(288.0, 288.0, 5.0, 101.0 / 3600.0);
    s.initial.fill = Fill::Pressure { pressure_pa: 150e5 };
    s.sample_time_s = 0.25;
    s.flows.push(Flow {
        name: "outlet".into(),
        kind: FlowKind::Orifice {
            diameter_m: 0.00635,
            discharge_coefficient: cd,
            back_pressure_pa: 101_300.0,
        },
        start_s: 0.0,
        stop_s: f64::INFINITY,
        opens_above_pa: None,
        closes_below_pa: None,
        closes_above_pa: None,
    });
    s
}

fn curve(name: &str) -> Vec<(f64, f64)> {
    let text = std::fs::read_to_string(format!("../../../shared/data/n2_haque_I1_{name}.csv")).unwrap();
    text.lines()
        .skip(1)
        .map(|l| {
            let (a, b) = l.split_once(',').unwrap();
            (a.parse().unwrap(), b.parse().unwrap())
        })
        .collect()
}

fn at(times: &[f64], values: &[f64], t: f64) -> f64 {
    let k = times.partition_point(|&x| x <= t).clamp(1, times.len() - 1);
    let w = (t - times[k - 1]) / (times[k] - times[k - 1]);
    values[k - 1] + w * (values[k] - values[k - 1])
}

fn score(times: &[f64], values: &[f64], curve: &[(f64, f64)]) -> (f64, f64) {
    let d: Vec<f64> = curve.iter().filter(|c| c.0 > 0.9).map(|&(t, v)| at(times, values, t) - v).collect();
    let n = d.len() as f64;
    (d.iter().sum::<f64>() / n, (d.iter().map(|x| x * x).sum::<f64>() / n).sqrt())
}

fn report(label: &str, tr: &Trajectory) {
    let (hi, lo) = (curve("gas_high"), curve("gas_low"));
    let (lt, lv): (Vec<f64>, Vec<f64>) = lo.iter().copied().unzip();
    let mid: Vec<(f64, f64)> = hi.iter().map(|&(t, v)| (t, 0.5 * (v + at(&lt, &lv, t)))).collect();
    let max: Vec<f64> = tr.gas_cells_k.iter().map(|c| c.iter().copied().fold(0.0, f64::max)).collect();
    let min: Vec<f64> = tr.gas_cells_k.iter().map(|c| c.iter().copied().fold(1e9, f64::min)).collect();
    let wmax: Vec<f64> = tr.wall_inner_k.iter().map(|c| c.iter().copied().fold(0.0, f64::max)).collect();
    let wmin: Vec<f64> = tr.wall_inner_k.iter().map(|c| c.iter().copied().fold(1e9, f64::min)).collect();
    let p: Vec<f64> = tr.pressure_pa.iter().map(|p| p / 1e5).collect();
    let f = |x: (f64, f64)| format!("{:+.2}/{:.2}", x.0, x.1);
    println!(
        "{label}: mean {} high {} low {} whi {} wlo {} P {} steps {} E {:.1e} M {:.1e}",
        f(score(&tr.time_s, &tr.gas_mean_k, &mid)),
        f(score(&tr.time_s, &max, &hi)),
        f(score(&tr.time_s, &min, &lo)),
        f(score(&tr.time_s, &wmax, &curve("wall_outer"))),
        f(score(&tr.time_s, &wmin, &curve("wall_inner"))),
        f(score(&tr.time_s, &p, &curve("pressure"))),
        tr.statistics.steps,
        tr.ledger.energy_residual(),
        tr.ledger.mass_residual()
    );
}

#[test]
fn explore() {
    for cd in [0.8, 0.75, 0.72, 0.70] {
        report(&format!("one {cd}"), &run(&vessel(GasResolution::WellMixed, MCADAMS), &scenario(cd), 1e-6));
    }
    let tr = run(&vessel(GasResolution::WellMixed, MCADAMS), &scenario(0.8), 1e-10);
    report("tight", &tr);
    println!("{:?}", tr.events);
    let daney = InsideFilm::Rayleigh { factor: 0.104, exponent: 0.352, multiplier: 1.0 };
    for (cells, c) in [(20, 0.0), (20, 0.05), (40, 0.05), (80, 0.05), (20, 0.1), (40, 0.1)] {
        let gas = GasResolution::Stratified(Stratification {
            cells,
            exchange_length_diameters: 1.0,
            core_mixing: c,
        });
        let start = std::time::Instant::now();
        let tr = run(&vessel(gas, daney), &scenario(0.75), 1e-5);
        println!("{:?} {:?}", start.elapsed(), tr.statistics);
        report(&format!("strat {cells} {c}"), &tr);
    }
}
