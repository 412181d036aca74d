//! Matching of a document's keys with the fields of a specification: same quantity, any unit of its dimension.
use super::suggestion;
use crate::problem::Problem;
use crate::units::{self, Unit};

/// The field a key belongs to and the unit its value is written in.
pub(super) type Match = (&'static str, Option<&'static Unit>);

/// Finds the field of a key. Names in problems are bare; the caller adds the table.
pub(super) fn match_key(key: &str, fields: &'static [&'static str]) -> Result<Match, Problem> {
    if let Some(found) = fields.iter().find_map(|field| in_right_unit(key, field)) {
        return Ok(found);
    }
    let known: Vec<String> = fields.iter().map(|field| example(field)).collect();
    for field in fields {
        let Some((base, _)) = units::split(field) else { continue };
        let (quantity, units) = (base.replace('_', " "), units_of_quantity(base, fields));
        if key == base {
            return Err(Problem::NoUnit { key: key.to_owned(), example: example(field), units });
        }
        if let Some(suffix) = key.strip_prefix(base).and_then(|rest| rest.strip_prefix('_')) {
            let is_unit = units::UNITS.iter().any(|unit| unit.suffix == suffix);
            // `film_facto` starts like the quantity `film` but is a slip of the key `film_factor`.
            if is_unit || known.iter().all(|name| strsim::jaro_winkler(name, key) < 0.95) {
                return Err(Problem::WrongUnit {
                    key: key.to_owned(),
                    unit: suffix.to_owned(),
                    quantity,
                    units,
                });
            }
        }
    }
    let nearest = suggestion(key, known.iter().map(String::as_str));
    Err(Problem::UnknownKey { key: key.to_owned(), nearest, known: known.join(", ") })
}

/// Suffixes of a quantity; one that is stated in kelvins here and in pascals there, as a sensor's offset, has both.
fn units_of_quantity(base: &str, fields: &[&'static str]) -> String {
    let of_quantity = fields.iter().filter_map(|field| units::split(field)).filter(|(name, _)| *name == base);
    of_quantity.map(|(_, unit)| units::listed(unit.dimension)).collect::<Vec<_>>().join(", ")
}

fn in_right_unit(key: &str, field: &'static str) -> Option<Match> {
    match units::split(field) {
        None => (key == field).then_some((field, None)),
        Some((base, si)) => {
            let suffix = key.strip_prefix(base)?.strip_prefix('_')?;
            Some((field, Some(units::find(suffix, si.dimension)?)))
        }
    }
}

/// A field's key as a person would write it: with the customary unit.
pub(super) fn example(field: &str) -> String {
    match units::split(field) {
        Some((base, si)) => {
            let customary = units::units_of(si.dimension).next().unwrap_or(si);
            format!("{base}_{}", customary.suffix)
        }
        None => field.to_owned(),
    }
}
