use super::*;
use crate::model::Model;
use crate::model::inputs::{FilmInput, Inputs, Moment};
use crate::scenario::{AxialVariation, OutsideFilm, Series, Sun, Surroundings};
use crate::simulate::{SimulationSettings, simulate};
use crate::{scenario, vessel};
use approx::assert_relative_eq;
use proptest::prelude::*;

const FILM: f64 = 14.0;
/// Rest that a cylinder comes from, K.
const START_K: f64 = 278.15;

fn vessel(name: &str) -> Vessel {
    vessel::presets::load(name).unwrap()
}

/// Wall, valve and gas temperatures and the mass of a vessel with a valve.
fn state(model: &ReducedModel, wall_k: &[f64], valve_k: f64, gas_k: f64, mass_kg: f64) -> Vec<f64> {
    let mut x: Vec<f64> = wall_k.iter().copied().cycle().take(model.wall_nodes()).collect();
    x.extend(model.valve_index().map(|_| valve_k));
    x.extend([gas_k, mass_kg]);
    x
}

#[test]
fn a_state_without_a_balance_spoils_no_later_one() {
    let vessel = vessel("nitrogen-20l");
    let rates = |model: &mut ReducedModel, ln_inside_film: f64| {
        let x = state(model, &[280.0, 287.0], 278.0, 284.0, 4.46);
        let mut rate = vec![0.0; model.states()];
        model.rates(&x, &Unknowns { ln_inside_film, ..Unknowns::still(265.0) }, &mut rate, None).unwrap();
        rate
    };
    let (mut model, mut fresh) = (ReducedModel::new(&vessel, 2, FILM), ReducedModel::new(&vessel, 2, FILM));
    // A film beyond all numbers.
    assert!(rates(&mut model, 800.0).iter().any(|rate| rate.is_nan()));
    let [after, never] = [&mut model, &mut fresh].map(|model| rates(model, 0.0));
    for (after, never) in after.iter().zip(&never) {
        assert_relative_eq!(after, never, max_relative = 1e-9);
    }
}

/// The model that simulates, on the same wall, moves the same energy states at the same rates.
#[test]
fn rates_are_those_of_the_simulation_on_the_same_wall() {
    for (name, mass_kg) in [("nitrogen-20l", 4.46), ("haque-i1", 4.0), ("closed-bottle", 4.46)] {
        let vessel = vessel(name);
        for nodes in [1, 2, 4] {
            let mut reduced = ReducedModel::new(&vessel, nodes, FILM);
            let mut vessel = vessel.clone();
            if let Some(valve) = &mut vessel.valve {
                valve.contact_w_k = reduced.spread.conductance_w_k;
            }
            let outflow_kg_s = 3e-5;
            let mut scenario = leaking(outflow_kg_s);
            scenario.surroundings.axial.film_slope = 0.3;
            let model = Model::on_mesh(Mesh::coarse(&vessel.geometry, nodes).0, &vessel, &scenario).unwrap();
            let x = state(&reduced, &[280.0, 287.0, 291.0], 278.0, 284.0, mass_kg);
            let unknowns = Unknowns { outflow_kg_s, film_slope: 0.3, ..Unknowns::still(265.0) };
            let mut rate = vec![0.0; reduced.states()];
            reduced.rates(&x, &unknowns, &mut rate, None).unwrap();
            let energy_states = |x: &[f64]| full_state(&model, &vessel, &reduced, x);
            let inputs = Inputs {
                moment: Moment::default(),
                air_k: 265.0,
                film: FilmInput::Coefficient(FILM),
                radiation_k: None,
                irradiance_w_m2: 0.0,
                air_difference_k: 0.0,
            };
            let mut expected = vec![0.0; model.layout().states];
            model.rate(&energy_states(&x), &inputs, &[true], &mut expected).unwrap();
            // Push the rates of temperatures and mass through the map to energies.
            let along = |s: f64| -> Vec<f64> {
                energy_states(&x.iter().zip(&rate).map(|(x, r)| x + s * r).collect::<Vec<_>>())
            };
            let step = 1.0;
            let (ahead, behind) = (along(step), along(-step));
            for index in 0..model.layout().heat_in {
                let moved = (ahead[index] - behind[index]) / (2.0 * step);
                assert_relative_eq!(moved, expected[index], max_relative = 2e-7, epsilon = 1e-9);
            }
        }
    }
}

