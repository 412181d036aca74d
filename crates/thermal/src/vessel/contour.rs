//! Checks of a vessel's contour: ends, neck, inner volume.
use super::InnerVolume;
use super::spec::{EndSpec, NeckSpec, ShapeChoice, VolumeSpec};
use crate::ThermalError;
use crate::document::check;
use crate::units::{ATMOSPHERE_PA, ZERO_CELSIUS_K};
use crate::wall::geometry::{End, EndShape, Geometry, Neck};

/// Longest length a vessel file may state, m: catches millimetres written as metres.
const LENGTH_MAX_M: f64 = 50.0;

pub(super) fn length(path: &str, value: f64) -> Result<f64, ThermalError> {
    let remedy = "check the unit, _mm or _m";
    check::within(path, check::positive(path, value, remedy)?, (0.0, LENGTH_MAX_M), "at most 50 m", remedy)
}

pub(super) fn end(
    path: &str,
    spec: &EndSpec,
    radius_m: f64,
    wall_m: f64,
    cells: usize,
) -> Result<End, ThermalError> {
    let at = |field: &str| format!("{path}.{field}");
    if spec.shape != ShapeChoice::Ellipsoidal && spec.depth_m.is_some() {
        let remedy = "leave the depth out, or use shape = \"ellipsoidal\"";
        return Err(check::conflict(&at("depth_m"), "this shape", remedy));
    }
    let shape = match spec.shape {
        ShapeChoice::Flat => EndShape::Flat,
        ShapeChoice::Hemispherical => EndShape::Dome { depth_m: radius_m },
        ShapeChoice::Ellipsoidal => {
            let depth_m = spec.depth_m.unwrap_or(0.5 * radius_m);
            let remedy =
                "a dome is as deep as the inner radius at most twice over; for no dome use shape = \"flat\"";
            check::positive(&at("depth_m"), depth_m, remedy)?;
            let range = (0.02 * radius_m, 2.0 * radius_m);
            let bound = "between 0.02 and 2 inner radii";
            EndShape::Dome { depth_m: check::within(&at("depth_m"), depth_m, range, bound, remedy)? }
        }
    };
    let remedy = "give the wall thickness of this end, or leave it out for that of the cylinder";
    let thickness_m = check::positive(&at("thickness_m"), spec.thickness_m.unwrap_or(wall_m), remedy)?;
    check::within(&at("thickness_m"), thickness_m, (0.0, LENGTH_MAX_M), "at most 50 m", remedy)?;
    let cells = check::cells(&at("cells"), spec.cells.unwrap_or(cells), 1)?;
    Ok(End { shape, thickness_m, cells })
}

pub(super) fn build_neck(spec: &NeckSpec, cylinder_m: f64) -> Result<Neck, ThermalError> {
    let at = |field: &str| format!("geometry.neck.{field}");
    let neck = Neck {
        inner_diameter_m: length(&at("inner_diameter_m"), spec.inner_diameter_m)?,
        thickness_m: length(&at("thickness_m"), spec.thickness_m)?,
        length_m: length(&at("length_m"), spec.length_m)?,
        cells: check::cells(&at("cells"), spec.cells.unwrap_or(1), 1)?,
    };
    if neck.inner_diameter_m + 2.0 * neck.thickness_m >= cylinder_m {
        let remedy = "the neck's outer diameter has to fit into the cylinder's inner diameter";
        return Err(check::broken(&at("inner_diameter_m"), spec.inner_diameter_m, "smaller", remedy));
    }
    Ok(neck)
}

pub(super) fn volume(spec: &VolumeSpec, geometry: &Geometry) -> Result<InnerVolume, ThermalError> {
    let stated = [
        ("volume.thermal_expansion_per_k", spec.thermal_expansion_per_k, 1e-3),
        ("volume.pressure_expansion_per_pa", spec.pressure_expansion_per_pa, 1e-8),
    ];
    for (path, value, most) in stated {
        let Some(value) = value else { continue };
        if spec.rigid && value != 0.0 {
            return Err(check::conflict(path, "rigid = true", "keep one of them"));
        }
        let remedy = "steel expands by 3.5e-5 per K, and a 20 L cylinder of it by about 1.5e-5 per bar";
        check::within(path, value, (0.0, most), &format!("between 0 and {most} (SI)"), remedy)?;
    }
    let contour_m3 = geometry.contour_volume_m3();
    let volume_m3 = spec.volume_m3.unwrap_or(contour_m3);
    let remedy = "check volume, diameter and lengths";
    check::positive("volume.volume_m3", volume_m3, remedy)?;
    let bound = format!("within 30 % of the contour's {:.4} l", 1e3 * contour_m3);
    check::within("volume.volume_m3", volume_m3, (0.7 * contour_m3, 1.3 * contour_m3), &bound, remedy)?;
    let reference_k = spec.reference_temperature_k.unwrap_or(ZERO_CELSIUS_K + 15.0);
    let reference_pa = spec.reference_pressure_pa.unwrap_or(ATMOSPHERE_PA);
    Ok(InnerVolume {
        volume_m3,
        thermal_expansion_per_k: spec.thermal_expansion_per_k.unwrap_or(0.0),
        pressure_expansion_per_pa: spec.pressure_expansion_per_pa.unwrap_or(0.0),
        reference_temperature_k: check::temperature_k("volume.reference_temperature_k", reference_k)?,
        reference_pressure_pa: check::pressure_pa("volume.reference_pressure_pa", reference_pa)?,
    })
}
