//! Heat conduction between the cells of a [`Mesh`].
//!
//! Between two nodes heat flows through two half cells in series, each with the conductivity of its own
//! material at its own node's temperature: `q = (T_a - T_b) / (1/(k_a g_a) + 1/(k_b g_b))`. Order of accuracy 2.
use super::mesh::{Link, Mesh};
use crate::real::powi;

/// Heat flow over a link and its derivatives with the two node temperatures.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LinkFlow {
    /// Heat flow from `a` to `b`, W.
    pub heat_w: f64,
    /// Derivative with the temperature of `a`, W/K.
    pub per_a_k: f64,
    /// Derivative with the temperature of `b`, W/K.
    pub per_b_k: f64,
}

/// Flow over one link at the node temperatures `temperature_k` (length: number of cells).
pub(crate) fn link_flow(mesh: &Mesh, link: &Link, temperature_k: &[f64]) -> LinkFlow {
    let (ta, tb) = (temperature_k[link.a], temperature_k[link.b]);
    let half = |cell: usize, shape: f64, t: f64| {
        let material = &mesh.materials[mesh.material[cell]];
        let slope = shape * material.conductivity_w_m_k * material.conductivity_slope_per_k;
        (shape * material.conductivity_at_w_m_k(t), slope)
    };
    let (ga, slope_a) = half(link.a, link.shape_a_m, ta);
    let (gb, slope_b) = half(link.b, link.shape_b_m, tb);
    let g = ga * gb / (ga + gb);
    let difference = ta - tb;
    LinkFlow {
        heat_w: g * difference,
        per_a_k: g + difference * powi(gb / (ga + gb), 2) * slope_a,
        per_b_k: -g + difference * powi(ga / (ga + gb), 2) * slope_b,
    }
}
