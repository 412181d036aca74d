//! Bounds of a vessel. A vessel file is held to them, and so is a vessel that comes from anywhere else.
use super::{GasResolution, InnerVolume, InsideFilm, Stratification, Surface, Valve, Vessel};
use crate::ThermalError;
use crate::bounds;
use crate::wall::geometry::{End, EndShape, Geometry, Layer, Neck};
use crate::wall::material::Material;

/// Shortest and longest length a vessel may have, m: catches millimetres written as metres.
const LENGTHS_M: (f64, f64) = (1e-6, 50.0);
/// What no real vessel is beyond, and the arithmetic of its model bears: any factor on a law, and any size of a valve.
const FACTORS: (f64, f64) = (1e-6, 1e6);

impl Vessel {
    /// Checks every value.
    ///
    /// # Errors
    /// [`ThermalError::Specification`] with the path of the first value that breaks a bound, as a vessel file has it.
    pub fn validate(&self) -> Result<(), ThermalError> {
        if self.name.trim().is_empty() {
            return Err(bounds::broken("name", "\"\"", "a name", "say what this vessel is called"));
        }
        self.geometry.validate()?;
        self.volume.validate(&self.geometry)?;
        self.valve.as_ref().map_or(Ok(()), Valve::validate)?;
        self.surface.validate()?;
        self.inside_film.validate()?;
        let remedy = "1 is the law as published";
        at_most("inside_film.jet_multiplier", self.jet_film_factor, remedy)?;
        match &self.gas {
            GasResolution::WellMixed => Ok(()),
            GasResolution::Stratified(gas) => gas.validate(),
        }
    }
}

fn length(path: &str, value: f64) -> Result<(), ThermalError> {
    positive_within(path, value, (LENGTHS_M, "m"), "check the unit, _mm or _m")
}

fn factor(path: &str, value: f64, remedy: &str) -> Result<(), ThermalError> {
    positive_within(path, value, (FACTORS, ""), remedy)
}

/// A film or a factor that may be 0.
fn at_most(path: &str, value: f64, remedy: &str) -> Result<(), ThermalError> {
    bounds::not_negative(path, value, remedy)?;
    bounds::within(path, value, (0.0, FACTORS.1), &format!("at most {}", FACTORS.1), remedy)?;
    Ok(())
}

/// A value above 0 in a range with its unit.
fn positive_within(
    path: &str,
    value: f64,
    (range, unit): ((f64, f64), &str),
    remedy: &str,
) -> Result<(), ThermalError> {
    bounds::positive(path, value, remedy)?;
    let bound = format!("between {} and {} {unit}", range.0, range.1);
    bounds::within(path, value, range, bound.trim_end(), remedy)?;
    Ok(())
}

impl Geometry {
    fn validate(&self) -> Result<(), ThermalError> {
        if self.layers.is_empty() {
            let remedy = "describe the wall by at least one [[layer]] with material and thickness_mm";
            return Err(bounds::broken("layer", 0, "at least one", remedy));
        }
        self.layers.iter().enumerate().try_for_each(|(i, layer)| layer.validate(&format!("layer[{i}]")))?;
        length("geometry.inner_diameter_m", self.inner_diameter_m)?;
        let (wall_m, radius_m) = (self.thickness_m(), 0.5 * self.inner_diameter_m);
        if wall_m > radius_m {
            let bound = format!("at most {} mm together, the inner radius", 1e3 * radius_m);
            let remedy = "check the unit: a steel cylinder of 200 bar has 4 to 8 mm";
            return Err(bounds::broken("layer[0].thickness_m", wall_m, &bound, remedy));
        }
        self.neck.as_ref().map_or(Ok(()), |neck| neck.validate(self.inner_diameter_m))?;
        length("geometry.cylinder_length_m", self.cylinder_length_m)?;
        bounds::cells("geometry.cylinder_cells", self.cylinder_cells, 1)?;
        self.bottom.validate("geometry.bottom", radius_m)?;
        self.shoulder.validate("geometry.shoulder", radius_m)
    }
}

impl Layer {
    fn validate(&self, path: &str) -> Result<(), ThermalError> {
        self.material.validate(&format!("{path}.material"))?;
        let remedy = "give the thickness of this layer of the wall";
        let range = ((LENGTHS_M.0, 1.0), "m");
        positive_within(&format!("{path}.thickness_m"), self.thickness_m, range, remedy)?;
        bounds::cells(&format!("{path}.cells"), self.cells, 1)?;
        Ok(())
    }
}

impl End {
    fn validate(&self, path: &str, radius_m: f64) -> Result<(), ThermalError> {
        if let EndShape::Dome { depth_m } = self.shape {
            let path = format!("{path}.depth_m");
            let remedy =
                "a dome is as deep as the inner radius at most twice over; for no dome use shape = \"flat\"";
            bounds::positive(&path, depth_m, remedy)?;
            let range = (0.02 * radius_m, 2.0 * radius_m);
            bounds::within(&path, depth_m, range, "between 0.02 and 2 inner radii", remedy)?;
        }
        let remedy = "give the wall thickness of this end, or leave it out for that of the cylinder";
        positive_within(&format!("{path}.thickness_m"), self.thickness_m, (LENGTHS_M, "m"), remedy)?;
        bounds::cells(&format!("{path}.cells"), self.cells, 1)?;
        Ok(())
    }
}

