//! Random numbers of a world: one stream for each purpose, so that a change to one leaves the others as they are.
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::StandardNormal;

/// What a stream of random numbers is drawn for; its number is that of the stream, so it stays when others come and go.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Purpose {
    ChamberVessel = 0,
    ChamberSensors = 1,
    ChamberTurbulence = 7,
    ChamberGusts = 8,
    ChamberDifference = 9,
    ChamberShoulderNoise = 10,
    ChamberValveNoise = 11,
    ChamberPressureNoise = 14,
    WorldVessel = 15,
    WorldGas,
    WorldFill,
    WorldClock,
    WorldAir,
    WorldWeather,
    WorldStays,
    WorldTrips,
    WorldWind,
    WorldSun,
    WorldHeater,
    WorldSite,
    WorldTurbulence,
    WorldGusts,
    WorldDifference,
    WorldFlow,
    WorldSensors,
    WorldShoulderNoise,
    WorldValveNoise,
    WorldPressureNoise,
    WorldRows,
    WorldGaps,
    WorldFault,
}

/// Random numbers of one seed for one purpose.
pub(crate) struct Random(ChaCha8Rng);

impl Random {
    pub(crate) fn new(seed: u64, purpose: Purpose) -> Self {
        let mut generator = ChaCha8Rng::seed_from_u64(seed);
        generator.set_stream(purpose as u64);
        Self(generator)
    }

    /// Uniform between two bounds.
    pub(crate) fn uniform(&mut self, (low, high): (f64, f64)) -> f64 {
        low + (high - low) * self.0.random::<f64>()
    }

    /// A whole number, both bounds included.
    pub(crate) fn whole(&mut self, (low, high): (usize, usize)) -> usize {
        self.0.random_range(low..=high)
    }

    /// A magnitude between two bounds, of either sign.
    pub(crate) fn either_sign(&mut self, magnitude: (f64, f64)) -> f64 {
        let sign = if self.0.random::<bool>() { 1.0 } else { -1.0 };
        sign * self.uniform(magnitude)
    }

    /// Evenly by the logarithm between two positive bounds.
    pub(crate) fn by_logarithm(&mut self, (low, high): (f64, f64)) -> f64 {
        low * (high / low).powf(self.0.random::<f64>())
    }

    /// True with a probability.
    pub(crate) fn happens(&mut self, probability: f64) -> bool {
        self.0.random::<f64>() < probability
    }

    /// Standard normal.
    pub(crate) fn normal(&mut self) -> f64 {
        self.0.sample(StandardNormal)
    }
}

/// Stationary Ornstein-Uhlenbeck process of unit variance on an even grid of times, linear between them.
///
/// The values are stretched by `[(2 + r)/3]^(-1/2)`, `r` the correlation of neighbours, which gives back
/// the variance that the straight lines between them take away.
pub(crate) struct OrnsteinUhlenbeck {
    spacing_s: f64,
    value: Vec<f64>,
}

impl OrnsteinUhlenbeck {
    pub(crate) fn draw(
        random: &mut Random,
        correlation_time_s: f64,
        spacing_s: f64,
        duration_s: f64,
    ) -> Self {
        let r = (-spacing_s / correlation_time_s).exp();
        let stretch = (3.0 / (2.0 + r)).sqrt();
        let steps = (duration_s / spacing_s).ceil() as usize + 1;
        let mut x = random.normal();
        let value = (0..=steps)
            .map(|_| {
                let now = x;
                x = r * x + (1.0 - r * r).sqrt() * random.normal();
                stretch * now
            })
            .collect();
        Self { spacing_s, value }
    }

    /// Value at a time, s, of the drawn duration.
    pub(crate) fn at(&self, t_s: f64) -> f64 {
        let place = t_s / self.spacing_s;
        let knot = (place.floor() as usize).min(self.value.len() - 2);
        let weight = place - knot as f64;
        self.value[knot] + weight * (self.value[knot + 1] - self.value[knot])
    }
}

#[cfg(test)]
mod tests;
