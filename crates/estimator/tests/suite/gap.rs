//! A gap is gone through in steps that become longer, and the estimate after it is that of steps of a minute.
use cylwatch_estimator::observer::{Commissioning, Observer, ObserverSettings};
use cylwatch_estimator::sensor::Sensor;
use cylwatch_thermal::vessel::presets;

/// An observer of a cylinder that has stood in its shelter for hours, and ten minutes in a tunnel that is so much warmer, K; time of the last
/// row, s.
fn in_a_tunnel(warmer_k: f64) -> (Observer, f64) {
    let vessel = presets::load("nitrogen-20l").unwrap();
    let sensors = ["shoulder", "valve", "pressure"].map(|name| Sensor::typical(name).unwrap());
    let filled = Commissioning::filled(200e5, 288.15);
    let mut observer = Observer::new(&vessel, &sensors, &filled, &ObserverSettings::default()).unwrap();
    for minute in 0..370 {
        let slow_k = 3.0 * (f64::from(minute) / 300.0).sin();
        let in_tunnel = f64::from((minute - 360).max(0));
        let [wall_k, valve_k, gas_k] =
            [20.0, 8.0, 35.0].map(|tau: f64| warmer_k * (1.0 - (-in_tunnel / tau).exp()) + slow_k);
        let row = [288.15 + wall_k, 288.15 + valve_k, 200e5 + 0.72e5 * gas_k];
        observer.step(60.0 * f64::from(minute), &row).unwrap();
    }
    (observer, 60.0 * 369.0)
}

/// Largest difference of what two observers know: of a mean, in standard deviations, of a standard deviation, as a part, and of a correlation.
fn difference(a: &Observer, b: &Observer) -> [f64; 3] {
    let members = (0..).map_while(|member| a.state(member).zip(b.state(member)));
    members.fold([0.0; 3], |worst, ((x, p), (y, q))| {
        let sd = q.diagonal().map(f64::sqrt);
        let mean = (&x - &y).component_div(&sd).amax();
        let widths = p.diagonal().map(f64::sqrt).component_div(&sd).add_scalar(-1.0).amax();
        let coupled = (&p - &q).component_div(&(&sd * sd.transpose())).amax();
        [worst[0].max(mean), worst[1].max(widths), worst[2].max(coupled)]
    })
}

/// Steps of 20 s instead of a minute change standard deviations by as much (0.026, 0.046).
#[test]
fn the_estimate_after_a_gap_is_that_of_steps_of_a_minute() {
    for (warmer_k, minutes) in [(25.0, 20), (-25.0, 60), (25.0, 360), (-15.0, 1440)] {
        let ((mut at_once, since_s), (mut by_minutes, _)) = (in_a_tunnel(warmer_k), in_a_tunnel(warmer_k));
        let missing = [f64::NAN; 3];
        for minute in 1..=minutes {
            by_minutes.step(since_s + 60.0 * f64::from(minute), &missing).unwrap();
        }
        at_once.step(since_s + 60.0 * f64::from(minutes), &missing).unwrap();
        let [mean, sd, coupled] = difference(&at_once, &by_minutes);
        println!("{warmer_k} K, {minutes} min: mean {mean:.4}, sd {sd:.4}, correlation {coupled:.4}");
        assert!(mean < 0.05 && sd < 0.03 && coupled < 0.06);
    }
}
