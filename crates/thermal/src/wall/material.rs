//! Solid materials of walls and valves, as data with their source.
//!
//! Heat capacity and conductivity are linear in temperature about 293.15 K, which covers the 200-400 K
//! of a cylinder's life: `c(T) = c_20 [1 + a_c (T - 293.15 K)]`, `k(T) = k_20 [1 + a_k (T - 293.15 K)]`.
//! A linear heat capacity keeps the wall's energy a quadratic that inverts in closed form, so that the
//! wall can carry energy as its state and conserve it exactly (see [`crate::model`]).

/// Temperature at which a material's data hold without correction, K.
pub const REFERENCE_TEMPERATURE_K: f64 = 293.15;

/// A solid.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// Name, as files spell it.
    pub name: String,
    /// Density, kg/m³ (constant: expansion is treated at the vessel's inner volume only).
    pub density_kg_m3: f64,
    /// Specific heat capacity at 293.15 K, J/(kg K).
    pub heat_capacity_j_kg_k: f64,
    /// Relative change of the heat capacity per kelvin, 1/K.
    pub heat_capacity_slope_per_k: f64,
    /// Thermal conductivity at 293.15 K, W/(m K).
    pub conductivity_w_m_k: f64,
    /// Relative change of the conductivity per kelvin, 1/K.
    pub conductivity_slope_per_k: f64,
    /// Where the numbers come from.
    pub source: String,
}
