//! A simulation in steps against one in a piece.
use crate::support::still;
use cylwatch_thermal::ThermalError;
use cylwatch_thermal::flow::{Flow, FlowKind};
use cylwatch_thermal::scenario::{Scenario, Series};
use cylwatch_thermal::simulate::{SimulationSettings, Stepped, simulate};
use cylwatch_thermal::vessel::{Vessel, presets};

const STEP_S: f64 = 300.0;
const STEPS: usize = 24;

fn vessel() -> Vessel {
    presets::load("nitrogen-20l").unwrap()
}

fn tight() -> SimulationSettings {
    SimulationSettings { relative_tolerance: 1e-12, ..SimulationSettings::default() }
}

/// Air, K, and mass flow out, kg/s, of a step.
fn inputs(step: usize) -> (f64, f64) {
    let phase = step as f64;
    (285.0 + 12.0 * (0.7 * phase).sin(), 2e-5 * (1.0 + (0.9 * phase).cos()))
}

fn leak(mass_flow_kg_s: Series) -> Flow {
    Flow::open("leak", FlowKind::LeakSeries { mass_flow_kg_s })
}

/// A step of its own.
fn step(index: usize) -> Scenario {
    let (air_k, flow_kg_s) = inputs(index);
    let mut step = still(air_k, 270.0, 12.0, STEP_S / 3600.0);
    step.flows = vec![leak(Series::constant(flow_kg_s))];
    step
}

/// All steps in a piece: each value holds for a step.
fn whole() -> Scenario {
    let held = |of: &dyn Fn(usize) -> f64| {
        let time = |k: usize| STEP_S * k as f64;
        let knots = (0..STEPS).flat_map(|k| [(time(k), of(k)), (time(k + 1), of(k))]);
        let (time_s, value) = knots.unzip();
        Series::try_new(time_s, value).unwrap()
    };
    let mut whole = still(0.0, 270.0, 12.0, STEPS as f64 * STEP_S / 3600.0);
    whole.surroundings.air_k = held(&|k| inputs(k).0);
    whole.flows = vec![leak(held(&|k| inputs(k).1))];
    whole.sample_time_s = STEP_S;
    whole
}

#[test]
fn in_steps_it_goes_as_in_one_piece() {
    let whole = simulate(&vessel(), &whole(), &tight(), &mut |_| ()).unwrap();
    let mut stepped = Stepped::new(&vessel(), &step(0), tight()).unwrap();
    let mut worst = 0.0_f64;
    for index in 0..STEPS {
        let now = stepped.sample(&step(index)).unwrap();
        let pairs = [
            (now.gas_mean_k[0], whole.gas_mean_k[index]),
            (now.pressure_pa[0], whole.pressure_pa[index]),
            (now.mass_kg[0], whole.mass_kg[index]),
            (now.wall_outer_k[0][0], whole.wall_outer_k[index][0]),
            (now.valve_k.unwrap()[0], whole.valve_k.as_ref().unwrap()[index]),
        ];
        worst = pairs.iter().fold(worst, |worst, (a, b)| worst.max((a / b - 1.0).abs()));
        stepped.advance(&step(index)).unwrap();
    }
    println!("in steps and in one piece, relative: {worst:.2e}");
    assert!(worst < 1e-9, "{worst}");
}

#[test]
fn from_a_saved_state_on_the_same_bits_come() {
    let mut one = Stepped::new(&vessel(), &step(0), SimulationSettings::default()).unwrap();
    (0..5).for_each(|index| drop(one.advance(&step(index)).unwrap()));
    let saved = one.state().to_vec();
    let mut other = Stepped::new(&vessel(), &step(0), SimulationSettings::default()).unwrap();
    other.restore(&saved).unwrap();
    for index in 5..9 {
        one.advance(&step(index)).unwrap();
        other.advance(&step(index)).unwrap();
        let bits = |of: &Stepped| of.state().iter().map(|value| value.to_bits()).collect::<Vec<_>>();
        assert_eq!(bits(&one), bits(&other), "step {index}");
    }
    one.restore(&saved).unwrap();
    assert_eq!(one.state(), saved);
}

#[test]
fn a_step_that_fails_leaves_the_state_and_another_states_is_refused() {
    let mut stepped = Stepped::new(&vessel(), &step(0), SimulationSettings::default()).unwrap();
    let before = stepped.state().to_vec();
    let cold = still(20.0, 270.0, 1e4, 10.0);
    assert!(stepped.advance(&cold).is_err());
    assert_eq!(stepped.state(), before);
    let refused = stepped.restore(&before[1..]).unwrap_err();
    assert!(matches!(refused, ThermalError::StateLength { .. }), "{refused}");
}
