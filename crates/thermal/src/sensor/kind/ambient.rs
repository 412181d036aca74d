//! Thermometer in the air: `y = T_air + b`.
use super::{Kind, Prediction, Quantity};
#[cfg(feature = "files")]
use super::{SensorKind, StatedKind};

pub(super) const KIND: Kind = Kind {
    quantity: Quantity::Temperature,
    predict: |_, exposure, parameters| Prediction {
        value: exposure.air_k + parameters[0],
        per_air: 1.0,
        per_parameter: [1.0, 0.0, 0.0],
        ..Prediction::default()
    },
    parameters: &[],
    #[cfg(feature = "files")]
    stated: StatedKind {
        name: "ambient",
        keys: &[],
        is_named: |name| name == "ambient",
        columns: &["ambient"],
        build: |_| Ok(SensorKind::Ambient),
        parameters: |_| Vec::new(),
        coupling: None,
        plausible: |_| super::surface::OUTSIDE_K,
        typical: |spec| {
            spec.noise_k.get_or_insert(0.05);
            // The air at the sensor is not the air at the cylinder.
            if !spec.says_offset() {
                spec.offset_sd_k = Some(0.6);
            }
        },
    },
};
