//! The monitor of a run: made from the first rows, or restored from a state.
use super::resume::refused;
use super::state::{Refusal, State};
use super::*;
use crate::detector::compiled::CompiledCylinder;
use crate::detector::evidence::Tails;
use crate::detector::monitor::alarm::AlarmSettings;
use crate::detector::monitor::{Limits, Monitor, MonitorSettings};
use crate::detector::prognosis::{Contents, ReactionSettings};
use crate::estimator::log::Quantity;
use crate::estimator::sensor::Sensor;
use crate::report::monitor::OperatingLimits;
use crate::thermal::units::{BAR_PA, QUOTED_K, ZERO_CELSIUS_K};
use crate::thermal::vessel::{Fill, Vessel};

/// A monitor and what a run must know beside it.
pub(super) struct Engine {
    /// The monitor.
    pub monitor: Monitor,
    /// Pressure of the full cylinder at 15 °C, Pa.
    pub full_pa: f64,
    /// Whether all was at rest at the first row.
    pub settled: bool,
    /// Whether the fill was stated, not read.
    pub stated: bool,
    /// Rows that were read to find the fill.
    pub first: Vec<Row>,
}

/// Settings of the monitor of a cylinder that was at rest at its first row, or was not.
fn settings(options: &Options, beginning: &RunStart, settled: bool) -> anyhow::Result<MonitorSettings> {
    let defaults = MonitorSettings::default();
    let limits = options.limits;
    let own = beginning.commissioned.as_ref().map(|commissioned| commissioned.found.tails()).transpose()?;
    Ok(MonitorSettings {
        tails: own,
        observer: fill::settings(defaults.observer, settled),
        false_alarm_interval_s: options.between_false_alarms_s,
        limits: Limits { operational_pa: limits.limit_pa, coldest_k: limits.coldest_k, ..defaults.limits },
        intake: crate::detector::monitor::intake::IntakeSettings {
            lateness_s: options.lateness_s,
            step_s: options.step_s,
            ..defaults.intake
        },
        reaction: ReactionSettings { next_service_s: limits.next_service_s, ..defaults.reaction },
        alarms: AlarmSettings::with_limit(limits.limit_pa),
        ..defaults
    })
}

/// Refuses limits at which the gas has no state: carbon dioxide condenses on a cold night.
fn check_limits(options: &Options, contents: &Contents, mass_kg: f64) -> anyhow::Result<()> {
    let OperatingLimits { limit_pa, coldest_k, .. } = options.limits;
    let states = contents
        .pressure_pa(mass_kg, coldest_k)
        .and_then(|_| contents.mass_kg(limit_pa, coldest_k))
        .and_then(|_| contents.mass_kg(limit_pa, QUOTED_K));
    states.map(|_| ()).with_context(|| {
        format!(
            "state --limit-bar and --coldest-degc for this cylinder: at {} bar or {} \u{b0}C its gas has no state",
            limit_pa / BAR_PA,
            coldest_k - ZERO_CELSIUS_K
        )
    })
}

/// Pressure of the full cylinder at 15 °C, Pa, which limits are held against.
fn full_pa(options: &Options, contents: &Contents, mass_kg: f64, messages: &Messages) -> anyhow::Result<f64> {
    check_limits(options, contents, mass_kg)?;
    let full_pa = contents.pressure_pa(mass_kg, QUOTED_K)?;
    let limit_pa = options.limits.limit_pa;
    if full_pa < limit_pa && !options.states_limit {
        let [full, limit] = [full_pa, limit_pa].map(|pressure_pa| pressure_pa / BAR_PA);
        messages.caution(&format!(
            "the fill makes {full:.1} bar at 15 °C, below the usual limit of {limit:.0} bar: if this vessel has \
             another one, state it with --limit-bar"
        ));
    }
    Ok(full_pa)
}

