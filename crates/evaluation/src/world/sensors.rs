//! Classes of sensors: what their data sheets say, and specimens drawn within them.
//!
//! A thermometer reads `T + kappa (h/h_0)^0.3 (T_air - T) + b + noise`, `h` the film by convection and `h_0` = 10 W/(m² K), behind a
//! first-order lag; a transmitter reads `p + b + c (T_valve - 288.15 K) + noise`. Readings come in steps. A candidate is told the class:
//! tolerances, standard deviations, noise, steps and range, and takes the coupling `kappa` as constant, 0.1 with 0.04.
//!
//! | class | thermometers | transmitter, of its range | steps |
//! |---|---|---|---|
//! | `class-a` | 0.19 K, noise 0.02 K | 0.1 %, 0.05 % per 10 K | 0.01 K, range/25000 |
//! | `class-b` | 0.4 K, noise 0.05 K | 0.25 %, 0.1 % per 10 K | 0.01 K, range/25000 |
//! | `coarse` | as class B | as class B | 0.1 or 0.5 K; 0.1 or 0.5 bar, below 100 bar range/2500 or range/500 |
//! | `transmitter` | as class B | off by 0.1 to 0.25 %, up to 0.15 % per 10 K | as class B |
//! | `lagging` | as class B behind 5 to 60 s | as class B | as class B |
//!
//! Tolerances are those of IEC 60751 at 20 °C, all deviations within equally likely. The class `transmitter` is told 0.25 % and a
//! standard deviation of 0.1 % per 10 K; with a range of 100 bar and more, one of four counts from the air and is logged as absolute,
//! which nobody is told. A lag is stated with an error of up to 30 %.
use cylwatch_estimator::sensor::{KindChoice, Pt100Class, SensorSpec, SensorsSpec};
use cylwatch_thermal::units::BAR_PA;
use serde::{Deserialize, Serialize};

use super::SensorClass;
use crate::random::{Purpose, Random};

/// Tolerances of classes A and B at 20 °C, K.
const CLASS_A_K: f64 = 0.19;
const CLASS_B_K: f64 = 0.4;
const COUPLING: (f64, f64) = (0.05, 0.15);
const STATED_COUPLING: (f64, f64) = (0.1, 0.04);
const FINE_K: f64 = 0.01;
/// Step and noise of a transmitter, of its range.
const FINE_RANGE: f64 = 4e-5;
const NOISE_RANGE: f64 = 4e-5;
const QUIET_RANGE: f64 = 2e-5;
const LAG_S: (f64, f64) = (5.0, 60.0);
const LAG_STATED: (f64, f64) = (1.0 / 1.3, 1.3);
const GAUGE_SHARE: f64 = 0.25;
/// Smallest range at which a gauge reading can be taken for an absolute one without notice, Pa.
const GAUGE_RANGE_PA: f64 = 100.0 * BAR_PA;
/// From the seed of one set of sensors to that of the next.
const NEXT_SET: u64 = 0x9E37_79B9_7F4A_7C15;

/// A thermometer as it is, and what its data sheet says of it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Thermometer {
    /// Constant offset, K.
    pub offset_k: f64,
    /// Coupling to the air at a film of 10 W/(m² K).
    pub air_coupling: f64,
    /// Time constant, s; 0: none.
    pub lag_s: f64,
    /// Time constant as stated, s.
    pub(crate) stated_lag_s: f64,
    /// Standard deviation of the noise, K.
    pub noise_k: f64,
    /// Step of a reading, K.
    pub resolution_k: f64,
}

/// A transmitter as it is.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Transmitter {
    /// Constant offset, Pa.
    pub offset_pa: f64,
    /// Temperature coefficient, Pa/K.
    pub coefficient_pa_k: f64,
    /// Standard deviation of the noise, Pa.
    pub noise_pa: f64,
    /// Step of a reading, Pa.
    pub resolution_pa: f64,
    /// Upper end of its range, Pa.
    pub full_scale_pa: f64,
    /// Whether it counts from the air and is logged as if it counted from vacuum.
    pub is_gauge: bool,
}

/// The sensors of a world.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SensorDraw {
    /// On the shoulder.
    pub shoulder: Thermometer,
    /// On the valve.
    pub valve: Thermometer,
    /// In the valve.
    pub pressure: Transmitter,
}

/// Seed of one set of sensors and rows.
pub(super) const fn seed_of_set(seed: u64, set: u64) -> u64 {
    seed ^ set.wrapping_mul(NEXT_SET)
}

