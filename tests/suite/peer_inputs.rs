//! This project's half of the comparison with other programs (`benches/peers/run`).
#[allow(dead_code)]
#[path = "../../examples/peers/main.rs"]
mod peers;

use approx::assert_relative_eq;
use nalgebra::{DMatrix, DVector};
use peers::{CASES, Inputs, Stopwatch, inputs, run};
use serde_json::Value;
use std::time::Duration;

/// The inputs as both sides read them: through a file.
fn read_inputs() -> (Value, Inputs) {
    let text = serde_json::to_string(&inputs().unwrap()).unwrap();
    (serde_json::from_str(&text).unwrap(), serde_json::from_str(&text).unwrap())
}

fn once(case: &str, inputs: &Inputs) -> Value {
    run(case, inputs, &Stopwatch::new(Duration::ZERO)).unwrap()
}

fn numbers(of: &Value) -> Vec<f64> {
    of.as_array().unwrap().iter().map(|value| value.as_f64().unwrap()).collect()
}

fn shape(of: &Value) -> (usize, usize) {
    let rows = of.as_array().unwrap();
    (rows.len(), rows[0].as_array().unwrap().len())
}

fn matrix(of: &Value) -> DMatrix<f64> {
    let rows: Vec<Vec<f64>> = of.as_array().unwrap().iter().map(numbers).collect();
    DMatrix::from_fn(rows.len(), rows[0].len(), |i, j| rows[i][j])
}

/// State after the record by the Kalman filter on dense matrices, in Joseph's form.
fn textbook(inputs: &Value) -> Vec<f64> {
    let [phi, g, h, mut p, z] = ["phi", "g", "h", "prior", "readings"].map(|name| matrix(&inputs[name]));
    let [q, r] = ["q", "r"].map(|name| numbers(&inputs[name]));
    let (m, n) = phi.shape();
    let (mut f, mut x) = (DMatrix::identity(n, n), DVector::zeros(n));
    f.rows_mut(0, m).copy_from(&phi);
    let noise = &g * DMatrix::from_diagonal(&DVector::from_vec(q)) * g.transpose();
    for z in z.row_iter() {
        x = &f * x;
        p = &f * p * f.transpose();
        let mut moving = p.view_mut((0, 0), (m, m));
        moving += &noise;
        for (j, &r) in r.iter().enumerate() {
            let h = h.row(j).transpose();
            let gain = &p * &h / (h.dot(&(&p * &h)) + r);
            let nu = z[j] - h.dot(&x);
            x += &gain * nu;
            let left = DMatrix::identity(n, n) - &gain * h.transpose();
            p = &left * p * left.transpose() + r * &gain * gain.transpose();
            p = (&p + p.transpose()) * 0.5;
        }
    }
    x.as_slice().to_vec()
}

#[test]
fn inputs_have_the_dimensions_of_the_observer_and_cases_answer_for_all_of_them() {
    let (file, inputs) = read_inputs();
    for case in CASES {
        assert!(file.get(case).is_some(), "{case}");
    }
    assert!(run("another", &inputs, &Stopwatch::new(Duration::ZERO)).is_err());
    let linear = &file["filter"];
    let (n, leading) = (19, 9);
    assert_eq!((shape(&linear["phi"]), shape(&linear["g"])), ((leading, n), (leading, leading)));
    assert_eq!((shape(&linear["h"]), shape(&linear["prior"])), ((3, n), (n, n)));
    assert_eq!(shape(&linear["readings"]), (500, 3));
    assert_eq!(shape(&file["horizon"]["windows"][19]), (20, 3));

    let filter = once("filter", &inputs);
    let sd = |i: usize| filter["covariance"][i][i].as_f64().unwrap().sqrt();
    let pairs = numbers(&filter["x"]).into_iter().zip(textbook(linear));
    assert!(pairs.enumerate().all(|(i, (ud, dense))| (ud - dense).abs() < 1e-10 * sd(i)));
    assert!(filter["time"]["minimum_s"].as_f64().unwrap() > 0.0);

    let horizon = once("horizon", &inputs);
    let bounded = file["horizon"]["bounded"].as_u64().unwrap() as usize;
    let newest = horizon["newest"].as_array().unwrap();
    assert!(newest.len() == 20 && newest.iter().all(|x| numbers(x)[bounded] >= 0.0));
    assert!((1..20).contains(&horizon["active"].as_u64().unwrap()));

    let properties = once("properties", &inputs);
    let densities = [&properties["density_kg_m3"], &file["properties"]["density_kg_m3"]].map(numbers);
    assert_eq!((densities[0].len(), &densities[0]), (210, &densities[1]));
    let pressures = [&properties["pressure_pa"], &file["properties"]["pressure_pa"]].map(numbers);
    for (found, given) in pressures[0].iter().zip(&pressures[1]) {
        assert_relative_eq!(found, given, max_relative = 1e-9);
    }
}

#[test]
fn a_tighter_tolerance_brings_the_closed_bottle_nearer_to_its_reference() {
    let (file, inputs) = read_inputs();
    let systems = once("integration", &inputs);
    for (k, cells) in [1, 48].into_iter().enumerate() {
        assert_eq!(file["integration"][k]["capacity_j_k"].as_array().unwrap().len(), cells);
        for method in ["runs", "runs_one_step"] {
            let runs = systems[k][method].as_array().unwrap();
            let errors: Vec<f64> = runs.iter().map(|run| run["error_k"].as_f64().unwrap()).collect();
            assert!(errors.windows(2).all(|pair| pair[1] < 0.5 * pair[0]), "{method}: {errors:?}");
            assert!(errors[2] < 1e-4, "{method}: {errors:?}");
        }
    }
}
