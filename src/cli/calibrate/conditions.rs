//! What happened to the cylinder while a log was recorded: a scenario, or the log's own air.
use super::air::drawn;
use super::quantities::Quantities;
use super::recording::{AMBIENT, Recording};
use crate::cli::fill::{self, FillSource, GivenFill};
use crate::estimator::observer::ObserverSettings;
use crate::estimator::observer::cylinder::Cylinder;
use crate::estimator::sensor::{Parameter, ParameterKind};
use crate::thermal::scenario::{AxialVariation, Initial, OutsideFilm, Scenario, Series, Surroundings};
use crate::thermal::units::ZERO_CELSIUS_K;
use crate::thermal::vessel::Fill;
use crate::thermal::vessel::Vessel;
use anyhow::{Context, bail};

/// Gaps up to so many usual intervals are bridged.
const BRIDGED_INTERVALS: f64 = 20.0;
/// Least noise of a reading of the air, K: that of a logger that rounds to 0.1 K.
const AIR_SD_K: f64 = 0.03;
/// Difference of air and cylinder in the first row that is no rest, K.
const REST_K: f64 = 2.0;
/// Change of the air between two rows that is a jump, K.
const JUMP_K: f64 = 5.0;
/// Standard deviation of the temperature that the first readings, or a scenario, stand for, K.
const SETTLED_SD_K: f64 = 1.0;
const UNSETTLED_SD_K: f64 = 5.0;

/// What happened, and how well its start is known.
pub(super) struct Conditions {
    pub scenario: Scenario,
    /// Standard deviation of the temperature of wall and gas at the start, K.
    pub temperature_sd_k: f64,
    /// Relative standard deviation of the gas mass.
    pub mass_sd: f64,
    /// What is known of the offset of the air's thermometer, K; `None`: it is certain, or a scenario says what the air does.
    pub air_offset: Option<Parameter>,
    /// What was taken from where, in words.
    pub words: String,
    /// What one should know of it.
    pub doubts: Vec<String>,
}

/// How circumstances are made.
pub(super) struct Exposure<'a> {
    pub quantities: &'a Quantities,
    pub fill: &'a GivenFill,
    pub source: FillSource,
}

