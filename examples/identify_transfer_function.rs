//! Table 1 of the paper rebuilt, and what its figures depend on: the choices of the identification and the mounting.
//!
//! `cargo run --release --example identify_transfer_function`
//!
//! `cylwatch reproduce` shows the table beside the published one; here each choice is changed by itself.
#![allow(clippy::print_stdout)]
use std::error::Error;

use cylwatch::estimator::identify::{Gain, Hold, Identified, IdentifyError, InitialState, Model, published};
use cylwatch::reproduce::table_1::{
    COUPLING, Place, Record, TABLE_1, first_order, largest_gain_of_an_offset, row,
    share_of_the_published_gain, validation,
};

fn table_1(course: &Record) -> Result<(), Box<dyn Error>> {
    println!("Table 1: scenarios 1 and 2, mean gas temperature from one thermometer");
    println!("                       pole/(1/s)    gain   fit/%  FPE/K2  MSE/K2  samples  sd(y)/K");
    for paper in &TABLE_1 {
        let model = match paper.place {
            Place::Shoulder => format!("{:10.6} {:7.4}", -published::POLE_PER_S, published::model().gain()),
            Place::Valve => format!("{:>10} {:>7}", "-", "-"),
        };
        println!(
            "{:9} published    {model}   {:5.2}  {:6.4}  {:6.4}  {:7.0}  {:7.1}",
            format!("{:?}", paper.place).to_lowercase(),
            paper.fit_percent,
            paper.fpe_k2,
            paper.mse_k2,
            paper.samples(2.0),
            paper.output_sd_k()
        );
        let found = row(course, paper.place)?;
        let (pole, s) = (found.derived.poles[0].real_per_s, &found.statistics);
        println!(
            "          simulated    {:10.6} {:7.4}   {:5.2}  {:6.4}  {:6.4}  {:7}  {:7.1}   pole in {:.6} to {:.6}",
            pole.value,
            found.model.gain(),
            s.fit_percent,
            s.fpe,
            s.mse,
            s.samples,
            course.gas_sd_k(),
            pole.low,
            pole.high
        );
    }
    println!(
        "The published FPE/MSE give these samples with 2 parameters; with 3, a start counted, half as many again.\n"
    );
    Ok(())
}

fn choices(course: &Record) -> Result<(), Box<dyn Error>> {
    println!("Shoulder: what the choices do to the pole (published 0.003021 1/s)");
    let line = |name: &str, course: &Record, hold, initial, gain| {
        let found = first_order(course, Place::Shoulder, hold, initial, gain)?;
        let (pole, s) = (found.model.den[1], &found.statistics);
        println!(
            "{name:48} {pole:.6} ({:+5.1} %)  gain {:.4}  fit {:5.2} %  MSE {:.4} K2",
            100.0 * (pole / published::POLE_PER_S - 1.0),
            found.model.gain(),
            s.fit_percent,
            s.mse
        );
        Ok::<(), IdentifyError>(())
    };
    let (first, zero) = (Hold::First, Hold::Zero);
    line("input straight, start estimated", course, first, InitialState::Estimated, Gain::Free)?;
    line("input straight, start zero", course, first, InitialState::Zero, Gain::Free)?;
    line("input straight, settled at the start", course, first, InitialState::Settled, Gain::Free)?;
    line("input held, start estimated", course, zero, InitialState::Estimated, Gain::Free)?;
    let gain = Gain::Fixed(published::model().gain());
    line("gain held at the published one", course, first, InitialState::Estimated, gain)?;
    for (name, scenario) in [("scenario 1 alone", "shock-cold"), ("scenario 2 alone", "tunnel-winter")] {
        let alone = Record::simulated(scenario, [COUPLING; 2])?;
        line(name, &alone, first, InitialState::Estimated, Gain::Free)?;
    }
    let jumping = Record::joined([COUPLING; 2], 0.01)?;
    line("joined without a minute between them", &jumping, first, InitialState::Estimated, Gain::Free)?;
    for coupling in [0.1, 0.2] {
        let mounted = Record::of_table_1([coupling; 2])?;
        let name = format!("reading {:.0} % of the way to the air", 100.0 * coupling);
        line(&name, &mounted, first, InitialState::Estimated, Gain::Free)?;
    }
    println!();
    causes_of_the_gain(course)
}

/// What could make the published gain, which cannot be physical: at rest every temperature is equal.
fn causes_of_the_gain(course: &Record) -> Result<(), Box<dyn Error>> {
    println!("Shoulder: what could make the published gain of {:.4}", published::model().gain());
    let line = |name: &str, found: &Identified| {
        let (pole, s) = (found.model.den[1], &found.statistics);
        let gain = found.model.gain();
        println!("{name:48} {pole:.6}  gain {gain:.4}  fit {:5.2} %  MSE {:.4} K2", s.fit_percent, s.mse);
    };
    if let Some((offset_k, found)) = largest_gain_of_an_offset(course) {
        line(&format!("largest of any offset: {offset_k:+.1} K"), &found);
    }
    let (share, found) = share_of_the_published_gain(course)?;
    line(&format!("reading {:.1} % of the way to 21 degC", 100.0 * share), &found);
    println!();
    Ok(())
}

fn mountings() -> Result<(), Box<dyn Error>> {
    println!("Fit in % by the share of the way to the air that the thermometer reads");
    let shares = [0.0, 0.05, 0.1, 0.15, 0.2, 0.3, 0.4];
    let mut lines = [String::from("shoulder"), String::from("valve   ")];
    for share in shares {
        let course = Record::of_table_1([share; 2])?;
        for (line, place) in lines.iter_mut().zip([Place::Shoulder, Place::Valve]) {
            line.push_str(&format!("  {:6.2}", row(&course, place)?.statistics.fit_percent));
        }
    }
    println!("share     {}", shares.map(|share| format!("{share:6.2}")).join("  "));
    println!("{}\n{}\n", lines[0], lines[1]);
    Ok(())
}

fn figure_3(identified: &Model) -> Result<(), Box<dyn Error>> {
    println!(
        "Figure 3: rms error in K (fit in %) on scenarios that the model was not identified from, by its start"
    );
    println!("{:38} {:>16} {:>16} {:>16}", "", "fitted", "first gas", "zero");
    for (name, scenario) in [("scenario 3", "ramp-warm"), ("scenario 4", "cool-down")] {
        let course = Record::simulated(scenario, [COUPLING; 2])?;
        for (which, model) in [("identified", identified), ("published", &published::model())] {
            let cells = validation(model, &course)?.map(|c| {
                let s = c.statistics;
                format!("{:7.3} ({:6.2})", s.mse.sqrt(), s.fit_percent)
            });
            println!("{:38} {:>16} {:>16} {:>16}", format!("{name}, {which}"), cells[0], cells[1], cells[2]);
        }
    }
    Ok(())
}

fn main() -> Result<(), Box<dyn Error>> {
    let course = Record::of_table_1([COUPLING; 2])?;
    table_1(&course)?;
    choices(&course)?;
    mountings()?;
    figure_3(&row(&course, Place::Shoulder)?.model)
}
