//! Validated options of `monitor`.
use super::arguments::{CylinderArguments, MonitorArguments};
use super::*;
use crate::cli::input::Spooled;
use crate::cli::options::LogArguments;
use crate::cli::output::check_distinct;
use crate::cli::unit_options::QuantityArguments;
use crate::detector::monitor::intake::IntakeSettings;
use crate::report::monitor::OperatingLimits;
use crate::thermal::units::DAY_S;
use crate::thermal::units::{BAR_PA, Dimension, ZERO_CELSIUS_K};
use std::ops::RangeInclusive;
use std::path::PathBuf;
use std::time::Duration;

/// Where the outputs of a run go; nowhere by default.
#[derive(Default)]
pub(in crate::cli) struct Places {
    /// Rows; `None`: nowhere.
    pub data: Option<Target>,
    /// Lines of events; `None`: words on stderr.
    pub events: Option<Target>,
    /// State to go on from and to save.
    pub state: Option<PathBuf>,
    /// Figure and report.
    pub views: Views,
}

/// Options that passed all checks that need no file to be read.
pub(in crate::cli) struct Options {
    pub vessel: String,
    pub log: String,
    /// Whether rows come one by one through a pipe, so that each result must go out at once.
    pub is_live: bool,
    /// Where the rows go; `None`: nowhere.
    pub data: Option<Target>,
    pub format: Format,
    pub views: Views,
    pub reading: LogArguments,
    pub sensors: Option<PathBuf>,
    pub fill: GivenFill,
    pub source: FillSource,
    pub learned_in: Option<PathBuf>,
    pub commissioned: Option<PathBuf>,
    pub limits: OperatingLimits,
    pub states_limit: bool,
    pub between_false_alarms_s: f64,
    pub lateness_s: f64,
    pub step_s: f64,
    pub events: Option<Target>,
    pub state: Option<PathBuf>,
    pub cold_start: bool,
    pub save_every: Duration,
    pub acknowledge: Option<String>,
    pub announced: Vec<Announced>,
    /// The rows to read, where they were taken out of a log of several cylinders.
    pub spooled: Option<Spooled>,
    /// Rows at the beginning of the log that the state has taken in; `None`: their times tell.
    pub known_rows: Option<u64>,
}

impl Options {
    /// Checks places and numbers.
    pub(super) fn checked(arguments: MonitorArguments) -> anyhow::Result<Self> {
        let mut inputs = arguments.inputs.paths()?;
        inputs.extend(arguments.cylinder.files().map(PathBuf::as_path));
        let data = Target::checked(arguments.data.output.as_deref(), &inputs)?;
        let events = arguments.events.as_deref();
        let events = events.map(|path| Target::checked(Some(path), &inputs)).transpose()?;
        let state = arguments.state.as_deref();
        let state = state.map(|path| Target::checked(Some(path), &inputs)).transpose()?;
        check_distinct(&[
            ("--output", Some(&data)),
            ("--events", events.as_ref()),
            ("--state", state.as_ref()),
        ])?;
        let state = state.map(state_file).transpose()?;
        let others: Vec<&Target> = std::iter::once(&data).chain(&events).collect();
        let views = Views::checked(&arguments.views, &inputs, &others)?;
        let places = Places { data: Some(data), events, state, views };
        Self::of(arguments, places)
    }

    /// The same with checked places.
    pub(in crate::cli) fn of(arguments: MonitorArguments, places: Places) -> anyhow::Result<Self> {
        let MonitorArguments { inputs, cylinder, reading, .. } = arguments;
        let CylinderArguments { given, sensors, fill, announced, commissioned, learned_in } = cylinder;
        let Places { data, events, state, views } = places;
        let time = |option: &str| given.si(option, Dimension::Time);
        let from_zero = |option: &str| given.si_from_zero(option, Dimension::Time);
        let save_every_s = time("save-every")?.unwrap_or(600.0).min(365.0 * DAY_S);
        Ok(Self {
            source: fill.source()?,
            format: arguments.data.format(),
            limits: limits(&given)?,
            states_limit: given.si("limit", Dimension::Pressure)?.is_some(),
            lateness_s: from_zero("lateness")?.unwrap_or(0.0),
            step_s: from_zero("step")?.unwrap_or_else(|| IntakeSettings::default().step_s),
            save_every: Duration::from_secs_f64(save_every_s),
            between_false_alarms_s: arguments.false_alarms.mean_time_s(),
            cold_start: arguments.cold_start,
            acknowledge: arguments.acknowledge,
            announced: announced.iter().map(|text| Announced::parse(text)).collect::<anyhow::Result<_>>()?,
            spooled: None,
            known_rows: None,
            is_live: inputs.log == "-"
                || Path::new(&inputs.log).metadata().is_ok_and(|found| !found.is_file()),
            vessel: inputs.vessel,
            log: inputs.log,
            data,
            views,
            reading,
            sensors: sensors.sensors,
            fill,
            learned_in,
            commissioned,
            events,
            state,
        })
    }

    /// The same for a caller: nothing is written.
    pub(super) fn kept(self) -> anyhow::Result<Self> {
        Ok(Self { data: Some(Target::Memory), events: Some(Target::Memory), views: Views::kept(), ..self })
    }

    /// Whether the rows are a table that grows from run to run.
    pub(super) fn has_table(&self) -> bool {
        self.state.is_some() && self.format == Format::Csv && matches!(self.data, Some(Target::File(_)))
    }
}

/// What a coldest night may be, K.
const COLDEST_K: RangeInclusive<f64> = 173.15..=333.15;

fn limits(given: &QuantityArguments<super::arguments::MonitorQuantities>) -> anyhow::Result<OperatingLimits> {
    let coldest_k = given.si("coldest", Dimension::Temperature)?.unwrap_or(ZERO_CELSIUS_K - 25.0);
    if !COLDEST_K.contains(&coldest_k) {
        let degc = coldest_k - ZERO_CELSIUS_K;
        bail!("--coldest of {degc} °C: it must be from -100 to 60 °C, the coldest that the cylinder will be");
    }
    Ok(OperatingLimits {
        limit_pa: given.si("limit", Dimension::Pressure)?.unwrap_or(160.0 * BAR_PA),
        coldest_k,
        next_service_s: given.si("next-service", Dimension::Time)?.unwrap_or(30.0 * DAY_S),
    })
}

fn state_file(target: Target) -> anyhow::Result<PathBuf> {
    match target {
        Target::File(path) => Ok(path),
        Target::Stdout | Target::Device(_) | Target::Memory => {
            bail!("--state must be a file: a state is read before the run and replaced after it")
        }
    }
}
