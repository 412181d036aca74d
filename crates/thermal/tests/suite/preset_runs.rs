//! The paper's scenarios on its cylinder.
use cylwatch_thermal::ThermalError;
use cylwatch_thermal::scenario;
use cylwatch_thermal::sensor::ParameterKind;
use cylwatch_thermal::simulate::{Method, SimulationSettings, simulate, simulate_while};
use cylwatch_thermal::trajectory::Trajectory;
use cylwatch_thermal::vessel::{self, GasResolution, Stratification};

use crate::support::run;

fn paper(name: &str) -> Trajectory {
    let vessel = vessel::presets::load("nitrogen-20l-paper").unwrap();
    run(&vessel, &scenario::presets::load(name).unwrap(), 1e-7)
}

/// Squared error and offset-free gain of `y' = b u - a y` against the gas, for a given pole: the input is linear
/// between samples (first-order hold), the initial state free, the gain by least squares.
fn fit_at_pole(a: f64, runs: &[(Vec<f64>, Vec<f64>)], dt: f64) -> (f64, f64) {
    let decay = (-a * dt).exp();
    // Exact response to a ramp between samples: y+ = decay y + g0 u0 + g1 u1.
    let g1 = 1.0 / a - (1.0 - decay) / (a * a * dt);
    let g0 = (1.0 - decay) / a - g1;
    let n = 1 + runs.len();
    let (mut normal, mut right, mut square) =
        (nalgebra::DMatrix::zeros(n, n), nalgebra::DVector::zeros(n), 0.0);
    for (index, (input, output)) in runs.iter().enumerate() {
        let (mut response, mut free) = (0.0, 1.0);
        for k in 0..output.len() {
            if k > 0 {
                response = decay * response + g0 * input[k - 1] + g1 * input[k];
                free *= decay;
            }
            let mut row = nalgebra::DVector::zeros(n);
            row[0] = response;
            row[1 + index] = free;
            normal += &row * row.transpose();
            right += row * output[k];
            square += output[k] * output[k];
        }
    }
    let solution = normal.clone().lu().solve(&right).unwrap();
    (square - right.dot(&solution), solution[0])
}

/// The paper identified G(s) = 0.003121 / (s + 0.003021) from shoulder to gas on scenarios 1 and 2. With the preset's
/// mounting coupling and films the simulated shoulder gives nearly that pole; the gain is 1 here, as physics wants
/// (the paper's 1.033 cannot be: at rest every temperature is equal).
#[test]
fn shoulder_to_gas_has_nearly_the_published_pole() {
    let runs: Vec<(Vec<f64>, Vec<f64>)> = ["shock-cold", "tunnel-winter"]
        .into_iter()
        .map(|name| {
            let trajectory = paper(name);
            let sensor = trajectory.scenario.sensors.iter().find(|s| s.name == "shoulder").unwrap();
            let coupling = sensor.parameter(ParameterKind::Coupling).unwrap().mean;
            let wall = trajectory.surface_k("shoulder").unwrap();
            let reading = wall
                .iter()
                .zip(&trajectory.ambient_k)
                .map(|(wall, air)| wall + coupling * (air - wall) - 273.15)
                .collect();
            (reading, trajectory.gas_mean_k.iter().map(|t| t - 273.15).collect())
        })
        .collect();
    let samples: usize = runs.iter().map(|(_, gas)| gas.len()).sum();
    let best = (0..400)
        .map(|i| 0.001 * (6.0_f64).powf(f64::from(i) / 399.0))
        .map(|a| (a, fit_at_pole(a, &runs, 60.0)))
        .min_by(|x, y| x.1.0.total_cmp(&y.1.0))
        .unwrap();
    let (pole, (error, b)) = best;
    println!(
        "pole {pole:.6} 1/s, gain {:.4}, MSE {:.3} K², {samples} samples",
        b / pole,
        error / samples as f64
    );
    assert!((pole / 0.003_021 - 1.0).abs() < 0.15, "pole {pole}");
    assert!((b / pole - 1.0).abs() < 0.01, "gain {}", b / pole);
    assert!((385..=391).contains(&samples), "{samples} samples");
}

