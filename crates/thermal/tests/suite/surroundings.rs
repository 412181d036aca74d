//! Signals with many bends, and surroundings that change along the axis.
use approx::assert_relative_eq;
use cylwatch_thermal::model::Model;
use cylwatch_thermal::model::inputs::{FilmInput, Inputs, Moment};
use cylwatch_thermal::scenario::{AxialVariation, OutsideFilm, Scenario, Series};
use cylwatch_thermal::simulate::{Method, SimulationSettings, simulate};
use cylwatch_thermal::trajectory::Trajectory;
use cylwatch_thermal::vessel::Vessel;

use crate::support::{closed_bottle, solid, still};

/// Air that falls and rises in ten-hour waves, its signal cut into pieces of `spacing_s`.
fn waves(spacing_s: f64, hours: f64) -> Scenario {
    let mut scenario = still(288.15, 288.15, 10.0, hours);
    let knots: Vec<f64> = (0..=(hours * 3600.0 / spacing_s) as usize).map(|k| k as f64 * spacing_s).collect();
    let air = knots.iter().map(|t| 288.15 + 5.0 * (t / 36_000.0 * std::f64::consts::TAU).sin()).collect();
    scenario.surroundings.air_k = Series::try_new(knots, air).unwrap();
    scenario
}

fn run_with(scenario: &Scenario, method: Method) -> Trajectory {
    let settings = SimulationSettings { method, ..SimulationSettings::default() };
    simulate(&closed_bottle(), scenario, &settings, &mut |_| {}).unwrap()
}

/// A straight line cut into pieces is still a straight line: the rounding of its pieces is no jump, and a
/// solver that restarted at each would take several steps more per piece.
#[test]
fn pieces_of_a_straight_line_cost_one_step_each() {
    for method in [Method::TrBdf2, Method::Esdirk34] {
        let mut scenario = still(288.15, 288.15, 10.0, 20.0);
        let knots: Vec<f64> = (0..=700).map(|k| f64::from(k) * 101.3).collect();
        let air = knots.iter().map(|t| 288.15 + 1e-4 * t).collect();
        scenario.surroundings.air_k = Series::try_new(knots, air).unwrap();
        let statistics = run_with(&scenario, method).statistics;
        let extra = statistics.steps as f64 / statistics.segments as f64;
        assert!(extra < 1.1, "{method:?}: {extra} steps per piece");
    }
}

/// One-step methods end a step one rounding beside an edge. Over weeks of edges that are samples too these
/// roundings must neither add up nor put a sample outside of the step that is read.
#[test]
fn weeks_of_bends_at_the_sample_times_run_through() {
    for (method, spacing_s) in [(Method::TrBdf2, 120.0), (Method::Esdirk34, 120.0), (Method::Bdf, 600.0)] {
        let trajectory = run_with(&waves(spacing_s, 24.0 * 21.0), method);
        assert_eq!(trajectory.time_s.len(), 21 * 1440 + 1);
        // After one wave the next is the same.
        let (a, b) = (trajectory.gas_mean_k[10 * 600], trajectory.gas_mean_k[50 * 600]);
        assert_relative_eq!(a, b, epsilon = 2e-3);
    }
}

/// 2.7 days are a rounding more than 233280 s: an edge there is the end, and one in the middle is one with its twin.
#[test]
fn edges_a_rounding_apart_run_through() {
    for method in [Method::TrBdf2, Method::Esdirk34, Method::Bdf] {
        let mut scenario = waves(120.0, 64.8);
        scenario.duration_s = 2.7 * 86_400.0;
        assert!(scenario.duration_s > 233_280.0);
        let trajectory = run_with(&scenario, method);
        assert_relative_eq!(*trajectory.time_s.last().unwrap(), 233_280.0);

        let mut twins = still(288.15, 288.15, 10.0, 20.0);
        let middle_s = 36_000.0;
        let knots = vec![0.0, middle_s, middle_s * (1.0 + f64::EPSILON), 72_000.0];
        twins.surroundings.air_k = Series::try_new(knots, vec![288.15, 288.15, 278.15, 278.15]).unwrap();
        let mut one = twins.clone();
        let knots = vec![0.0, middle_s, middle_s, 72_000.0];
        one.surroundings.air_k = Series::try_new(knots, vec![288.15, 288.15, 278.15, 278.15]).unwrap();
        let (twins, one) = (run_with(&twins, method), run_with(&one, method));
        assert_relative_eq!(twins.gas_mean_k.last().unwrap(), one.gas_mean_k.last().unwrap(), epsilon = 1e-3);
    }
}

