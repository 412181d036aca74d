//! Patterns of families: `vessel/climate/gas/sensors/rows`, each part a key, several with `|` between them, or `*` for all of the axis. With
//! `?` before it a list is gone through in turn: `?` alone takes one of all kinds, `?60s|120s` one of two.
//!
//! A pattern with `?` stands for one family for each combination of the other axes and each turn. Turn `n` takes kind `n mod N` of the first
//! such axis, `n + n div N` of the next one, and so on, so that the axes do not go round together.
use std::fmt::Display;
use std::str::FromStr;

use crate::world::{Climate, Family, GasKind, RowPattern, SensorClass, VesselKind, WorldError};

/// One part of a pattern.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Part<T> {
    kinds: Vec<T>,
    /// One of the kinds in turn, instead of all.
    in_turn: bool,
}

/// A pattern of families.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Pattern {
    vessel: Part<VesselKind>,
    climate: Part<Climate>,
    gas: Part<GasKind>,
    sensors: Part<SensorClass>,
    rows: Part<RowPattern>,
}

impl<T: Copy + FromStr<Err = WorldError>> Part<T> {
    fn parse(text: &str, all: &[T]) -> Result<Self, WorldError> {
        let list = text.strip_prefix('?');
        let kinds = match list.unwrap_or(text) {
            "*" => all.to_vec(),
            "" if list.is_some() => all.to_vec(),
            kinds => kinds.split('|').map(str::parse).collect::<Result<_, _>>()?,
        };
        Ok(Self { kinds, in_turn: list.is_some() })
    }

    /// The kinds of a turn; `round` counts the axes that go round and moves on.
    fn of_turn(&self, turn: usize, round: &mut usize) -> Vec<T> {
        if !self.in_turn {
            return self.kinds.clone();
        }
        let n = self.kinds.len();
        let shifted = turn + *round * (turn / n);
        *round += 1;
        vec![self.kinds[shifted % n]]
    }
}

impl<T: PartialEq> Part<T> {
    fn holds(&self, kind: &T) -> bool {
        self.kinds.contains(kind)
    }
}

impl FromStr for Pattern {
    type Err = WorldError;

    fn from_str(text: &str) -> Result<Self, WorldError> {
        let parts: Vec<&str> = text.split('/').collect();
        let [vessel, climate, gas, sensors, rows] = parts[..] else {
            return Err(WorldError::FamilyKey { text: text.to_owned() });
        };
        Ok(Self {
            vessel: Part::parse(vessel, VesselKind::ALL)?,
            climate: Part::parse(climate, Climate::ALL)?,
            gas: Part::parse(gas, GasKind::ALL)?,
            sensors: Part::parse(sensors, SensorClass::ALL)?,
            rows: Part::parse(rows, RowPattern::ALL)?,
        })
    }
}

impl Pattern {
    /// Whether a family is one of the pattern.
    pub(crate) fn holds(&self, family: &Family) -> bool {
        self.vessel.holds(&family.vessel)
            && self.climate.holds(&family.climate)
            && self.gas.holds(&family.gas)
            && self.sensors.holds(&family.sensors)
            && self.rows.holds(&family.rows)
    }

    /// The families of the pattern, in the order of the axes; `turn` gives the turn of the combination of a number.
    pub(crate) fn families(&self, turn: impl Fn(usize) -> usize) -> Vec<Family> {
        (0..self.combinations()).filter_map(|number| self.family(number, turn(number))).collect()
    }

    /// Number of families of one turn: combinations of the axes that do not go round.
    pub(crate) fn combinations(&self) -> usize {
        let count = |in_turn: bool, kinds: usize| if in_turn { 1 } else { kinds };
        count(self.vessel.in_turn, self.vessel.kinds.len())
            * count(self.climate.in_turn, self.climate.kinds.len())
            * count(self.gas.in_turn, self.gas.kinds.len())
            * count(self.sensors.in_turn, self.sensors.kinds.len())
            * count(self.rows.in_turn, self.rows.kinds.len())
    }

