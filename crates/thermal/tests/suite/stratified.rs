//! Stacked gas in small vessels, whose cells hold little.
use cylwatch_thermal::flow::{Flow, FlowKind, Opening, Source};
use cylwatch_thermal::scenario::Series;
use cylwatch_thermal::simulate::{SimulationSettings, simulate};
use cylwatch_thermal::vessel::{GasResolution, Stratification, Vessel};
use cylwatch_thermal::wall::geometry::Orientation;

use crate::filling::{filled, supply};
use crate::support::{closed_bottle, rigid, run, run_layers, still};

fn stacked(diameter_m: f64, length_m: f64, orientation: Orientation, cells: usize) -> Vessel {
    let mut vessel = closed_bottle();
    vessel.geometry.inner_diameter_m = diameter_m;
    vessel.geometry.cylinder_length_m = length_m;
    vessel.geometry.orientation = orientation;
    vessel.volume = rigid(vessel.geometry.contour_volume_m3());
    vessel.gas = GasResolution::Stratified(Stratification { cells, ..Default::default() });
    vessel
}

fn vent(diameter_m: f64) -> Flow {
    let kind = FlowKind::Orifice { diameter_m, discharge_coefficient: 0.8, back_pressure_pa: 1e5 };
    let source =
        Source::Supply { temperature_k: Series::constant(288.15), pressure_pa: Series::constant(1e5) };
    Flow { kind, ..supply(Opening::Orifice { diameter_m, discharge_coefficient: 0.8 }, source) }
}

/// A first step of 0.1 s may empty the cell at the valve: it is one to repeat, not the end. Vessels of 6, 10 and 140 L.
#[test]
fn many_cells_in_a_small_vessel_survive_a_discharge() {
    use Orientation::{Horizontal, Vertical};
    for (diameter_m, length_m, orientation, cells, bore_m, bar) in [
        (0.15, 0.34, Vertical, 30, 0.003, 150.0),
        (0.15, 0.34, Vertical, 60, 0.006, 150.0),
        (0.15, 0.34, Horizontal, 30, 0.0015, 300.0),
        (0.15, 0.34, Horizontal, 60, 0.0015, 300.0),
        (0.17, 0.44, Vertical, 60, 0.003, 300.0),
        (0.17, 0.44, Horizontal, 60, 0.003, 150.0),
        (0.35, 1.5, Horizontal, 100, 0.008, 250.0),
    ] {
        let vessel = stacked(diameter_m, length_m, orientation, cells);
        let run = run(&vessel, &filled(bar * 1e5, 288.15, 1.0, vent(bore_m)), 1e-6);
        let (mass, energy) = (run.ledger.mass_residual(), run.ledger.energy_residual());
        assert!(mass.abs() < 1e-8 && energy.abs() < 1e-8, "{cells} cells: mass {mass:e}, energy {energy:e}");
    }
}

/// At rest the smoothing of the wall's layer, 0.05 W for each cell, may move some hundredths of a kelvin.
#[test]
fn many_cells_in_a_small_vessel_survive_rest_and_a_fill() {
    for orientation in [Orientation::Vertical, Orientation::Horizontal] {
        let vessel = stacked(0.15, 0.34, orientation, 60);
        let rest = run(&vessel, &still(288.15, 288.15, 8.0, 0.1), 1e-6);
        assert!(rest.gas_cells_k.iter().flatten().all(|k| (k - 288.15).abs() < 0.1));
    }
    let source =
        Source::Supply { temperature_k: Series::constant(288.15), pressure_pa: Series::constant(250e5) };
    let refill = supply(Opening::Orifice { diameter_m: 0.006, discharge_coefficient: 0.8 }, source);
    let filled =
        run_layers(&stacked(0.17, 0.44, Orientation::Vertical, 30), &filled(5e5, 288.15, 1.0, refill), 1e-6);
    assert!(filled.ledger.energy_residual().abs() < 1e-8);
}

/// A jet of 3 kg/s into cells of less than a gram: their pressures would differ by more than they have.
#[test]
fn more_flow_than_a_cell_can_pass_on_is_refused_with_a_number_that_works() {
    let source =
        Source::Supply { temperature_k: Series::constant(288.15), pressure_pa: Series::constant(250e5) };
    let refill = supply(Opening::Orifice { diameter_m: 0.008, discharge_coefficient: 0.8 }, source);
    let scenario = filled(5e5, 288.15, 1.0, refill);
    let result = |cells: usize| {
        let vessel = stacked(0.1, 0.26, Orientation::Horizontal, cells);
        let settings = SimulationSettings { fills_layers: true, ..SimulationSettings::default() };
        simulate(&vessel, &scenario, &settings, &mut |_| {})
    };
    let message = result(60).unwrap_err().to_string();
    let number = message.split("at most ").nth(1).and_then(|rest| rest.split(' ').next()).unwrap();
    assert!(result(number.parse().unwrap()).is_ok(), "{message}");
}

/// No model of what a jet mixes holds on measured fills; without layers the same fill runs.
#[test]
fn a_refill_of_layers_is_refused_with_the_model_to_take() {
    let source =
        Source::Supply { temperature_k: Series::constant(288.15), pressure_pa: Series::constant(250e5) };
    let refill = supply(Opening::Orifice { diameter_m: 0.001, discharge_coefficient: 0.8 }, source);
    let scenario = filled(5e5, 288.15, 1.0, refill);
    let result = |vessel: &Vessel| simulate(vessel, &scenario, &SimulationSettings::default(), &mut |_| {});
    let mut vessel = stacked(0.17, 0.44, Orientation::Vertical, 20);
    let message = result(&vessel).unwrap_err().to_string();
    assert!(message.starts_with("refill: ") && message.contains("model = \"well-mixed\""), "{message}");
    vessel.gas = GasResolution::WellMixed;
    assert!(result(&vessel).is_ok());
}
