#![allow(missing_docs, clippy::unwrap_used, clippy::print_stdout)]
use cylwatch_detector::estimator::observer::Commissioning;
use cylwatch_detector::estimator::sensor::Sensor;
use cylwatch_detector::estimator::thermal::vessel::presets;
use cylwatch_detector::estimator::truth::*;
use cylwatch_detector::monitor::*;
use rayon::prelude::*;
use std::collections::BTreeMap;
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let (from, to): (u64, u64) = (a[1].parse().unwrap(), a[2].parse().unwrap());
    let bar_h: f64 = a[3].parse().unwrap();
    let days: f64 = a[4].parse().unwrap();
    let sd: f64 = a.get(5).map_or(4e-3, |x| x.parse::<f64>().unwrap() * 1e-3);
    let tau: f64 = a.get(6).map_or(5400.0, |x| x.parse::<f64>().unwrap() * 3600.0);
    let rate = bar_h * 19.18e-3 / 3600.0;
    let out: Vec<_> = (from..to)
        .into_par_iter()
        .map(|seed| {
            let onset = 10.0 * 86400.0 + 86400.0 * ((seed * 7919 % 1000) as f64 / 1000.0);
            let s = TruthSettings {
                gas_cells: 1,
                relative_tolerance: 1e-4,
                leak: (bar_h > 0.0).then_some(TruthLeak { rate_kg_s: rate, start_s: onset }),
                ..Default::default()
            };
            let truth = generate_with(&Course::RailwayWeeks { days }, seed, 60.0, &s).unwrap();
            let cols = ["shoulder", "valve", "pressure"]
                .map(|n| truth.log.channels.iter().position(|c| c.name == n).unwrap());
            let sensors = ["shoulder", "valve", "pressure"].map(|n| Sensor::typical(n).unwrap());
            let settings = MonitorSettings {
                mass_error: onset::MassError { sd_kg: sd, time_s: tau, ..Default::default() },
                ..Default::default()
            };
            let mut m = Monitor::new(
                &presets::load("nitrogen-20l").unwrap(),
                &sensors,
                &Commissioning { settled: false, ..Commissioning::filled(200e5, 288.15) },
                &settings,
            )
            .unwrap();
            let mut kinds: BTreeMap<String, u32> = BTreeMap::new();
            let mut alarm: Option<f64> = None;
            let mut at_alarm = None;
            let mut after = None;
            let t0 = std::time::Instant::now();
            let mut verdicts: BTreeMap<String, u32> = BTreeMap::new();
            for (t, row) in truth.log.rows() {
                for o in m.step(t, &cols.map(|c| row[c])).unwrap() {
                    *verdicts.entry(o.verdict.to_string()).or_default() += 1;
                    for e in &o.events {
                        let k = match &e.kind {
                            EventKind::Verdict { from, to } => format!("{from}->{to}"),
                            k => k.name().to_string(),
                        };
                        *kinds.entry(k).or_default() += 1;
                    }
                    if o.verdict == Verdict::Leak && t > onset && alarm.is_none() {
                        alarm = Some(t);
                        at_alarm = o.leak;
                    }
                    if alarm.is_some_and(|x| t >= x + 86400.0) && after.is_none() {
                        after = o.leak;
                    }
                }
            }
            (
                seed,
                onset,
                kinds,
                alarm,
                at_alarm,
                after,
                t0.elapsed().as_secs_f64() / truth.time_s.len() as f64,
                verdicts,
            )
        })
        .collect();
    let mut all: BTreeMap<String, u32> = BTreeMap::new();
    let mut ver: BTreeMap<String, u32> = BTreeMap::new();
    let (mut n, mut rin, mut oin, mut oin2) = (0, 0, 0, 0);
    for (seed, onset, kinds, alarm, at, after, dt, v) in &out {
        for (k, c) in kinds {
            *all.entry(k.clone()).or_default() += c;
        }
        for (k, c) in v {
            *ver.entry(k.clone()).or_default() += c;
        }
        if let (Some(alarm), Some(at), Some(after)) = (alarm, at, after) {
            n += 1;
            rin += u32::from(after.rate_kg_s.holds(rate));
            oin += u32::from(at.onset_s.holds(*onset));
            oin2 += u32::from(after.onset_s.holds(*onset));
            println!(
                "seed {seed} alarm +{:.2} h; at alarm onset {:+.2} h [{:+.2},{:+.2}]; +24h rate {:.4} [{:.4},{:.4}] of {:.4} bar/h, onset {:+.2} [{:+.2} {:+.2}], {:.1} us",
                (alarm - onset) / 3600.0,
                (at.onset_s.value - onset) / 3600.0,
                (at.onset_s.low - onset) / 3600.0,
                (at.onset_s.high - onset) / 3600.0,
                after.rate_kg_s.value * 3600.0 / 19.18e-3,
                after.rate_kg_s.low * 3600.0 / 19.18e-3,
                after.rate_kg_s.high * 3600.0 / 19.18e-3,
                bar_h,
                (after.onset_s.value - onset) / 3600.0,
                (after.onset_s.low - onset) / 3600.0,
                (after.onset_s.high - onset) / 3600.0,
                dt * 1e6
            );
        } else {
            println!("seed {seed} alarm {:?} {:.1} us", alarm.map(|a| (a - onset) / 3600.0), dt * 1e6);
        }
    }
    println!(
        "{all:#?}\n{ver:#?}\nfound {n} of {}; rate in {rin}, onset at alarm in {oin}, onset +24 h in {oin2}",
        out.len()
    );
}
