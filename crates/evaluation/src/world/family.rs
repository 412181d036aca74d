//! The axes of a world, each a closed set with a text key, and the family: one of each.
use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Serialize};

use super::WorldError;

/// A closed set of kinds whose text keys are also their serialised form.
macro_rules! axis {
    ($(#[$doc:meta])* $name:ident ($axis:literal) { $($(#[$kind_doc:meta])* $kind:ident = $key:literal,)+ }) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
        pub enum $name {
            $($(#[$kind_doc])* #[serde(rename = $key)] $kind,)+
        }

        impl $name {
            /// All of them, in the order of the table.
            pub const ALL: &'static [Self] = &[$(Self::$kind),+];

            /// Text key.
            pub const fn key(self) -> &'static str {
                match self { $(Self::$kind => $key),+ }
            }
        }

        impl fmt::Display for $name {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.pad(self.key())
            }
        }

        impl FromStr for $name {
            type Err = WorldError;

            fn from_str(text: &str) -> Result<Self, WorldError> {
                Self::ALL.iter().copied().find(|kind| kind.key() == text).ok_or_else(|| WorldError::UnknownKey {
                    axis: $axis,
                    text: text.to_owned(),
                    known: Self::ALL.iter().map(|kind| kind.key()).collect::<Vec<_>>().join(", "),
                })
            }
        }
    };
}

axis! {
    /// Vessels; the nominal one of each is a file of `world/vessel`.
    VesselKind ("vessel") {
        /// 20 L nitrogen, 200 bar, steel.
        Nitrogen20 = "nitrogen-20l",
        /// 50 L argon, 300 bar, steel.
        Argon50 = "argon-50l",
        /// 80 L nitrogen, 300 bar, steel.
        Nitrogen80 = "nitrogen-80l",
        /// 6.8 L breathing air, 300 bar, aluminium liner in carbon composite.
        AirComposite7 = "air-composite-7l",
        /// 10 L helium, 200 bar, steel.
        Helium10 = "helium-10l",
        /// 50 L hydrogen, 200 bar, steel, lying.
        Hydrogen50 = "hydrogen-50l",
        /// 7.75 L air tank of 3 to 8 bar absolute, thin steel.
        AirTank8 = "air-tank-8l",
    }
}

axis! {
    /// Climates; the law of each is in the file of its name in `world/climate`.
    Climate ("climate") {
        /// Winter under a rail vehicle; seasons in logs of more than 60 d.
        Railway = "railway",
        /// The kind of the built-in railway week: wind that switches at the mouths of tunnels within 1 to 60 s, tunnels to 55 °C.
        Switching = "switching",
        /// Twenty short tunnels a day, stations between them.
        Metro = "metro",
        /// Desert summer, sun of 1000 W/m².
        Desert = "desert",
        /// Arctic winter.
        Arctic = "arctic",
        /// A vehicle that stands in the open for a month and longer.
        Parked = "parked",
        /// A heated hall: a heater that switches, doors that open.
        Hall = "hall",
        /// A workshop that keeps its temperature within half a kelvin.
        Workshop = "workshop",
        /// A climatic chamber that repeats four temperature profiles.
        Chamber = "chamber",
        /// A roof in summer with showers.
        Showers = "showers",
    }
}

axis! {
    /// How the gas and the wall of the truth are resolved.
    GasKind ("gas") {
        /// Well-mixed gas behind a coarse wall.
        Mixed = "mixed",
        /// Stacked gas cells.
        Stratified = "stratified",
        /// Stacked gas cells whose exchange of heat along the axis is off by up to a factor of three.
        AxialExchange = "axial-exchange",
        /// Well-mixed gas behind the whole finite-volume mesh of the wall.
        FullMesh = "full-mesh",
    }
}

axis! {
    /// Sensors: what their data sheet says, and what they do.
    SensorClass ("sensors") {
        /// Pt100 of class A, a transmitter of 0.1 % of its range.
        ClassA = "class-a",
        /// Pt100 of class B, a transmitter of 0.25 % of its range.
        ClassB = "class-b",
        /// Temperatures in steps of 0.1 or 0.5 K, pressures in steps of 0.1 or 0.5 bar or a part of the range.
        Coarse = "coarse",
        /// A transmitter that is 0.1 to 0.24 % of its range off, with up to 0.15 % of it per 10 K; some count from the air.
        Transmitter = "transmitter",
        /// Thermometers with a time constant of 5 to 60 s.
        Lagging = "lagging",
    }
}

axis! {
    /// How often rows come; each with jitter, lost rows, gaps, and one step of the clock in long logs.
    RowPattern ("rows") {
        /// Every second.
        EverySecond = "1s",
        /// Every 10 s.
        TenSeconds = "10s",
        /// Every minute.
        Minute = "60s",
        /// Every 2 min.
        TwoMinutes = "120s",
        /// Every 5 min.
        FiveMinutes = "300s",
    }
}

impl RowPattern {
    /// Nominal interval between rows, s.
    pub const fn interval_s(self) -> f64 {
        match self {
            Self::EverySecond => 1.0,
            Self::TenSeconds => 10.0,
            Self::Minute => 60.0,
            Self::TwoMinutes => 120.0,
            Self::FiveMinutes => 300.0,
        }
    }
}

/// One of each axis. Its text key is `vessel/climate/gas/sensors/rows`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub struct Family {
    /// Vessel.
    pub vessel: VesselKind,
    /// Climate.
    pub climate: Climate,
    /// How the truth resolves the gas.
    pub gas: GasKind,
    /// Sensors.
    pub sensors: SensorClass,
    /// Rows.
    pub rows: RowPattern,
}

