//! Names of parameters on a command line and in files: `wall-capacity`, `offset:shoulder`, `discharge-coefficient:vent`.
use std::str::FromStr;

use super::ParameterKind;

/// Names without an object.
const GLOBAL_NAMES: [(&str, ParameterKind); 10] = [
    ("outside-film", ParameterKind::OutsideFilm),
    ("inside-film", ParameterKind::InsideFilm),
    ("jet-film", ParameterKind::JetFilm),
    ("wall-capacity", ParameterKind::WallCapacity),
    ("valve-capacity", ParameterKind::ValveCapacity),
    ("valve-contact", ParameterKind::ValveContact),
    ("volume", ParameterKind::Volume),
    ("fill-mass", ParameterKind::FillMass),
    ("initial-temperature", ParameterKind::InitialTemperature),
    ("air-offset", ParameterKind::AirOffset),
];

/// Names that are followed by a colon and the name of a sensor or a flow.
const OBJECT_NAMES: [&str; 6] =
    ["coupling", "lag", "offset", "span", "temperature-coefficient", "discharge-coefficient"];

/// A name that no parameter has.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ParameterNameError {
    /// Unknown word.
    #[error("there is no parameter `{name}`; known are {known}")]
    Unknown {
        /// As given.
        name: String,
        /// All that are known.
        known: String,
    },
    /// A number of a sensor or a flow without its name.
    #[error("`{name}` is a number of a {object}: write {name}:NAME with the name of the {object}")]
    WithoutObject {
        /// As given.
        name: String,
        /// `sensor` or `flow`.
        object: &'static str,
    },
}

impl ParameterKind {
    /// Name for files and command lines.
    pub fn name(&self) -> String {
        let of = |word: &str, object: &str| format!("{word}:{object}");
        match self {
            Self::SensorCoupling { sensor } => of("coupling", sensor),
            Self::SensorLag { sensor } => of("lag", sensor),
            Self::SensorOffset { sensor } => of("offset", sensor),
            Self::SensorSpan { sensor } => of("span", sensor),
            Self::SensorTemperatureCoefficient { sensor } => of("temperature-coefficient", sensor),
            Self::DischargeCoefficient { flow } => of("discharge-coefficient", flow),
            plain => {
                let named = GLOBAL_NAMES.iter().find(|(_, kind)| kind == plain);
                named.map_or_else(|| plain.to_string(), |(name, _)| (*name).to_owned())
            }
        }
    }

    /// All names; those of a sensor's or a flow's number end in a colon.
    pub fn names() -> impl Iterator<Item = String> {
        let plain = GLOBAL_NAMES.iter().map(|(name, _)| (*name).to_owned());
        plain.chain(OBJECT_NAMES.iter().map(|name| format!("{name}:")))
    }

    /// Unit of its value in SI; `1` for factors.
    pub fn si_unit(&self, is_pressure: bool) -> &'static str {
        match self {
            Self::InitialTemperature | Self::AirOffset => "K",
            Self::SensorOffset { .. } if is_pressure => "Pa",
            Self::SensorOffset { .. } => "K",
            Self::SensorLag { .. } => "s",
            Self::SensorTemperatureCoefficient { .. } => "Pa/K",
            _ => "1",
        }
    }
}

impl FromStr for ParameterKind {
    type Err = ParameterNameError;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let (word, object) = match text.split_once(':') {
            Some((word, object)) => (word, Some(object.to_owned()).filter(|object| !object.is_empty())),
            None => (text, None),
        };
        if let (Some((_, kind)), None) = (GLOBAL_NAMES.iter().find(|(name, _)| *name == text), &object) {
            return Ok(kind.clone());
        }
        let unknown = || {
            let known = Self::names().collect::<Vec<_>>().join(", ");
            ParameterNameError::Unknown { name: text.to_owned(), known }
        };
        if !OBJECT_NAMES.contains(&word) {
            return Err(unknown());
        }
        let is_flow = word == "discharge-coefficient";
        let Some(name) = object else {
            let object = if is_flow { "flow" } else { "sensor" };
            return Err(ParameterNameError::WithoutObject { name: word.to_owned(), object });
        };
        let sensor = name.clone();
        Ok(match word {
            "coupling" => Self::SensorCoupling { sensor },
            "lag" => Self::SensorLag { sensor },
            "offset" => Self::SensorOffset { sensor },
            "span" => Self::SensorSpan { sensor },
            "temperature-coefficient" => Self::SensorTemperatureCoefficient { sensor },
            _ => Self::DischargeCoefficient { flow: name },
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_name_is_read_as_the_parameter_that_has_it() {
        for name in ParameterKind::names() {
            let full = if name.ends_with(':') { format!("{name}wall_bottom") } else { name };
            let kind: ParameterKind = full.parse().unwrap();
            assert_eq!(kind.name(), full);
        }
    }

    #[test]
    fn names_that_say_too_little_or_too_much_are_refused() {
        let fault = |name: &str| name.parse::<ParameterKind>().unwrap_err().to_string();
        assert!(fault("wal-capacity").contains("known are outside-film, inside-film"));
        assert!(fault("volume:shoulder").contains("no parameter `volume:shoulder`"));
        assert!(fault("offset").contains("offset:NAME with the name of the sensor"));
        assert!(fault("discharge-coefficient:").contains("name of the flow"));
    }
}