impl Exposure<'_> {
    /// Those of a log whose air was measured; its time is 0 in the first row.
    pub(super) fn of_log(&self, recording: &Recording, vessel: &Vessel) -> anyhow::Result<Conditions> {
        let first_k = recording.first_k();
        let given = match (self.source, recording.first_pa()) {
            (FillSource::Given(fill), _) => fill,
            (FillSource::FirstPressure, Some(pressure_pa)) => Fill::Pressure { pressure_pa },
            (FillSource::FirstPressure, None) => bail!(
                "{}: the log has no pressure, so that nothing says how much gas there is: give \
                 --fill-pressure-bar and --fill-temperature-degc, or --fill-mass-kg",
                recording.name
            ),
        };
        let commissioning = self.fill.commissioning(given, vessel, first_k, 0.0)?;
        let mass_kg = commissioning.mass_kg(vessel, first_k)?;
        let of_air = recording.air_sensor.parameters().iter();
        let air_offset = of_air.copied().find(|of| of.kind == ParameterKind::Offset);
        let mut air = self.air(recording)?;
        if let Some(certain) = air_offset.filter(|offset| offset.sd == 0.0) {
            air = air.shifted(-certain.mean)?;
        }
        let mut doubts = misfit(recording, vessel, mass_kg)?;
        doubts.extend(jump(recording));
        let apart_k = air.at(0.0) - first_k;
        if !commissioning.settled && apart_k.abs() > REST_K {
            doubts.push(format!(
                "{}: the air is {apart_k:+.1} K from the cylinder in the first row: wall and gas need not have one \
                 temperature then; begin the log at rest, or give a scenario",
                recording.name
            ));
        }
        let (film, of_film) = self.film()?;
        let radiation_k = matches!(film, OutsideFilm::Convection { .. }).then(|| air.clone());
        let words = format!(
            "{}: air from the column {AMBIENT}, {of_film}; {}, wall and gas at the {:.2} °C that the first readings say",
            recording.name,
            mass_source(given, mass_kg),
            first_k - ZERO_CELSIUS_K
        );
        let scenario = Scenario {
            name: recording.name.clone(),
            initial: Initial {
                fill: Fill::Mass { mass_kg },
                wall_temperature_k: first_k,
                gas_temperature_k: first_k,
            },
            surroundings: Surroundings {
                air_k: air,
                film,
                radiation_k,
                sun: None,
                axial: AxialVariation::default(),
            },
            flows: Vec::new(),
            pressure_limits_pa: Vec::new(),
            sensors: Vec::new(),
            duration_s: recording.end_s().max(1.0),
            sample_time_s: 60.0,
        };
        Ok(Conditions {
            scenario,
            temperature_sd_k: if commissioning.settled { SETTLED_SD_K } else { UNSETTLED_SD_K },
            mass_sd: commissioning.mass_sd,
            air_offset: air_offset.filter(|offset| offset.sd > 0.0),
            words,
            doubts,
        })
    }

    /// Those of a scenario; a fill that was given goes before the scenario's.
    pub(super) fn of_scenario(
        &self,
        recording: &Recording,
        mut scenario: Scenario,
        vessel: &Vessel,
    ) -> anyhow::Result<Conditions> {
        if self.quantities.film_w_m2_k()?.is_some() || self.quantities.wind_m_s()?.is_some() {
            bail!(
                "--film and --wind are for logs without a scenario: leave them out, or leave out --scenario"
            );
        }
        let first_k = scenario.initial.wall_temperature_k;
        let mut of_fill = "its fill".to_owned();
        let mass_of = |fill: Fill| -> anyhow::Result<f64> {
            Ok(self.fill.commissioning(fill, vessel, first_k, 0.0)?.mass_kg(vessel, first_k)?)
        };
        let mass_kg = match self.source {
            FillSource::Given(fill) => {
                let mass_kg = mass_of(fill)?;
                of_fill = mass_source(fill, mass_kg);
                scenario.initial.fill = Fill::Mass { mass_kg };
                mass_kg
            }
            FillSource::FirstPressure => mass_of(scenario.initial.fill)?,
        };
        // A pressure that a scenario states is not read off a first row: it is as sure as a stated mass.
        let commissioning = self.fill.commissioning(Fill::Mass { mass_kg }, vessel, first_k, 0.0)?;
        let mut doubts = misfit(recording, vessel, mass_kg)?;
        if !recording.air.is_empty() {
            doubts.push(format!(
                "{}: the scenario {} says what the air does; the column {AMBIENT} is not used",
                recording.name, scenario.name
            ));
        }
        let words = format!("{}: scenario `{}` with {of_fill}", recording.name, scenario.name);
        let mass_sd = commissioning.mass_sd;
        Ok(Conditions { scenario, temperature_sd_k: SETTLED_SD_K, mass_sd, air_offset: None, words, doubts })
    }

    fn film(&self) -> anyhow::Result<(OutsideFilm, String)> {
        let wind =
            |wind_m_s: f64| OutsideFilm::Convection { wind_m_s: Series::constant(wind_m_s), multiplier: 1.0 };
        Ok(match (self.quantities.film_w_m2_k()?, self.quantities.wind_m_s()?) {
            (Some(_), Some(_)) => bail!("--film and --wind both say the outside film: keep one"),
            (Some(film), None) => (
                OutsideFilm::Coefficient { film_w_m2_k: Series::constant(film) },
                format!("film {film} W/(m² K) with radiation"),
            ),
            (None, Some(wind_m_s)) => {
                (wind(wind_m_s), format!("film of a wind of {wind_m_s} m/s, and radiation"))
            }
            (None, None) => (wind(0.0), "film of still air, and radiation".to_owned()),
        })
    }

    /// The air straight between its readings.
    fn air(&self, recording: &Recording) -> anyhow::Result<Series> {
        let (name, readings) = (&recording.name, &recording.air);
        let Some((&(first_s, _), &(last_s, _))) = readings.first().zip(readings.last()) else {
            bail!(
                "{name}: nothing says what the air does: the log has no reading {AMBIENT}, and there is no scenario; \
                 give --map {AMBIENT}_degc=THEIRS (of a simulated log its {AMBIENT}_degc), or --scenario"
            );
        };
        let usual_s = BRIDGED_INTERVALS * recording.interval_s;
        let longest_s = self.quantities.longest_gap_s()?.unwrap_or(usual_s);
        let ends = [(0.0, first_s), (last_s, recording.end_s())];
        let between = readings.windows(2).map(|pair| (pair[0].0, pair[1].0));
        if let Some((from_s, to_s)) = between.chain(ends).find(|(from_s, to_s)| to_s - from_s > longest_s) {
            bail!(
                "{name}: the air is missing from {from_s:.0} s to {to_s:.0} s, longer than {longest_s:.1} s: cut the log \
                 there, give a scenario, or allow the gap by --longest-gap-min"
            );
        }
        let (time_s, air_k) = drawn(readings, AIR_SD_K).into_iter().unzip();
        Series::try_new(time_s, air_k).with_context(|| name.clone())
    }
}

/// A change of the air that is over before the next row: when within the interval is unknown.
fn jump(recording: &Recording) -> Option<String> {
    let changes = recording.air.windows(2).map(|pair| (pair[0].0, pair[1].0, pair[1].1 - pair[0].1));
    let (from_s, to_s, change_k) = changes.max_by(|a, b| a.2.abs().total_cmp(&b.2.abs()))?;
    (change_k.abs() > JUMP_K).then(|| {
        format!(
            "{}: the air changes by {change_k:+.1} K between the rows at {from_s:.0} s and {to_s:.0} s, and when it did is not \
             known: the inside film suffers first; log the air more often, or say the moment in a scenario",
            recording.name
        )
    })
}

/// Where the gas mass comes from.
fn mass_source(fill: Fill, mass_kg: f64) -> String {
    match fill {
        Fill::Mass { .. } => format!("{mass_kg:.3} kg of gas as given"),
        Fill::Settled { .. } => format!("{mass_kg:.3} kg of gas by the fill as given"),
        Fill::Pressure { .. } => format!("{mass_kg:.3} kg of gas by the first pressure"),
    }
}

/// Doubts about a fill beside the first pressure.
fn misfit(recording: &Recording, vessel: &Vessel, mass_kg: f64) -> anyhow::Result<Vec<String>> {
    let Some(read_pa) = recording.first_pa() else { return Ok(Vec::new()) };
    let first_k = recording.first_k();
    let mut cylinder = Cylinder::new(vessel, &recording.sensors, &ObserverSettings::default())?;
    let fill_pa = cylinder.model().settled_pressure_pa(mass_kg, first_k)?;
    let doubt = fill::misfit(mass_kg, first_k, fill_pa, read_pa).with_context(|| recording.name.clone())?;
    Ok(doubt.map(|doubt| format!("{}: {doubt}", recording.name)).into_iter().collect())
}
