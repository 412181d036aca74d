//! A file of single readings, a cylinder a row, as somebody writes them down who goes from one to the next.
use super::Round;
use super::single::Look;
use crate::detector::inspection::SingleReading;
use crate::report::inspection::Inspected;
use crate::thermal::units::{self, Dimension, Unit};
use crate::thermal::vessel::Fill;
use anyhow::{Context, anyhow, bail};
use std::io::{BufRead, BufReader};
use std::path::Path;

/// Column that makes a file one of single readings.
const CYLINDER: &str = "cylinder";
/// Quantities of a row: name, what it measures, whether every row needs it.
const QUANTITIES: [(&str, Dimension, bool); 5] = [
    ("pressure", Dimension::Pressure, true),
    ("temperature", Dimension::Temperature, true),
    ("rested", Dimension::Time, false),
    ("fill_pressure", Dimension::Pressure, false),
    ("fill_temperature", Dimension::Temperature, false),
];

/// Whether a file is one of single readings: its header has the column `cylinder`.
pub(super) fn is_round(path: &Path) -> anyhow::Result<bool> {
    if path == Path::new("-") {
        return Ok(false);
    }
    let file = std::fs::File::open(path).with_context(|| format!("{} cannot be read", path.display()))?;
    let mut line = Vec::new();
    let mut reader = BufReader::new(file);
    while line.is_empty() || line.starts_with(b"#") {
        line.clear();
        if reader.read_until(b'\n', &mut line).is_err() || line.is_empty() {
            return Ok(false);
        }
    }
    let text = String::from_utf8_lossy(&line).to_lowercase();
    let mut names =
        text.trim_start_matches('\u{feff}').split([',', ';', '\t']).map(|name| name.trim().trim_matches('"'));
    Ok(names.any(|name| name == CYLINDER))
}

/// Columns of the file.
struct Columns {
    cylinder: usize,
    date: Option<usize>,
    /// Of each quantity.
    quantities: [Option<(usize, String, &'static Unit)>; 5],
}

impl Columns {
    fn of(header: &csv::StringRecord) -> anyhow::Result<Self> {
        let position = |name: &str| header.iter().position(|found| found.eq_ignore_ascii_case(name));
        let cylinder = position(CYLINDER).context("there is no column cylinder")?;
        let mut quantities: [Option<(usize, String, &'static Unit)>; 5] = Default::default();
        for (index, name) in header.iter().enumerate() {
            let name = name.to_lowercase();
            let Some((base, unit)) = units::split(&name) else { continue };
            let Some(of) = QUANTITIES.iter().position(|(quantity, ..)| *quantity == base) else { continue };
            let unit = units::find(unit.suffix, QUANTITIES[of].1).with_context(|| {
                format!(
                    "column {name} has no unit of {base}: end its name in one of {}",
                    units::listed(QUANTITIES[of].1)
                )
            })?;
            if let Some((_, first, _)) = &quantities[of] {
                bail!("columns {first} and {name} state the same quantity: keep one of them");
            }
            quantities[of] = Some((index, name.clone(), unit));
        }
        for (of, (name, dimension, _)) in QUANTITIES.iter().enumerate().filter(|(_, (.., needed))| *needed) {
            if quantities[of].is_none() {
                bail!(
                    "there is no column of {name}: name it {name} with its unit, one of {}",
                    units::listed(*dimension)
                );
            }
        }
        Ok(Self { cylinder, date: position("date"), quantities })
    }

    /// Value of a quantity in a row, SI.
    fn si(&self, of: usize, record: &csv::StringRecord, decimal_comma: bool) -> anyhow::Result<Option<f64>> {
        let Some((index, name, unit)) = &self.quantities[of] else { return Ok(None) };
        let text = record.get(*index).unwrap_or_default();
        if text.is_empty() {
            return Ok(None);
        }
        let plain = if decimal_comma { text.replace(',', ".") } else { text.to_owned() };
        let value: f64 = plain.parse().map_err(|_| anyhow!("{name} = {text} must be a number"))?;
        let si = unit.to_si(value);
        if !si.is_finite() || si < 0.0 || (si == 0.0 && QUANTITIES[of].0 != "rested") {
            bail!("{name} = {text} must be above {}: check the number and its unit", unit.from_si(0.0));
        }
        Ok(Some(si))
    }
}

impl Round<'_> {
    /// Judges every cylinder of a file.
    ///
    /// # Errors
    /// Names the file, the line, the value and the remedy.
    pub(super) fn of_round(&self, path: &Path) -> anyhow::Result<Vec<Inspected>> {
        let name = path.to_string_lossy();
        let text = self.inputs.read(&name)?;
        let text = text.strip_prefix('\u{feff}').unwrap_or(&text);
        let header = text.lines().find(|line| !line.starts_with('#') && !line.is_empty()).unwrap_or_default();
        let delimiter =
            [b';', b'\t'].into_iter().find(|&byte| header.as_bytes().contains(&byte)).unwrap_or(b',');
        let mut reader = csv::ReaderBuilder::new()
            .comment(Some(b'#'))
            .delimiter(delimiter)
            .trim(csv::Trim::All)
            .flexible(true)
            .from_reader(text.as_bytes());
        let columns = Columns::of(&reader.headers()?.clone()).with_context(|| format!("{name}:1"))?;
        let mut cylinders = Vec::new();
        for record in reader.records() {
            let record = record.with_context(|| name.to_string())?;
            if record.iter().all(str::is_empty) {
                continue;
            }
            let line = record.position().map_or(0, csv::Position::line);
            let cylinder = self.of_record(&record, &columns, delimiter != b',');
            cylinders.push(cylinder.with_context(|| format!("{name}:{line}"))?);
        }
        if cylinders.is_empty() {
            bail!("{name}: there is no reading below the header: write a row for each cylinder");
        }
        Ok(cylinders)
    }

    fn of_record(
        &self,
        record: &csv::StringRecord,
        columns: &Columns,
        comma: bool,
    ) -> anyhow::Result<Inspected> {
        let si = |of: usize| columns.si(of, record, comma);
        let needed = |of: usize| {
            si(of)?
                .with_context(|| format!("{} is empty: complete the row or leave it out", QUANTITIES[of].0))
        };
        let reading = SingleReading {
            pressure_pa: needed(0)?,
            temperature_k: needed(1)?,
            rested_s: si(2)?.unwrap_or(0.0),
        };
        let fill = match (si(3)?, si(4)?) {
            (Some(pressure_pa), Some(temperature_k)) => Some(Fill::Settled { pressure_pa, temperature_k }),
            (None, None) => None,
            _ => bail!("a fill is a pressure and a temperature: complete fill_pressure and fill_temperature"),
        };
        let date = match columns.date.and_then(|index| record.get(index)).filter(|text| !text.is_empty()) {
            Some(text) => Some(text.parse().map_err(|_| anyhow!("date = {text} must be as 2026-11-27"))?),
            None => None,
        };
        let cylinder = record.get(columns.cylinder).unwrap_or_default().to_owned();
        self.of_look(cylinder, &Look { reading, date, fill })
    }
}
