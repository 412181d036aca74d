//! Whether the five best layouts of a 20 L cylinder achieve what the placement predicts.
//!
//! `cargo run --release -p cylwatch-evaluation --example placement_monte_carlo -- [seeds] [mismatched seeds]`
//!
//! `seeds`: 100 by default, in worlds that are the observer's own model, for the member that gives the mass, and half as many for one whose
//! leak rate walks; `mismatched seeds`: 20 by default, drawn cylinders in railway weather under the observer as it is. Candidates: bottom,
//! middle, shoulder, neck, valve, ambient; three of them beside the pressure, by exhaustive search on the gas temperature. Standard
//! deviations and errors with 95 % intervals over seeds. Then the smallest leak that is found in a day, by the statistic of its signature, and the paper's
//! question: one thermometer beside the pressure, at each place.
#![allow(clippy::unwrap_used, clippy::print_stdout)]
use cylwatch_thermal::units::DAY_S;
use std::time::Instant;

use cylwatch_estimator::observer::{LeakHypothesis, ObserverSettings};
use cylwatch_estimator::placement::search::{Method, SearchControl, search};
use cylwatch_estimator::placement::{
    Conditions, Constraints, DetectionSettings, InstrumentedCylinder, Quantity,
};
use cylwatch_estimator::sensor::Sensor;
use cylwatch_estimator::thermal::vessel::{Vessel, presets};
use cylwatch_evaluation::placement::{
    Achieved, Claim, ConfirmSettings, Confirmed, Detected, calm, detected_matched, detected_mismatched,
    matched, mismatched,
};

const NAMES: [&str; 7] = ["bottom", "middle", "shoulder", "neck", "valve", "ambient", "pressure"];
const BEST: usize = 5;
const G: f64 = 1e-3;
const G_H: f64 = 1e-3 / 3600.0;

struct Study {
    vessel: Vessel,
    candidates: Vec<Sensor>,
    conditions: Conditions,
}

impl Study {
    fn new() -> Self {
        Self {
            vessel: presets::load("nitrogen-20l").unwrap(),
            candidates: NAMES.iter().map(|name| Sensor::typical(name).unwrap()).collect(),
            conditions: Conditions::default(),
        }
    }

    /// Take the film inside at the difference of wall and gas that these settings make.
    fn linearise_for(&mut self, settings: &ObserverSettings) {
        self.conditions = self.conditions.at_typical_difference(&self.vessel, settings).unwrap();
    }

    fn claim<'a>(
        &'a self,
        settings: &'a ObserverSettings,
        member: &'a LeakHypothesis,
        layouts: &'a [Vec<usize>],
    ) -> Claim<'a> {
        let Self { vessel, candidates, conditions } = self;
        Claim { vessel, candidates, settings, member, conditions, layouts }
    }

    /// The best layouts by the gas temperature.
    fn best(&self, settings: &ObserverSettings, member: &LeakHypothesis) -> Vec<Vec<usize>> {
        let cylinder =
            InstrumentedCylinder::new(&self.vessel, &self.candidates, settings, member, &self.conditions)
                .unwrap();
        let constraints = Constraints { must: vec![NAMES.len() - 1], ..Constraints::of(4) };
        let problem = cylinder.problem(Quantity::GasTemperature).unwrap();
        let found =
            search(&problem, &constraints, Method::Exhaustive, f64::INFINITY, &SearchControl::default())
                .unwrap();
        found.layouts.into_iter().take(BEST).map(|layout| layout.sensors).collect()
    }
}

fn line(name: &str, unit: f64, achieved: &Achieved) {
    let Achieved { predicted, stated, rms, interval, coverage, coverage_interval, .. } = *achieved;
    println!(
        "  {name:32} {:9.4} {:9.4} {:9.4} [{:.4}, {:.4}] {:6.3}   {:5.1} [{:.1}, {:.1}]",
        predicted.unwrap_or(f64::NAN) / unit,
        stated / unit,
        rms / unit,
        interval.low / unit,
        interval.high / unit,
        achieved.ratio().unwrap_or(f64::NAN),
        100.0 * coverage,
        100.0 * coverage_interval.low,
        100.0 * coverage_interval.high
    );
}

fn table(layouts: &[Confirmed]) {
    type Part = fn(&Confirmed) -> Option<&Achieved>;
    let parts: [(&str, f64, Part); 3] = [
        ("gas temperature, K", 1.0, |of| Some(&of.gas_k)),
        ("mass, g", G, |of| Some(&of.mass_kg)),
        ("leak rate, g/h", G_H, |of| of.leak_kg_s.as_ref()),
    ];
    for (title, unit, part) in parts {
        if layouts.iter().any(|of| part(of).is_some()) {
            let (predicted, stated, achieved, ratio) = ("predicted", "stated", "achieved", "ratio");
            println!(
                "  {title:32} {predicted:>9} {stated:>9} {achieved:>9} {:18} {ratio}   in 95 % band",
                ""
            );
        }
        for of in layouts {
            let names: Vec<&str> = of.layout.iter().map(|&candidate| NAMES[candidate]).collect();
            if let Some(achieved) = part(of) {
                line(&names.join(" "), unit, achieved);
            }
        }
    }
}

