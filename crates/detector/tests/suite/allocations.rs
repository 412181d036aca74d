//! After the monitor has been made, neither a row nor a state that is saved needs memory that it has not had: for controllers, whose memory is given
//! once.
use cylwatch_allocations::allocations;
use cylwatch_detector::estimator::observer::Commissioning;
use cylwatch_detector::estimator::sensor::Sensor;
use cylwatch_detector::estimator::thermal::vessel::presets;
use cylwatch_detector::monitor::{Monitor, MonitorSettings, Verdict};
use cylwatch_detector::prognosis::Contents;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

const DAY_S: f64 = 86_400.0;

/// What may happen to a cylinder.
pub(crate) const HAPPENS: [&str; 10] = [
    "nothing",
    "leak",
    "discharge",
    "refill",
    "spikes",
    "transmitter",
    "thermometer",
    "missing",
    "stuck",
    "swapped",
];

/// Mass, kg, and readings of a cylinder in slow weather at a time, s, with what may happen to one.
pub(crate) fn row(contents: &Contents, rng: &mut ChaCha8Rng, time_s: f64, happens: &str) -> [f64; 3] {
    let hour = time_s / 3600.0;
    let gas_k = 285.0 + 6.0 * (hour / 24.0 * core::f64::consts::TAU).sin();
    let since_h = (hour - 30.0).max(0.0);
    let mass_kg = 4.45
        - match happens {
            "leak" => 0.02 * since_h,
            "discharge" => (0.05 * 60.0 * since_h).min(1.5),
            "refill" => -(0.05 * 60.0 * since_h).min(0.3),
            _ => 0.0,
        };
    let mut noise = || rng.random_range(-1.0..1.0);
    let mut readings = [
        gas_k + 0.03 * noise(),
        gas_k + 0.03 * noise(),
        contents.pressure_pa(mass_kg, gas_k).unwrap() + 3e3 * noise(),
    ];
    let minute = (time_s / 60.0) as usize;
    match happens {
        "spikes" if minute.is_multiple_of(97) => readings[2] *= 0.7,
        "transmitter" if since_h > 0.0 => readings[2] -= 3e5,
        "thermometer" if since_h > 0.0 => readings[1] += 4.0,
        "missing" if minute % 7 < 2 => readings[minute % 3] = f64::NAN,
        "stuck" if since_h > 0.0 => readings[0] = 290.0,
        "swapped" => readings[0] += 3.0 * (hour * 2.0).sin(),
        _ => {}
    }
    readings
}

#[test]
fn whatever_happens_no_row_and_no_saved_state_allocates() {
    let vessel = presets::load("nitrogen-20l").unwrap();
    let contents = Contents::of(&vessel);
    let sensors = ["shoulder", "valve", "pressure"].map(|name| Sensor::typical(name).unwrap());
    let filled = Commissioning::filled(200e5, 288.15);
    let (mut verdicts, mut room) = (Vec::new(), vec![0; 32 << 10]);
    for happens in HAPPENS {
        let mut rng = ChaCha8Rng::seed_from_u64(7);
        let mut monitor = Monitor::new(&vessel, &sensors, &filled, &MonitorSettings::default()).unwrap();
        let (mut time_s, mut clock_s, mut verdict) = (0.0, 0.0, Verdict::Tight);
        while time_s < 2.6 * DAY_S {
            // Rows of ten seconds for a while, a gap, and a clock that is set.
            time_s += match time_s {
                t if t < 7200.0 => 10.0,
                t if (150_000.0..150_060.0).contains(&t) => 9000.0,
                _ => 60.0,
            };
            if (200_000.0..200_060.0).contains(&time_s) {
                clock_s = -7200.0;
            }
            let readings = row(&contents, &mut rng, time_s, happens);
            let (mut outputs, mut said) = (0, None);
            let counted = allocations(|| {
                monitor.take(time_s + clock_s, &readings).unwrap();
                while let Some(output) = monitor.next_output().unwrap() {
                    outputs += 1;
                    said = Some(output.decision.verdict);
                }
            });
            verdict = said.unwrap_or(verdict);
            assert_eq!(counted, 0, "{happens}: at {time_s} s, with {outputs} outputs");
            if outputs > 0 && (time_s / 60.0) as usize % 60 == 7 {
                let mut length = 0;
                let counted = allocations(|| length = monitor.save_into(&mut room).unwrap());
                assert_eq!(counted, 0, "{happens}: a state at {time_s} s");
                assert_eq!(room[..length], monitor.save().unwrap(), "{happens}: at {time_s} s");
            }
        }
        verdicts.push(verdict);
        assert!(monitor.intake().counts().jumps == 1 && monitor.intake().counts().gaps >= 1, "{happens}");
    }
    // The rows were those of what was to happen.
    assert_eq!(verdicts[..2], [Verdict::Tight, Verdict::Leak], "{verdicts:?}");
}
