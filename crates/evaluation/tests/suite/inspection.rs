//! Whether the probabilities of an inspection are right, on worlds that it does not know.
//!
//! A tight world is cut to a log or to its last row. What it was filled with is drawn so that 0 to 10 % have been lost, uniformly, which is what an inspection
//! that supposes nothing of the loss stands for; the fill is stated with an error of 1 % of its mass. Stated probabilities of a refill are then
//! sorted into bins, and the share of cylinders that have lost more than 5 % must be what was stated.
use cylwatch_detector::inspection::{
    Criterion, Inspection, Instruments, SingleReading, UncertainMass, commissioning,
};
use cylwatch_detector::monitor::{Monitor, MonitorSettings};
use cylwatch_detector::prognosis::Contents;
use cylwatch_estimator::log::Quantity;
use cylwatch_estimator::observer::Commissioning;
use cylwatch_estimator::sensor::Sensor;
use cylwatch_evaluation::world::{Request, SensorClass, World, generate};
use cylwatch_thermal::units::{HOUR_S, QUOTED_K};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::StandardNormal;

const FILL_SD: f64 = 0.01;
const BINS: [f64; 6] = [0.0, 0.05, 0.3, 0.7, 0.95, 1.0];
/// Probability that a bin of right probabilities is outside its band.
const BAND: f64 = 0.005;
/// Where cylinders hang and stand.
const PLACES: [(&str, &str); 10] = [
    ("nitrogen-20l", "railway"),
    ("nitrogen-20l", "hall"),
    ("argon-50l", "parked"),
    ("nitrogen-80l", "arctic"),
    ("air-composite-7l", "workshop"),
    ("helium-10l", "metro"),
    ("hydrogen-50l", "showers"),
    ("nitrogen-20l", "switching"),
    ("argon-50l", "hall"),
    ("nitrogen-80l", "chamber"),
];

/// A stated probability of a refill, and whether one was due.
type Stated = (f64, bool);

/// The last reading of a quantity.
fn last(world: &World, quantity: Quantity) -> f64 {
    let of = |sensor: &Sensor| sensor.quantity() == quantity;
    let column = world.operator_data.sensors.iter().position(of).unwrap();
    world.log.rows().map(|(_, row)| row[column]).filter(|value| value.is_finite()).last().unwrap()
}

/// Judges what a cylinder holds against a fill that is drawn.
fn judged(world: &World, now: UncertainMass, random: &mut ChaCha8Rng) -> Stated {
    let contents = Contents::of(&world.operator_data.vessel);
    let loss = 0.1 * random.random::<f64>();
    let settled_pa = *world.truth.settled_pa.last().unwrap();
    let filled_kg = contents.mass_kg(settled_pa / (1.0 - loss), QUOTED_K).unwrap();
    let mass_kg = filled_kg * (1.0 + FILL_SD * random.sample::<f64, _>(StandardNormal));
    let filled = UncertainMass { mass_kg, sd_kg: FILL_SD * mass_kg };
    let Inspection { refill_probability, .. } = Criterion::default().judge(&contents, filled, now).unwrap();
    (refill_probability, loss > Criterion::default().loss_limit)
}

/// By a log.
fn by_log(world: &World, random: &mut ChaCha8Rng) -> Stated {
    let known = &world.operator_data;
    let first_pa = {
        let column = known.sensors.iter().position(|sensor| sensor.quantity() == Quantity::Pressure).unwrap();
        world.log.rows().map(|(_, row)| row[column]).find(|value| value.is_finite()).unwrap()
    };
    let mut settings = MonitorSettings::default();
    settings.observer.air.prior_sd = Commissioning::UNSETTLED_AIR_SD_K;
    let mut monitor =
        Monitor::new(&known.vessel, &known.sensors, &commissioning(first_pa, false), &settings).unwrap();
    let mut outputs = Vec::new();
    for (time_s, row) in world.log.rows() {
        outputs.extend(monitor.step(time_s, row).unwrap());
    }
    outputs.extend(monitor.finish().unwrap());
    judged(world, (&outputs.last().unwrap().estimate).into(), random)
}

