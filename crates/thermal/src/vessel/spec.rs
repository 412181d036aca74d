//! Raw content of a vessel file.
//!
//! Every field is SI here; the file may use any unit of the field's dimension (see [`crate::document`]).
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

pub use super::calibration::{CalibrationSpec, FittedSpec, OriginSpec, PriorSpec};

/// Raw content of a vessel file.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize, JsonSchema)]
pub struct VesselSpec {
    /// Name for people.
    pub name: String,
    /// The gas inside, e.g. `nitrogen`.
    pub fluid: String,
    /// Equation of state; the reference equation by default.
    #[serde(default)]
    pub equation: EquationChoice,
    /// How the axis lies; vertical, valve at the top, by default.
    #[serde(default)]
    pub orientation: OrientationChoice,
    /// Inner contour.
    pub geometry: GeometrySpec,
    /// Layers of the cylindrical wall, from the inside to the outside; at least one.
    #[serde(default)]
    pub layer: Vec<LayerSpec>,
    /// Materials of this file; they hide those of the library with the same name.
    #[serde(default)]
    pub material: Vec<MaterialSpec>,
    /// Inner volume and how it gives way; by default the contour's volume, rigid.
    #[serde(default)]
    pub volume: VolumeSpec,
    /// Valve body on the neck; none by default.
    pub valve: Option<ValveSpec>,
    /// The outer surface: radiation, film.
    #[serde(default)]
    pub surface: SurfaceSpec,
    /// Heat transfer between wall and gas.
    #[serde(default)]
    pub inside_film: InsideFilmSpec,
    /// How the gas is resolved.
    #[serde(default)]
    pub gas: GasSpec,
    /// Where fitted values of this file come from; none for a file that nobody has calibrated.
    pub calibration: Option<CalibrationSpec>,
}

/// Equation of state.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum EquationChoice {
    /// The fluid's reference equation.
    #[default]
    Reference,
    /// Ideal gas.
    IdealGas,
    /// Peng and Robinson's cubic equation.
    PengRobinson,
}

/// How the axis lies.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum OrientationChoice {
    /// Valve at the top.
    #[default]
    Vertical,
    /// Axis horizontal.
    Horizontal,
}

/// Inner contour: bottom, cylinder, shoulder, neck.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize, JsonSchema)]
pub struct GeometrySpec {
    /// Inner diameter of the cylinder.
    pub inner_diameter_m: f64,
    /// Inner length of the cylinder without its ends.
    pub cylinder_length_m: f64,
    /// Axial wall cells of the cylinder, 6 by default.
    pub cylinder_cells: Option<usize>,
    /// True: the whole wall is one cell of one temperature.
    #[serde(default)]
    pub lumped: bool,
    /// Closing end at the bottom; 2 axial cells by default.
    #[serde(default)]
    pub bottom: EndSpec,
    /// Closing end at the valve's side; 3 axial cells by default.
    #[serde(default)]
    pub shoulder: EndSpec,
    /// Tube above the shoulder that carries the valve; none by default.
    pub neck: Option<NeckSpec>,
}

/// A closing end.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, Serialize, JsonSchema)]
pub struct EndSpec {
    /// Shape of the inner contour, ellipsoidal by default.
    #[serde(default)]
    pub shape: ShapeChoice,
    /// Inner depth of an ellipsoidal end; half the inner radius by default.
    pub depth_m: Option<f64>,
    /// Wall thickness; the cylinder's by default.
    pub thickness_m: Option<f64>,
    /// Axial wall cells along the meridian.
    pub cells: Option<usize>,
}

/// Shape of a closing end.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ShapeChoice {
    /// A disc.
    Flat,
    /// Half a sphere.
    Hemispherical,
    /// Half a spheroid of stated depth.
    #[default]
    Ellipsoidal,
}

/// The neck.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize, JsonSchema)]
pub struct NeckSpec {
    /// Bore.
    pub inner_diameter_m: f64,
    /// Wall thickness.
    pub thickness_m: f64,
    /// Length.
    pub length_m: f64,
    /// Axial wall cells, 1 by default.
    pub cells: Option<usize>,
}

/// A layer of the cylindrical wall.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize, JsonSchema)]
pub struct LayerSpec {
    /// Name of a material of the library or of this file.
    pub material: String,
    /// Thickness on the cylinder.
    pub thickness_m: f64,
    /// Radial wall cells, 3 by default.
    pub cells: Option<usize>,
    /// Factor on the heat capacity of the material, 1 by default; a calibration sets it.
    pub heat_capacity_factor: Option<f64>,
}