/// A cylinder whose monitor begins with a fill that is stated, before there are rows. `typical` gives the sensors where no file does,
/// from the vessel and the pressure of its fill at 15 °C, Pa.
pub(in crate::cli) fn compiled(
    options: &Options,
    inputs: &Inputs,
    fill: Fill,
    typical: impl FnOnce(&Vessel, f64) -> anyhow::Result<Vec<Sensor>>,
    messages: &Messages,
) -> anyhow::Result<CompiledCylinder> {
    let beginning = RunStart::find(options, inputs, messages)?;
    let mut settings = settings(options, &beginning, options.fill.is_settled())?;
    let vessel = beginning.vessel;
    let learned = options.learned_in.as_deref();
    let learned = learned.map(|path| start::learned(inputs, path, &vessel)).transpose()?;
    let commissioning = options.fill.commissioning(fill, &vessel, QUOTED_K, 0.0)?;
    let mass_kg = commissioning.mass_kg(&vessel, QUOTED_K)?;
    let full_pa = full_pa(options, &Contents::of(&vessel), mass_kg, messages)?;
    // A controller knows no built-in vessel, and so not what thresholds this one has.
    settings.tails.get_or_insert_with(|| Tails::of(&vessel, full_pa));
    if let Some(commissioned) = &beginning.commissioned {
        commissioned.cautions(full_pa).iter().for_each(|caution| messages.caution(caution));
    }
    let sensors = match options.sensors.as_deref() {
        Some(path) => selection::read(inputs, path)?,
        None => typical(&vessel, full_pa)?,
    };
    let cylinder = CompiledCylinder { vessel, sensors, commissioning, settings, learned };
    // Whatever a controller would refuse is told here.
    cylinder.monitor()?;
    Ok(cylinder)
}

impl Engine {
    /// A monitor that continues from a state.
    pub(super) fn restored(
        options: &Options,
        beginning: &RunStart,
        selection: &Selection,
        state: &State,
    ) -> anyhow::Result<Self> {
        let settings = settings(options, beginning, state.settled)?;
        let restored = Monitor::restore(&beginning.vessel, &selection.sensors, &settings, &state.monitor);
        let path = options.state.as_deref().unwrap_or(Path::new("the state"));
        let monitor = restored.map_err(|error| refused(path, &Refusal::Monitor(error)))?;
        Ok(Self {
            monitor,
            full_pa: state.full_pa,
            settled: state.settled,
            stated: state.stated,
            first: Vec::new(),
        })
    }

    /// A monitor that begins with the first rows.
    pub(super) fn cold(
        options: &Options,
        inputs: &Inputs,
        beginning: &RunStart,
        selection: &mut Selection,
        log: &mut LogInput,
        messages: &Messages,
    ) -> anyhow::Result<Self> {
        let vessel = &beginning.vessel;
        let learned = options.learned_in.as_deref();
        let learned = learned.map(|path| start::learned(inputs, path, vessel)).transpose()?;
        let (first, fill) = start::first_rows(&mut log.reader, selection, options.source, vessel)?;
        let first_k = selection.mean_temperature_k(first.first());
        let begin = || first.last().map_or_else(String::new, |row| log.reader.place(row));
        let commissioning =
            options.fill.commissioning(fill, vessel, first_k, selection.pressure_offset_sd_pa());
        let mut commissioning = commissioning.with_context(begin)?;
        let mass_kg = commissioning.mass_kg(vessel, first_k)?;
        // What the cylinder was filled with is the mass, not a pressure at whatever temperature the first row has.
        if matches!(commissioning.fill, Fill::Pressure { .. }) {
            commissioning.fill = Fill::Mass { mass_kg };
        }
        let contents = Contents::of(vessel);
        let fill_pa = contents.pressure_pa(mass_kg, first_k).with_context(|| {
            format!(
                "{}: the fill of {mass_kg:.3} kg does not fit the vessel: look at vessel and fill",
                begin()
            )
        })?;
        if let (Some(row), Some(channel)) = (first.last(), selection.first_of(Quantity::Pressure))
            && let Some(doubt) =
                fill::misfit(mass_kg, first_k, fill_pa, row.readings[channel]).with_context(begin)?
        {
            messages.caution(&format!("{}: {doubt}", begin()));
        }
        let full_pa = full_pa(options, &contents, mass_kg, messages)?;
        let settings = settings(options, beginning, options.fill.is_settled())?;
        let (vessel, sensors) = (vessel.clone(), selection.sensors.clone());
        let cylinder = CompiledCylinder { vessel, sensors, commissioning, settings, learned };
        let monitor = cylinder.monitor()?;
        let stated = options.source != FillSource::FirstPressure;
        Ok(Self { monitor, full_pa, settled: options.fill.is_settled(), stated, first })
    }
}
