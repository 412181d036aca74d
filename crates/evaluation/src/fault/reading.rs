//! Faults of what sensors read.
use cylwatch_thermal::units::{ATMOSPHERE_PA, ZERO_CELSIUS_K};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::StandardNormal;
use serde::{Deserialize, Serialize};

use super::{Arrival, Fault, Record};
use crate::EvaluationError;

/// Temperature at which a transmitter's temperature coefficient says nothing, K.
const CALIBRATED_K: f64 = 288.15;
const PA_PER_PSI: f64 = 6_894.757_293_168;
/// What a transmitter shows at 3.6 mA, the signal of a broken wire, as a part of its full scale: `(3.6 - 4)/16`.
const WIRE_BREAK: f64 = -0.025;
/// What an open Pt100 shows, the top of its range, K.
const OPEN_PT100_K: f64 = 850.0 + ZERO_CELSIUS_K;

/// What a dead sensor gives.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum DeadCode {
    /// Zero in the unit of a file: 0 bar, 0 K.
    Zero,
    /// The top of its range.
    FullScale,
    /// Nothing.
    NotANumber,
    /// More than anything.
    Infinite,
    /// -999 in the unit of a file: bar, °C.
    Minus999,
    /// The signal of 3.6 mA, or an open Pt100.
    WireBreak,
}

impl DeadCode {
    /// All of them.
    pub const ALL: [Self; 6] =
        [Self::Zero, Self::FullScale, Self::NotANumber, Self::Infinite, Self::Minus999, Self::WireBreak];

    /// The reading of a transmitter of such a full scale, Pa; of a thermometer without one, K.
    fn reading(self, full_scale_pa: Option<f64>) -> f64 {
        match (self, full_scale_pa) {
            (Self::Zero, _) => 0.0,
            (Self::NotANumber, _) => f64::NAN,
            (Self::Infinite, _) => f64::INFINITY,
            (Self::Minus999, Some(_)) => -999e5,
            (Self::Minus999, None) => -999.0 + ZERO_CELSIUS_K,
            (Self::FullScale, Some(full_scale_pa)) => full_scale_pa,
            (Self::WireBreak, Some(full_scale_pa)) => WIRE_BREAK * full_scale_pa,
            (Self::FullScale | Self::WireBreak, None) => OPEN_PT100_K,
        }
    }
}

/// A unit taken for another.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum UnitConfusion {
    /// Degrees Celsius read as kelvin.
    CelsiusAsKelvin,
    /// Kelvin read as degrees Celsius.
    KelvinAsCelsius,
    /// Degrees Fahrenheit read as degrees Celsius.
    FahrenheitAsCelsius,
    /// Kilopascal read as bar.
    KilopascalAsBar,
    /// Bar read as kilopascal.
    BarAsKilopascal,
    /// Pounds per square inch read as bar.
    PsiAsBar,
    /// Bar read as pounds per square inch.
    BarAsPsi,
    /// A gauge pressure read as an absolute one.
    GaugeAsAbsolute,
}

impl UnitConfusion {
    /// All of them.
    pub(crate) const ALL: [Self; 8] = [
        Self::CelsiusAsKelvin,
        Self::KelvinAsCelsius,
        Self::FahrenheitAsCelsius,
        Self::KilopascalAsBar,
        Self::BarAsKilopascal,
        Self::PsiAsBar,
        Self::BarAsPsi,
        Self::GaugeAsAbsolute,
    ];

    /// Whether it concerns pressures, else temperatures.
    pub(crate) fn is_of_pressure(self) -> bool {
        !matches!(self, Self::CelsiusAsKelvin | Self::KelvinAsCelsius | Self::FahrenheitAsCelsius)
    }

    /// A reading as it is taken, K or Pa.
    fn taken(self, reading: f64) -> f64 {
        match self {
            Self::CelsiusAsKelvin => reading - ZERO_CELSIUS_K,
            Self::KelvinAsCelsius => reading + ZERO_CELSIUS_K,
            Self::FahrenheitAsCelsius => 1.8 * (reading - ZERO_CELSIUS_K) + 32.0 + ZERO_CELSIUS_K,
            Self::KilopascalAsBar => reading * 100.0,
            Self::BarAsKilopascal => reading / 100.0,
            Self::PsiAsBar => reading / PA_PER_PSI * 1e5,
            Self::BarAsPsi => reading / 1e5 * PA_PER_PSI,
            Self::GaugeAsAbsolute => reading - ATMOSPHERE_PA,
        }
    }
}

