//! How well the monitor states rate and onset of the leaks of the long run: what it says with the alarm and a day later.
use std::io::Write as _;
use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use cylwatch_detector::monitor::{Event, EventKind, LeakFinding, Monitor, MonitorSettings};
use cylwatch_estimator::observer::Commissioning;
use cylwatch_estimator::sensor::Sensor;
use cylwatch_estimator::thermal::vessel::presets;
use cylwatch_evaluation::performance::{CONFIDENCE, Proportion};
use rayon::prelude::*;

use crate::Fault;
use crate::campaign::{Part, RATES_BAR_H, rate_bar_h};
use crate::truths::{self, Readings, Run};

const DAY_S: f64 = 86_400.0;
const HOUR_S: f64 = 3600.0;
const BAR_PA: f64 = 1e5;
/// Leak rate beyond which a loss is hardly told from a discharge, bar/h.
const SLOW_BAR_H: f64 = 5.0;

/// What was said of one leak.
struct Said {
    rate_bar_h: f64,
    rate_kg_s: f64,
    onset_s: f64,
    /// With the alarm, and a day after it.
    findings: [LeakFinding; 2],
}

/// Run the monitor on the readings of all leaks, and print how often its intervals hold the truth, and how often it says that gas was exchanged.
pub fn print(folder: &Path) -> Result<(), Fault> {
    let (said, exchanges) = (Mutex::new(Vec::new()), AtomicUsize::new(0));
    Part::Leaks.groups().par_iter().with_max_len(1).try_for_each(|group| -> Result<(), Fault> {
        let readings = truths::readings(folder, group)?;
        for (run, readings) in group.iter().zip(&readings) {
            if let Some(one) = watch(run, readings, &exchanges)? {
                said.lock().map_err(|_| "another thread failed")?.push(one);
            }
        }
        Ok(())
    })?;
    table(&said.into_inner().map_err(|_| "another thread failed")?)?;
    let exchanges = exchanges.into_inner();
    writeln!(std::io::stdout(), "\nExchanges of gas that were none, up to {SLOW_BAR_H} bar/h: {exchanges}")?;
    Ok(())
}

/// `None` if the leak was not found a day before the end.
fn watch(run: &Run, readings: &Readings, exchanges: &AtomicUsize) -> Result<Option<Said>, Fault> {
    let Some(leak) = run.settings.leak else { return Ok(None) };
    let sensors = ["shoulder", "valve", "pressure"].map(Sensor::typical);
    let sensors = sensors.into_iter().collect::<Result<Vec<_>, _>>()?;
    let filled = Commissioning { settled: false, ..Commissioning::filled(200.0 * BAR_PA, 288.15) };
    let vessel = presets::load(&run.settings.vessel)?;
    let mut monitor = Monitor::new(&vessel, &sensors, &filled, &MonitorSettings::default())?;
    let mut alarm: Option<(f64, LeakFinding)> = None;
    for (time_s, row) in readings.rows() {
        for output in monitor.step(time_s, &row)? {
            let exchange = |event: &&Event| {
                let kind = matches!(event.kind, EventKind::Discharge(_) | EventKind::Refill(_));
                kind && rate_bar_h(run) <= SLOW_BAR_H
            };
            exchanges.fetch_add(output.events.iter().filter(exchange).count(), Ordering::Relaxed);
            let Some(leak_said) = output.leak else { continue };
            if time_s < leak.start_s {
                // It was there before.
                return Ok(None);
            }
            let (alarm_s, first) = *alarm.get_or_insert((time_s, leak_said));
            if time_s >= alarm_s + DAY_S {
                let findings = [first, leak_said];
                let (rate_bar_h, rate_kg_s) = (rate_bar_h(run), leak.rate_kg_s);
                return Ok(Some(Said { rate_bar_h, rate_kg_s, onset_s: leak.start_s, findings }));
            }
        }
    }
    Ok(None)
}

fn table(said: &[Said]) -> Result<(), Fault> {
    let mut out = std::io::stdout();
    writeln!(out, "95 % intervals of the monitor that hold the truth\n")?;
    writeln!(
        out,
        "| bar/h | leaks | rate after a day | its median error | onset at the alarm | onset after a day | median error, h |"
    )?;
    writeln!(out, "|---|---|---|---|---|---|---|")?;
    for rate in RATES_BAR_H {
        let of_rate: Vec<&Said> = said.iter().filter(|one| one.rate_bar_h == rate).collect();
        line(&mut out, &rate.to_string(), &of_rate)?;
    }
    line(&mut out, "all", &said.iter().collect::<Vec<_>>())
}

fn line(out: &mut impl std::io::Write, name: &str, said: &[&Said]) -> Result<(), Fault> {
    if said.is_empty() {
        return Ok(());
    }
    let holds = |hit: &dyn Fn(&Said) -> bool| {
        let hits = said.iter().filter(|one| hit(one)).count() as u64;
        let share = Proportion { hits, trials: said.len() as u64 };
        let (low, high) = share.wilson(CONFIDENCE);
        format!("{:.1} ({:.0} to {:.0}) %", 100.0 * share.value(), 100.0 * low, 100.0 * high)
    };
    let median = |error: &dyn Fn(&Said) -> f64| {
        let mut errors: Vec<f64> = said.iter().map(|one| error(one).abs()).collect();
        errors.sort_by(f64::total_cmp);
        errors[errors.len() / 2]
    };
    writeln!(
        out,
        "| {name} | {} | {} | {:.0} % | {} | {} | {:.1} |",
        said.len(),
        holds(&|one| one.findings[1].rate_kg_s.holds(one.rate_kg_s)),
        100.0 * median(&|one| one.findings[1].rate_kg_s.value / one.rate_kg_s - 1.0),
        holds(&|one| one.findings[0].onset_s.holds(one.onset_s)),
        holds(&|one| one.findings[1].onset_s.holds(one.onset_s)),
        median(&|one| (one.findings[1].onset_s.value - one.onset_s) / HOUR_S),
    )?;
    Ok(())
}
