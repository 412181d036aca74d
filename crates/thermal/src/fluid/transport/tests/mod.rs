//! Correlations against CoolProp, their limits, and their derivatives.
mod coolprop;

use num_dual::{Dual64, DualNum};
use proptest::prelude::*;

use super::*;
use coolprop::Row;

const NAMES: [&str; 3] = ["nitrogen", "argon", "air"];

fn named(name: &str) -> Transport {
    Transport::for_fluid(name).unwrap()
}

fn state(row: &Row) -> TransportState<f64> {
    TransportState {
        temperature_k: row[0],
        density_kg_m3: row[1],
        dp_drho_pa_m3_kg: row[2],
        cp_j_kg_k: row[3],
        cv_j_kg_k: row[4],
    }
}

/// Largest relative deviations of viscosity, background and whole conductivity over a table.
fn deviations(fluid: Transport, table: &[Row]) -> [f64; 3] {
    let mut worst = [0.0_f64; 3];
    for row in table {
        let state = state(row);
        let viscosity = fluid.viscosity_pa_s(row[1], row[0]);
        let background = fluid.background_conductivity_w_m_k(row[1], row[0]);
        let whole = background + fluid.critical_enhancement_w_m_k(&state, viscosity, row[5]);
        let pairs = [(viscosity, row[6]), (background, row[7] - row[8]), (whole, row[7])];
        for (slot, (value, reference)) in worst.iter_mut().zip(pairs) {
            let deviation = (value / reference - 1.0).abs();
            if deviation > 1e-6 {
                println!("T {} K, rho {} kg/m3: {value:e} instead of {reference:e}", row[0], row[1]);
            }
            *slot = slot.max(deviation);
        }
    }
    println!("worst deviations {worst:?}");
    worst
}

mod published {
    use super::*;

    #[test]
    fn nitrogen_agrees_with_coolprop() {
        assert!(deviations(named("nitrogen"), &coolprop::NITROGEN).iter().all(|d| *d < 1e-6));
    }

    #[test]
    fn argon_agrees_with_coolprop() {
        assert!(deviations(named("argon"), &coolprop::ARGON).iter().all(|d| *d < 1e-6));
    }

    #[test]
    fn air_agrees_with_coolprop() {
        assert!(deviations(named("air"), &coolprop::AIR).iter().all(|d| *d < 1e-6));
    }
}
