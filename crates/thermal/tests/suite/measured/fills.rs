//! Fills: a steel tank at three rates, a small vessel, an air tank, a type III tank.
use cylwatch_thermal::vessel::Vessel;

use super::{at, case, curve, fitted, middle, rms, run};

/// Striednig et al. 2014, hydrogen into 23.5 L of steel at 5, 10 and 30 MPa/min: nothing is fitted. The pressure is the stated ramp, to 206 bar, which
/// it reaches when the measured temperatures bend; the gas is throttled from 350 bar. The inlet is not known, so there is no jet.
#[test]
fn a_steel_tank_that_is_filled_at_three_rates_is_within_4_k() {
    for (rate, bar_k) in [("5", 1.3), ("10", 2.1), ("30", 4.0)] {
        let (vessel, mut scenario) = case("striednig_2014", &format!("fill_{rate}_mpa_min"));
        let filled = run(&vessel, &scenario);
        println!("striednig_2014 {rate} MPa/min");
        let points = curve("striednig_2014", &format!("gas_{rate}_mpa_min"));
        let gas = rms("gas", &filled.time_s, &filled.gas_mean_k, &points);
        assert!(gas <= bar_k);
        // The energy of the fill is in the wall at the end, whatever the films were.
        let (end_s, end_k) = points[points.len() - 1];
        assert!((at(&filled.time_s, &filled.gas_mean_k, end_s) - end_k).abs() < 3.5);
        set_inlet(&mut scenario, Some(0.005));
        let filled = run(&vessel, &scenario);
        rms("through 5 mm", &filled.time_s, &filled.gas_mean_k, &points);
    }
}

/// Woodfield et al. 2007, hydrogen to 104 bar in 18 s into 0.94 L, along the measured pressure; nothing is fitted. Two thermometers up to 13 K apart.
///
/// Misses 4 K: the thermometers differ by up to 13 K, and where they hung and how the gas entered is not said. The inlet, 5 mm, is the carrier's. With the
/// vessel's diameter for the length of the jet's film in place of the height of the gas it would be 12.7 K, with no jet at all 23 K.
#[test]
fn a_small_vessel_is_filled_to_8_k_by_the_height_of_its_gas() {
    let (one, other) = (curve("woodfield_2007", "fill_gas_1"), curve("woodfield_2007", "fill_gas_2"));
    let middle = middle(&one, &other);
    let (vessel, mut scenario) = case("woodfield_2007", "fill");
    println!("woodfield_2007 fill");
    let filled = run(&vessel, &scenario);
    let jet = rms("middle of two thermometers", &filled.time_s, &filled.gas_mean_k, &middle);
    let stronger = Vessel { jet_film_factor: 212.0 / 75.0, ..vessel.clone() };
    let filled = run(&stronger, &scenario);
    let by_diameter = rms("with the diameter for the length", &filled.time_s, &filled.gas_mean_k, &middle);
    set_inlet(&mut scenario, None);
    let filled = run(&vessel, &scenario);
    let without = rms("without a jet", &filled.time_s, &filled.gas_mean_k, &middle);
    assert!(jet <= 7.6 && by_diameter <= 13.0 && without <= 25.0);
}

/// Thorncroft et al. 2007, air of the room into 16 L of 37 mbar through 2.71 mm. Fitted: the coefficient, to the pressure.
///
/// Misses 4 K: the jet enters faster than sound into next to nothing, where its film was never measured and is five times too strong. Without
/// it the gas is 12 K too warm on average; 60 mm would fit best, to 8 K.
#[test]
fn an_evacuated_tank_is_too_cold_under_the_film_of_its_jet() {
    let (vessel, best) = fitted("thorncroft_2007", "fill", &curve("thorncroft_2007", "fill_pressure"));
    let points = curve("thorncroft_2007", "fill_gas");
    let jet = rms("gas", &best.run.time_s, &best.run.gas_mean_k, &points);
    let mut scenario = best.run.scenario.clone();
    set_inlet(&mut scenario, None);
    let filled = run(&vessel, &scenario);
    let without = rms("without a jet", &filled.time_s, &filled.gas_mean_k, &points);
    assert!(best.pressure.1 <= 0.03 && jet <= 11.2 && without <= 22.5);
}

/// Dicken and Merida 2007, hydrogen from 93 bar into 74 L of type III in 37 s: one number, the mean of 63 thermocouples at the end, 68.9 degC.
/// The flow is the carrier's, scaled to the end pressure. Published computations of the flow field say 71.3 and 71.4 degC.
#[test]
fn a_type_iii_tank_ends_within_5_k_of_its_mean() {
    let (vessel, scenario) = case("dicken_2007", "fill");
    let run = run(&vessel, &scenario);
    let end_k = run.gas_mean_k[run.gas_mean_k.len() - 1];
    println!("dicken_2007 fill: {:.1} degC at the end, measured 68.9", end_k - 273.15);
    assert!((end_k - 342.05).abs() < 5.2);
}

fn set_inlet(scenario: &mut cylwatch_thermal::scenario::Scenario, bore_m: Option<f64>) {
    use cylwatch_thermal::flow::FlowKind;
    for flow in &mut scenario.flows {
        if let FlowKind::Supply { inlet_diameter_m, .. } = &mut flow.kind {
            *inlet_diameter_m = bore_m;
        }
    }
}
