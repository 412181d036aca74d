//! Sensitivities of a run against closed forms and against differences of whole runs.
use cylwatch_thermal::flow::{Flow, FlowKind};
use cylwatch_thermal::fluid::{Equation, Fluid};
use cylwatch_thermal::scenario::{self, OutsideFilm, Scenario};
use cylwatch_thermal::simulate::{Neighbours, SimulationSettings, simulate, simulate_with_neighbours};
use cylwatch_thermal::trajectory::{EventKind, Trajectory};
use cylwatch_thermal::vessel::Fill;
use cylwatch_thermal::vessel::{self, InsideFilm, Vessel};

use crate::support::{insulated, run, still};

/// Half distance of a parameter's logarithm to its neighbours.
const HALF: f64 = 1e-4;

type Change = fn(&mut Vessel, &mut Scenario, f64);

const CHANGES: [(&str, Change); 6] = [
    ("outside film", |_, scenario, factor| {
        if let OutsideFilm::Coefficient { film_w_m2_k } = &mut scenario.surroundings.film {
            *film_w_m2_k = film_w_m2_k.scaled(factor).unwrap();
        }
    }),
    ("inside film", |vessel, _, factor| {
        let InsideFilm::Rayleigh { multiplier, .. } = &mut vessel.inside_film else { panic!("a power law") };
        *multiplier *= factor;
    }),
    ("wall capacity", |vessel, _, factor| {
        vessel.geometry.layers[0].material.heat_capacity_j_kg_k *= factor;
    }),
    ("valve contact", |vessel, _, factor| {
        if let Some(valve) = &mut vessel.valve {
            valve.contact_w_k *= factor;
        }
    }),
    ("volume", |vessel, _, factor| vessel.volume.volume_m3 *= factor),
    ("discharge", |_, scenario, factor| {
        for flow in &mut scenario.flows {
            if let FlowKind::Orifice { discharge_coefficient, .. } = &mut flow.kind {
                *discharge_coefficient *= factor;
            }
        }
    }),
];

fn changed(vessel: &Vessel, scenario: &Scenario, change: Change, by: f64) -> (Vessel, Scenario) {
    let (mut vessel, mut scenario) = (vessel.clone(), scenario.clone());
    change(&mut vessel, &mut scenario, by.exp());
    (vessel, scenario)
}

fn settings(relative_tolerance: f64) -> SimulationSettings {
    SimulationSettings { relative_tolerance, ..SimulationSettings::default() }
}

/// Derivatives of gas temperature, pressure, mass, shoulder and valve to the logarithm of a parameter.
fn slopes(below: &Trajectory, above: &Trajectory, half: f64) -> Vec<Vec<f64>> {
    let course = |run: &Trajectory| {
        let mut all = vec![run.gas_mean_k.clone(), run.pressure_pa.clone(), run.mass_kg.clone()];
        all.extend(run.surface_k("shoulder"));
        all.extend(run.surface_k("valve"));
        all
    };
    let difference = |(below, above): (Vec<f64>, Vec<f64>)| {
        below.iter().zip(above).map(|(below, above)| (above - below) / (2.0 * half)).collect()
    };
    course(below).into_iter().zip(course(above)).map(difference).collect()
}

/// Largest difference of derivatives over their largest value, for each course.
fn disagreement(a: &[Vec<f64>], b: &[Vec<f64>]) -> f64 {
    let one = |(a, b): (&Vec<f64>, &Vec<f64>)| {
        let scale = b.iter().fold(0.0_f64, |scale, b| scale.max(b.abs()));
        let worst = a.iter().zip(b).fold(0.0_f64, |worst, (a, b)| worst.max((a - b).abs()));
        if scale == 0.0 { worst } else { worst / scale }
    };
    a.iter().zip(b).map(one).fold(0.0, f64::max)
}

/// Tangents at a tolerance against differences of runs at 1e-12, at a larger distance, with Richardson's extrapolation.
fn compare(vessel: &Vessel, scenario: &Scenario, tolerance: f64, names: &[&str]) -> f64 {
    let changes: Vec<_> = CHANGES.iter().filter(|(name, _)| names.contains(name)).collect();
    let neighbours: Vec<Neighbours> = changes
        .iter()
        .map(|(_, change)| Neighbours {
            below: changed(vessel, scenario, *change, -HALF),
            above: changed(vessel, scenario, *change, HALF),
        })
        .collect();
    let (_, found) =
        simulate_with_neighbours(vessel, scenario, &neighbours, &settings(tolerance), &mut |_| true).unwrap();
    let mut worst = 0.0_f64;
    for ((name, change), [below, above]) in changes.into_iter().zip(&found) {
        let tangent = slopes(below, above, HALF);
        let difference = |half: f64| {
            let side = |by: f64| {
                let (vessel, scenario) = changed(vessel, scenario, *change, by);
                simulate(&vessel, &scenario, &settings(1e-12), &mut |_| {}).unwrap()
            };
            slopes(&side(-half), &side(half), half)
        };
        let (coarse, fine) = (difference(1e-2), difference(5e-3));
        let combine = |(coarse, fine): (&f64, &f64)| (4.0 * fine - coarse) / 3.0;
        let expected: Vec<Vec<f64>> = coarse
            .iter()
            .zip(&fine)
            .map(|(coarse, fine)| coarse.iter().zip(fine).map(combine).collect())
            .collect();
        let error = disagreement(&tangent, &expected);
        println!("{name} at {tolerance}: {error:.1e}");
        worst = worst.max(error);
    }
    worst
}