impl Family {
    /// Every combination of the axes, in the order of their keys' tables.
    pub fn all() -> impl Iterator<Item = Self> {
        VesselKind::ALL.iter().flat_map(|&vessel| {
            Climate::ALL.iter().flat_map(move |&climate| {
                GasKind::ALL.iter().flat_map(move |&gas| {
                    SensorClass::ALL.iter().flat_map(move |&sensors| {
                        RowPattern::ALL.iter().map(move |&rows| Self { vessel, climate, gas, sensors, rows })
                    })
                })
            })
        })
    }

    /// The 20 L cylinder on a railway in winter with well-mixed gas, sensors of class B and a row every 2 min.
    pub const fn usual() -> Self {
        Self {
            vessel: VesselKind::Nitrogen20,
            climate: Climate::Railway,
            gas: GasKind::Mixed,
            sensors: SensorClass::ClassB,
            rows: RowPattern::TwoMinutes,
        }
    }

    /// Text key.
    pub fn key(&self) -> String {
        self.to_string()
    }
}

impl fmt::Display for Family {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { vessel, climate, gas, sensors, rows } = self;
        write!(f, "{vessel}/{climate}/{gas}/{sensors}/{rows}")
    }
}

impl FromStr for Family {
    type Err = WorldError;

    fn from_str(text: &str) -> Result<Self, WorldError> {
        let parts: Vec<&str> = text.split('/').collect();
        let [vessel, climate, gas, sensors, rows] = parts[..] else {
            return Err(WorldError::FamilyKey { text: text.to_owned() });
        };
        Ok(Self {
            vessel: vessel.parse()?,
            climate: climate.parse()?,
            gas: gas.parse()?,
            sensors: sensors.parse()?,
            rows: rows.parse()?,
        })
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    #[test]
    fn every_family_comes_back_from_its_key_and_from_json() {
        let mut keys = BTreeSet::new();
        for family in Family::all() {
            let key = family.key();
            assert_eq!(key.parse::<Family>().unwrap(), family);
            let json = serde_json::to_string(&family).unwrap();
            assert_eq!(serde_json::from_str::<Family>(&json).unwrap(), family);
            assert!(keys.insert(key), "{family} twice");
        }
        assert_eq!(keys.len(), 7 * 10 * 4 * 5 * 5);
    }

    #[test]
    fn a_key_that_is_none_is_refused_with_those_that_are() {
        let error = "nitrogen-20l/railway/mixed/class-b".parse::<Family>().unwrap_err();
        assert!(error.to_string().contains("vessel/climate/gas/sensors/rows"), "{error}");
        let error = "nitrogen-20l/winter/mixed/class-b/60s".parse::<Family>().unwrap_err();
        assert!(error.to_string().contains("winter") && error.to_string().contains("railway"), "{error}");
    }
}
