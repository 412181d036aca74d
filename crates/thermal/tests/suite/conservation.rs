//! The ledger of mass and energy: what goes in is what is there.
use cylwatch_thermal::fluid::Fluid;
use cylwatch_thermal::scenario;
use cylwatch_thermal::simulate::{Method, SimulationSettings, simulate};
use cylwatch_thermal::trajectory::Trajectory;
use cylwatch_thermal::vessel::{self, Fill, GasResolution, Stratification, Vessel};
use cylwatch_thermal::wall::geometry::Orientation;

fn run(vessel: &Vessel, scenario: &str, tolerance: f64, method: Method) -> Trajectory {
    let settings = SimulationSettings { relative_tolerance: tolerance, method, ..Default::default() };
    let scenario = scenario::presets::load(scenario).unwrap();
    simulate(vessel, &scenario, &settings, &mut |_| {}).unwrap()
}

fn assert_closed(what: &str, trajectory: &Trajectory, bound: f64) {
    let (mass, energy) = (trajectory.ledger.mass_residual(), trajectory.ledger.energy_residual());
    println!("{what}: mass {mass:.1e}, energy {energy:.1e}, {} steps", trajectory.statistics.steps);
    assert!(mass.abs() <= bound && energy.abs() <= bound, "{what}: mass {mass:e}, energy {energy:e}");
    assert!(trajectory.ledger.energy_scale_j > 1e3, "{what}: nothing was turned over");
}

fn vessel_for(scenario: &str) -> Vessel {
    let name = match scenario {
        "haque-i1" => "haque-i1",
        "bottle-step" => "closed-bottle",
        _ => "nitrogen-20l",
    };
    vessel::presets::load(name).unwrap()
}

#[test]
fn ledger_closes_over_every_preset_at_the_default_tolerance() {
    for name in scenario::presets::FILES.names() {
        assert_closed(name, &run(&vessel_for(name), name, 1e-6, Method::Bdf), 1e-9);
    }
}

#[test]
fn ledger_closes_to_1e_8_at_tolerance_1e_10() {
    for name in scenario::presets::FILES.names().filter(|name| *name != "railway-week") {
        assert_closed(name, &run(&vessel_for(name), name, 1e-10, Method::Bdf), 1e-8);
    }
}

/// Full blowdown of the elastic 20 L cylinder with valve, with every method.
#[test]
fn ledger_closes_during_a_choked_blowdown_with_every_method() {
    let vessel = vessel::presets::load("nitrogen-20l").unwrap();
    for method in [Method::Bdf, Method::TrBdf2, Method::Esdirk34] {
        assert_closed(&format!("{method:?}"), &run(&vessel, "haque-i1", 1e-7, method), 1e-8);
    }
}

#[test]
fn ledger_closes_for_stacked_gas_standing_and_lying() {
    let constants = Stratification { cells: 12, exchange_length_diameters: 1.0, core_mixing: 0.05 };
    for orientation in [Orientation::Vertical, Orientation::Horizontal] {
        let mut vessel = vessel::presets::load("nitrogen-20l").unwrap();
        vessel.gas = GasResolution::Stratified(constants);
        vessel.geometry.orientation = orientation;
        for scenario in ["tunnel-winter", "haque-i1"] {
            assert_closed(scenario, &run(&vessel, scenario, 1e-6, Method::Bdf), 1e-8);
        }
    }
}

#[test]
fn ledger_closes_for_every_gas() {
    for name in Fluid::names() {
        let mut vessel = vessel::presets::load("nitrogen-20l").unwrap();
        vessel.fluid = Fluid::named(name).unwrap();
        let mut scenario = scenario::presets::load("leak-after-tunnel").unwrap();
        if name == "carbon-dioxide" {
            // It condenses at 26.5 bar and -10 degC.
            scenario.initial.fill = Fill::Settled { pressure_pa: 20e5, temperature_k: 288.15 };
        }
        assert_closed(name, &simulate(&vessel, &scenario, &Default::default(), &mut |_| {}).unwrap(), 1e-9);
    }
}
