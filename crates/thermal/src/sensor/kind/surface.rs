//! Thermometer on the wall or the valve: `y = T + kappa (T_air - T) + b` with the mounting coupling `kappa`.
use super::{Bound, Kind, ParameterKind, Prediction, Quantity};
#[cfg(feature = "files")]
use {
    super::{SensorKind, StatedKind, SurfacePlace, Table},
    crate::ThermalError,
    crate::document::check,
    crate::sensor::{PLACES, Pt100Class},
};

/// Lowest and highest temperature outside that can be a reading, K: colder than the coldest weather, hotter than
/// any cylinder may become.
#[cfg(feature = "files")]
pub(super) const OUTSIDE_K: (f64, f64) = (183.15, 423.15);

pub(super) const KIND: Kind = Kind {
    quantity: Quantity::Temperature,
    predict: |_, exposure, parameters| {
        let (kappa, t, air) = (parameters[1], exposure.body_k, exposure.air_k);
        Prediction {
            value: t + kappa * (air - t) + parameters[0],
            per_body: 1.0 - kappa,
            per_air: kappa,
            per_parameter: [1.0, air - t, 0.0],
            ..Prediction::default()
        }
    },
    parameters: &[(
        ParameterKind::Coupling,
        [
            Bound::fraction("air_coupling", "0 is a sensor in ideal contact, 0.15 to 0.2 a strapped one"),
            Bound::fraction("air_coupling_sd", "0.04 is usual for strapped sensors"),
        ],
    )],
    #[cfg(feature = "files")]
    stated: StatedKind {
        name: "surface",
        keys: &["place", "height_m", "air_coupling", "air_coupling_sd"],
        is_named: |_| false,
        columns: &["shoulder", "valve", "wall_<place>"],
        build: |table| Ok(SensorKind::Surface { place: place(table)? }),
        parameters: |spec| vec![[spec.air_coupling, spec.air_coupling_sd]],
        coupling: Some(|spec| [&mut spec.air_coupling, &mut spec.air_coupling_sd]),
        plausible: |_| OUTSIDE_K,
        typical: |spec| {
            spec.noise_k.get_or_insert(0.05);
            spec.air_coupling.get_or_insert(0.1);
            spec.air_coupling_sd.get_or_insert(0.04);
            if !spec.says_offset() {
                spec.class = Some(Pt100Class::B);
            }
        },
    },
};

#[cfg(feature = "files")]
fn place(table: &Table<'_>) -> Result<SurfacePlace, ThermalError> {
    let spec = table.spec;
    if let Some(height_m) = spec.height_m {
        if spec.place.is_some() {
            return Err(check::conflict(&table.at("height_m"), "place", "say in one way where it sits"));
        }
        return Ok(SurfacePlace::Height { height_m });
    }
    let (field, name) = match &spec.place {
        Some(place) => ("place", place.as_str()),
        None => ("name", spec.name.strip_prefix("wall_").unwrap_or(&spec.name)),
    };
    SurfacePlace::named(name).ok_or_else(|| check::unknown(&table.at(field), name, PLACES))
}
