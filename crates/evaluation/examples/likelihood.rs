//! Finds settings of the observer by maximum likelihood over worlds, and says what they do to the estimate.
//!
//! `cargo run --release -p cylwatch-evaluation --example likelihood -- PLAN GROUP [GROUP ...]`
//!
//! ```text
//! PLAN    plan of the judge; its tight worlds are used (crates/evaluation/plans)
//! GROUP   settings that are scaled together, as JSON paths joined by commas: /sun/prior_sd,/sun/per_sqrt_s
//! ```
//!
//! The first member's innovations `nu` of variance `S`, after the first day, give `-2 ln L = sum (nu^2/S + ln S)`, with `nu^2/S` up to 25 so that a reading that is far off
//! counts no more than five standard deviations. One factor for each group is found by golden section between 1/16 and 16, one group after the other, in two sweeps; its standard deviation
//! is that of the curvature there, if innovations were independent.
//!
//! For the observer as it is and for what was found it prints the likelihood a reading, the NIS, the error of gas temperature and mass, and the normalised error squared of each sensor's constants over the
//! worlds (NEES, 1 where they are as certain as they say): a likelihood that rises while these get worse has found the model's errors, not its constants.
//!
//! Source: innovations' likelihood, F. Schweppe, IEEE Trans. Inf. Theory 11 (1965) 61.
#![allow(clippy::print_stdout)]
use std::error::Error;
use std::path::Path;

use cylwatch_detector::evidence::observer_settings;
use cylwatch_estimator::consistency::Coverage;
use cylwatch_estimator::minimum::golden_section;
use cylwatch_estimator::observer::{Observer, ObserverSettings};
use cylwatch_evaluation::judge::candidate::Registry;
use cylwatch_evaluation::judge::plan::Plan;
use cylwatch_evaluation::world::{Overlay, World, generate};
use rayon::prelude::*;

type Failure = Box<dyn Error + Send + Sync>;

/// Time from which innovations count, s.
const LEARNT_S: f64 = 86_400.0;
/// Largest square of a standardised innovation.
const FAR: f64 = 25.0;
/// Logarithm of the largest factor, and how near to the best one a search comes.
const LN_FACTOR: f64 = 2.77;
const WITHIN: f64 = 0.05;
const SWEEPS: usize = 2;

/// Sums over readings and rows of a world.
#[derive(Clone, Debug, Default)]
struct Watched {
    readings: f64,
    minus_two_ln: f64,
    squares: f64,
    rows: f64,
    gas_k2: f64,
    mass_part2: f64,
    /// Errors of the constants of the sensors and their standard deviations, with their names.
    constants: Vec<(&'static str, [f64; 2])>,
}

fn main() -> Result<(), Failure> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [plan, groups @ ..] = &arguments[..] else { return Err("usage: likelihood PLAN GROUP...".into()) };
    let plan = Plan::read(Path::new(plan), &Registry::default(), &[])?;
    let tight = plan.tasks.iter().filter(|task| task.request.overlay == Overlay::Nothing);
    let requests: Vec<_> = tight.map(|task| task.request).collect();
    let worlds: Vec<World> = requests.par_iter().map(generate).collect::<Result<_, _>>()?;
    if worlds.is_empty() {
        return Err("the plan has no tight world".into());
    }
    println!("{} tight worlds, {:.1} cylinder-days", worlds.len(), days(&worlds));
    let mut settings = observer_settings();
    say("as it is", &watch_all(&worlds, &settings)?);
    let mut found = vec![(1.0, f64::NAN); groups.len()];
    for _ in 0..SWEEPS {
        for (group, found) in groups.iter().zip(&mut found) {
            let at = |ln: f64| {
                let scaled = scaled(&settings, group, ln.exp())?;
                Ok::<_, Failure>(watch_all(&worlds, &scaled)?.iter().map(|of| of.minus_two_ln).sum::<f64>())
            };
            let best = golden_section((-LN_FACTOR, LN_FACTOR), WITHIN, at)?;
            let step = 4.0 * WITHIN;
            let curvature = (at(best + step)? - 2.0 * at(best)? + at(best - step)?) / (step * step);
            settings = scaled(&settings, group, best.exp())?;
            *found = (found.0 * best.exp(), (2.0 / curvature).sqrt());
        }
    }
    for (group, (factor, sd)) in groups.iter().zip(found) {
        println!("{group}: times {factor:.3}, relative sd {sd:.1e}");
    }
    say("likeliest", &watch_all(&worlds, &settings)?);
    Ok(())
}

