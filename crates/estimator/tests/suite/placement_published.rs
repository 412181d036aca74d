//! Positions by the paper's own measure: against the reproduction of its Table 1, and in cases whose order is plain.
use cylwatch_estimator::EstimatorError;
use cylwatch_estimator::placement::{
    PublishedRecord, PublishedScore, PublishedScores, PublishedSettings, Specimens, published_scores,
};
use cylwatch_estimator::sensor::{ParameterKind, Sensor};
use cylwatch_estimator::thermal::vessel::presets;

const SEEDS: usize = 12;

fn drawn() -> PublishedSettings {
    PublishedSettings { seeds: SEEDS, ..PublishedSettings::default() }
}

fn ideal() -> PublishedSettings {
    PublishedSettings { specimens: Specimens::Ideal, ..PublishedSettings::default() }
}

fn scores(sensors: &[Sensor], settings: &PublishedSettings) -> PublishedScores {
    published_scores(&presets::load("nitrogen-20l-paper").unwrap(), sensors, settings).unwrap()
}

fn typical(name: &str) -> Sensor {
    Sensor::typical(name).unwrap()
}

/// A thermometer on a place by another name, with its coupling and its offset's standard deviation, K.
fn mounted(place: &str, name: &str, coupling: f64, offset_sd_k: f64) -> Sensor {
    let mut sensor = typical(place);
    sensor.name = name.to_owned();
    let known = sensor.parameter_mut(ParameterKind::Coupling).unwrap();
    (known.mean, known.sd) = (coupling, 0.0);
    sensor.parameter_mut(ParameterKind::Offset).unwrap().sd = offset_sd_k;
    sensor
}

/// What book/src/identify.md states of the simulated Table 1, to its digits.
#[test]
fn ideal_thermometers_have_the_models_of_the_reproduced_table_1() {
    let sensors = [mounted("shoulder", "shoulder", 0.15, 0.0), mounted("valve", "valve", 0.15, 0.0)];
    let found = scores(&sensors, &ideal());
    let check = |name: &str, pole_per_s: f64, gain: f64, fit_percent: f64, mse_k2: f64| {
        let score = found.find(name).unwrap();
        let merit = score.on(PublishedRecord::Identification);
        let near = |value: f64, expected: f64, digit: f64| {
            assert!((value - expected).abs() <= 0.6 * digit, "{name}: {value}, {expected}");
        };
        near(1.0 / score.time_constant_s.mean, pole_per_s, 1e-6);
        near(score.gain.mean, gain, 1e-4);
        near(merit.fit_percent.mean, fit_percent, 1e-2);
        near(merit.mse_k2.mean, mse_k2, 1e-4);
        assert_eq!((merit.mse_k2.low, merit.mse_k2.high), (merit.mse_k2.mean, merit.mse_k2.mean));
    };
    check("shoulder", 0.003279, 0.9983, 99.36, 0.0330);
    check("valve", 0.002487, 0.9953, 99.11, 0.0637);
    // Figure 3 of the same page: 0.13 and 0.16 K.
    let rms_k = |record| found.find("shoulder").unwrap().on(record).mse_k2.mean.sqrt();
    assert!((rms_k(PublishedRecord::RampWarm) - 0.13).abs() < 0.006);
    assert!((rms_k(PublishedRecord::CoolDown) - 0.16).abs() < 0.006);
}

#[test]
fn a_fine_thermometer_in_the_gas_beats_all_others_on_every_record() {
    let mut gas = typical("gas_1");
    gas.noise_sd = 0.01;
    gas.parameter_mut(ParameterKind::Offset).unwrap().sd = 0.01;
    let others = ["bottom", "middle", "shoulder", "neck", "valve"];
    let sensors: Vec<Sensor> = others.iter().map(|name| typical(name)).chain([gas]).collect();
    for settings in [drawn(), ideal()] {
        let found = scores(&sensors, &settings);
        for record in PublishedRecord::ALL {
            assert_eq!(found.ranking(record)[0], "gas_1");
            for other in others {
                let duel = found.duel("gas_1", other, record).unwrap();
                assert!(duel.share == 1.0 && duel.ahead_percent.low > 0.0, "{other}, {record:?}: {duel:?}");
            }
        }
    }
    // It is the gas: no lag, gain one, no error.
    let alone = scores(&sensors, &ideal());
    let gas = alone.find("gas_1").unwrap();
    assert_eq!(gas.time_constant_s.mean, 0.0);
    assert!((gas.gain.mean - 1.0).abs() < 1e-12);
    assert!(gas.on(PublishedRecord::Validation).fit_percent.mean > 100.0 - 1e-9);
}

#[test]
fn a_well_glued_thermometer_beats_a_bad_one_on_the_same_place() {
    let sensors = [mounted("shoulder", "glued", 0.15, 0.02), mounted("shoulder", "loose", 0.6, 2.0)];
    let found = scores(&sensors, &drawn());
    for record in [PublishedRecord::Identification, PublishedRecord::Validation] {
        let duel = found.duel("glued", "loose", record).unwrap();
        assert_eq!(duel.share, 1.0, "{record:?}: {duel:?}");
        assert_eq!(found.duel("loose", "glued", record).unwrap().share, 0.0);
    }
}

#[test]
fn equal_seeds_give_equal_numbers_whoever_else_is_there() {
    let sensors: Vec<Sensor> = ["shoulder", "valve", "pressure", "ambient"].map(typical).to_vec();
    let settings = drawn();
    let found = scores(&sensors, &settings);
    let names: Vec<&str> = found.scores.iter().map(|score| score.name.as_str()).collect();
    assert_eq!(names, ["shoulder", "valve"]);
    assert_eq!(found.scores, scores(&sensors, &settings).scores);
    let alone: PublishedScore = scores(&sensors[1..2], &settings).scores[0].clone();
    assert_eq!(alone, found.scores[1]);
    let other = scores(&sensors, &PublishedSettings { first_seed: 1000, ..settings });
    assert_ne!(other.scores, found.scores);
}

#[test]
fn lost_readings_are_left_out_and_what_cannot_be_scored_is_refused() {
    let mut lossy = typical("shoulder");
    lossy.dropout = 0.3;
    let found = scores(&[lossy.clone()], &drawn());
    assert!(found.scores[0].on(PublishedRecord::Validation).fit_percent.low > 80.0);
    let vessel = presets::load("nitrogen-20l-paper").unwrap();
    lossy.dropout = 1.0;
    let refused = |sensors: &[Sensor], settings: &PublishedSettings| {
        published_scores(&vessel, sensors, settings).unwrap_err()
    };
    assert!(matches!(refused(&[lossy], &drawn()), EstimatorError::Identify(_)));
    let none = PublishedSettings { seeds: 0, ..drawn() };
    assert!(matches!(refused(&[], &none), EstimatorError::PlacementSetting { setting: "seeds", .. }));
    let twice = [typical("valve"), typical("valve")];
    assert!(matches!(refused(&twice, &drawn()), EstimatorError::SensorTwice { .. }));
}