fn leaking(mass_flow_kg_s: f64) -> scenario::Scenario {
    let mut scenario = scenario::presets::load("bottle-step").unwrap();
    scenario.flows = vec![crate::flow::Flow::open("leak", crate::flow::FlowKind::Leak { mass_flow_kg_s })];
    scenario
}

/// State of the simulating model with the temperatures and mass of a reduced state.
fn full_state(model: &Model, vessel: &Vessel, reduced: &ReducedModel, x: &[f64]) -> Vec<f64> {
    let layout = model.layout();
    let mut full = vec![0.0; layout.states];
    let wall = &model.mesh().materials[0];
    for node in 0..layout.wall {
        full[node] = wall.energy_state_k(x[node]);
    }
    if let (Some(to), Some(from)) = (layout.valve, reduced.valve_index()) {
        full[to] = vessel.valve.as_ref().unwrap().material.energy_state_k(x[from]);
    }
    full[layout.mean_wall] = wall.energy_state_k(reduced.mean_wall_k(x));
    let (gas_k, mass_kg) = (x[reduced.gas_index()], x[reduced.mass_index()]);
    let mut v = vessel.volume.volume_m3;
    for _ in 0..50 {
        let p = vessel.fluid.pressure_pa(mass_kg / v, gas_k);
        v = vessel.volume.volume_m3(reduced.mean_wall_k(x), p);
    }
    full[layout.mass] = mass_kg;
    full[layout.energy] = mass_kg * vessel.fluid.state(mass_kg / v, gas_k).internal_energy_j_kg;
    full
}

proptest! {
    #[test]
    fn jacobian_is_the_derivative(
        wall in prop::array::uniform3(235.0..335.0_f64),
        valve_k in 235.0..335.0_f64,
        gas_k in 235.0..335.0_f64,
        mass_kg in 0.3..5.0_f64,
        unknown in prop::array::uniform8(-1.0..1.0_f64),
        preset in 0..3_usize,
    ) {
        let vessel = vessel(["nitrogen-20l", "haque-i1", "closed-bottle"][preset]);
        let mut model = ReducedModel::new(&vessel, 3, FILM);
        let x = state(&model, &wall, valve_k, gas_k, mass_kg);
        let n = model.states();
        let z = |values: &[f64]| Unknowns {
            air_k: values[0],
            ln_outside_film: values[1],
            ln_inside_film: values[2],
            ln_capacity: values[3],
            sun_w: values[4],
            valve_sun: values[5],
            film_slope: values[6],
            outflow_kg_s: values[7],
        };
        let [a, o, i, c, s, v, slope, r] = unknown;
        let at: Vec<f64> = x.iter().copied().chain([280.0 + 40.0 * a, o, 0.5 * i, 0.2 * c, 5.0 * s, 0.25 + 0.25 * v, 0.3 * slope, 1e-3 * r]).collect();
        let mut jacobian = DMatrix::zeros(n, n + Unknowns::COUNT);
        let (mut rate, mut again) = (vec![0.0; n], vec![0.0; n]);
        model.rates(&at[..n], &z(&at[n..]), &mut rate, Some(&mut jacobian)).unwrap();
        model.rates(&at[..n], &z(&at[n..]), &mut again, None).unwrap();
        for (one, two) in rate.iter().zip(&again) {
            prop_assert!((one - two).abs() <= 1e-9 * one.abs().max(1e-6), "with and without derivatives: {one} {two}");
        }
        for column in 0..at.len() {
            // Steps stay clear of the flat spot of the film at rest, 0.01 K wide.
            let step = [1e-3, 1e-3, 1e-3, 1e-3, 1e-3, 1e-4, 1e-3, 1e-4, 1e-4, 1e-4, 1e-2, 1e-3, 1e-4, 1e-5];
            let step = if model.valve_index().is_some() { step[column] } else { step[column + usize::from(column > 2)] };
            let mut along = |sign: f64| {
                let mut moved = at.clone();
                moved[column] += sign * step;
                let mut rate = vec![0.0; n];
                model.rates(&moved[..n], &z(&moved[n..]), &mut rate, None).unwrap();
                rate
            };
            let (ahead, behind) = (along(1.0), along(-1.0));
            for row in 0..n {
                let expected = (ahead[row] - behind[row]) / (2.0 * step);
                let scale = rate[row].abs().max(1e-3);
                prop_assert!(
                    (jacobian[(row, column)] - expected).abs() <= 2e-5 * expected.abs() + 1e-5 * scale,
                    "({row}, {column}): {} against {expected}", jacobian[(row, column)]
                );
            }
        }
    }
}