impl SensorDraw {
    /// The draw of a seed of a set, with a transmitter of a range, Pa.
    pub(super) fn draw(class: SensorClass, full_scale_pa: f64, seed: u64) -> Self {
        let random = &mut Random::new(seed, Purpose::WorldSensors);
        let (shoulder, valve) = (thermometer(class, random), thermometer(class, random));
        let mut drawn = Self { shoulder, valve, pressure: transmitter(class, full_scale_pa, random) };
        if class == SensorClass::Coarse {
            // Both thermometers pass the same logger.
            drawn.valve.resolution_k = drawn.shoulder.resolution_k;
        }
        drawn
    }

    /// What the data sheets say, in the order of the log's channels.
    pub(super) fn data_sheets(&self, class: SensorClass) -> SensorsSpec {
        let surface = |name: &str, specimen: &Thermometer| SensorSpec {
            name: name.into(),
            kind: Some(KindChoice::Surface),
            class: Some(if class == SensorClass::ClassA { Pt100Class::A } else { Pt100Class::B }),
            air_coupling: Some(STATED_COUPLING.0),
            air_coupling_sd: Some(STATED_COUPLING.1),
            noise_k: Some(specimen.noise_k),
            resolution_k: Some(specimen.resolution_k),
            lag_s: (specimen.stated_lag_s > 0.0).then_some(specimen.stated_lag_s),
            ..SensorSpec::default()
        };
        let (accuracy, per_10_k) = data_sheet(class);
        let range_pa = self.pressure.full_scale_pa;
        let pressure = SensorSpec {
            name: "pressure".into(),
            kind: Some(KindChoice::Pressure),
            full_scale_pa: Some(range_pa),
            offset_tolerance_pa: Some(accuracy * range_pa),
            temperature_coefficient_sd_pa_k: Some(per_10_k * range_pa / 10.0),
            noise_pa: Some(self.pressure.noise_pa),
            resolution_pa: Some(self.pressure.resolution_pa),
            ..SensorSpec::default()
        };
        SensorsSpec {
            sensor: vec![surface("shoulder", &self.shoulder), surface("valve", &self.valve), pressure],
        }
    }
}

/// Accuracy and standard deviation of the temperature error per 10 K, of the range.
const fn data_sheet(class: SensorClass) -> (f64, f64) {
    match class {
        SensorClass::ClassA => (1e-3, 5e-4),
        SensorClass::ClassB | SensorClass::Coarse | SensorClass::Transmitter | SensorClass::Lagging => {
            (2.5e-3, 1e-3)
        }
    }
}

fn thermometer(class: SensorClass, random: &mut Random) -> Thermometer {
    let tolerance_k = if class == SensorClass::ClassA { CLASS_A_K } else { CLASS_B_K };
    let offset_k = random.uniform((-tolerance_k, tolerance_k));
    let air_coupling = random.uniform(COUPLING);
    let (lag_s, error) = (random.uniform(LAG_S), random.by_logarithm(LAG_STATED));
    let lag_s = if class == SensorClass::Lagging { lag_s } else { 0.0 };
    let steps_k = if random.happens(0.5) { 0.1 } else { 0.5 };
    Thermometer {
        offset_k,
        air_coupling,
        lag_s,
        stated_lag_s: lag_s * error,
        noise_k: if class == SensorClass::ClassA { 0.02 } else { 0.05 },
        resolution_k: if class == SensorClass::Coarse { steps_k } else { FINE_K },
    }
}

fn transmitter(class: SensorClass, full_scale_pa: f64, random: &mut Random) -> Transmitter {
    let (accuracy, per_10_k) = data_sheet(class);
    let is_far_off = class == SensorClass::Transmitter;
    let (near, far) = (random.uniform((-accuracy, accuracy)), random.either_sign((0.4 * accuracy, accuracy)));
    let (normal, evenly) = (per_10_k * random.normal(), random.either_sign((0.0, 1.5 * per_10_k)));
    let (is_gauge, is_fine) = (random.happens(GAUGE_SHARE), random.happens(0.5));
    let steps_pa = match (full_scale_pa >= GAUGE_RANGE_PA, is_fine) {
        (true, true) => 0.1 * BAR_PA,
        (true, false) => 0.5 * BAR_PA,
        (false, true) => full_scale_pa / 2500.0,
        (false, false) => full_scale_pa / 500.0,
    };
    Transmitter {
        offset_pa: full_scale_pa * if is_far_off { far } else { near },
        coefficient_pa_k: 0.1 * full_scale_pa * if is_far_off { evenly } else { normal },
        noise_pa: full_scale_pa * if class == SensorClass::ClassA { QUIET_RANGE } else { NOISE_RANGE },
        resolution_pa: if class == SensorClass::Coarse { steps_pa } else { FINE_RANGE * full_scale_pa },
        full_scale_pa,
        is_gauge: is_far_off && is_gauge && full_scale_pa >= GAUGE_RANGE_PA,
    }
}
