//! `cylwatch commission`: thresholds of the leak statistics for one vessel, found by simulation.
mod arguments;
mod options;

pub(super) use arguments::CommissionArguments;

use super::input::Inputs;
use super::message::Messages;
use super::output::Target;
use super::progress::Progress;
use crate::detector::evidence::Tails;
use crate::detector::monitor::MonitorSettings;
use crate::evaluation::tails::{Campaign, FitSettings, commission, monitor_all};
use crate::evaluation::world::NominalVessel;
use crate::report::commission::{CommissionedVessel, VesselMark, Worlds, intention};
use crate::report::{Provenance, quoted};
use crate::thermal::units::BAR_PA;
use crate::thermal::units::DAY_S;
use crate::thermal::units::YEAR_S;
use anyhow::{Context, bail};
use options::Options;
use std::path::Path;

/// Simulates, fits, writes. A file appears at the end or not at all.
pub(super) fn run(arguments: CommissionArguments, messages: &Messages) -> anyhow::Result<()> {
    let output = arguments.output.clone();
    let options = Options::checked(arguments)?;
    let inputs = Inputs::default();
    let (specification, vessel, _) = inputs.vessel_specification(&options.vessel, messages)?;
    let mark = VesselMark::of(&specification, &vessel)?;
    let nominal = options.nominal(vessel)?;
    messages.say(&intention(&nominal, &options.campaign));
    let found = simulate(&nominal, &options, messages)?;
    let of_bar = |pressure_pa: f64| pressure_pa / BAR_PA;
    let commissioned = CommissionedVessel {
        vessel: mark,
        fill_pressure_bar: of_bar(nominal.fill_pa.1),
        full_scale_bar: of_bar(nominal.full_scale_pa),
        false_alarm_years: options.fit.mean_time_s / YEAR_S,
        rehearsal: options.fit.stretch < 1.0,
        worlds: Worlds::of(&options.campaign),
        found,
    };
    let provenance = Provenance { seed: Some(options.campaign.seed), ..inputs.provenance() };
    let document = serde_json::to_string_pretty(&commissioned.document(&provenance)?)? + "\n";
    let summary = commissioned.summary(&Tails::usual(&nominal.vessel, nominal.fill_pa.1))?;
    options.data.write(document.as_bytes())?;
    messages.say(&summary.to_text());
    messages.say(&format!("to use them: {}", usage(&options.vessel, &output)));
    Ok(())
}

fn simulate(
    nominal: &NominalVessel,
    options: &Options,
    messages: &Messages,
) -> anyhow::Result<crate::evaluation::tails::Commissioned> {
    let progress = Progress::new(messages);
    let show = |part: f64| progress.show("simulating cylinders", part);
    let requests = options.campaign.requests();
    let monitored = monitor_all(nominal, &requests, &MonitorSettings::default(), &show)?;
    progress.show("fitting", 1.0);
    Ok(commission(&monitored, &options.fit)?)
}

/// The command line of a monitor with these thresholds.
fn usage(vessel: &str, output: &Path) -> String {
    let named = |name: &str, other: &str| if name == "-" { other.to_owned() } else { quoted(name) };
    let (vessel, output) = (named(vessel, "VESSEL"), named(&output.to_string_lossy(), "FILE"));
    format!("cylwatch monitor {vessel} LOG --commissioned {output}")
}
