//! A part of the gas in one state: the whole gas of a vessel that is mixed well, or a cell of a stacked one.
use crate::fluid::{Real, State};

/// State of the node with the derivatives of its volume.
#[derive(Clone, Copy, Debug)]
pub(super) struct Node<D> {
    /// Thermodynamic state.
    pub state: State<D>,
    /// Volume, m³.
    pub volume_m3: D,
    /// Its derivatives with mass, m³/kg, energy, m³/J, and temperature of the wall, m³/K.
    pub volume_by: [D; 3],
}

/// Everything that flows, and what it does to the node.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rates<D> {
    /// Net mass flow in, kg/s.
    pub mass_kg_s: D,
    /// Change of the gas energy, W.
    pub energy_w: D,
    /// Net enthalpy flow in, W.
    pub enthalpy_w: D,
    /// Work on the vessel, W.
    pub work_w: D,
}

impl<D: Real> Node<D> {
    /// Rates of the node for its net mass, enthalpy and heat inflow and the rate of the mean wall temperature.
    pub(crate) fn balance(&self, mass_kg_s: D, enthalpy_w: D, heat_w: D, wall_rate_k_s: D) -> Rates<D> {
        let p = self.state.pressure_pa;
        let [by_mass, by_energy, by_wall] = self.volume_by;
        let volume_rate_without_energy = by_mass * mass_kg_s + by_wall * wall_rate_k_s;
        let supplied = heat_w + enthalpy_w;
        let energy_w = (supplied - p * volume_rate_without_energy) / (p * by_energy + 1.0);
        Rates { mass_kg_s, energy_w, enthalpy_w, work_w: supplied - energy_w }
    }

    /// The same node in other numbers, e.g. with other derivatives.
    pub(crate) fn map<E: Real>(&self, f: impl Fn(D) -> E) -> Node<E> {
        let s = &self.state;
        Node {
            state: State {
                temperature_k: f(s.temperature_k),
                density_kg_m3: f(s.density_kg_m3),
                pressure_pa: f(s.pressure_pa),
                internal_energy_j_kg: f(s.internal_energy_j_kg),
                enthalpy_j_kg: f(s.enthalpy_j_kg),
                entropy_j_kg_k: f(s.entropy_j_kg_k),
                cv_j_kg_k: f(s.cv_j_kg_k),
                cp_j_kg_k: f(s.cp_j_kg_k),
                sound_speed_m_s: f(s.sound_speed_m_s),
                dp_dt_pa_k: f(s.dp_dt_pa_k),
                dp_drho_pa_m3_kg: f(s.dp_drho_pa_m3_kg),
                compressibility: f(s.compressibility),
                expansion_per_k: f(s.expansion_per_k),
            },
            volume_m3: f(self.volume_m3),
            volume_by: self.volume_by.map(f),
        }
    }
}