/// By the last row, read by a person: a contact thermometer and a gauge of class 1.6; `rested_s`: what is known of the rest.
fn by_reading(world: &World, rested_s: f64, random: &mut ChaCha8Rng) -> Stated {
    let vessel = &world.operator_data.vessel;
    let full_pa = *world.truth.settled_pa.last().unwrap();
    let gauge = Sensor::typical_gauge("pressure", full_pa, 0.016).unwrap();
    let range_pa = gauge.plausible().1 / 1.031_25;
    let off_pa = 0.016 * range_pa * (2.0 * random.random::<f64>() - 1.0);
    let reading = SingleReading {
        pressure_pa: world.truth.pressure_pa.last().unwrap() + off_pa,
        temperature_k: last(world, Quantity::Temperature),
        rested_s,
    };
    let [thermometer, air] = ["shoulder", "ambient"].map(|name| Sensor::typical(name).unwrap());
    let mass = reading.mass(vessel, &Instruments { thermometer, air, gauge }).unwrap();
    judged(world, mass, random)
}

/// Shares of the bins beside what was stated, and whether all lie in their bands.
fn reliability(title: &str, stated: &[Stated]) -> bool {
    let mut right = true;
    for pair in BINS.windows(2) {
        let within: Vec<&Stated> =
            stated.iter().filter(|(p, _)| (pair[0]..pair[1]).contains(p) || *p == pair[1]).collect();
        if within.is_empty() {
            continue;
        }
        let count = within.len();
        let mean = within.iter().map(|(p, _)| p).sum::<f64>() / count as f64;
        let due = within.iter().filter(|(_, due)| *due).count();
        let (low, high) = band(count, mean);
        let holds = (low..=high).contains(&due);
        println!(
            "{title}: stated {mean:.3}, due {due} of {count} ({low} to {high}){}",
            if holds { "" } else { " !" }
        );
        right &= holds;
    }
    let told = stated.iter().filter(|(p, _)| *p <= 0.05 || *p >= 0.95).count();
    let wrong = stated.iter().filter(|(p, due)| (*p <= 0.05 && *due) || (*p >= 0.95 && !*due)).count();
    println!("{title}: told {told} of {}, wrong {wrong}", stated.len());
    right
}

/// Successes that a binomial variable lies between.
fn band(count: usize, probability: f64) -> (usize, usize) {
    use statrs::distribution::{Binomial, DiscreteCDF};
    let binomial = Binomial::new(probability.clamp(0.0, 1.0), count as u64).unwrap();
    (binomial.inverse_cdf(0.5 * BAND) as usize, binomial.inverse_cdf(1.0 - 0.5 * BAND) as usize)
}

/// Draws of a class of sensors, `each` of them: by logs of a day, by single readings without and with rest.
fn classes(each: u64) -> bool {
    let mut right = true;
    for &class in SensorClass::ALL {
        let mut random = ChaCha8Rng::seed_from_u64(97);
        let mut stated = Vec::new();
        for draw in 0..each {
            let (vessel, climate) = PLACES[draw as usize % PLACES.len()];
            let family = format!("{vessel}/{climate}/mixed/{class}/60s").parse().unwrap();
            let world = generate(&Request::tight(family, 4000 + draw, 24.0 * HOUR_S)).unwrap();
            stated.push(by_log(&world, &mut random));
        }
        right &= reliability(&format!("log of a day, {class}"), &stated);
    }
    let readings = [("rest not known", "switching", 0.0), ("6 h of rest in a hall", "hall", 6.0 * HOUR_S)];
    for (title, climate, rested_s) in readings {
        let mut random = ChaCha8Rng::seed_from_u64(98);
        let vessels = ["nitrogen-20l", "argon-50l", "nitrogen-80l", "helium-10l", "hydrogen-50l"];
        let stated: Vec<Stated> = (0..each)
            .map(|draw| {
                let vessel = vessels[draw as usize % vessels.len()];
                let family = format!("{vessel}/{climate}/mixed/class-b/60s").parse().unwrap();
                // Any time of the day.
                let length_s = (13.0 + draw as f64 % 11.0) * HOUR_S;
                let world = generate(&Request::tight(family, 5000 + draw, length_s)).unwrap();
                by_reading(&world, rested_s, &mut random)
            })
            .collect();
        right &= reliability(&format!("single reading, {title}"), &stated);
    }
    right
}

#[test]
fn stated_probabilities_of_some_inspections_lie_in_their_bands() {
    assert!(classes(8));
}

#[test]
#[ignore = "minutes: cargo test --release -p cylwatch-evaluation --test suite -- --ignored --nocapture inspection"]
fn stated_probabilities_of_two_hundred_inspections_of_each_class_lie_in_their_bands() {
    assert!(classes(200));
}