/// A material of the file's own.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize, JsonSchema)]
pub struct MaterialSpec {
    /// Name that layers and the valve use.
    pub name: String,
    /// Density.
    pub density_kg_m3: f64,
    /// Specific heat capacity at 20 °C.
    pub heat_capacity_j_kg_k: f64,
    /// Relative change of the heat capacity per kelvin, 0 by default.
    #[serde(default)]
    pub heat_capacity_slope_per_k: f64,
    /// Thermal conductivity at 20 °C.
    pub conductivity_w_m_k: f64,
    /// Relative change of the conductivity per kelvin, 0 by default.
    #[serde(default)]
    pub conductivity_slope_per_k: f64,
    /// Where the numbers come from.
    pub source: Option<String>,
}

/// Inner volume.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, Serialize, JsonSchema)]
pub struct VolumeSpec {
    /// Volume at the reference state; by default the contour's (cylinder, ends and neck).
    pub volume_m3: Option<f64>,
    /// True: the volume is constant and no expansion may be given.
    #[serde(default)]
    pub rigid: bool,
    /// Relative expansion by temperature (steel: 3.5e-5 per K); 0 by default.
    pub thermal_expansion_per_k: Option<f64>,
    /// Relative expansion by pressure (20 L steel: 1.5e-5 per bar); 0 by default.
    pub pressure_expansion_per_pa: Option<f64>,
    /// Temperature of the reference state, 15 °C by default.
    pub reference_temperature_k: Option<f64>,
    /// Absolute pressure of the reference state, 1 atm by default.
    pub reference_pressure_pa: Option<f64>,
}

/// Valve body.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize, JsonSchema)]
pub struct ValveSpec {
    /// Name of a material of the library or of this file; brass by default.
    pub material: Option<String>,
    /// Mass.
    pub mass_kg: f64,
    /// Thermal contact to the neck, 8 W/K by default (practice for a 25E thread).
    pub contact_w_k: Option<f64>,
    /// Diameter that the outside film is computed with, 50 mm by default.
    pub diameter_m: Option<f64>,
    /// Outer area; by default that of a cylinder as long as wide of the valve's volume and diameter, `6 V / D`.
    pub area_m2: Option<f64>,
    /// Outside film relative to the cylinder's where that is a coefficient, 1 by default.
    pub film_factor: Option<f64>,
    /// Factor on the heat capacity of the material, 1 by default; a calibration sets it.
    pub heat_capacity_factor: Option<f64>,
}

/// The outer surface.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, Serialize, JsonSchema)]
pub struct SurfaceSpec {
    /// Long-wave emissivity, 0.9 by default (paint).
    pub emissivity: Option<f64>,
    /// Absorptivity for sunlight, 0.6 by default (medium paint).
    pub solar_absorptivity: Option<f64>,
    /// Factor on the outside film that a scenario states or that follows from its wind, of cylinder and valve alike, 1 by
    /// default; a calibration sets it.
    pub film_factor: Option<f64>,
}

/// Film law inside.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, Serialize, JsonSchema)]
pub struct InsideFilmSpec {
    /// Law, McAdams's by default.
    #[serde(default)]
    pub law: LawChoice,
    /// Factor `c` of `Nu = c Ra^n`, for the law `rayleigh`.
    pub factor: Option<f64>,
    /// Exponent `n` of `Nu = c Ra^n`, for the law `rayleigh`.
    pub exponent: Option<f64>,
    /// Film coefficient, for the law `coefficient`; 0 lets no heat through.
    pub film_w_m2_k: Option<f64>,
    /// Multiplier of the power laws, 1 by default.
    pub multiplier: Option<f64>,
    /// Multiplier of what the jet of a refill adds, whatever the law; 1 by default, 0 leaves it out.
    pub jet_multiplier: Option<f64>,
}

/// Film law inside.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum LawChoice {
    /// `Nu = 0.13 Ra^(1/3)`.
    #[default]
    Mcadams,
    /// `Nu = 0.104 Ra^0.352`.
    Daney,
    /// `Nu = factor Ra^exponent`.
    Rayleigh,
    /// A constant coefficient.
    Coefficient,
}

/// How the gas is resolved.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, Serialize, JsonSchema)]
pub struct GasSpec {
    /// Model, well mixed by default.
    #[serde(default)]
    pub model: GasChoice,
    /// Gas cells of the stratified model, 2 to 100; 20 by default.
    pub cells: Option<usize>,
    /// Length, in inner diameters, over which the wall's boundary layer gives its heat back, 1 by default.
    pub exchange_length_diameters: Option<f64>,
    /// Constant of the core's mixing, 0.05 by default.
    pub core_mixing: Option<f64>,
}

/// How the gas is resolved.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum GasChoice {
    /// One node.
    #[default]
    WellMixed,
    /// Stacked cells of common pressure; no refills.
    Stratified,
}
