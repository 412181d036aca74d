//! Thermometer that hangs in the gas: `y = T_gas + b`. Typical: thermocouple type T class 1 (IEC 60584-1: ±0.5 K).
use super::{Kind, Prediction, Quantity};
#[cfg(feature = "files")]
use {
    super::{GasPlace, SensorKind, StatedKind, Table},
    crate::ThermalError,
    crate::document::check,
    crate::sensor::valid,
};

/// Lowest and highest temperature in the gas that can be a reading, K: blowdown and fast filling.
#[cfg(feature = "files")]
pub(super) const INSIDE_K: (f64, f64) = (93.15, 603.15);

pub(super) const KIND: Kind = Kind {
    quantity: Quantity::Temperature,
    predict: |_, exposure, parameters| Prediction {
        value: exposure.body_k + parameters[0],
        per_body: 1.0,
        per_parameter: [1.0, 0.0, 0.0],
        ..Prediction::default()
    },
    parameters: &[],
    #[cfg(feature = "files")]
    stated: StatedKind {
        name: "gas",
        keys: &["cell", "height_m"],
        is_named: |name| cell_of(name).is_some(),
        columns: &["gas_<name>"],
        build: |table| Ok(SensorKind::Gas { place: place(table)? }),
        parameters: |_| Vec::new(),
        coupling: None,
        plausible: |_| INSIDE_K,
        typical: |spec| {
            spec.noise_k.get_or_insert(0.1);
            if !spec.says_offset() {
                spec.offset_tolerance_k = Some(0.5);
            }
        },
    },
};

/// Number of the name `gas_<number>`.
#[cfg(feature = "files")]
fn cell_of(name: &str) -> Option<usize> {
    name.strip_prefix("gas_")?.parse().ok()
}

/// Where a sensor hangs: a cell, or a height.
#[cfg(feature = "files")]
pub(super) fn place(table: &Table<'_>) -> Result<GasPlace, ThermalError> {
    let spec = table.spec;
    if let Some(height_m) = spec.height_m {
        if spec.cell.is_some() {
            return Err(check::conflict(&table.at("height_m"), "cell", "say in one way where it hangs"));
        }
        return Ok(GasPlace::Height { height_m });
    }
    match (spec.cell, cell_of(&spec.name)) {
        (None, Some(0)) => {
            let remedy = "gas_1 is the lowest cell of the gas";
            Err(check::broken(&table.at("name"), &spec.name, "numbered from 1", remedy))
        }
        (Some(number), _) | (None, Some(number)) => Ok(GasPlace::Cell { number }),
        (None, None) => Err(check::missing(&table.at("cell"), valid::CELL_REMEDY)),
    }
}
