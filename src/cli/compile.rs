//! `cylwatch compile`: a cylinder as bytes for a controller, which reads no files.
mod footprint;

use self::footprint::Footprint;
use super::fill::FillSource;
use super::format::Format;
use super::input::Inputs;
use super::message::Messages;
use super::monitor::{CylinderArguments, MonitorArguments, Options, Places, compiled};
use super::options::{FalseAlarmArguments, HELP_FOOTER, INPUT, LogArguments, OUTPUT, VesselAndLog};
use super::output::{Target, check_distinct};
use crate::detector::compiled::CompiledCylinder;
use crate::estimator::log::Quantity;
use crate::estimator::sensor::Sensor;
use crate::report::Provenance;
use crate::thermal::vessel::{Fill, Vessel};
use anyhow::{Context, bail};
use clap::{Args, ValueEnum};
use std::fmt::Write;
use std::path::{Path, PathBuf};

/// What the bytes are written as.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum CompiledFormat {
    /// The bytes.
    Bin,
    /// An array in C.
    C,
}

/// A cylinder whose monitor begins without a log.
#[derive(Debug, Args)]
pub(crate) struct CompiledArguments {
    /// Vessel: a TOML file, the name of a built-in one, or - for stdin.
    pub vessel: String,
    /// Names of the readings of a row, in their order; their sensors are typical.
    #[arg(long, value_name = "LIST", value_delimiter = ',', conflicts_with = "sensors", help_heading = INPUT,
        default_value = "shoulder,valve,pressure")]
    pub readings: Vec<String>,
    #[command(flatten)]
    pub false_alarms: FalseAlarmArguments,
    #[command(flatten)]
    pub cylinder: CylinderArguments,
}

impl CompiledArguments {
    /// The files that are read.
    pub(super) fn paths(&self) -> Vec<&Path> {
        let mut paths = vec![Path::new(&self.vessel)];
        paths.extend(self.cylinder.files().map(PathBuf::as_path));
        paths
    }

    /// The cylinder, checked.
    pub(super) fn compiled(self, inputs: &Inputs, messages: &Messages) -> anyhow::Result<CompiledCylinder> {
        if !self.cylinder.announced.is_empty() {
            bail!("--announced is a time of a log: leave it out");
        }
        let Self { vessel, readings, false_alarms, cylinder } = self;
        let log = VesselAndLog { vessel, log: String::new() };
        let options = MonitorArguments::of_another(log, cylinder, false_alarms, LogArguments::default());
        let options = Options::of(options, Places::default())?;
        let fill = match options.source {
            FillSource::Given(fill @ (Fill::Settled { .. } | Fill::Mass { .. })) => fill,
            _ => bail!(
                "without a log the fill is stated: give --fill-pressure-bar and --fill-temperature-degc, or --fill-mass-kg"
            ),
        };
        let typical = |vessel: &Vessel, full_pa: f64| typical(&readings, vessel, full_pa);
        compiled(&options, inputs, fill, typical, messages)
    }
}

/// Arguments of `compile`.
#[derive(Debug, Args)]
#[command(after_help = HELP_FOOTER, after_long_help = HELP)]
pub(crate) struct CompileArguments {
    #[command(flatten)]
    pub compiled: CompiledArguments,
    /// File for the bytes; - is stdout.
    #[arg(long, short, value_name = "FILE", help_heading = OUTPUT, required_unless_present = "footprint")]
    pub output: Option<PathBuf>,
    /// What they are written as [default: c for a file that ends in .c or .h, else bin].
    #[arg(long, value_enum, help_heading = OUTPUT, requires = "output")]
    pub format: Option<CompiledFormat>,
    /// Print what it takes on a controller: code, state, stack, arena, instructions; =csv or =json as data.
    #[arg(long, value_enum, value_name = "FORMAT", num_args = 0..=1, require_equals = true, help_heading = OUTPUT)]
    pub footprint: Option<Option<Format>>,
}

