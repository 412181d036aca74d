//! Kinds of sensors. A file of this folder is the home of one: what a table may say about it, its checks, what it reads,
//! its uncertain parameters and its typical numbers. The enums here list them.
mod ambient;
mod gas;
mod immersion;
mod pressure;
mod surface;

use super::parameter::ParameterKind;
use super::place::{GasPlace, SurfacePlace};
use super::reading::{Exposure, Prediction, Quantity, Site};
use super::valid::{Bound, Bounds};
pub use pressure::{ELECTRONICS_REFERENCE_K, PressureReference};
use serde::{Deserialize, Serialize};
#[cfg(feature = "files")]
use {
    super::{SensorSpec, table::Table},
    crate::ThermalError,
    schemars::JsonSchema,
};

/// What a sensor reads, and where.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum SensorKind {
    /// Temperature of the outer surface, or of the valve body.
    Surface {
        /// Where it sits.
        place: SurfacePlace,
    },
    /// Gas pressure, by a transmitter at the valve.
    Pressure {
        /// What it counts from.
        reference: PressureReference,
        /// Upper end of its range, Pa, counted as it counts; `None`: it has no end.
        full_scale_pa: Option<f64>,
    },
    /// Gas temperature inside.
    Gas {
        /// Where it hangs.
        place: GasPlace,
    },
    /// Air temperature.
    Ambient,
    /// Gas temperature inside, by a thermometer on a stem through the valve.
    Immersion {
        /// Where its tip is.
        place: GasPlace,
    },
}

/// What a sensor reads, as a file says it.
#[cfg(feature = "files")]
#[derive(Clone, Copy, Debug, Deserialize, Serialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "kebab-case")]
pub enum KindChoice {
    /// Temperature of the outer surface or of the valve body.
    Surface,
    /// Gas pressure.
    Pressure,
    /// Gas temperature inside.
    Gas,
    /// Air temperature.
    Ambient,
    /// Gas temperature inside, on a stem through the valve.
    Immersion,
}

/// What is true of every sensor of a kind.
pub(super) struct Kind {
    pub(super) quantity: Quantity,
    /// Static reading with its derivatives; the parameters are in the order of a sensor's.
    pub(super) predict: fn(&SensorKind, &Exposure, &[f64]) -> Prediction,
    /// Parameters beyond the offset, with their bounds.
    pub(super) parameters: &'static [(ParameterKind, Bounds)],
    #[cfg(feature = "files")]
    pub(super) stated: StatedKind,
}

#[cfg(feature = "files")]
pub(super) type CouplingKeys = fn(&mut SensorSpec) -> [&mut Option<f64>; 2];

/// A kind in files.
#[cfg(feature = "files")]
pub(super) struct StatedKind {
    /// As in `kind = surface`.
    pub(super) name: &'static str,
    /// Keys of a table beyond those that every sensor of its quantity has.
    pub(super) keys: &'static [&'static str],
    /// Whether a sensor of this name is of this kind unless its table says otherwise.
    pub(super) is_named: fn(&str) -> bool,
    /// Names of its columns in a log, as `gas_<name>`.
    pub(super) columns: &'static [&'static str],
    /// What it reads and where, checked.
    pub(super) build: fn(&Table<'_>) -> Result<SensorKind, ThermalError>,
    /// Parameters beyond the offset, as a table states them: mean and standard deviation.
    pub(super) parameters: fn(&SensorSpec) -> Vec<[Option<f64>; 2]>,
    /// Where a table says the coupling and its standard deviation; `None`: it has none.
    pub(super) coupling: Option<CouplingKeys>,
    /// Lowest and highest value that can be a reading unless the table says otherwise.
    pub(super) plausible: fn(&SensorKind) -> (f64, f64),
    /// Fills in typical numbers wherever the table says nothing.
    pub(super) typical: fn(&mut SensorSpec),
}

impl SensorKind {
    fn kind(&self) -> &'static Kind {
        match self {
            Self::Surface { .. } => &surface::KIND,
            Self::Pressure { .. } => &pressure::KIND,
            Self::Gas { .. } => &gas::KIND,
            Self::Ambient => &ambient::KIND,
            Self::Immersion { .. } => &immersion::KIND,
        }
    }

    /// Where it sits.
    pub fn site(&self) -> Site {
        match *self {
            Self::Surface { place } => Site::Surface(place),
            Self::Pressure { .. } => Site::Port,
            Self::Gas { place } | Self::Immersion { place } => Site::Gas(place),
            Self::Ambient => Site::Air,
        }
    }

    /// Its parameters in their order, with the bounds of those beyond the offset.
    pub(super) fn parameters(
        &self,
    ) -> impl Iterator<Item = (ParameterKind, Option<&'static Bounds>)> + Clone {
        let more = self.kind().parameters.iter().map(|(kind, bounds)| (*kind, Some(bounds)));
        core::iter::once((ParameterKind::Offset, None)).chain(more)
    }

    /// What it measures.
    pub fn quantity(&self) -> Quantity {
        self.kind().quantity
    }

    /// Static reading (before a lag, without drift and noise) with its derivatives. It is linear in the exposure for fixed
    /// parameters, and linear in the parameters for a fixed exposure.
    ///
    /// # Shapes
    /// `parameters`: one value for each of [`MountedSensor::parameters`](super::MountedSensor::parameters), in that order;
    /// further ones are ignored.
    ///
    /// # Panics
    /// With fewer values than parameters.
    pub fn predict(&self, exposure: &Exposure, parameters: &[f64]) -> Prediction {
        (self.kind().predict)(self, exposure, parameters)
    }
}

#[cfg(feature = "files")]
impl KindChoice {
    const ALL: [Self; 5] = [Self::Surface, Self::Ambient, Self::Pressure, Self::Gas, Self::Immersion];

    pub(super) fn kind(self) -> &'static Kind {
        match self {
            Self::Surface => &surface::KIND,
            Self::Pressure => &pressure::KIND,
            Self::Gas => &gas::KIND,
            Self::Ambient => &ambient::KIND,
            Self::Immersion => &immersion::KIND,
        }
    }

    /// The kind that a sensor's name says: `pressure`, `ambient`, `gas_<number>`; else a surface.
    pub(super) fn of_name(name: &str) -> Self {
        Self::ALL.into_iter().find(|choice| (choice.kind().stated.is_named)(name)).unwrap_or(Self::Surface)
    }

    /// Names of columns in a log that say a sensor, with what it measures: whole ones as `shoulder`, or `gas_<name>` for
    /// all that begin so.
    pub fn columns() -> impl Iterator<Item = (&'static str, Quantity)> {
        let of = |kind: &'static Kind| kind.stated.columns.iter().map(|name| (*name, kind.quantity));
        Self::ALL.into_iter().flat_map(move |choice| of(choice.kind()))
    }
}

#[cfg(all(test, feature = "files"))]
mod tests {
    use super::KindChoice;

    #[test]
    fn every_kind_of_the_schema_is_listed_under_its_name() {
        let schema = serde_json::to_string(&schemars::schema_for!(KindChoice)).unwrap();
        assert_eq!(schema.matches("\"const\"").count(), KindChoice::ALL.len(), "{schema}");
        for choice in KindChoice::ALL {
            assert_eq!(serde_json::to_value(choice).unwrap(), choice.kind().stated.name);
        }
    }
}