fn days(worlds: &[World]) -> f64 {
    let length_s =
        |world: &World| world.log.time_s.last().unwrap_or(&0.0) - world.log.time_s.first().unwrap_or(&0.0);
    worlds.iter().map(length_s).sum::<f64>() / 86_400.0
}

/// The settings with those of a group times a factor.
fn scaled(settings: &ObserverSettings, group: &str, factor: f64) -> Result<ObserverSettings, Failure> {
    let mut document = serde_json::to_value(settings)?;
    for path in group.split(',') {
        let value = document.pointer_mut(path).ok_or_else(|| format!("no setting {path}"))?;
        let number = value.as_f64().ok_or_else(|| format!("{path} is no number"))?;
        *value = (factor * number).into();
    }
    let settings: ObserverSettings = serde_json::from_value(document)?;
    settings.validate()?;
    Ok(settings)
}

fn watch_all(worlds: &[World], settings: &ObserverSettings) -> Result<Vec<Watched>, Failure> {
    worlds.par_iter().map(|world| watch(world, settings)).collect()
}

fn watch(world: &World, settings: &ObserverSettings) -> Result<Watched, Failure> {
    let data = &world.operator_data;
    let mut observer = Observer::new(&data.vessel, &data.sensors, &data.commissioning, settings)?;
    let mut watched = Watched::default();
    let begun_s = world.log.time_s.first().copied().unwrap_or_default();
    for (row, (time_s, readings)) in world.log.rows().enumerate() {
        let estimate = observer.step(time_s, readings)?;
        if time_s - begun_s < LEARNT_S {
            continue;
        }
        for innovation in observer.innovations().iter().filter(|of| of.nu.is_finite()) {
            let square = (innovation.nu * innovation.nu / innovation.s).min(FAR);
            watched.readings += 1.0;
            watched.squares += square;
            watched.minus_two_ln += square + innovation.s.ln();
        }
        watched.rows += 1.0;
        watched.gas_k2 += (estimate.gas_mean_k - world.truth.gas_mean_k[row]).powi(2);
        watched.mass_part2 += (estimate.mass_kg / world.truth.mass_kg[row] - 1.0).powi(2);
    }
    watched.constants = constants(world, &mut observer);
    Ok(watched)
}

/// Errors of the constants of the sensors that are states, and their standard deviations.
fn constants(world: &World, observer: &mut Observer) -> Vec<(&'static str, [f64; 2])> {
    let Some((mean, covariance)) = observer.state(0) else { return Vec::new() };
    let drawn = &world.drawn.sensors;
    let truths = [
        ("shoulder.offset_k", drawn.shoulder.offset_k),
        ("valve.offset_k", drawn.valve.offset_k),
        ("pressure.offset_pa", drawn.pressure.offset_pa),
        ("pressure.temperature_coefficient_pa_k", drawn.pressure.coefficient_pa_k),
    ];
    let names = &observer.cylinder().state_map().names;
    let of = |&(name, truth): &(&'static str, f64)| {
        let state = names.iter().position(|state| state == name)?;
        Some((name, [mean[state] - truth, covariance[(state, state)].sqrt()]))
    };
    truths.iter().filter_map(of).collect()
}

fn say(what: &str, worlds: &[Watched]) {
    let sum = |of: fn(&Watched) -> f64| worlds.iter().map(of).sum::<f64>();
    let (readings, rows) = (sum(|of| of.readings), sum(|of| of.rows));
    println!("{what}:");
    println!(
        "  -2 ln L a reading {:.4}, NIS {:.3}",
        sum(|of| of.minus_two_ln) / readings,
        sum(|of| of.squares) / readings
    );
    println!(
        "  gas temperature {:.3} K rms, mass {:.3} % rms",
        (sum(|of| of.gas_k2) / rows).sqrt(),
        100.0 * (sum(|of| of.mass_part2) / rows).sqrt()
    );
    let mut names: Vec<&str> = worlds.iter().flat_map(|of| &of.constants).map(|(name, _)| *name).collect();
    names.sort_unstable();
    names.dedup();
    for name in names {
        let of_name = worlds.iter().flat_map(|of| &of.constants).filter(|(of, _)| *of == name);
        let (mut squares, mut band) = (0.0, Coverage::default());
        for (_, [error, sd]) in of_name {
            squares += (error / sd).powi(2);
            band.add(*error, *sd);
        }
        let Coverage { inside, samples } = band;
        println!("  {name}: NEES {:.2}, {inside} of {samples} in their 95 %", squares / samples as f64);
    }
}
