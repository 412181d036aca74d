//! All detectors side by side on the readings of one cylinder, and what they said.
use cylwatch_detector::evidence::{Evidence, Scale, observer_settings};
use cylwatch_estimator::observer::{Commissioning, Observer};
use cylwatch_estimator::sensor::Sensor;
use cylwatch_estimator::thermal::vessel::presets;
use cylwatch_evaluation::baseline::{ErrorCusum, Filling, PressureError, Reading, Threshold};

use crate::Fault;
use crate::campaign::rate_bar_h;
use crate::records::{Record, Rises};
use crate::truths::{Readings, Run};

const MINUTE_S: f64 = 60.0;
const FILLING: Filling = Filling { pressure_pa: 200e5, temperature_k: 288.15 };
/// Limit of the pressure switch, Pa.
const LIMIT_PA: f64 = 160e5;
/// Time over which the refitted detector learns its zero, s.
const ZERO_S: f64 = 4.0 * 86_400.0;
/// Mean and standard deviation of its error over the fleet, Pa.
const ERROR_PA: (f64, f64) = (0.0, 0.7e5);
/// Holding times of the refitted detector.
pub const REFITTED: [(&str, f64); 4] = [
    ("refitted, 0 min", 0.0),
    ("refitted, 10 min", 10.0 * MINUTE_S),
    ("refitted, 60 min", 60.0 * MINUTE_S),
    ("refitted, 180 min", 180.0 * MINUTE_S),
];
/// Name of the paper's detector.
pub const PUBLISHED: &str = "published";

type Detector = Box<dyn FnMut(Reading) -> f64>;

fn baselines() -> Result<Vec<(&'static str, Detector)>, Fault> {
    let error = PressureError::refitted("nitrogen", FILLING)?;
    let mut cusum = ErrorCusum::known(error.clone(), ERROR_PA.0, ERROR_PA.1);
    let mut all = vec![
        (PUBLISHED, of(Threshold::published(FILLING))),
        ("raw switch", of(Threshold::raw_switch(LIMIT_PA))),
        ("ideal gas", of(Threshold::ideal_gas(FILLING))),
        ("cumulative sum", Box::new(move |reading| cusum.update(reading))),
    ];
    for (name, hold_s) in REFITTED {
        all.push((name, of(Threshold::new(error.clone()).held_for(hold_s).zeroed_over(ZERO_S))));
    }
    Ok(all)
}

fn of(mut threshold: Threshold) -> Detector {
    Box::new(move |reading| threshold.update(reading))
}

/// Run all detectors over a cylinder's readings.
pub fn judge(run: &Run, readings: &Readings) -> Result<Vec<Record>, Fault> {
    let sensors = ["shoulder", "valve", "pressure"].map(Sensor::typical);
    let sensors = sensors.into_iter().collect::<Result<Vec<_>, _>>()?;
    let settings = observer_settings();
    let commissioning = Commissioning::filled(FILLING.pressure_pa, FILLING.temperature_k);
    let vessel = presets::load(&run.settings.vessel)?;
    let mut observer = Observer::new(&vessel, &sensors, &commissioning, &settings)?;
    let mut evidence = Evidence::new(&settings);
    let mut baselines = baselines()?;
    let onset_s = run.settings.leak.map_or(0.0, |leak| leak.start_s);
    let mut rises = vec![Rises::since(onset_s); Scale::ALL.len() + baselines.len()];
    let mut end_s = 0.0;
    for (time_s, row) in readings.rows() {
        let [shoulder_k, _, pressure_pa] = row;
        observer.step(time_s, &row)?;
        let statistics = evidence.update(&observer, time_s, 1.0);
        let (own, others) = rises.split_at_mut(Scale::ALL.len());
        own.iter_mut().zip(statistics).for_each(|(rises, value)| rises.update(time_s, value));
        for (rises, (_, baseline)) in others.iter_mut().zip(&mut baselines) {
            rises.update(time_s, baseline(Reading { time_s, shoulder_k, pressure_pa }));
        }
        end_s = time_s;
    }
    let names = Scale::ALL.iter().map(|scale| scale.as_str()).chain(baselines.iter().map(|(name, _)| *name));
    let record = |(name, rises): (&str, Rises)| Record {
        run: run.name.clone(),
        detector: name.to_owned(),
        rate_bar_h: rate_bar_h(run),
        onset_s,
        end_s,
        rises,
    };
    Ok(names.zip(rises).map(record).collect())
}