impl Neck {
    fn validate(&self, cylinder_m: f64) -> Result<(), ThermalError> {
        length("geometry.neck.inner_diameter_m", self.inner_diameter_m)?;
        length("geometry.neck.thickness_m", self.thickness_m)?;
        length("geometry.neck.length_m", self.length_m)?;
        bounds::cells("geometry.neck.cells", self.cells, 1)?;
        if self.inner_diameter_m + 2.0 * self.thickness_m >= cylinder_m {
            let remedy = "the neck's outer diameter has to fit into the cylinder's inner diameter";
            let path = "geometry.neck.inner_diameter_m";
            return Err(bounds::broken(path, self.inner_diameter_m, "smaller", remedy));
        }
        Ok(())
    }
}

impl Material {
    /// Checks every number; `path` is that of its table.
    pub(super) fn validate(&self, path: &str) -> Result<(), ThermalError> {
        for (field, value, range) in [
            ("density_kg_m3", self.density_kg_m3, ((1.0, 3e4), "kg/m3")),
            ("heat_capacity_j_kg_k", self.heat_capacity_j_kg_k, ((1.0, 1e5), "J/(kg K)")),
            ("conductivity_w_m_k", self.conductivity_w_m_k, ((1e-3, 1e4), "W/(m K)")),
        ] {
            positive_within(&format!("{path}.{field}"), value, range, "give the value at 20 degC")?;
        }
        let remedy = "give the relative change per kelvin, e.g. 6e-4 for the heat capacity of steel";
        for (field, value) in [
            ("heat_capacity_slope_per_k", self.heat_capacity_slope_per_k),
            ("conductivity_slope_per_k", self.conductivity_slope_per_k),
        ] {
            let bound = "between -0.004 and 0.004 per K";
            bounds::within(&format!("{path}.{field}"), value, (-0.004, 0.004), bound, remedy)?;
        }
        Ok(())
    }
}

impl InnerVolume {
    fn validate(&self, geometry: &Geometry) -> Result<(), ThermalError> {
        for (path, value, most) in [
            ("volume.thermal_expansion_per_k", self.thermal_expansion_per_k, 1e-3),
            ("volume.pressure_expansion_per_pa", self.pressure_expansion_per_pa, 1e-8),
        ] {
            let remedy = "steel expands by 3.5e-5 per K, and a 20 L cylinder of it by about 1.5e-5 per bar";
            bounds::within(path, value, (0.0, most), &format!("between 0 and {most} (SI)"), remedy)?;
        }
        let contour_m3 = geometry.contour_volume_m3();
        let (path, remedy) = ("volume.volume_m3", "check volume, diameter and lengths");
        bounds::positive(path, self.volume_m3, remedy)?;
        let bound = format!("within 30 % of the contour's {:.4} l", 1e3 * contour_m3);
        bounds::within(path, self.volume_m3, (0.7 * contour_m3, 1.3 * contour_m3), &bound, remedy)?;
        bounds::temperature_k("volume.reference_temperature_k", self.reference_temperature_k)?;
        bounds::pressure_pa("volume.reference_pressure_pa", self.reference_pressure_pa)?;
        Ok(())
    }
}

impl Valve {
    fn validate(&self) -> Result<(), ThermalError> {
        self.material.validate("valve.material")?;
        factor("valve.mass_kg", self.mass_kg, "give the mass of the valve, or no [valve]")?;
        length("valve.diameter_m", self.diameter_m)?;
        let remedy = "give the conductance of thread and sealing, 5 to 15 W/K are usual";
        factor("valve.contact_w_k", self.contact_w_k, remedy)?;
        factor("valve.area_m2", self.area_m2, "give the area that the air touches")?;
        factor("valve.film_factor", self.film_factor, "1 is the cylinder's own film")
    }
}

impl Surface {
    fn validate(&self) -> Result<(), ThermalError> {
        let remedy = "paint has about 0.9, bare metal 0.1 to 0.3";
        bounds::fraction("surface.emissivity", self.emissivity, remedy)?;
        let remedy = "white paint has about 0.25, dark paint 0.9";
        bounds::fraction("surface.solar_absorptivity", self.solar_absorptivity, remedy)?;
        factor("surface.film_factor", self.film_factor, "1 is the film as the scenario states it")
    }
}

impl InsideFilm {
    fn validate(&self) -> Result<(), ThermalError> {
        match *self {
            Self::Rayleigh { factor: of_law, exponent, multiplier } => {
                factor("inside_film.multiplier", multiplier, "1 is the law as published")?;
                bounds::positive("inside_film.exponent", exponent, "give the law's constant")?;
                let remedy = "laminar flow has 1/4, turbulent flow 1/3";
                bounds::within("inside_film.exponent", exponent, (0.0, 0.5), "at most 0.5", remedy)?;
                factor("inside_film.factor", of_law, "give the law's constant")
            }
            Self::Coefficient { film_w_m2_k } => {
                let remedy = "0 lets no heat through; a full cylinder has 50 to 150";
                at_most("inside_film.film_w_m2_k", film_w_m2_k, remedy)
            }
        }
    }
}

impl Stratification {
    fn validate(&self) -> Result<(), ThermalError> {
        if !(2..=100).contains(&self.cells) {
            let remedy = "20 are usual; model = \"well-mixed\" is the gas of one temperature";
            return Err(bounds::broken("gas.cells", self.cells, "between 2 and 100", remedy));
        }
        factor("gas.exchange_length_diameters", self.exchange_length_diameters, "about 1 is usual")?;
        bounds::fraction("gas.core_mixing", self.core_mixing, "0 to 0.2 are usual")?;
        Ok(())
    }
}
