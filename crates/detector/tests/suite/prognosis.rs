//! The time left against leaks of the physical model: a hole in a cylinder, a cold night on a tight one.
use cylwatch_detector::estimator::thermal::scenario::{self, Scenario};
use cylwatch_detector::estimator::thermal::units::QUOTED_K;
use cylwatch_detector::estimator::thermal::{simulate, vessel};
use cylwatch_detector::prognosis::{Contents, LossLaw, MassAndLeak, Passage, Prognosis};

const BAR: f64 = 1e5;

/// A full cylinder at 15 °C with a leak that is there from the start.
fn leaking(leak: &str, hours: u32) -> Scenario {
    let text = format!(
        "name = \"leak\"\nduration_h = {hours}\nsample_time_min = 2\n\
         [initial]\nfill_pressure_bar = 200\nfill_temperature_degc = 15\ntemperature_degc = 15\n\
         [ambient]\nair_degc = 15\nfilm_w_m2_k = 20\n\
         [[leak]]\nname = \"leak\"\n{leak}\n"
    );
    scenario::read_scenario(&text, "leak.toml", &|_: &str| Err(std::io::ErrorKind::NotFound.into())).unwrap()
}

/// Hours until 160 bar at 15 °C: simulated, and foretold from mass and leak rate after the first hour.
fn hours(leak: &str, hours: u32, law: LossLaw) -> (f64, f64) {
    let vessel = vessel::presets::load("nitrogen-20l").unwrap();
    let run = simulate::simulate(&vessel, &leaking(leak, hours), &Default::default(), &mut |_| {}).unwrap();
    let limit_kg = Contents::of(&vessel).mass_kg(160.0 * BAR, QUOTED_K).unwrap();
    let reached = run.mass_kg.iter().position(|mass_kg| *mass_kg <= limit_kg).unwrap();
    let now = run.time_s.iter().position(|time_s| *time_s >= 3600.0).unwrap();
    let state = MassAndLeak::try_new(run.mass_kg[now], run.outflow_kg_s[now], [[0.0; 2]; 2]).unwrap();
    let Passage::In(left_s) = Prognosis::try_new(state, limit_kg, law).unwrap().quantile(0.5, 1e8) else {
        panic!("the limit lies ahead");
    };
    ((run.time_s[reached] - run.time_s[now]) / 3600.0, left_s / 3600.0)
}

#[test]
fn a_constant_leak_takes_the_time_foretold() {
    let (simulated_h, foretold_h) = hours("flow_g_h = 60", 16, LossLaw::Linear);
    // Samples every 2 min.
    assert!((simulated_h - foretold_h).abs() < 0.05, "{simulated_h} {foretold_h}");
}

#[test]
fn a_hole_takes_longer_than_a_constant_leak_and_nearly_as_long_as_a_choked_one() {
    let hole = "diameter_mm = 0.02";
    let (simulated_h, choked_h) = hours(hole, 40, LossLaw::Choked);
    let (_, linear_h) = hours(hole, 40, LossLaw::Linear);
    println!(
        "hole of 20 um, 200 to 160 bar: {simulated_h:.2} h, choked {choked_h:.2} h, straight {linear_h:.2} h"
    );
    assert!((choked_h / simulated_h - 1.0).abs() < 0.05, "{simulated_h} {choked_h}");
    assert!((0.85..0.95).contains(&(linear_h / simulated_h)), "{simulated_h} {linear_h}");
}

#[test]
fn a_cold_night_comes_before_the_limit_at_15_degc() {
    let contents = Contents::of(&vessel::presets::load("nitrogen-20l").unwrap());
    let mass_kg = contents.mass_kg(180.0 * BAR, QUOTED_K).unwrap();
    let left = |kelvin: f64| {
        let limit_kg = contents.mass_kg(160.0 * BAR, kelvin).unwrap();
        // 2 g/h +- 0.2, mass to 5 g.
        let covariance = [[25e-6, 0.0], [0.0, (0.2e-3 / 3600.0_f64).powi(2)]];
        let state = MassAndLeak::try_new(mass_kg, 2e-3 / 3600.0, covariance).unwrap();
        Prognosis::try_new(state, limit_kg, LossLaw::Choked).unwrap().quantile(0.5, 1e8)
    };
    // 180 bar at 15 degC are 160 bar at -7.8 degC (CoolProp).
    assert_eq!(left(273.15 - 10.0), Passage::Reached);
    let days = |passage| if let Passage::In(time_s) = passage { time_s / 86_400.0 } else { f64::NAN };
    let (at_zero, quoted) = (days(left(273.15)), days(left(QUOTED_K)));
    println!("180 bar losing 2 g/h: 160 bar at 0 degC in {at_zero:.1} d, at 15 degC in {quoted:.1} d");
    assert!(at_zero > 0.0 && at_zero < 0.5 * quoted);
}
