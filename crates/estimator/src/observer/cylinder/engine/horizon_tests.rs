use nalgebra::{DMatrix, DVector};

use super::*;
use crate::filter::horizon::{HorizonStatus, MovingHorizon};
use crate::filter::{Plant, StateSpace};
use crate::observer::states::StateKind;
use crate::observer::{LeakHypothesis, ObserverSettings};
use crate::sensor::Sensor;
use crate::thermal::vessel::presets;

/// A settled cylinder at 15 °C and 200 bar with a pressure that rises by 0.1 bar a minute; the masses along the last window.
fn masses_while_pressure_rises(settings: &MovingHorizonSettings) -> Vec<f64> {
    let sensors = ["shoulder", "pressure"].map(|name| Sensor::typical(name).unwrap());
    let vessel = presets::load("nitrogen-20l").unwrap();
    let mut cylinder = Cylinder::new(&vessel, &sensors, &ObserverSettings::single()).unwrap();
    cylinder.suppose(&LeakHypothesis::walking_mass(5.0));
    let n = cylinder.states();
    let mut x = vec![0.0; n];
    let mut covariance = DMatrix::identity(n, n) * 1e-4;
    for (i, kind) in cylinder.state_map().kinds.iter().enumerate() {
        match kind {
            StateKind::Wall(_) | StateKind::Valve | StateKind::Gas | StateKind::Air => x[i] = 288.15,
            StateKind::Mass => x[i] = 4.49,
            StateKind::Leak => covariance[(i, i)] = 0.0,
            _ => {}
        }
    }
    let start_pa = cylinder.output(1, &x, None).unwrap();
    let constraints = cylinder.constraints(settings);
    let mean = DVector::from_vec(x);
    let mut window =
        MovingHorizon::try_new(cylinder.for_window(), &mean, &covariance, constraints, settings.horizon())
            .unwrap();
    for k in 1..12 {
        let estimate = window.step(60.0, &[288.15, start_pa + 1e4 * f64::from(k)]).unwrap();
        assert!(!matches!(estimate.status, HorizonStatus::Fallback(_)));
    }
    let mass = cylinder.state_map().mass;
    window.trajectory().iter().map(|x| x[mass]).collect()
}

#[test]
fn mass_rises_nowhere_in_the_window_unless_it_may() {
    let bound = MovingHorizonSettings { samples: 10, ..MovingHorizonSettings::default() };
    let masses = masses_while_pressure_rises(&bound);
    assert_eq!(masses.len(), 11);
    assert!(masses.windows(2).all(|w| w[1] <= w[0] + 1e-9), "{masses:?}");
    let free = MovingHorizonSettings { mass_not_rising: false, ..bound };
    let masses = masses_while_pressure_rises(&free);
    assert!(masses[10] > masses[0] + 5e-4, "{masses:?}");
}
