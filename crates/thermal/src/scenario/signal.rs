//! Signals against time as a file states them: a constant, changes in order, a table, or a CSV column.
use schemars::JsonSchema;
use serde::Deserialize;

use super::series::Series;
use crate::ThermalError;
use crate::document::{Problem, check, column};
use crate::units::Dimension;

/// Largest mass flow, kg/s.
pub(super) const MASS_FLOW_MAX_KG_S: f64 = 100.0;

/// Reads a file that a scenario names; relative names count from the scenario's folder.
pub(super) type Files<'f> = &'f dyn Fn(&str) -> std::io::Result<String>;

/// A column of a CSV file with a column `time_s`, `time_min`, `time_h` or `time_d`.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
pub(crate) struct CsvSpec {
    /// File, relative to the scenario.
    pub file: String,
    /// Column; its suffix is the unit.
    pub column: String,
}

/// A change of any signal in SI.
#[derive(Clone, Copy, Debug)]
pub(super) struct Change {
    at_s: f64,
    over_s: Option<f64>,
    to: f64,
    /// Field name of `to`, for paths.
    to_field: &'static str,
}

macro_rules! change {
    ($(#[$doc:meta])* $name:ident, $to:ident) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
        pub struct $name {
            /// Time at which it begins.
            pub at_s: f64,
            /// Time that it takes; a step by default.
            pub over_s: Option<f64>,
            /// New value.
            pub $to: f64,
        }

        impl From<&$name> for Change {
            fn from(change: &$name) -> Self {
                Self { at_s: change.at_s, over_s: change.over_s, to: change.$to, to_field: stringify!($to) }
            }
        }
    };
}

macro_rules! table {
    ($(#[$doc:meta])* $name:ident, $value:ident) => {
        $(#[$doc])*
        #[derive(Clone, Debug, Deserialize, JsonSchema)]
        pub struct $name {
            /// Times; the same time twice is a jump.
            pub time_s: Vec<f64>,
            /// Values at these times, linear between them.
            pub $value: Vec<f64>,
        }

        impl $name {
            pub(super) fn columns(&self) -> (&[f64], &[f64], &'static str) {
                (&self.time_s, &self.$value, stringify!($value))
            }
        }
    };
}

change!(
    /// Step or ramp of a temperature.
    TemperatureChange, to_k);
change!(
    /// Step or ramp of a film coefficient.
    FilmChange, to_w_m2_k);
change!(
    /// Step or ramp of the wind speed.
    WindChange, to_m_s);
change!(
    /// Step or ramp of the irradiance.
    IrradianceChange, to_w_m2);
table!(
    /// Air temperature against time.
    AirTable, air_k);
table!(
    /// Film coefficient against time.
    FilmTable, film_w_m2_k);
table!(
    /// Wind speed against time.
    WindTable, wind_m_s);
table!(
    /// Radiation temperature against time.
    RadiationTable, radiation_k);
table!(
    /// Irradiance against time.
    IrradianceTable, irradiance_w_m2);
table!(
    /// Mass flow against time.
    FlowTable, flow_kg_s);
table!(
    /// Temperature against time.
    TemperatureTable, temperature_k);
table!(
    /// Absolute pressure against time.
    PressureTable, pressure_pa);

/// One signal in whatever form it was given.
pub(super) struct Signal<'a> {
    /// Path of the table it stands in, e.g. `ambient`.
    pub of: &'a str,
    /// Name in keys, e.g. `air`.
    pub name: &'static str,
    pub dimension: Dimension,
    pub constant: Option<f64>,
    pub changes: Vec<Change>,
    pub table: Option<(&'a [f64], &'a [f64], &'static str)>,
    pub csv: Option<&'a CsvSpec>,
}

impl Signal<'_> {
    /// The series in a scenario of a duration, s, or `None` if the file says nothing about this signal.
    pub(super) fn series(&self, files: Files<'_>, duration_s: f64) -> Result<Option<Series>, ThermalError> {
        let path = |form: &str| format!("{}.{}{form}", self.of, self.name);
        let constant = path(&format!("_{}", crate::units::si_suffix(self.dimension)));
        let others = [
            (path("_change[0]"), !self.changes.is_empty()),
            (path("_table"), self.table.is_some()),
            (path("_csv"), self.csv.is_some()),
        ];
        let given: Vec<&String> = others.iter().filter(|(_, given)| *given).map(|(path, _)| path).collect();
        if let [first, second, ..] = given[..] {
            return Err(check::conflict(second, &last(first), "say the signal in one form"));
        }
        if let (Some(_), [other]) = (self.constant, &given[..])
            && self.changes.is_empty()
        {
            return Err(check::conflict(&constant, &last(other), "say the signal in one form"));
        }
        if let Some(table) = self.table {
            return self.series_of_table(&path("_table"), table).map(Some);
        }
        if let Some(csv) = self.csv {
            return self.series_of_csv(&path("_csv"), csv, files, duration_s).map(Some);
        }
        let Some(value) = self.constant else {
            if self.changes.is_empty() {
                return Ok(None);
            }
            return Err(check::missing(&constant, "say the value before the first change"));
        };
        self.check(&constant, value)?;
        self.series_of_changes(&path("_change"), value, duration_s).map(Some)
    }

    /// Value before everything that changes it.
    pub(super) fn first(&self) -> Option<f64> {
        self.constant
    }

    fn check(&self, path: &str, value: f64) -> Result<f64, ThermalError> {
        match self.dimension {
            Dimension::Temperature => check::temperature_k(path, value),
            Dimension::Pressure => check::pressure_pa(path, value),
            Dimension::MassFlow => {
                let bound = "between 0 and 100 kg/s";
                let remedy = "the direction is clear from [[leak]], [[discharge]] or [[refill]]; check the unit, _g_h or _kg_s";
                check::within(path, value, (0.0, MASS_FLOW_MAX_KG_S), bound, remedy)
            }
            Dimension::Film => {
                let bound = "between 0 and 10000 W/m2/K";
                let remedy = "0 lets no heat through, still air has about 8, wind 20 to 100";
                check::within(path, value, (0.0, 1e4), bound, remedy)
            }
            Dimension::Speed => {
                let bound = "between 0 and 200 m/s";
                check::within(path, value, (0.0, 200.0), bound, "0 is still air")
            }
            _ => {
                let bound = "between 0 and 2000 W/m2";
                check::within(path, value, (0.0, 2_000.0), bound, "the sun at noon gives about 1000")
            }
        }
    }

    fn series_of_changes(&self, path: &str, constant: f64, duration_s: f64) -> Result<Series, ThermalError> {
        if self.changes.is_empty() {
            return Ok(Series::constant(constant));
        }
        let (mut time_s, mut value) = (Vec::new(), Vec::new());
        let (mut free_s, mut level) = (0.0, constant);
        let mut last_step_s = f64::NEG_INFINITY;
        for (i, change) in self.changes.iter().enumerate() {
            let path = |field: &str| format!("{path}[{i}].{field}");
            self.check(&path(change.to_field), change.to)?;
            check::not_negative(&path("at_s"), change.at_s, "time counts from the start of the scenario")?;
            let over_s = change.over_s.unwrap_or(0.0);
            check::not_negative(
                &path("over_s"),
                over_s,
                "say how long the ramp takes, or leave it out for a step",
            )?;
            if change.at_s > duration_s {
                let bound = format!("at most {}, the duration", check::time_text(duration_s));
                let remedy = "check the unit, _s, _min or _h, or let the scenario last longer";
                return Err(check::broken(&path("at_s"), change.at_s, &bound, remedy));
            }
            if change.at_s < free_s {
                let bound = format!("at least {}, the end of the change before", check::time_text(free_s));
                return Err(check::broken(&path("at_s"), change.at_s, &bound, "sort the changes by time"));
            }
            if over_s == 0.0 && change.at_s == last_step_s {
                let bound =
                    format!("later than {}, the time of the step before", check::time_text(last_step_s));
                return Err(check::broken(&path("at_s"), change.at_s, &bound, "merge the two steps"));
            }
            if time_s.last() != Some(&change.at_s) {
                time_s.push(change.at_s);
                value.push(level);
            }
            time_s.push(change.at_s + over_s);
            value.push(change.to);
            if over_s == 0.0 {
                last_step_s = change.at_s;
            }
            (free_s, level) = (change.at_s + over_s, change.to);
        }
        Series::try_new(time_s, value)
    }

    fn series_of_table(&self, path: &str, table: (&[f64], &[f64], &str)) -> Result<Series, ThermalError> {
        let (time_s, value, field) = table;
        let values = format!("{path}.{field}");
        if time_s.is_empty() {
            return Err(check::broken(
                &format!("{path}.time_s"),
                "[]",
                "a list with at least one time",
                "add rows",
            ));
        }
        if time_s.len() != value.len() {
            let bound = format!("a list of {} values, one for each time", time_s.len());
            let text = format!("{} values", value.len());
            return Err(check::broken(&values, text, &bound, "give as many values as times"));
        }
        for (i, &value) in value.iter().enumerate() {
            self.check(&format!("{values}[{i}]"), value)?;
        }
        if let Some((i, bound)) = disorder(time_s) {
            let time = format!("{path}.time_s[{i}]");
            return Err(check::broken(
                &time,
                time_s[i],
                &bound,
                "sort the rows; the same time twice is a jump",
            ));
        }
        Series::try_new(time_s.to_vec(), value.to_vec())
    }

    fn series_of_csv(
        &self,
        path: &str,
        csv: &CsvSpec,
        files: Files<'_>,
        duration_s: f64,
    ) -> Result<Series, ThermalError> {
        let text = files(&csv.file).map_err(|error| {
            let remedy = format!("the name counts from the scenario's folder ({error})");
            check::broken(
                &format!("{path}.file"),
                format!("{:?}", csv.file),
                "a file that can be read",
                &remedy,
            )
        })?;
        let name_path = format!("{path}.column");
        let (file, name, dimension) = (csv.file.as_str(), csv.column.as_str(), self.dimension);
        let column = column::read(&text, &column::Source { path: &name_path, name, file, dimension })?;
        let fault = |i: usize, problem| ThermalError::Document {
            file: csv.file.clone(),
            line: column.line[i],
            problem: Box::new(problem),
        };
        for (i, &value) in column.value.iter().enumerate() {
            let Err(ThermalError::Specification { problem, .. }) = self.check(&csv.column, value) else {
                continue;
            };
            let mut problem = *problem;
            if let Problem::Value { text, .. } = &mut problem {
                text.clone_from(&column.text[i].1);
            }
            return Err(fault(i, problem));
        }
        if let Some((i, bound)) = disorder(&column.time_s) {
            let remedy = "sort the rows; the same time twice is a jump".to_owned();
            let (key, text) = (column.time_name.clone(), column.text[i].0.clone());
            return Err(fault(i, Problem::Value { key, text, bound, remedy }));
        }
        if let Some(i) = ends_early(&column.time_s, duration_s) {
            let (key, text) = (column.time_name.clone(), column.text[i].0.clone());
            let bound = format!("at least {}, the end of the scenario", check::time_text(duration_s));
            let remedy = "let the table go on, or the scenario end with it".to_owned();
            return Err(fault(i, Problem::Value { key, text, bound, remedy }));
        }
        Series::try_new(column.time_s, column.value)
    }
}

/// The last row, if it lies more than the interval before it ahead of the end: what was recorded does not say what came then.
fn ends_early(time_s: &[f64], duration_s: f64) -> Option<usize> {
    let last = time_s.len().checked_sub(1)?;
    let interval_s = if last > 0 { time_s[last] - time_s[last - 1] } else { 0.0 };
    (time_s[last] + interval_s < duration_s).then_some(last)
}

/// The first row that is out of order, and what it would have to be.
fn disorder(time_s: &[f64]) -> Option<(usize, String)> {
    (1..time_s.len()).find_map(|i| {
        let before = check::time_text(time_s[i - 1]);
        if time_s[i] < time_s[i - 1] {
            return Some((i, format!("at least {before}, the time before")));
        }
        let third = i > 1 && time_s[i] == time_s[i - 2];
        third.then(|| (i, format!("later than {before}, the time of the two rows before")))
    })
}

/// Last name of a path without index.
fn last(path: &str) -> String {
    let last = path.rsplit('.').next().unwrap_or(path);
    crate::problem::without_indices(last)
}