    /// The combination of a number, the last axis fastest, in a turn.
    fn family(&self, number: usize, turn: usize) -> Option<Family> {
        let mut round = 0;
        let vessels = self.vessel.of_turn(turn, &mut round);
        let climates = self.climate.of_turn(turn, &mut round);
        let gases = self.gas.of_turn(turn, &mut round);
        let sensors = self.sensors.of_turn(turn, &mut round);
        let rows = self.rows.of_turn(turn, &mut round);
        let mut rest = number;
        let mut digit = |count: usize| {
            let digit = rest % count;
            rest /= count;
            digit
        };
        let (rows_at, sensors_at, gas_at) = (digit(rows.len()), digit(sensors.len()), digit(gases.len()));
        let (climate_at, vessel_at) = (digit(climates.len()), digit(vessels.len()));
        Some(Family {
            vessel: *vessels.get(vessel_at)?,
            climate: *climates.get(climate_at)?,
            gas: *gases.get(gas_at)?,
            sensors: *sensors.get(sensors_at)?,
            rows: *rows.get(rows_at)?,
        })
    }
}

/// A kind of one axis, as in `climate=desert`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Axis {
    axis: &'static str,
    key: String,
}

impl FromStr for Axis {
    type Err = WorldError;

    fn from_str(text: &str) -> Result<Self, WorldError> {
        let (axis, key) = text.split_once('=').unwrap_or((text, ""));
        let unknown = || WorldError::UnknownKey {
            axis: "axis",
            text: axis.to_owned(),
            known: "vessel, climate, gas, sensors, rows".to_owned(),
        };
        let axis = match axis {
            "vessel" => key.parse::<VesselKind>().map(|_| "vessel")?,
            "climate" => key.parse::<Climate>().map(|_| "climate")?,
            "gas" => key.parse::<GasKind>().map(|_| "gas")?,
            "sensors" => key.parse::<SensorClass>().map(|_| "sensors")?,
            "rows" => key.parse::<RowPattern>().map(|_| "rows")?,
            _ => return Err(unknown()),
        };
        Ok(Self { axis, key: key.to_owned() })
    }
}

impl Axis {
    /// Whether a family has this kind.
    pub(crate) fn holds(&self, family: &Family) -> bool {
        let key = match self.axis {
            "vessel" => family.vessel.key(),
            "climate" => family.climate.key(),
            "gas" => family.gas.key(),
            "sensors" => family.sensors.key(),
            _ => family.rows.key(),
        };
        key == self.key
    }
}

impl Display for Axis {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}={}", self.axis, self.key)
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    fn pattern(text: &str) -> Pattern {
        text.parse().unwrap()
    }

    #[test]
    fn a_wildcard_stands_for_every_kind_of_its_axis_and_alternatives_for_theirs() {
        let families = pattern("*/railway|desert/mixed/class-b/120s").families(|_| 0);
        assert_eq!(families.len(), 14);
        assert_eq!(families.iter().collect::<BTreeSet<_>>().len(), 14);
        assert_eq!(pattern("*/*/*/*/*").families(|_| 0), Family::all().collect::<Vec<_>>());
        assert!(families.iter().all(|family| pattern("*/railway|desert/*/class-b/*").holds(family)));
        assert!(!pattern("*/hall/*/*/*").holds(&families[0]));
    }

    #[test]
    fn in_turn_every_pair_of_kinds_comes_up_and_each_combination_has_one_family() {
        let pattern = pattern("nitrogen-20l/railway/mixed/?/?");
        let turns: Vec<Family> = (0..25).flat_map(|turn| pattern.families(|_| turn)).collect();
        assert_eq!(turns.len(), 25);
        assert_eq!(turns.iter().collect::<BTreeSet<_>>().len(), 25);
        assert_eq!(self::pattern("*/*/?/?/?").families(|number| number).len(), 70);
        let some = self::pattern("nitrogen-20l/?hall|desert/mixed/class-b/?60s|120s");
        let turns: BTreeSet<Family> = (0..4).flat_map(|turn| some.families(|_| turn)).collect();
        assert_eq!(turns.len(), 4);
        assert!("?/?/mixed/class-b/".parse::<Pattern>().is_err());
    }

    #[test]
    fn a_wrong_key_is_refused_with_those_that_are_known() {
        let error = "*/winter/*/*/*".parse::<Pattern>().unwrap_err().to_string();
        assert!(error.contains("winter") && error.contains("railway"), "{error}");
        assert!("a/b".parse::<Pattern>().is_err() && "weather=hot".parse::<Axis>().is_err());
        assert!("climate=hot".parse::<Axis>().is_err());
    }

    #[test]
    fn an_axis_holds_the_families_of_its_kind_alone() {
        let desert: Axis = "climate=desert".parse().unwrap();
        assert_eq!(Family::all().filter(|family| desert.holds(family)).count(), 700);
        assert_eq!(desert.to_string(), "climate=desert");
    }
}
