//! What does the ideal gas law get wrong about the pressure of a cooling cylinder?
//!
//! `cargo run --release --example scenario_4`
//!
//! The paper's fourth scenario, 60 to 28 °C in 14 h, with the reference equation of nitrogen and with the ideal gas.
//! Both cylinders were filled to 200 bar at 15 °C, so the ideal one holds more gas and still changes less.
#![allow(clippy::print_stdout)]

use cylwatch::report::aligned;
use cylwatch::thermal::fluid::Equation;
use cylwatch::thermal::simulate::{SimulationSettings, simulate};
use cylwatch::thermal::{scenario, vessel};

/// A cylinder that cools.
pub(crate) struct Cooling {
    /// Equation of state.
    pub equation: &'static str,
    /// Gas mass, kg.
    pub mass_kg: f64,
    /// Gauge at start and end, bar.
    pub pressure_bar: [f64; 2],
    /// Fall of the gauge per fall of the gas temperature, bar/K.
    pub slope_bar_k: f64,
}

/// Runs both.
pub(crate) fn run() -> anyhow::Result<[Cooling; 2]> {
    Ok([cooling("reference", Equation::Reference)?, cooling("ideal gas", Equation::IdealGas)?])
}

fn cooling(name: &'static str, equation: Equation) -> anyhow::Result<Cooling> {
    let mut vessel = vessel::presets::load("nitrogen-20l")?;
    vessel.fluid = vessel.fluid.with_equation(equation);
    let scenario = scenario::presets::load("cool-down")?;
    let run = simulate(&vessel, &scenario, &SimulationSettings::default(), &mut |_| ())?;
    let end = run.time_s.len() - 1;
    let fall_bar = (run.pressure_pa[0] - run.pressure_pa[end]) / 1e5;
    Ok(Cooling {
        equation: name,
        mass_kg: run.mass_kg[0],
        pressure_bar: [run.pressure_pa[0] / 1e5, run.pressure_pa[end] / 1e5],
        slope_bar_k: fall_bar / (run.gas_mean_k[0] - run.gas_mean_k[end]),
    })
}

fn main() -> anyhow::Result<()> {
    let rows = run()?.map(|Cooling { equation, mass_kg, pressure_bar: [start, end], slope_bar_k }| {
        let bar = |value: f64| format!("{value:.1}");
        vec![
            equation.into(),
            format!("{mass_kg:.3}"),
            bar(start),
            bar(end),
            bar(start - end),
            format!("{slope_bar_k:.3}"),
        ]
    });
    let header = ["equation", "gas / kg", "60 degC / bar", "end / bar", "fall / bar", "slope / (bar/K)"];
    print!("{}", aligned(&header, &rows));
    println!("\nThe ideal gas explains seven tenths of the fall; it would take the rest for a leak.");
    Ok(())
}