#[test]
fn pressure_and_its_derivatives_agree_with_differences() {
    let mut model = ReducedModel::new(&vessel("nitrogen-20l"), 2, FILM);
    let x = state(&model, &[270.0, 290.0], 280.0, 284.0, 4.4);
    let p = model.pressure(&x).unwrap();
    let mut difference = |index: usize, step: f64| {
        let mut at = |s: f64| {
            let mut y = x.clone();
            y[index] += s;
            model.pressure(&y).unwrap().pressure_pa
        };
        (at(step) - at(-step)) / (2.0 * step)
    };
    assert_relative_eq!(p.per_gas_k, difference(3, 1e-3), max_relative = 1e-7);
    assert_relative_eq!(p.per_mass_kg, difference(4, 1e-5), max_relative = 1e-7);
    let by_node = difference(0, 1e-2);
    assert_relative_eq!(p.per_wall_k * model.mean_wall_per_node(&x, 0), by_node, max_relative = 1e-4);
}

#[test]
fn a_state_without_gas_is_refused() {
    let mut model = ReducedModel::new(&vessel("nitrogen-20l"), 1, FILM);
    for (gas_k, mass_kg) in [(280.0, 0.0), (280.0, -1.0), (f64::NAN, 4.0), (0.0, 4.0)] {
        assert!(model.pressure(&[280.0, 280.0, gas_k, mass_kg]).is_err());
    }
}

/// The largest differences of a model of two nodes from the resolved wall after the first ten minutes, K.
#[derive(Debug, Default)]
struct Apart {
    valve_k: f64,
    shoulder_k: f64,
    /// Of the resolved valve and shoulder from the upper node.
    valve_over_node_k: f64,
    shoulder_over_node_k: f64,
}

/// Valve and shoulder against the resolved wall, from rest at [`START_K`] into surroundings for an hour.
fn against_the_resolved_wall(vessel: &Vessel, surroundings: &Surroundings, unknowns: &Unknowns) -> Apart {
    let mut scenario = scenario::presets::load("bottle-step").unwrap();
    scenario.duration_s = 3600.0;
    scenario.sample_time_s = 60.0;
    scenario.initial.wall_temperature_k = START_K;
    scenario.initial.gas_temperature_k = START_K;
    scenario.surroundings = surroundings.clone();
    let run = simulate(vessel, &scenario, &SimulationSettings::default(), &mut |_| {}).unwrap();
    let (valve_k, shoulder_k) = (run.valve_k.clone().unwrap(), run.surface_k("shoulder").unwrap());
    let mut model = ReducedModel::new(vessel, 2, FILM);
    let place = model.surface(&SurfacePlace::Shoulder).unwrap();
    let mut x = state(&model, &[START_K; 2], START_K, START_K, run.mass_kg[0]);
    let mut rate = vec![0.0; x.len()];
    let mut apart = Apart::default();
    for (sample, time_s) in run.time_s.iter().enumerate() {
        if *time_s >= 600.0 {
            let read =
                x[place.state] + place.valve_share * (x[2] - x[1]) + place.sun_rise_k_w * unknowns.sun_w;
            apart.valve_k = apart.valve_k.max((x[2] - valve_k[sample]).abs());
            apart.shoulder_k = apart.shoulder_k.max((read - shoulder_k[sample]).abs());
            apart.valve_over_node_k = apart.valve_over_node_k.max(valve_k[sample] - x[1]);
            apart.shoulder_over_node_k = apart.shoulder_over_node_k.max(shoulder_k[sample] - x[1]);
        }
        for _ in 0..60 {
            model.rates(&x, unknowns, &mut rate, None).unwrap();
            x.iter_mut().zip(&rate).for_each(|(x, rate)| *x += rate);
        }
    }
    apart
}

