//! From the raw content of a vessel file to a checked [`Vessel`].
use std::f64::consts::PI;

use super::spec::{
    EndSpec, EquationChoice, GasChoice, GasSpec, InsideFilmSpec, LawChoice, NeckSpec,
    OrientationChoice, ShapeChoice, SurfaceSpec, ValveSpec, VesselSpec, VolumeSpec,
};
use super::{GasResolution, InnerVolume, InsideFilm, Stratification, Surface, Valve, Vessel};
use crate::ThermalError;
use crate::document::check;
use crate::fluid::Fluid;
use crate::units::{ATMOSPHERE_PA, ZERO_CELSIUS_K};
use crate::wall::geometry::{End, EndShape, Geometry, Layer, Neck, Orientation};
use crate::wall::library;
use crate::wall::material::Material;

/// Longest length a vessel file may state, m: catches millimetres written as metres.
const LENGTH_MAX_M: f64 = 50.0;

impl VesselSpec {
    /// Checks the specification and fills in its defaults.
    ///
    /// # Errors
    /// [`ThermalError::Specification`] with the path of the first value that breaks a bound.
    pub fn build(&self) -> Result<Vessel, ThermalError> {
        if self.name.trim().is_empty() {
            return Err(check::broken("name", "\"\"", "a name", "say what this vessel is called"));
        }
        let geometry = self.geometry()?;
        let volume = volume(&self.volume, &geometry)?;
        let valve = self.valve.as_ref().map(|valve| self.valve(valve)).transpose()?;
        Ok(Vessel {
            name: self.name.clone(),
            fluid: self.fluid()?,
            geometry,
            volume,
            valve,
            surface: surface(&self.surface)?,
            inside_film: inside_film(&self.inside_film)?,
            gas: gas(&self.gas)?,
        })
    }

    fn fluid(&self) -> Result<Fluid, ThermalError> {
        named_fluid(&self.fluid, self.equation)
    }

    fn geometry(&self) -> Result<Geometry, ThermalError> {
        let spec = &self.geometry;
        let layers = self.layers()?;
        let wall_m = layers.iter().map(|layer| layer.thickness_m).sum();
        let inner_diameter_m = length("geometry.inner_diameter_m", spec.inner_diameter_m)?;
        let radius_m = 0.5 * inner_diameter_m;
        let neck = spec.neck.as_ref().map(|neck| build_neck(neck, inner_diameter_m)).transpose()?;
        Ok(Geometry {
            orientation: match self.orientation {
                OrientationChoice::Vertical => Orientation::Vertical,
                OrientationChoice::Horizontal => Orientation::Horizontal,
            },
            inner_diameter_m,
            cylinder_length_m: length("geometry.cylinder_length_m", spec.cylinder_length_m)?,
            cylinder_cells: check::cells("geometry.cylinder_cells", spec.cylinder_cells.unwrap_or(6), 1)?,
            bottom: end("geometry.bottom", &spec.bottom, radius_m, wall_m, 2)?,
            shoulder: end("geometry.shoulder", &spec.shoulder, radius_m, wall_m, 3)?,
            neck,
            layers,
            lumped: spec.lumped,
        })
    }

    fn layers(&self) -> Result<Vec<Layer>, ThermalError> {
        if self.layer.is_empty() {
            let remedy = "describe the wall by at least one [[layer]] with material and thickness_mm";
            return Err(check::missing("layer", remedy));
        }
        let layer = |(i, spec): (usize, &super::spec::LayerSpec)| {
            let path = format!("layer[{i}]");
            let remedy = "give the thickness of this layer of the wall";
            Ok(Layer {
                material: self.material(&format!("{path}.material"), &spec.material)?,
                thickness_m: check::within(
                    &format!("{path}.thickness_m"),
                    check::positive(&format!("{path}.thickness_m"), spec.thickness_m, remedy)?,
                    (0.0, 1.0),
                    "at most 1 m",
                    remedy,
                )?,
                cells: check::cells(&format!("{path}.cells"), spec.cells.unwrap_or(3), 1)?,
            })
        };
        self.layer.iter().enumerate().map(layer).collect()
    }