/// A bottle of poor conductor, so that every height answers for itself.
fn insulating(conductivity: f64) -> Vessel {
    let mut vessel = closed_bottle();
    vessel.geometry.layers[0].material = solid(7850.0, 470.0, conductivity);
    vessel.geometry.cylinder_cells = 4;
    vessel.geometry.lumped = false;
    vessel
}

#[test]
fn surfaces_under_a_strong_film_take_the_air_of_their_height() {
    let mut scenario = still(288.15, 288.15, 1e4, 6.0);
    let air_difference_k = Some(Series::constant(4.0));
    scenario.surroundings.axial = AxialVariation { film_slope: 0.0, air_difference_k };
    let settings = SimulationSettings::default();
    let trajectory = simulate(&insulating(0.05), &scenario, &settings, &mut |_| {}).unwrap();
    let surface = trajectory.wall_outer_k.last().unwrap();
    for (surface_k, height) in surface.iter().zip([0.0, 0.125, 0.375, 0.625, 0.875, 1.0]) {
        assert_relative_eq!(*surface_k, 288.15 + 4.0 * (height - 0.5), epsilon = 0.01);
    }
}

/// A uniform wall in colder air loses heat in proportion to the film at each height.
#[test]
fn film_slope_scales_the_loss_of_each_height() {
    let vessel = insulating(1e9);
    let mut scenario = still(280.0, 300.0, 10.0, 1.0);
    scenario.surroundings.axial.film_slope = 0.4;
    let model = Model::new(&vessel, &scenario).unwrap();
    let x = model.initial_state(&vessel, &scenario.initial).unwrap();
    let inputs = Inputs {
        moment: Moment::default(),
        air_k: 280.0,
        film: FilmInput::Coefficient(10.0),
        radiation_k: None,
        irradiance_w_m2: 0.0,
        air_difference_k: 0.0,
    };
    let mut rate = vec![0.0; x.len()];
    model.rate(&x, &inputs, &[], &mut rate).unwrap();
    let mesh = model.mesh();
    for (column, height) in [0.0, 0.125, 0.375, 0.625, 0.875, 1.0].into_iter().enumerate() {
        let cell = mesh.outer_cell(column);
        let loss_w_m2 =
            -rate[cell] * mesh.volume_m3[cell] * 7850.0 * 470.0 / mesh.columns[column].outer_area_m2;
        assert_relative_eq!(loss_w_m2, 200.0 * (1.0 + 0.4 * (height - 0.5)), max_relative = 1e-6);
    }
}

/// A vessel's factor on its film does what the same factor on the scenario's film does.
#[test]
fn film_factor_of_the_vessel_acts_as_one_on_the_film_of_the_scenario() {
    let settings = SimulationSettings::default();
    let gas_k = |vessel: &Vessel, scenario: &Scenario| {
        *simulate(vessel, scenario, &settings, &mut |_| {}).unwrap().gas_mean_k.last().unwrap()
    };
    let mut vessel = closed_bottle();
    let plain = vessel.clone();
    vessel.surface.film_factor = 1.3;
    let coefficient = gas_k(&plain, &still(253.15, 288.15, 13.0, 0.5));
    assert_relative_eq!(gas_k(&vessel, &still(253.15, 288.15, 10.0, 0.5)), coefficient, epsilon = 1e-6);
    let mut windy = still(253.15, 288.15, 10.0, 0.5);
    windy.surroundings.film = OutsideFilm::Convection { wind_m_s: Series::constant(3.0), multiplier: 1.0 };
    let mut scaled = windy.clone();
    scaled.surroundings.film = OutsideFilm::Convection { wind_m_s: Series::constant(3.0), multiplier: 1.3 };
    assert_relative_eq!(gas_k(&vessel, &windy), gas_k(&plain, &scaled), epsilon = 1e-6);
    assert!(gas_k(&vessel, &windy) < gas_k(&plain, &windy) - 0.5);
}
