//! What the freest mass does without a leak: the noise behind the shortest possible delay.
//!
//! From the second day on the mass is kept every 20 min, as a part of the true one, and an Ornstein-Uhlenbeck process is fitted
//! (`Noise::fit`). A log of two years keeps 53 000 numbers.
use super::Moment;
use crate::noise::{Noise, Residual};
use crate::world::World;

/// Interval of the masses that are kept, s.
pub(crate) const SETTLED_S: f64 = 1200.0;

/// The masses that are kept.
#[derive(Clone, Debug, Default)]
pub(crate) struct FreeMass {
    kept: Vec<Residual>,
}

impl FreeMass {
    /// Take a statement.
    pub(crate) fn take(&mut self, moment: &Moment<'_>, world: &World) {
        let Some(mass_kg) = moment.statement.free_mass_kg.filter(|mass_kg| mass_kg.is_finite()) else {
            return;
        };
        let due = self.kept.last().is_none_or(|last| moment.now_s >= last.time_s + SETTLED_S);
        if moment.period == 1 && due {
            let value = mass_kg / world.truth.mass_kg[moment.row];
            self.kept.push(Residual { time_s: moment.now_s, value });
        }
    }

    /// After the last statement, part of the gas; `None`: too few to tell.
    pub(crate) fn finish(self) -> Option<Noise> {
        let noise = Noise::fit(&self.kept)?;
        (noise.sd.is_finite() && noise.correlation_time_s.is_finite()).then_some(noise)
    }
}