    /// A material of the file or of the library.
    fn material(&self, path: &str, name: &str) -> Result<Material, ThermalError> {
        let own = self.material.iter().position(|material| material.name.eq_ignore_ascii_case(name));
        if let Some(i) = own {
            return self.own_material(i);
        }
        library::find(name).ok_or_else(|| {
            let mut known: Vec<&str> = library::names().collect();
            known.extend(self.material.iter().map(|material| material.name.as_str()));
            check::unknown(path, name, known)
        })
    }

    fn own_material(&self, i: usize) -> Result<Material, ThermalError> {
        let spec = &self.material[i];
        let path = |field: &str| format!("material[{i}].{field}");
        let positive = |field: &str, value| check::positive(&path(field), value, "give the value at 20 degC");
        let slope = |field: &str, value| {
            let remedy = "give the relative change per kelvin, e.g. 6e-4 for the heat capacity of steel";
            check::within(&path(field), value, (-0.004, 0.004), "between -0.004 and 0.004 per K", remedy)
        };
        Ok(Material {
            name: spec.name.clone(),
            density_kg_m3: positive("density_kg_m3", spec.density_kg_m3)?,
            heat_capacity_j_kg_k: positive("heat_capacity_j_kg_k", spec.heat_capacity_j_kg_k)?,
            heat_capacity_slope_per_k: slope("heat_capacity_slope_per_k", spec.heat_capacity_slope_per_k)?,
            conductivity_w_m_k: positive("conductivity_w_m_k", spec.conductivity_w_m_k)?,
            conductivity_slope_per_k: slope("conductivity_slope_per_k", spec.conductivity_slope_per_k)?,
            source: spec.source.clone().unwrap_or_else(|| "the vessel file".to_owned()),
        })
    }

    fn valve(&self, spec: &ValveSpec) -> Result<Valve, ThermalError> {
        let material = self.material("valve.material", spec.material.as_deref().unwrap_or("brass"))?;
        let mass_kg = check::positive("valve.mass_kg", spec.mass_kg, "give the mass of the valve, or no [valve]")?;
        let diameter_m = length("valve.diameter_m", spec.diameter_m.unwrap_or(0.05))?;
        let volume_m3 = mass_kg / material.density_kg_m3;
        let area_m2 = spec.area_m2.unwrap_or(6.0 * volume_m3 / diameter_m);
        let factor = spec.film_factor.unwrap_or(1.0);
        Ok(Valve {
            material,
            mass_kg,
            contact_w_k: check::positive(
                "valve.contact_w_k",
                spec.contact_w_k.unwrap_or(8.0),
                "give the conductance of thread and sealing, 5 to 15 W/K are usual",
            )?,
            area_m2: check::positive("valve.area_m2", area_m2, "give the area that the air touches")?,
            diameter_m,
            film_factor: check::positive("valve.film_factor", factor, "1 is the cylinder's own film")?,
        })
    }
}

/// The gas by name, with its equation of state.
fn named_fluid(name: &str, equation: EquationChoice) -> Result<Fluid, ThermalError> {
    let _ = equation;
    match name {
        "nitrogen" => Ok(Fluid {}),
        _ => Err(check::unknown("fluid", name, ["nitrogen"])),
    }
}

fn length(path: &str, value: f64) -> Result<f64, ThermalError> {
    let remedy = "check the unit, _mm or _m";
    check::within(path, check::positive(path, value, remedy)?, (0.0, LENGTH_MAX_M), "at most 50 m", remedy)
}

