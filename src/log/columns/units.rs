//! Units at the end of a column's name, and what people write instead of them.
use crate::estimator::log::Quantity;
use crate::estimator::sensor::KindChoice;
use crate::thermal::document::Problem;
use crate::thermal::units::{self, Dimension, Unit};

/// Endings that mean a unit and are none of ours, with ours where the numbers are the same.
const FOREIGN: [(&str, Dimension, Option<&str>); 18] = [
    ("c", Dimension::Temperature, Some("degc")),
    ("celsius", Dimension::Temperature, Some("degc")),
    ("deg_c", Dimension::Temperature, Some("degc")),
    ("°c", Dimension::Temperature, Some("degc")),
    ("deg", Dimension::Temperature, Some("degc")),
    ("kelvin", Dimension::Temperature, Some("k")),
    ("f", Dimension::Temperature, Some("degf")),
    ("deg_f", Dimension::Temperature, Some("degf")),
    ("°f", Dimension::Temperature, Some("degf")),
    ("fahrenheit", Dimension::Temperature, Some("degf")),
    ("hpa", Dimension::Pressure, Some("mbar")),
    ("bara", Dimension::Pressure, Some("bar")),
    ("psia", Dimension::Pressure, Some("psi")),
    ("mpaa", Dimension::Pressure, Some("mpa")),
    ("atm", Dimension::Pressure, None),
    ("torr", Dimension::Pressure, None),
    ("ms", Dimension::Time, None),
    ("us", Dimension::Time, None),
];

/// Names of columns of the kinds of sensors, and what a unit of theirs measures.
fn names() -> impl Iterator<Item = (&'static str, Dimension)> {
    KindChoice::columns().map(|(name, quantity)| match quantity {
        Quantity::Temperature => (name, Dimension::Temperature),
        Quantity::Pressure => (name, Dimension::Pressure),
    })
}

/// Those that are one name, as `shoulder`.
pub(super) fn whole_names() -> impl Iterator<Item = (&'static str, Dimension)> {
    names().filter(|(name, _)| !name.contains('<'))
}

/// The quantity of a sensor's unit.
pub(super) fn quantity(unit: &Unit) -> Option<Quantity> {
    match unit.dimension {
        Dimension::Temperature => Some(Quantity::Temperature),
        Dimension::Pressure => Some(Quantity::Pressure),
        _ => None,
    }
}

/// Unit of the column `name` if it is the quantity `base`; `None`: it is another one.
///
/// # Errors
/// It is `base` without a unit, in a unit of another quantity, or in something that looks like a unit.
pub(super) fn of(name: &str, base: &str, dimension: Dimension) -> Result<Option<&'static Unit>, Problem> {
    let Some(rest) = name.strip_prefix(base) else { return Ok(None) };
    if rest.is_empty() {
        return Err(no_unit(base, dimension));
    }
    let Some(suffix) = rest.strip_prefix('_') else { return Ok(None) };
    if let Some(unit) = units::find(suffix, dimension) {
        return Ok(Some(unit));
    }
    if units::UNITS.iter().any(|unit| unit.suffix == suffix) {
        return Err(wrong_unit(name, base, suffix, dimension, None));
    }
    match meant(suffix, dimension) {
        Some(nearest) => Err(wrong_unit(name, base, suffix, dimension, nearest)),
        None => Ok(None),
    }
}

/// Name and unit of `wall_<place>`, `gas_<name>` and the like.
///
/// # Errors
/// As of [`of`]. Names that begin so and end in another quantity (`wall_thickness_mm`, `gas_type`) are other columns,
/// but `wall_middle` is taken to lack its unit.
pub(super) fn of_prefixed(name: &str) -> Result<Option<(&str, &'static Unit)>, Problem> {
    let begins_so = |known: &str| {
        let (beginning, _) = known.split_once('<')?;
        name.strip_prefix(beginning).filter(|place| !place.is_empty())
    };
    let Some((_, dimension)) = names().find(|(known, _)| begins_so(known).is_some()) else {
        return Ok(None);
    };
    if let Some((base, unit)) = units::split(name) {
        let is_place = base.len() > "wall".len() && base.contains('_');
        return Ok((is_place && unit.dimension == dimension).then_some((base, unit)));
    }
    if let Some((base, suffix)) = name.rsplit_once('_')
        && base.contains('_')
        && let Some(nearest) = meant(suffix, dimension)
    {
        return Err(wrong_unit(name, base, suffix, dimension, nearest));
    }
    if name.starts_with("wall_") { Err(no_unit(name, dimension)) } else { Ok(None) }
}

/// Whether an ending that is no unit is meant as one; then the unit of ours that it may be, if there is one.
fn meant(suffix: &str, dimension: Dimension) -> Option<Option<&'static str>> {
    let foreign = FOREIGN.iter().find(|(word, of, _)| *word == suffix && *of == dimension);
    if let Some(&(_, _, ours)) = foreign {
        return Some(ours);
    }
    let likeness = |unit: &&Unit| strsim::jaro_winkler(unit.suffix, suffix);
    let likely = units::units_of(dimension).filter(|unit| unit.suffix.len() > 2 && likeness(unit) > 0.8);
    likely.max_by(|a, b| likeness(a).total_cmp(&likeness(b))).map(|unit| Some(unit.suffix))
}

fn no_unit(base: &str, dimension: Dimension) -> Problem {
    let customary = units::units_of(dimension).next().map_or("", |unit| unit.suffix);
    Problem::NoUnit {
        key: base.to_owned(),
        example: format!("{base}_{customary}"),
        units: format!("{}, or give --map {base}_{customary}={base}", units::listed(dimension)),
    }
}

fn wrong_unit(name: &str, base: &str, suffix: &str, dimension: Dimension, ours: Option<&str>) -> Problem {
    let nearest = ours.map_or(String::new(), |ours| format!(", did you mean {base}_{ours}?"));
    let quantity = match dimension {
        Dimension::Temperature => "temperature",
        Dimension::Pressure => "pressure",
        Dimension::Time => "time",
        Dimension::Mass => "mass",
        _ => "a flow of mass",
    };
    Problem::WrongUnit {
        key: name.to_owned(),
        unit: suffix.to_owned(),
        quantity: quantity.to_owned(),
        units: units::listed(dimension) + &nearest,
    }
}

/// Our name with the unit of theirs where ours has none and theirs ends in one.
pub(super) fn with_unit_of(ours: &str, theirs: &str) -> String {
    let theirs = theirs.to_ascii_lowercase();
    match (units::split(ours), units::split(&theirs)) {
        (None, Some((_, unit))) if ours != "time" || unit.dimension == Dimension::Time => {
            format!("{ours}_{}", unit.suffix)
        }
        _ => ours.to_owned(),
    }
}

/// The name of a reading that a column's name may be a slip of.
pub(super) fn nearest(name: &str) -> Option<String> {
    let (base, unit) = units::split(name)?;
    quantity(unit)?;
    let known = whole_names().map(|(name, _)| name).chain(["wall_middle"]);
    let likeness = |candidate: &&str| strsim::jaro_winkler(base, candidate);
    let best = known.max_by(|a, b| likeness(a).total_cmp(&likeness(b)))?;
    (likeness(&best) > 0.9).then(|| format!("{best}_{}", unit.suffix))
}