impl Fault {
    /// Change readings if the fault is one of readings; whether it is.
    pub(super) fn change_readings(
        &self,
        record: &mut Record,
        onset_s: f64,
        seed: u64,
    ) -> Result<bool, EvaluationError> {
        let random = ChaCha8Rng::seed_from_u64(seed);
        let index = self.sensors().first().map(|name| record.sensor(name)).transpose()?.unwrap_or(0);
        let pressure = self.sensors().first() == Some(&"pressure");
        let mut rows = Column { record, index, from_s: onset_s, until_s: onset_s + self.lasting_s() };
        match self {
            Self::Stuck { .. } => rows.hold(),
            Self::Offset { by, .. } => rows.each(|_, reading| reading + by),
            Self::Drift { per_s, .. } => rows.each(|time_s, reading| reading + per_s * (time_s - onset_s)),
            Self::Span { share, per_k, .. } => rows.span(*share, *per_k)?,
            Self::Noise { sd, .. } => rows.noise(*sd, random),
            Self::Quantised { step, .. } => rows.always(|reading| (reading / step).round() * step),
            Self::Spikes { height, longest, share, .. } => rows.spikes(*height, *longest, *share, random),
            Self::Dead { code, full_scale_pa, .. } => {
                let full_scale_pa = Some(*full_scale_pa).filter(|_| pressure);
                rows.each(|_, _| code.reading(full_scale_pa));
            }
            Self::Lost { sensors, .. } => rows.lose(sensors)?,
            Self::Swapped { first, second } => {
                let (a, b) = (rows.record.sensor(first)?, rows.record.sensor(second)?);
                rows.record.rows_mut().for_each(|row| row.readings.swap(a, b));
            }
            Self::Units { sensors, mix_up } => rows.mistake(sensors, *mix_up)?,
            Self::Detached { noise_k, .. } => rows.detach(*noise_k, random)?,
            Self::Pulses { height_pa, mean_s, .. } => rows.pulse(*height_pa, *mean_s, random),
            _ => return Ok(false),
        }
        Ok(true)
    }
}

/// The readings of one sensor while a fault lasts.
struct Column<'a> {
    record: &'a mut Record,
    index: usize,
    from_s: f64,
    until_s: f64,
}

impl Column<'_> {
    fn rows(&mut self) -> impl Iterator<Item = &mut Arrival> {
        let (from_s, until_s) = (self.from_s, self.until_s);
        self.record.rows_mut().filter(move |row| row.stamp_s >= from_s && row.stamp_s < until_s)
    }

    /// A function of time, s, and reading.
    fn each(&mut self, mut change: impl FnMut(f64, f64) -> f64) {
        let index = self.index;
        for row in self.rows() {
            row.readings[index] = change(row.stamp_s, row.readings[index]);
        }
    }

    /// A function of every reading, whatever the onset.
    fn always(&mut self, change: impl Fn(f64) -> f64) {
        let index = self.index;
        self.record.rows_mut().for_each(|row| row.readings[index] = change(row.readings[index]));
    }

    /// The first reading of the fault stays.
    fn hold(&mut self) {
        let mut held = f64::NAN;
        self.each(|_, reading| {
            if held.is_nan() {
                held = reading;
            }
            held
        });
    }

    fn span(&mut self, share: f64, per_k: f64) -> Result<(), EvaluationError> {
        let (index, valve) = (self.index, self.record.sensor("valve")?);
        for row in self.record.rows_mut() {
            let warmer_k = row.readings[valve] - CALIBRATED_K;
            row.readings[index] = row.readings[index] * (1.0 + share) + per_k * warmer_k;
        }
        Ok(())
    }

    fn noise(&mut self, sd: f64, mut random: ChaCha8Rng) {
        self.each(|_, reading| {
            let normal: f64 = random.sample(StandardNormal);
            reading + sd * normal
        });
    }

    /// Spikes of 1 to `longest` readings begin so often that their readings have the share.
    fn spikes(&mut self, height: f64, longest: usize, share: f64, mut random: ChaCha8Rng) {
        let mean_length = 0.5 * (1 + longest) as f64;
        let begins = share / (mean_length * (1.0 - share) + share);
        let (mut left, mut sign) = (0, 1.0);
        self.each(|_, reading| {
            if left == 0 && random.random::<f64>() < begins {
                left = random.random_range(1..=longest);
                sign = if random.random() { 1.0 } else { -1.0 };
            }
            if left == 0 {
                return reading;
            }
            left -= 1;
            reading + sign * height
        });
    }

    fn lose(&mut self, sensors: &[String]) -> Result<(), EvaluationError> {
        for sensor in sensors {
            self.index = self.record.sensor(sensor)?;
            self.each(|_, _| f64::NAN);
        }
        Ok(())
    }

    fn mistake(&mut self, sensors: &[String], mix_up: UnitConfusion) -> Result<(), EvaluationError> {
        for sensor in sensors {
            self.index = self.record.sensor(sensor)?;
            self.always(|reading| mix_up.taken(reading));
        }
        Ok(())
    }

    fn detach(&mut self, noise_k: f64, mut random: ChaCha8Rng) -> Result<(), EvaluationError> {
        let (index, ambient) = (self.index, self.record.sensor("ambient")?);
        for row in self.rows() {
            let normal: f64 = random.sample(StandardNormal);
            row.readings[index] = row.readings[ambient] + noise_k * normal;
        }
        Ok(())
    }

    /// Pulses and the times between them last exponentially long.
    fn pulse(&mut self, height_pa: f64, mean_s: f64, mut random: ChaCha8Rng) {
        let mut change_s = f64::NEG_INFINITY;
        let mut state = 0.0;
        self.each(|time_s, reading| {
            if time_s >= change_s {
                let uniform: f64 = random.random();
                change_s = time_s - mean_s * (1.0 - uniform).ln();
                let sign = if random.random() { 1.0 } else { -1.0 };
                state = if state == 0.0 { sign } else { 0.0 };
            }
            reading + state * height_pa
        });
    }
}
