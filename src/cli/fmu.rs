//! `cylwatch fmu`: a simulated cylinder or its monitor as a Functional Mock-up Unit, an archive that other programs simulate with.
use super::compile::CompiledArguments;
use super::input::Inputs;
use super::message::Messages;
use super::options::{EXPERT, HELP_FOOTER, OUTPUT};
use super::output::Target;
use crate::cosimulation::description::{About, MODEL_IDENTIFIER, Version, describe};
use crate::cosimulation::variable::Causality;
use crate::cosimulation::{CompiledPlant, FilmInputs, Instance, Resource};
use anyhow::{Context, bail};
use clap::{Args, ValueEnum};
use std::env::consts::{ARCH, DLL_PREFIX, DLL_SUFFIX, OS};
use std::io::{Cursor, Write};
use std::path::{Path, PathBuf};
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, ZipWriter};

/// What a unit is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum UnitKind {
    /// The simulated cylinder: surroundings and flows in, temperatures, pressure, mass and readings out.
    Plant,
    /// The monitor: readings in, estimate and verdict out.
    Monitor,
}

/// Version of the interface.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum InterfaceVersion {
    /// FMI 2.0.
    #[value(name = "2")]
    Two,
    /// FMI 3.0.
    #[value(name = "3")]
    Three,
}

/// What fixes the film outside of a plant.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Film {
    /// Wind and the air's temperature; the surface radiates.
    Wind,
    /// The coefficient, radiation included.
    Coefficient,
}

/// Arguments of `fmu`.
#[derive(Debug, Args)]
#[command(after_help = HELP_FOOTER, after_long_help = HELP)]
pub(crate) struct FmuArguments {
    /// What the unit is.
    #[arg(long, value_enum)]
    pub kind: UnitKind,
    /// Version of the Functional Mock-up Interface.
    #[arg(long, value_enum, default_value = "2")]
    pub fmi: InterfaceVersion,
    /// Input of a plant that fixes its film outside [default: wind].
    #[arg(long, value_enum)]
    pub film: Option<Film>,
    #[command(flatten)]
    pub compiled: CompiledArguments,
    /// File for the archive; - is stdout.
    #[arg(long, short, value_name = "FILE", help_heading = OUTPUT)]
    pub output: PathBuf,
    /// The library that goes into the archive [default: the one beside this program].
    #[arg(long, value_name = "FILE", help_heading = EXPERT)]
    pub library: Option<PathBuf>,
}

const HELP: &str = "\
The archive holds the description of the variables with their units, the library with the functions of the
interface (built by `cargo build --release -p cylwatch-fmi`), and the cylinder as sealed bytes. All values
are SI. Inputs hold for a step. The monitor takes a row a step: its readings at the beginning of the step,
NaN where one is missing.

Examples:
  cylwatch fmu nitrogen-20l --kind plant --fill-pressure-bar 200 --fill-temperature-degc 15 -o plant.fmu
  cylwatch fmu nitrogen-20l --kind monitor --fill-pressure-bar 200 --fill-temperature-degc 15 --fmi 3 -o monitor.fmu";

/// Step that a description proposes, s: rows closer together than a minute the monitor unites.
const STEP_S: f64 = 60.0;

/// Checks, compiles, writes.
pub(super) fn run(arguments: FmuArguments, messages: &Messages) -> anyhow::Result<()> {
    let FmuArguments { compiled, kind, fmi, film, output, library } = arguments;
    let library = library.map_or_else(beside_this_program, Ok)?;
    let mut paths = compiled.paths();
    paths.push(&library);
    let target = Target::checked(Some(&output), &paths)?;
    if kind == UnitKind::Monitor && film.is_some() {
        bail!("--film is an input of a plant: leave it out");
    }
    let library_bytes = std::fs::read(&library).with_context(|| missing(&library))?;
    let inputs = Inputs::default();
    let cylinder = compiled.compiled(&inputs, messages)?;
    let name = cylinder.vessel.name.clone();
    let resource = match kind {
        UnitKind::Monitor => Resource::Monitor(Box::new(cylinder)),
        UnitKind::Plant => Resource::Plant(Box::new(CompiledPlant {
            vessel: cylinder.vessel,
            sensors: cylinder.sensors,
            fill: cylinder.commissioning.fill,
            film: match film {
                Some(Film::Coefficient) => FilmInputs::Coefficient,
                Some(Film::Wind) | None => FilmInputs::Wind,
            },
        })),
    };
    let bytes = resource.to_bytes()?;
    let unit = Instance::new(&bytes)?;
    let what = match kind {
        UnitKind::Plant => "simulated cylinder",
        UnitKind::Monitor => "monitor of a cylinder",
    };
    let version = match fmi {
        InterfaceVersion::Two => Version::Two,
        InterfaceVersion::Three => Version::Three,
    };
    let about = About { name: &format!("{name}: {what}"), description: what, step_s: STEP_S };
    let description = describe(&unit, &about, version)?;
    let archive = archive(&[
        ("modelDescription.xml", description.as_bytes()),
        (&format!("binaries/{}/{MODEL_IDENTIFIER}{DLL_SUFFIX}", platform(version)?), &library_bytes),
        (&format!("resources/{}", Resource::FILE), &bytes),
        ("resources/provenance.txt", (inputs.provenance().lines() + "\n").as_bytes()),
    ])?;
    let count = |causality| unit.variables().iter().filter(|of| of.causality == causality).count();
    messages.say(&format!(
        "{} bytes: {name}, {what}, {} parameters, {} inputs, {} outputs",
        archive.len(),
        count(Causality::Parameter),
        count(Causality::Input),
        count(Causality::Output)
    ));
    target.write(&archive)
}

fn beside_this_program() -> anyhow::Result<PathBuf> {
    let program =
        std::env::current_exe().context("the place of this program is not known: give --library")?;
    Ok(program.with_file_name(format!("{DLL_PREFIX}cylwatch_fmi{DLL_SUFFIX}")))
}

fn missing(library: &Path) -> String {
    format!(
        "{}, the library for the archive, cannot be read: build it with `cargo build --release -p cylwatch-fmi`, or say with \
         --library where it is",
        library.display()
    )
}

/// Folder of the library for the machine at hand.
fn platform(version: Version) -> anyhow::Result<String> {
    Ok(match (version, ARCH, OS) {
        (Version::Two, "x86_64", "linux") => "linux64".to_owned(),
        (Version::Two, "x86_64", "windows") => "win64".to_owned(),
        (Version::Two, "x86_64", "macos") => "darwin64".to_owned(),
        (Version::Two, ..) => bail!("FMI 2.0 has no name for {ARCH} and {OS}: choose --fmi 3"),
        (Version::Three, _, "macos") => format!("{ARCH}-darwin"),
        (Version::Three, ..) => format!("{ARCH}-{OS}"),
    })
}

/// The archive: the same bytes of the same files, whenever it is written.
fn archive(files: &[(&str, &[u8])]) -> anyhow::Result<Vec<u8>> {
    let options = SimpleFileOptions::default()
        .compression_method(CompressionMethod::Deflated)
        .last_modified_time(DateTime::default())
        .unix_permissions(0o644);
    let mut writer = ZipWriter::new(Cursor::new(Vec::new()));
    for (name, bytes) in files {
        writer.start_file(*name, options)?;
        writer.write_all(bytes)?;
    }
    Ok(writer.finish()?.into_inner())
}
