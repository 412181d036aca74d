//! From the raw content of a vessel file to a checked [`Vessel`].
use super::calibration::CalibrationSpec;
use super::contour::{end, neck, volume};
use super::spec::{
    EquationChoice, GasChoice, GasSpec, InsideFilmSpec, LawChoice, OrientationChoice, SurfaceSpec, ValveSpec,
    VesselSpec,
};
use super::{GasResolution, InsideFilm, Stratification, Surface, Valve, Vessel};
use crate::ThermalError;
use crate::document::check;
use crate::fluid::{Equation, Fluid};
use crate::wall::geometry::{Geometry, Layer, Orientation};
use crate::wall::library;
use crate::wall::material::Material;

impl VesselSpec {
    /// Checks the specification and fills in its defaults.
    ///
    /// # Errors
    /// [`ThermalError::Specification`] with the path of the first value that breaks a bound.
    pub fn build(&self) -> Result<Vessel, ThermalError> {
        let geometry = self.geometry()?;
        let vessel = Vessel {
            name: self.name.clone(),
            fluid: named_fluid(&self.fluid, self.equation)?,
            volume: volume(&self.volume, &geometry)?,
            geometry,
            valve: self.valve.as_ref().map(|valve| self.valve(valve)).transpose()?,
            surface: surface(&self.surface),
            inside_film: inside_film(&self.inside_film)?,
            jet_film_factor: self.inside_film.jet_multiplier.unwrap_or(1.0),
            gas: gas(&self.gas)?,
        };
        vessel.validate()?;
        self.calibration.as_ref().map_or(Ok(()), CalibrationSpec::check)?;
        Ok(vessel)
    }

    fn geometry(&self) -> Result<Geometry, ThermalError> {
        let spec = &self.geometry;
        let layers = self.layers()?;
        let wall_m: f64 = layers.iter().map(|layer| layer.thickness_m).sum();
        let radius_m = 0.5 * spec.inner_diameter_m;
        Ok(Geometry {
            orientation: match self.orientation {
                OrientationChoice::Vertical => Orientation::Vertical,
                OrientationChoice::Horizontal => Orientation::Horizontal,
            },
            inner_diameter_m: spec.inner_diameter_m,
            cylinder_length_m: spec.cylinder_length_m,
            cylinder_cells: spec.cylinder_cells.unwrap_or(6),
            bottom: end("geometry.bottom", &spec.bottom, radius_m, wall_m, 2)?,
            shoulder: end("geometry.shoulder", &spec.shoulder, radius_m, wall_m, 3)?,
            neck: spec.neck.as_ref().map(neck),
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
            let material = self.material(&format!("{path}.material"), &spec.material)?;
            Ok(Layer {
                material: scaled(material, &path, spec.heat_capacity_factor)?,
                thickness_m: spec.thickness_m,
                cells: spec.cells.unwrap_or(3),
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
        let material = Material {
            name: spec.name.clone(),
            density_kg_m3: spec.density_kg_m3,
            heat_capacity_j_kg_k: spec.heat_capacity_j_kg_k,
            heat_capacity_slope_per_k: spec.heat_capacity_slope_per_k,
            conductivity_w_m_k: spec.conductivity_w_m_k,
            conductivity_slope_per_k: spec.conductivity_slope_per_k,
            source: spec.source.clone().unwrap_or_else(|| "the vessel file".to_owned()),
        };
        material.validate(&format!("material[{i}]"))?;
        Ok(material)
    }

    fn valve(&self, spec: &ValveSpec) -> Result<Valve, ThermalError> {
        let material = self.material("valve.material", spec.material.as_deref().unwrap_or("brass"))?;
        let material = scaled(material, "valve", spec.heat_capacity_factor)?;
        let diameter_m = spec.diameter_m.unwrap_or(0.05);
        let volume_m3 = spec.mass_kg / material.density_kg_m3;
        Ok(Valve {
            material,
            mass_kg: spec.mass_kg,
            contact_w_k: spec.contact_w_k.unwrap_or(8.0),
            area_m2: spec.area_m2.unwrap_or(6.0 * volume_m3 / diameter_m),
            diameter_m,
            film_factor: spec.film_factor.unwrap_or(1.0),
        })
    }
}

/// The gas by name, with its equation of state.
fn named_fluid(name: &str, equation: EquationChoice) -> Result<Fluid, ThermalError> {
    let equation = match equation {
        EquationChoice::Reference => Equation::Reference,
        EquationChoice::IdealGas => Equation::IdealGas,
        EquationChoice::PengRobinson => Equation::PengRobinson,
    };
    let fluid = Fluid::named(name)
        .map_err(|error| check::broken("fluid", format!("{name:?}"), "a known gas", &error.to_string()))?;
    Ok(fluid.with_equation(equation))
}

/// A material with a factor on its heat capacity.
fn scaled(mut material: Material, path: &str, factor: Option<f64>) -> Result<Material, ThermalError> {
    let remedy = "1 is the material as the library or the file states it";
    let path = format!("{path}.heat_capacity_factor");
    material.heat_capacity_j_kg_k *= check::positive(&path, factor.unwrap_or(1.0), remedy)?;
    Ok(material)
}

fn surface(spec: &SurfaceSpec) -> Surface {
    Surface {
        emissivity: spec.emissivity.unwrap_or(0.9),
        solar_absorptivity: spec.solar_absorptivity.unwrap_or(0.6),
        film_factor: spec.film_factor.unwrap_or(1.0),
    }
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
    let needed = |field: &str, value: Option<f64>| {
        value.ok_or_else(|| check::missing(&format!("inside_film.{field}"), "this law needs it"))
    };
    let power = |factor, exponent| InsideFilm::Rayleigh { factor, exponent, multiplier };
    Ok(match law {
        LawChoice::Mcadams => power(0.13, 1.0 / 3.0),
        LawChoice::Daney => power(0.104, 0.352),
        LawChoice::Rayleigh => {
            let exponent = needed("exponent", spec.exponent)?;
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
    let usual = Stratification::default();
    Ok(GasResolution::Stratified(Stratification {
        cells: spec.cells.unwrap_or(usual.cells),
        exchange_length_diameters: spec.exchange_length_diameters.unwrap_or(usual.exchange_length_diameters),
        core_mixing: spec.core_mixing.unwrap_or(usual.core_mixing),
    }))
}