fn leaks(detected: &[Detected]) {
    println!(
        "  {:32} {:>9} {:>9}   {:>6} {:>6} {:>6}   found of leaks {:.3} g/h (predicted)",
        "smallest leak in a day, g/h",
        "predicted",
        "achieved",
        "sd",
        "mean",
        "answer",
        detected.first().map_or(f64::NAN, |first| first.leak_kg_s / G_H),
    );
    for of in detected {
        let names: Vec<&str> = of.layout.iter().map(|&candidate| NAMES[candidate]).collect();
        let rates = [of.predicted_kg_s, of.achieved_kg_s].map(|rate| rate / G_H);
        println!(
            "  {:32} {:9.4} {:9.4}   {:6.3} {:6.3} {:6.3}   {:.2} ({:.2})",
            names.join(" "),
            rates[0],
            rates[1],
            of.sd,
            of.mean,
            of.answer,
            of.found,
            of.found_predicted
        );
    }
}

fn main() {
    let mut arguments = std::env::args().skip(1).map(|argument| argument.parse::<u64>().unwrap());
    let (seeds, mismatched_seeds) = (arguments.next().unwrap_or(100), arguments.next().unwrap_or(20));
    let mut study = Study::new();
    let usual = ObserverSettings { wall_nodes: 6, ..ObserverSettings::default() };
    let quiet = calm(&usual, &study.conditions);
    let mass = usual.bank[0];
    study.linearise_for(&quiet);
    println!("wall and gas {:.3} K apart", study.conditions.apart_k);
    let leak = LeakHypothesis::walking_rate(0.02);
    for (title, member, seeds) in [("mass walks", mass, seeds), ("leak rate walks", leak, seeds.div_ceil(2))]
    {
        let begun = Instant::now();
        let layouts = study.best(&quiet, &member);
        let settings = ConfirmSettings { seeds, ..ConfirmSettings::default() };
        let found =
            matched(&study.claim(&quiet, &member, &layouts), &settings, &SearchControl::default(), &|_| ())
                .unwrap();
        println!("matched, {title}: {seeds} seeds, {:.0} s", begun.elapsed().as_secs_f64());
        table(&found.layouts);
    }
    // The member whose innovations tell a leak in the study.
    let slow = usual.bank[2];
    let layouts = study.best(&quiet, &slow);
    let settings = ConfirmSettings { seeds, ..ConfirmSettings::default() };
    let detection = DetectionSettings::default();
    let control = SearchControl::default();
    let begun = Instant::now();
    let found =
        detected_matched(&study.claim(&quiet, &slow, &layouts), &settings, &detection, &control).unwrap();
    println!("matched, smallest leak: {seeds} seeds, {:.0} s", begun.elapsed().as_secs_f64());
    leaks(&found);
    study.linearise_for(&usual);
    let begun = Instant::now();
    let layouts = study.best(&usual, &mass);
    let settings =
        ConfirmSettings { seeds: mismatched_seeds, duration_s: 8.0 * DAY_S, ..ConfirmSettings::default() };
    let found =
        mismatched(&study.claim(&usual, &mass, &layouts), &settings, &SearchControl::default(), &|_| ())
            .unwrap();
    println!("mismatched, railway weeks: {mismatched_seeds} seeds, {:.0} s", begun.elapsed().as_secs_f64());
    table(&found.layouts);
    let settings = ConfirmSettings { burn_in_s: 5.0 * DAY_S, ..settings };
    let found =
        detected_mismatched(&study.claim(&usual, &slow, &layouts), &settings, &detection, &control).unwrap();
    println!("mismatched, smallest leak: {mismatched_seeds} seeds");
    leaks(&found);
    // The paper's question: one thermometer beside the pressure, at each place.
    let singles: Vec<Vec<usize>> = (0..5).map(|place| vec![place, NAMES.len() - 1]).collect();
    let seeds = 2 * mismatched_seeds;
    let settings = ConfirmSettings { seeds, burn_in_s: 3.0 * DAY_S, ..settings };
    let found = mismatched(&study.claim(&usual, &mass, &singles), &settings, &control, &|_| ()).unwrap();
    println!("one thermometer, railway weeks: {seeds} seeds");
    table(&found.layouts);
    let settings = ConfirmSettings { burn_in_s: 5.0 * DAY_S, ..settings };
    let found =
        detected_mismatched(&study.claim(&usual, &slow, &singles), &settings, &detection, &control).unwrap();
    leaks(&found);
}
