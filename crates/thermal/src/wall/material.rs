//! Solid materials of walls and valves, as data with their source.
//!
//! Heat capacity and conductivity are linear in temperature about 293.15 K, which covers the 200-400 K
//! of a cylinder's life: `c(T) = c_20 [1 + a_c (T - 293.15 K)]`, `k(T) = k_20 [1 + a_k (T - 293.15 K)]`.
//! A linear heat capacity keeps the wall's energy a quadratic that inverts in closed form, so that the
//! wall can carry energy as its state and conserve it exactly (see [`crate::model`]).
use alloc::string::String;
use alloc::vec::Vec;
use serde::{Deserialize, Serialize};

/// Temperature at which a material's data hold without correction, K.
pub(crate) const REFERENCE_TEMPERATURE_K: f64 = 293.15;

/// A solid.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
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

impl Material {
    /// Temperature of a cell from its energy state: `x = T_ref + e / c_20`, the temperature that a constant
    /// heat capacity would give, K.
    pub(crate) fn temperature_k(&self, energy_state_k: f64) -> f64 {
        let y = energy_state_k - REFERENCE_TEMPERATURE_K;
        let root = libm::sqrt((1.0 + 2.0 * self.heat_capacity_slope_per_k * y).max(0.0));
        REFERENCE_TEMPERATURE_K + 2.0 * y / (1.0 + root)
    }

    /// Derivative of [`Material::temperature_k`]: `c_20 / c(T)`.
    pub(crate) fn temperature_slope(&self, energy_state_k: f64) -> f64 {
        let y = energy_state_k - REFERENCE_TEMPERATURE_K;
        1.0 / libm::sqrt((1.0 + 2.0 * self.heat_capacity_slope_per_k * y).max(f64::MIN_POSITIVE))
    }

    /// Energy state of a cell at a temperature, K; inverse of [`Material::temperature_k`].
    pub(crate) fn energy_state_k(&self, temperature_k: f64) -> f64 {
        let y = temperature_k - REFERENCE_TEMPERATURE_K;
        REFERENCE_TEMPERATURE_K + y * (1.0 + 0.5 * self.heat_capacity_slope_per_k * y)
    }

    /// Conductivity at a temperature, W/(m K).
    pub(crate) fn conductivity_at_w_m_k(&self, temperature_k: f64) -> f64 {
        self.conductivity_w_m_k
            * (1.0 + self.conductivity_slope_per_k * (temperature_k - REFERENCE_TEMPERATURE_K))
    }

    /// Volume-weighted mixture for a lumped wall: capacities add, resistances of the layers add.
    pub(crate) fn mixture(parts: &[(&Material, f64)]) -> Material {
        if let [(only, _)] = parts {
            return (*only).clone();
        }
        let sum = |value: &dyn Fn(&Material) -> f64| parts.iter().map(|(m, t)| value(m) * t).sum::<f64>();
        let thickness: f64 = sum(&|_| 1.0);
        let mass = sum(&|m| m.density_kg_m3);
        let capacity = sum(&|m| m.density_kg_m3 * m.heat_capacity_j_kg_k);
        let resistance = sum(&|m| 1.0 / m.conductivity_w_m_k);
        Material {
            name: parts.iter().map(|(m, _)| m.name.as_str()).collect::<Vec<_>>().join(" + "),
            density_kg_m3: mass / thickness,
            heat_capacity_j_kg_k: capacity / mass,
            heat_capacity_slope_per_k: sum(&|m| {
                m.density_kg_m3 * m.heat_capacity_j_kg_k * m.heat_capacity_slope_per_k
            }) / capacity,
            conductivity_w_m_k: thickness / resistance,
            conductivity_slope_per_k: sum(&|m| m.conductivity_slope_per_k / m.conductivity_w_m_k)
                / resistance,
            source: "mixture of the layers".into(),
        }
    }
}