const HELP: &str = "\
A controller gets one row after the other: seconds, and the readings in the order of --readings or of the
file of sensors, in K and in Pa absolute, NaN where one is missing. Its monitor then says what
`cylwatch monitor` with the same options says of the same rows, bit for bit.

Examples:
  cylwatch compile nitrogen-20l --fill-pressure-bar 200 --fill-temperature-degc 15 -o cylinder.bin
  cylwatch compile nitrogen-20l --fill-pressure-bar 200 --fill-temperature-degc 15 --footprint
  cylwatch compile my-cylinder.toml --sensors sensors.toml --fill-mass-kg 4.5 -o cylinder.c";

/// Checks, compiles, writes.
pub(super) fn run(arguments: CompileArguments, messages: &Messages) -> anyhow::Result<()> {
    let CompileArguments { compiled, output, format, footprint } = arguments;
    let target =
        output.as_ref().map(|output| Target::checked(Some(output), &compiled.paths())).transpose()?;
    check_distinct(&[
        ("--output", target.as_ref()),
        ("--footprint", footprint.is_some().then_some(&Target::Stdout)),
    ])?;
    let ending = output.as_deref().and_then(Path::extension);
    let format = format.unwrap_or(match ending {
        Some(ending) if ending == "c" || ending == "h" => CompiledFormat::C,
        _ => CompiledFormat::Bin,
    });
    let inputs = Inputs::default();
    let cylinder = compiled.compiled(&inputs, messages)?;
    let bytes = cylinder.to_bytes()?;
    messages.say(&format!(
        "{} bytes: {}, readings {}",
        bytes.len(),
        cylinder.vessel.name,
        cylinder.sensors.iter().map(unit_of).collect::<Vec<_>>().join(", ")
    ));
    let taken = footprint
        .map(|format| Footprint::of(&cylinder, &bytes)?.written(format, &inputs.provenance()))
        .transpose()?;
    if let Some(target) = target {
        match format {
            CompiledFormat::Bin => target.write(&bytes)?,
            CompiledFormat::C => target.write(in_c(&bytes, &inputs.provenance()).as_bytes())?,
        }
    }
    taken.map_or(Ok(()), |text| Target::Stdout.write(text.as_bytes()))
}

/// Typical sensors of readings.
fn typical(readings: &[String], vessel: &Vessel, full_pa: f64) -> anyhow::Result<Vec<Sensor>> {
    let of = |name: &String| -> anyhow::Result<Sensor> {
        let sensor = Sensor::typical(name)
            .with_context(|| format!("--readings: the place of {name} is unknown, --sensors says it"))?;
        if let Some(needs) = sensor.misfit(vessel) {
            bail!("--readings: {name} needs {needs}, which the vessel does not have: leave it out");
        }
        match sensor.quantity() {
            Quantity::Pressure => Ok(Sensor::typical_transmitter(name, full_pa)?),
            Quantity::Temperature => Ok(sensor),
        }
    };
    readings.iter().map(of).collect()
}

fn unit_of(sensor: &Sensor) -> String {
    let unit = match sensor.quantity() {
        Quantity::Pressure => "Pa",
        Quantity::Temperature => "K",
    };
    format!("{} in {unit}", sensor.name)
}

/// The bytes as an array in C, for C99 and C++.
fn in_c(bytes: &[u8], provenance: &Provenance) -> String {
    let mut text = String::new();
    for head in provenance.lines().lines() {
        // A remark ends at `*/`.
        let _ = writeln!(text, "/* {} */", head.replace("*/", "* /"));
    }
    text.push_str("#include <stddef.h>\n\nconst unsigned char cw_cylinder[] = {\n");
    for line in bytes.chunks(20) {
        let numbers: Vec<String> = line.iter().map(u8::to_string).collect();
        let _ = writeln!(text, "    {},", numbers.join(", "));
    }
    let _ = writeln!(text, "}};\n\nconst size_t cw_cylinder_size = {};", bytes.len());
    text
}
