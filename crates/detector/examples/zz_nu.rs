#![allow(missing_docs, clippy::unwrap_used, clippy::print_stdout)]
use cylwatch_detector::estimator::observer::*;
use cylwatch_detector::estimator::sensor::Sensor;
use cylwatch_detector::estimator::thermal::vessel::presets;
use cylwatch_detector::estimator::truth::*;
use rayon::prelude::*;
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let (from, to): (u64, u64) = (a[1].parse().unwrap(), a[2].parse().unwrap());
    let rows: Vec<String> = (from..to)
        .into_par_iter()
        .flat_map_iter(|seed| {
            let s = TruthSettings { gas_cells: 1, relative_tolerance: 1e-4, ..Default::default() };
            let truth = generate_with(&Course::RailwayWeeks { days: 21.0 }, seed, 60.0, &s).unwrap();
            let cols = ["shoulder", "valve", "pressure"]
                .map(|n| truth.log.channels.iter().position(|c| c.name == n).unwrap());
            let sensors = ["shoulder", "valve", "pressure"].map(|n| Sensor::typical(n).unwrap());
            let mut m = Observer::new(
                &presets::load("nitrogen-20l").unwrap(),
                &sensors,
                &Commissioning { settled: false, ..Commissioning::filled(200e5, 288.15) },
                &ObserverSettings::default(),
            )
            .unwrap();
            let mut last: Option<[f64; 6]> = None;
            let mut out = vec![];
            for (t, row) in truth.log.rows() {
                let r = cols.map(|c| row[c]);
                let e = m.step(t, &r).unwrap();
                let i = m.innovations();
                let now = [i[2].nu, r[2] - i[2].nu, r[0], r[1], e.gas_mean_k, i[2].s.sqrt()];
                if let Some(l) = last {
                    let d = (now[0] - l[0]).abs() / 1e5;
                    if d > 0.15 && t > 3600.0 {
                        out.push(format!(
                            "{seed},{t},{:.3},{:.3},{:.3},{:.2},{:.2},{:.2},{:?}",
                            d,
                            now[0] / 1e5,
                            now[5] / 1e5,
                            (now[1] - l[1]).abs() / 1e5,
                            (now[2] - l[2]).abs(),
                            (now[3] - l[3]).abs(),
                            i[2].outcome
                        ));
                    }
                }
                last = Some(now);
            }
            out
        })
        .collect();
    for r in rows {
        println!("{r}");
    }
}