fn end(path: &str, spec: &EndSpec, radius_m: f64, wall_m: f64, cells: usize) -> Result<End, ThermalError> {
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
            let remedy = "a dome is as deep as the inner radius at most twice over; for no dome use shape = \"flat\"";
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

fn build_neck(spec: &NeckSpec, cylinder_m: f64) -> Result<Neck, ThermalError> {
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

/// Inner volume of the contour, m³: cylinder and half spheroids, without the neck, whose bore the valve fills.
pub(super) fn contour_volume_m3(geometry: &Geometry) -> f64 {
    let section_m2 = PI * (0.5 * geometry.inner_diameter_m).powi(2);
    let dome_m = |end: &End| match end.shape {
        EndShape::Flat => 0.0,
        EndShape::Dome { depth_m } => 2.0 / 3.0 * depth_m,
    };
    section_m2 * (geometry.cylinder_length_m + dome_m(&geometry.bottom) + dome_m(&geometry.shoulder))
}

fn volume(spec: &VolumeSpec, geometry: &Geometry) -> Result<InnerVolume, ThermalError> {
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
    let contour_m3 = contour_volume_m3(geometry);
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

fn surface(spec: &SurfaceSpec) -> Result<Surface, ThermalError> {
    let emissivity = spec.emissivity.unwrap_or(0.9);
    let absorptivity = spec.solar_absorptivity.unwrap_or(0.6);
    Ok(Surface {
        emissivity: check::fraction("surface.emissivity", emissivity, "paint has about 0.9, bare metal 0.1 to 0.3")?,
        solar_absorptivity: check::fraction(
            "surface.solar_absorptivity",
            absorptivity,
            "white paint has about 0.25, dark paint 0.9",
        )?,
    })
}

fn inside_film(spec: &InsideFilmSpec) -> Result<InsideFilm, ThermalError> {
    let law = spec.law;
    let refuse = |field: &str, value: Option<f64>, allowed: bool| match value {
        Some(_) if !allowed => {
            let remedy = "leave it out, or choose the law that takes it";
            Err(check::conflict(&format!("inside_film.{field}"), "this law", remedy))
        }
        _ => Ok(()),
    };
    refuse("factor", spec.factor, law == LawChoice::Rayleigh)?;
    refuse("exponent", spec.exponent, law == LawChoice::Rayleigh)?;
    refuse("film_w_m2_k", spec.film_w_m2_k, law == LawChoice::Coefficient)?;
    refuse("multiplier", spec.multiplier, law != LawChoice::Coefficient)?;
    let multiplier = spec.multiplier.unwrap_or(1.0);
    check::positive("inside_film.multiplier", multiplier, "1 is the law as published")?;
    let needed = |field: &str, value: Option<f64>| {
        let path = format!("inside_film.{field}");
        let value = value.ok_or_else(|| check::missing(&path, "this law needs it"))?;
        check::positive(&path, value, "give the law's constant")
    };
    let power = |factor, exponent| InsideFilm::Rayleigh { factor, exponent, multiplier };
    Ok(match law {
        LawChoice::Mcadams => power(0.13, 1.0 / 3.0),
        LawChoice::Daney => power(0.104, 0.352),
        LawChoice::Rayleigh => {
            let exponent = needed("exponent", spec.exponent)?;
            let remedy = "laminar flow has 1/4, turbulent flow 1/3";
            check::within("inside_film.exponent", exponent, (0.0, 0.5), "at most 0.5", remedy)?;
            power(needed("factor", spec.factor)?, exponent)
        }
        LawChoice::Coefficient => {
            InsideFilm::Coefficient { film_w_m2_k: needed("film_w_m2_k", spec.film_w_m2_k)? }
        }
    })
}

fn gas(spec: &GasSpec) -> Result<GasResolution, ThermalError> {
    if spec.model == GasChoice::WellMixed {
        let given = [
            ("gas.cells", spec.cells.is_some()),
            ("gas.exchange_length_diameters", spec.exchange_length_diameters.is_some()),
            ("gas.core_mixing", spec.core_mixing.is_some()),
        ];
        if let Some((path, _)) = given.iter().find(|(_, given)| *given) {
            let remedy = "leave it out, or use model = \"stratified\"";
            return Err(check::conflict(path, "model = \"well-mixed\"", remedy));
        }
        return Ok(GasResolution::WellMixed);
    }
    let exchange = spec.exchange_length_diameters.unwrap_or(1.0);
    let mixing = spec.core_mixing.unwrap_or(0.05);
    Ok(GasResolution::Stratified(Stratification {
        cells: check::cells("gas.cells", spec.cells.unwrap_or(8), 2)?,
        exchange_length_diameters: check::positive("gas.exchange_length_diameters", exchange, "about 1 is usual")?,
        core_mixing: check::within("gas.core_mixing", mixing, (0.0, 1.0), "between 0 and 1", "0 to 0.2 are usual")?,
    }))
}
