//! How the heat of valve and sun spreads in the stretch of wall that one node stands for.
//!
//! The valve stands on the neck, and the sun shines on the upper quarter. Neck and shoulder are a fin: they follow such
//! heat within minutes, the node that lumps them with the wall beneath in tens of minutes. A node alone would draw the
//! valve's heat through the contact only, miss most of the resistance, and tell nothing of a shoulder that is
//! warmer than its node. So the resolved wall is condensed once (static condensation): a heat flow of 1 W, distributed `f`
//! over the columns, raises them between nominal films by
//!
//! `theta = (K + S)^-1 f`  with conduction `K` and films `S = diag(h_out A_out + h_in A_in)`, K/W.
//!
//! Relative to the means of the nodes (weights: heat capacity), `theta - mean`, the profile of the topmost column, where the
//! valve sits, is a resistance in series with the contact, `1/G = 1/contact + R`, and each column `j` stands at
//! `T_j = T_node + beta_j (T_valve - T_top) + s_j Q_sun` with `beta = G (theta_valve - mean)` and
//! `s = theta_sun - mean - beta s_top`, since the sun beneath it also takes the valve's flow back.
//!
//! Valid while heat flows change slowly against the settling of the fin, `rho c t / (h_out + h_in)`, about six minutes;
//! what is faster stays model error.
use alloc::vec::Vec;
use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

use crate::wall::mesh::Mesh;

/// Inside film of the profile, W/(m² K): free convection of dense gas at some tenths of a kelvin.
const INSIDE_FILM_W_M2_K: f64 = 50.0;
/// Lower end of the stretch in the sun as a fraction of the outer height: its top stands out of whatever holds a cylinder.
const LIT_FROM_FRACTION: f64 = 0.75;
/// Temperature at which the wall conducts, K.
const CONDUCTING_K: f64 = 283.15;

/// The condensed profiles.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Spread {
    /// Conductance from the valve to the topmost node, W/K; 0 without a valve.
    pub conductance_w_k: f64,
    /// Rise of the topmost column over the topmost node in the sun, before the valve answers, K/W.
    pub top_rise_k_w: f64,
    /// Share of the valve's departure from the topmost node at each column.
    pub share: Vec<f64>,
    /// Rise of each column over its node in the sun, K/W.
    pub rise_k_w: Vec<f64>,
    /// Part of the sun on the wall that each node absorbs.
    pub lit: Vec<f64>,
}

impl Spread {
    /// Of a resolved mesh of one layer, its columns lumped into nodes; a contact of 0 W/K: no valve.
    pub(super) fn new(
        fine: &Mesh,
        node_of_column: &[usize],
        contact_w_k: f64,
        outside_film_w_m2_k: f64,
    ) -> Self {
        let wall = wall_matrix(fine, outside_film_w_m2_k);
        let last = fine.columns.len() - 1;
        let valve = above_nodes(fine, node_of_column, &wall, |j| if j == last { 1.0 } else { 0.0 });
        let lit_m2 = fine.lit_area_m2((LIT_FROM_FRACTION, 1.0));
        let sun = above_nodes(fine, node_of_column, &wall, |j| lit_m2[j]);
        let conductance_w_k =
            if contact_w_k > 0.0 { (contact_w_k.recip() + valve[last]).recip() } else { 0.0 };
        let share: Vec<f64> = valve.iter().map(|above| conductance_w_k * above).collect();
        let rise_k_w = sun.iter().zip(&share).map(|(rise, share)| rise - share * sun[last]).collect();
        let all_m2: f64 = lit_m2.iter().sum();
        let mut lit = vec![0.0; node_of_column[last] + 1];
        lit_m2.iter().zip(node_of_column).for_each(|(area_m2, &node)| lit[node] += area_m2 / all_m2);
        Self { conductance_w_k, top_rise_k_w: sun[last], share, rise_k_w, lit }
    }
}

/// Conduction between the columns and films to both sides, W/K.
fn wall_matrix(fine: &Mesh, outside_film_w_m2_k: f64) -> Cholesky<f64, Dyn> {
    let count = fine.columns.len();
    let mut matrix = DMatrix::zeros(count, count);
    for (j, column) in fine.columns.iter().enumerate() {
        matrix[(j, j)] =
            outside_film_w_m2_k * column.outer_area_m2 + INSIDE_FILM_W_M2_K * column.inner_area_m2;
    }
    let conductivity = fine.materials[0].conductivity_at_w_m_k(CONDUCTING_K);
    for link in &fine.links {
        let g = conductivity * link.series_m();
        matrix[(link.a, link.a)] += g;
        matrix[(link.b, link.b)] += g;
        matrix[(link.a, link.b)] -= g;
        matrix[(link.b, link.a)] -= g;
    }
    matrix.cholesky().expect("films make the matrix positive definite")
}

/// Rise of each column over the mean of its node, K, when 1 W enters in proportion to weights.
fn above_nodes(
    fine: &Mesh,
    node_of_column: &[usize],
    wall: &Cholesky<f64, Dyn>,
    weight: impl Fn(usize) -> f64,
) -> Vec<f64> {
    let mut heat = DVector::from_fn(fine.columns.len(), |j, _| weight(j));
    let total = heat.sum();
    if total == 0.0 {
        return vec![0.0; heat.len()];
    }
    heat /= total;
    let rise = wall.solve(&heat);
    let mean_of_node = |node: usize| {
        let (sum, volume) =
            (0..rise.len()).filter(|&j| node_of_column[j] == node).fold((0.0, 0.0), |(sum, volume), j| {
                (sum + fine.volume_m3[j] * rise[j], volume + fine.volume_m3[j])
            });
        sum / volume
    };
    (0..rise.len()).map(|j| rise[j] - mean_of_node(node_of_column[j])).collect()
}
