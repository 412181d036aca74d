//! From the raw content of a vessel file to a checked [`Vessel`].
use super::contour::{build_neck, end, length, volume};
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
        if self.name.trim().is_empty() {
            return Err(check::broken("name", "\"\"", "a name", "say what this vessel is called"));
        }
        let geometry = self.geometry()?;
        let volume = volume(&self.volume, &geometry)?;
        if let Some(calibration) = &self.calibration {
            calibration.check()?;
        }
        let valve = self.valve.as_ref().map(|valve| self.valve(valve)).transpose()?;
        Ok(Vessel {
            name: self.name.clone(),
            fluid: named_fluid(&self.fluid, self.equation)?,
            geometry,
            volume,
            valve,
            surface: surface(&self.surface)?,
            inside_film: inside_film(&self.inside_film)?,
            jet_film_factor: check::not_negative(
                "inside_film.jet_multiplier",
                self.inside_film.jet_multiplier.unwrap_or(1.0),
                "1 is the law as published",
            )?,
            gas: gas(&self.gas)?,
        })
    }

    fn geometry(&self) -> Result<Geometry, ThermalError> {
        let spec = &self.geometry;
        let layers = self.layers()?;
        let wall_m: f64 = layers.iter().map(|layer| layer.thickness_m).sum();
        let inner_diameter_m = length("geometry.inner_diameter_m", spec.inner_diameter_m)?;
        let radius_m = 0.5 * inner_diameter_m;
        if wall_m > radius_m {
            let bound = format!("at most {} mm together, the inner radius", 1e3 * radius_m);
            let remedy = "check the unit: a steel cylinder of 200 bar has 4 to 8 mm";
            return Err(check::broken("layer[0].thickness_m", wall_m, &bound, remedy));
        }
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
            let material = self.material(&format!("{path}.material"), &spec.material)?;
            Ok(Layer {
                material: scaled(material, &path, spec.heat_capacity_factor)?,
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
        let material = scaled(material, "valve", spec.heat_capacity_factor)?;
        let mass_kg =
            check::positive("valve.mass_kg", spec.mass_kg, "give the mass of the valve, or no [valve]")?;
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

fn surface(spec: &SurfaceSpec) -> Result<Surface, ThermalError> {
    let emissivity = spec.emissivity.unwrap_or(0.9);
    let absorptivity = spec.solar_absorptivity.unwrap_or(0.6);
    Ok(Surface {
        emissivity: check::fraction(
            "surface.emissivity",
            emissivity,
            "paint has about 0.9, bare metal 0.1 to 0.3",
        )?,
        solar_absorptivity: check::fraction(
            "surface.solar_absorptivity",
            absorptivity,
            "white paint has about 0.25, dark paint 0.9",
        )?,
        film_factor: check::positive(
            "surface.film_factor",
            spec.film_factor.unwrap_or(1.0),
            "1 is the film as the scenario states it",
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
            let path = "inside_film.film_w_m2_k";
            let film = spec.film_w_m2_k.ok_or_else(|| check::missing(path, "this law needs it"))?;
            let remedy = "0 lets no heat through; a full cylinder has 50 to 150";
            InsideFilm::Coefficient { film_w_m2_k: check::not_negative(path, film, remedy)? }
        }
    })
}

fn gas_cells(cells: usize) -> Result<usize, ThermalError> {
    if (2..=100).contains(&cells) {
        return Ok(cells);
    }
    let remedy = "20 are usual; model = \"well-mixed\" is the gas of one temperature";
    Err(check::broken("gas.cells", cells, "between 2 and 100", remedy))
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
    let exchange = spec.exchange_length_diameters.unwrap_or(usual.exchange_length_diameters);
    let mixing = spec.core_mixing.unwrap_or(usual.core_mixing);
    Ok(GasResolution::Stratified(Stratification {
        cells: gas_cells(spec.cells.unwrap_or(usual.cells))?,
        exchange_length_diameters: check::positive(
            "gas.exchange_length_diameters",
            exchange,
            "about 1 is usual",
        )?,
        core_mixing: check::within(
            "gas.core_mixing",
            mixing,
            (0.0, 1.0),
            "between 0 and 1",
            "0 to 0.2 are usual",
        )?,
    }))
}