/// Scenario 1 ends in the cold: the gauge of a tight cylinder passes 160 bar.
#[test]
fn tight_cylinder_trips_the_160_bar_switch_in_the_cold() {
    let trajectory = paper("shock-cold");
    let last = trajectory.pressure_pa.last().unwrap() / 1e5;
    assert!((160.0..163.0).contains(&last), "{last} bar after 3 h");
    let lost = trajectory.mass_kg[0] - trajectory.mass_kg.last().unwrap();
    assert!(lost.abs() < 1e-12);
}

#[test]
fn all_methods_agree_within_their_tolerance() {
    let vessel = vessel::presets::load("nitrogen-20l").unwrap();
    let scenario = scenario::presets::load("tunnel-winter").unwrap();
    let with = |method| {
        let settings = SimulationSettings { relative_tolerance: 1e-8, method, ..Default::default() };
        simulate(&vessel, &scenario, &settings, &mut |_| {}).unwrap().gas_mean_k
    };
    let reference = with(Method::Bdf);
    for method in [Method::TrBdf2, Method::Esdirk34] {
        for (a, b) in with(method).iter().zip(&reference) {
            assert!((a - b).abs() < 2e-4, "{method:?}: {a} against {b}");
        }
    }
}

/// The error falls with the tolerance, and the default is good for 10 mK.
#[test]
fn error_follows_the_tolerance() {
    let vessel = vessel::presets::load("nitrogen-20l").unwrap();
    let scenario = scenario::presets::load("tunnel-winter").unwrap();
    let truth = run(&vessel, &scenario, 1e-11);
    let errors: Vec<f64> = [1e-4, 1e-6, 1e-8]
        .into_iter()
        .map(|tolerance| {
            let here = run(&vessel, &scenario, tolerance);
            here.gas_mean_k.iter().zip(&truth.gas_mean_k).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
        })
        .collect();
    println!("largest error of the mean gas temperature: {errors:?} K");
    assert!(errors[0] > 5.0 * errors[1] && errors[1] > 5.0 * errors[2], "{errors:?}");
    assert!(errors[1] < 0.01, "{errors:?}");
}

/// Closed 20 L cylinder at 10 min after a 65 K step (project study of the stratified gas, section 8): the mean gas
/// lags the wall by 67 to 83 s, and the top is the warmer end in both directions.
#[test]
fn stacked_gas_lags_like_the_single_node_and_is_warmer_at_the_top() {
    let mut vessel = vessel::presets::load("nitrogen-20l").unwrap();
    let constants = Stratification { cells: 20, exchange_length_diameters: 1.0, core_mixing: 0.05 };
    let scenario = scenario::presets::load("tunnel-winter").unwrap();
    let single = run(&vessel, &scenario, 1e-6);
    vessel.gas = GasResolution::Stratified(constants);
    let stacked = run(&vessel, &scenario, 1e-6);
    let lag = |t: &Trajectory| t.wall_mean_k[10] - t.gas_mean_k[10];
    println!("wall minus gas at 10 min: {:.2} K one node, {:.2} K stacked", lag(&single), lag(&stacked));
    assert!((lag(&single) / lag(&stacked) - 1.0).abs() < 0.3);
    let gas = &stacked.gas_cells_k[10];
    let spread = gas[17] - gas[2];
    println!("top minus bottom, 10 to 90 % of the height, at 10 min: {spread:.2} K");
    assert!((0.3..2.5).contains(&spread), "{spread}");
}

#[test]
fn a_run_that_may_not_go_on_ends_after_the_step_that_it_is_asked_at() {
    let vessel = vessel::presets::load("nitrogen-20l-paper").unwrap();
    let scenario = scenario::presets::load("tunnel-winter").unwrap();
    let settings = SimulationSettings::default();
    let mut told = Vec::new();
    let stopped = simulate_while(&vessel, &scenario, &settings, &mut |done| {
        told.push(done);
        done < 0.5
    });
    let last = told.last().unwrap();
    assert!(told.len() > 10 && told.is_sorted() && (0.5..1.0).contains(last), "{told:?}");
    match stopped.unwrap_err() {
        ThermalError::Stopped { time_s } => assert_eq!(time_s / scenario.duration_s, *last),
        other => panic!("{other}"),
    }
    let whole = simulate(&vessel, &scenario, &settings, &mut |_| {}).unwrap();
    let going = simulate_while(&vessel, &scenario, &settings, &mut |_| true).unwrap();
    assert_eq!(whole.pressure_pa, going.pressure_pa);
}
