//! A thermometer on a stem through the valve, in an observer that knows of the stem and in one that does not.
use cylwatch_estimator::observer::{Commissioning, Observer, ObserverSettings};
use cylwatch_estimator::sensor::{SensorSuite, read_sensors, sample};
use cylwatch_estimator::thermal::scenario;
use cylwatch_estimator::thermal::simulate::{SimulationSettings, simulate};
use cylwatch_estimator::thermal::trajectory::Trajectory;
use cylwatch_estimator::thermal::vessel;

/// The stem reads so much of the way from the gas to the valve, two standard deviations more than typical.
const COUPLING: f64 = 0.2;

const SEEDS: u64 = 3;

/// A good thermometer of a kind, one on the valve and the pressure.
fn suite(kind: &str) -> SensorSuite {
    let text = format!(
        "[[sensor]]\nname = \"gas_1\"\nkind = \"{kind}\"\noffset_sd_k = 0.05\nnoise_k = 0.02\n\
         [[sensor]]\nname = \"valve\"\n[[sensor]]\nname = \"pressure\"\n"
    );
    read_sensors(&text, "sensors.toml").unwrap().1
}

/// Error of the gas temperature, K, and the same in its standard deviations, root mean square, of an observer that takes the
/// thermometer in the gas for one of a kind.
fn errors(run: &Trajectory, kind: &str, seed: u64) -> (f64, f64) {
    let mut truth = suite("immersion").draw(seed);
    truth.find_mut("gas_1").unwrap().truth.parameters[1] = COUPLING;
    let log = sample(run, &truth, seed).unwrap();
    let filled = Commissioning::filled(run.pressure_pa[0], run.gas_mean_k[0]);
    let settings = ObserverSettings::default();
    let mut observer = Observer::new(&run.vessel, suite(kind).sensors(), &filled, &settings).unwrap();
    let (mut k2, mut sd2) = (0.0, 0.0);
    for ((time_s, readings), gas_k) in log.rows().zip(&run.gas_mean_k) {
        let estimate = observer.step(time_s, readings).unwrap();
        let error_k = estimate.gas_mean_k - gas_k;
        k2 += error_k.powi(2);
        sd2 += (error_k / estimate.gas_mean_sd_k).powi(2);
    }
    let n = log.time_s.len() as f64;
    ((k2 / n).sqrt(), (sd2 / n).sqrt())
}

#[test]
fn an_observer_that_knows_of_the_stem_errs_less_and_as_it_states() {
    let vessel = vessel::presets::load("nitrogen-20l").unwrap();
    for name in ["shock-cold", "tunnel-winter"] {
        let scenario = scenario::presets::load(name).unwrap();
        let run = simulate(&vessel, &scenario, &SimulationSettings::default(), &mut |_| ()).unwrap();
        for seed in 0..SEEDS {
            let [(k, sd), (k_without, sd_without)] =
                ["immersion", "gas"].map(|kind| errors(&run, kind, seed));
            println!(
                "{name}, seed {seed}: {k:.3} K, {sd:.2} sd; without the stem {k_without:.3} K, {sd_without:.2} sd"
            );
            assert!(k < 0.6 * k_without && sd < 1.3 && sd_without > 1.5);
        }
    }
}