/// `T = T_a + (T_0 - T_a) exp(-t/tau)` has the derivative `-(T_0 - T_a) t/tau exp(-t/tau)` to the film's logarithm.
#[test]
fn wall_without_gas_contact_has_the_derivative_of_its_exponential() {
    let vessel = insulated(Fluid::named("nitrogen").unwrap());
    let scenario = still(253.15, 293.15, 12.0, 4.0);
    let neighbours = Neighbours {
        below: changed(&vessel, &scenario, CHANGES[0].1, -HALF),
        above: changed(&vessel, &scenario, CHANGES[0].1, HALF),
    };
    let (run, found) =
        simulate_with_neighbours(&vessel, &scenario, &[neighbours], &settings(1e-9), &mut |_| true).unwrap();
    let [below, above] = &found[0];
    for (k, (t, wall)) in run.time_s.iter().zip(&run.wall_mean_k).enumerate().skip(1) {
        // The wall's own resistance is a share s of the film's: d ln(conductance) / d ln(film) = 1 - s.
        let share = 12.0 * 0.5 * 0.0067 / 45.0;
        let ratio = (wall - 253.15) / 40.0;
        let expected = 40.0 * ratio * ratio.ln() * (1.0 - share);
        let found = (above.wall_mean_k[k] - below.wall_mean_k[k]) / (2.0 * HALF);
        assert!((found - expected).abs() < 40.0 * 3e-5, "{found} at {t} s instead of {expected}");
    }
}

/// `T/T_0 = (1 + (g-1)/2 B t)^-2` with `B` proportional to the discharge coefficient.
#[test]
fn adiabatic_blowdown_has_the_derivative_of_the_closed_form() {
    let fluid = Fluid::named("argon").unwrap().with_equation(Equation::IdealGas);
    let vessel = insulated(fluid);
    let mut scenario = still(288.15, 288.15, 1e-9, 25.0 / 3600.0);
    scenario.sample_time_s = 1.0;
    scenario.initial.fill = Fill::Pressure { pressure_pa: 150e5 };
    scenario.flows.push(nozzle(None));
    let neighbours = Neighbours {
        below: changed(&vessel, &scenario, CHANGES[5].1, -HALF),
        above: changed(&vessel, &scenario, CHANGES[5].1, HALF),
    };
    let (run, found) =
        simulate_with_neighbours(&vessel, &scenario, &[neighbours], &settings(1e-8), &mut |_| true).unwrap();
    let [below, above] = &found[0];
    for (k, gas) in run.gas_mean_k.iter().enumerate() {
        let base = (gas / 288.15).powf(-0.5);
        let expected = -2.0 * gas * (base - 1.0) / base;
        let found = (above.gas_mean_k[k] - below.gas_mean_k[k]) / (2.0 * HALF);
        assert!((found - expected).abs() < 288.0 * 1e-6, "{found} instead of {expected}");
    }
}

fn nozzle(closes_below_pa: Option<f64>) -> Flow {
    Flow {
        name: "nozzle".into(),
        kind: FlowKind::Orifice { diameter_m: 0.004, discharge_coefficient: 0.8, back_pressure_pa: 1e5 },
        start_s: 0.0,
        stop_s: f64::INFINITY,
        opens_above_pa: None,
        closes_below_pa,
        closes_above_pa: None,
    }
}

#[test]
fn tangents_are_the_differences_of_whole_runs() {
    let vessel = vessel::presets::load("nitrogen-20l").unwrap();
    let mut scenario = scenario::presets::load("tunnel-step").unwrap();
    (scenario.duration_s, scenario.sample_time_s) = (5400.0, 60.0);
    let names = ["outside film", "inside film", "wall capacity", "valve contact", "volume"];
    assert!(compare(&vessel, &scenario, 1e-9, &names) < 2e-5);
    assert!(compare(&vessel, &scenario, 1e-8, &names) < 2e-5);
    assert!(compare(&vessel, &scenario, 1e-6, &names) < 1e-3);
}

/// The nozzle closes earlier in a neighbour that empties faster.
#[test]
fn tangents_jump_where_a_flow_closes_at_its_pressure() {
    let vessel = vessel::presets::load("nitrogen-20l").unwrap();
    let mut scenario = scenario::presets::load("shock-cold").unwrap();
    (scenario.duration_s, scenario.sample_time_s) = (120.0, 1.0);
    scenario.flows = vec![nozzle(Some(120e5))];
    let closed = run(&vessel, &scenario, 1e-9);
    let last = closed.events.last().unwrap();
    assert!(last.time_s < 60.0 && last.kind == EventKind::FlowClosed { flow: "nozzle".into() }, "{last:?}");
    let names = ["discharge", "volume", "inside film"];
    assert!(compare(&vessel, &scenario, 1e-9, &names) < 1e-5);
}

#[test]
fn neighbour_of_another_shape_is_refused() {
    let vessel = vessel::presets::load("nitrogen-20l").unwrap();
    let scenario = scenario::presets::load("shock-cold").unwrap();
    let mut other = vessel.clone();
    other.geometry.cylinder_cells += 1;
    let neighbours =
        Neighbours { below: (vessel.clone(), scenario.clone()), above: (other, scenario.clone()) };
    let error = simulate_with_neighbours(&vessel, &scenario, &[neighbours], &settings(1e-6), &mut |_| true)
        .unwrap_err();
    assert!(error.to_string().contains("neighbour 0"), "{error}");
}
