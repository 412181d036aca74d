//! Columns under foreign names: which mapping names which column, and in which unit.
use super::units;
use crate::log::label::Label;
use crate::log::mapping::is_named;
use crate::log::{LogError, Mapping};

/// Our name of the second column of `time=Datum+Zeit`.
pub(super) const CLOCK: &str = "time of day";

/// Our name of every column that a mapping names.
pub(super) fn names(headers: &[String], mappings: &[Mapping]) -> Result<Vec<Option<String>>, LogError> {
    let mut mapped: Vec<Option<String>> = vec![None; headers.len()];
    for mapping in mappings {
        let refuse = |reason: String| LogError::Mapping { mapping: mapping.to_string(), reason };
        let mut take = |name: &str, ours: &dyn Fn(&str) -> Result<String, String>| {
            let index = position(headers, name).map_err(refuse)?;
            if mapped[index].is_some() {
                return Err(refuse(format!("column {} is mapped twice: keep one", headers[index])));
            }
            mapped[index] = Some(ours(&headers[index]).map_err(refuse)?);
            Ok(())
        };
        let is_one = headers.iter().any(|header| is_named(header, &mapping.theirs));
        match mapping.pair().filter(|_| !is_one) {
            Some((date, clock)) => {
                take(date, &|_| Ok("time".to_owned()))?;
                take(clock, &|_| Ok(CLOCK.to_owned()))?;
            }
            None => take(&mapping.theirs, &|header| with_unit(&mapping.ours, header, &mapping.theirs))?,
        }
    }
    Ok(mapped)
}

/// The only column of this name: as a whole, else without its unit.
fn position(headers: &[String], name: &str) -> Result<usize, String> {
    let exact = headers.iter().any(|header| header == name);
    let is_it = |header: &String| if exact { header == name } else { is_named(header, name) };
    let mut found = headers.iter().enumerate().filter(|(_, header)| is_it(header));
    let Some((index, _)) = found.next() else {
        return Err(format!("the log has no column {name}; it has {}", headers.join(", ")));
    };
    match found.next() {
        Some((_, second)) if *second == headers[index] => {
            Err(format!("the log has several columns {name}: rename them"))
        }
        Some((_, second)) => {
            Err(format!("{} and {second} are both called {name}: write one of them", headers[index]))
        }
        None => Ok(index),
    }
}

/// Our name with the unit of theirs where ours has none.
///
/// # Errors
/// Their unit is in brackets and another one than ours, or none that is read, and who names the column has left it out.
fn with_unit(ours: &str, header: &str, theirs: &str) -> Result<String, String> {
    let Label { base, unit } = Label::of(header);
    let (Some(word), Some(suffixes)) = (unit, Label::of(header).suffixes()) else {
        return Ok(units::with_unit_of(ours, header));
    };
    let plain = crate::thermal::units::split(ours);
    if plain.is_some() && header == theirs {
        return Ok(ours.to_owned());
    }
    let quantity = plain.map_or(ours, |(quantity, _)| quantity);
    let Some(first) = suffixes.first() else {
        return Err(format!("the column is in {word}, which is no unit that is read: convert it"));
    };
    match plain {
        None if ours == "time" && !matches!(*first, "s" | "min" | "h" | "d") => Ok(ours.to_owned()),
        None => Ok(format!("{ours}_{first}")),
        Some((_, unit)) if suffixes.contains(&unit.suffix) => Ok(ours.to_owned()),
        Some(_) => Err(format!(
            "the header says {word}: write {quantity}_{first}={base}, or, if the header is wrong, its whole name: {ours}={header}"
        )),
    }
}
