//! A vessel's contour as a file states it: ends, neck, inner volume.
use super::InnerVolume;
use super::spec::{EndSpec, NeckSpec, ShapeChoice, VolumeSpec};
use crate::ThermalError;
use crate::document::check;
use crate::units::{ATMOSPHERE_PA, ZERO_CELSIUS_K};
use crate::wall::geometry::{End, EndShape, Geometry, Neck};

pub(super) fn end(
    path: &str,
    spec: &EndSpec,
    radius_m: f64,
    wall_m: f64,
    cells: usize,
) -> Result<End, ThermalError> {
    if spec.shape != ShapeChoice::Ellipsoidal && spec.depth_m.is_some() {
        let remedy = "leave the depth out, or use shape = \"ellipsoidal\"";
        return Err(check::conflict(&format!("{path}.depth_m"), "this shape", remedy));
    }
    let shape = match spec.shape {
        ShapeChoice::Flat => EndShape::Flat,
        ShapeChoice::Hemispherical => EndShape::Dome { depth_m: radius_m },
        ShapeChoice::Ellipsoidal => EndShape::Dome { depth_m: spec.depth_m.unwrap_or(0.5 * radius_m) },
    };
    let thickness_m = spec.thickness_m.unwrap_or(wall_m);
    Ok(End { shape, thickness_m, cells: spec.cells.unwrap_or(cells) })
}

pub(super) fn neck(spec: &NeckSpec) -> Neck {
    Neck {
        inner_diameter_m: spec.inner_diameter_m,
        thickness_m: spec.thickness_m,
        length_m: spec.length_m,
        cells: spec.cells.unwrap_or(1),
    }
}

pub(super) fn volume(spec: &VolumeSpec, geometry: &Geometry) -> Result<InnerVolume, ThermalError> {
    for (path, value) in [
        ("volume.thermal_expansion_per_k", spec.thermal_expansion_per_k),
        ("volume.pressure_expansion_per_pa", spec.pressure_expansion_per_pa),
    ] {
        if spec.rigid && value.is_some_and(|value| value != 0.0) {
            return Err(check::conflict(path, "rigid = true", "keep one of them"));
        }
    }
    Ok(InnerVolume {
        volume_m3: spec.volume_m3.unwrap_or(geometry.contour_volume_m3()),
        thermal_expansion_per_k: spec.thermal_expansion_per_k.unwrap_or(0.0),
        pressure_expansion_per_pa: spec.pressure_expansion_per_pa.unwrap_or(0.0),
        reference_temperature_k: spec.reference_temperature_k.unwrap_or(ZERO_CELSIUS_K + 15.0),
        reference_pressure_pa: spec.reference_pressure_pa.unwrap_or(ATMOSPHERE_PA),
    })
}