fn constant(value: f64) -> Series {
    Series::try_new(vec![0.0, 3600.0], vec![value; 2]).unwrap()
}

fn calm(air_k: f64) -> Surroundings {
    Surroundings {
        air_k: constant(air_k),
        film: OutsideFilm::Coefficient { film_w_m2_k: constant(FILM) },
        radiation_k: None,
        sun: None,
        axial: AxialVariation { film_slope: 0.0, air_difference_k: None },
    }
}

/// Sun of 500 W/m² on the upper fifth, and on the valve or not; what the wall absorbs of it, W.
fn sunny(vessel: &Vessel, valve: bool) -> (Surroundings, f64) {
    let sun = Sun { irradiance_w_m2: constant(500.0), from_fraction: 0.8, to_fraction: 1.0, valve };
    let lit_m2: f64 =
        Mesh::new(&vessel.geometry).lit_area_m2((sun.from_fraction, sun.to_fraction)).iter().sum();
    let sun_w = 500.0 * vessel.surface.solar_absorptivity * lit_m2;
    (Surroundings { sun: Some(sun), ..calm(START_K) }, sun_w)
}

/// The valve stands some kelvins above its node, because the neck lets little heat through.
#[test]
fn few_nodes_tell_a_valve_in_hot_air() {
    let vessel = vessel("nitrogen-20l");
    let apart = against_the_resolved_wall(&vessel, &calm(313.15), &Unknowns::still(313.15));
    println!("{apart:.2?}");
    assert!(apart.valve_over_node_k > 1.5, "{apart:?}");
    assert!(apart.valve_k < 0.5, "{apart:?}");
    assert!(apart.shoulder_k < 0.3, "{apart:?}");
}

/// The shoulder stands above its node in the sun on it.
#[test]
fn few_nodes_tell_a_shoulder_in_the_sun() {
    let vessel = vessel("nitrogen-20l");
    let (surroundings, sun_w) = sunny(&vessel, true);
    let unknowns = Unknowns { sun_w, ..Unknowns::still(START_K) };
    let apart = against_the_resolved_wall(&vessel, &surroundings, &unknowns);
    println!("sun {sun_w:.1} W: {apart:.2?}");
    assert!(apart.shoulder_over_node_k > 0.7, "{apart:?}");
    assert!(apart.shoulder_k < 0.25, "{apart:?}");
}

/// A valve in the shade stays colder than the lit shoulder. With the usual part of the sun it would look like one in colder air.
#[test]
fn a_valve_in_the_shade_is_told_by_its_part_of_the_sun() {
    let vessel = vessel("nitrogen-20l");
    let (surroundings, sun_w) = sunny(&vessel, false);
    let off_k = |valve_sun: f64| {
        let unknowns = Unknowns { sun_w, valve_sun, ..Unknowns::still(START_K) };
        against_the_resolved_wall(&vessel, &surroundings, &unknowns).valve_k
    };
    let (shade, usual) = (off_k(0.0), off_k(ReducedModel::VALVE_SUN));
    println!("sun {sun_w:.1} W: off by {shade:.2} K, with the usual part {usual:.2} K");
    assert!(shade < 0.25 && usual > 4.0 * shade, "{shade} {usual}");
}
