//! The fill and how it is stated at commissioning.
//!
//! The pressure at 15 °C is drawn evenly over the vessel's range. It is stated with an error of 0.5 % (normal); in one of six worlds the
//! gas is 2.5 % less than stated on top. The told standard deviation of the mass, 1.2 %, is the root mean square of both. In one of four
//! worlds the log begins in the middle of operation: the cylinder is not settled, and the candidate is told so.
use cylwatch_estimator::observer::Commissioning;
use cylwatch_thermal::units::QUOTED_K;
use cylwatch_thermal::vessel::Fill;
use serde::{Deserialize, Serialize};

use crate::random::{Purpose, Random};

const STATED_SD: f64 = 0.005;
const MISSTATED_SHARE: f64 = 1.0 / 6.0;
const MISSTATEMENT: f64 = 0.025;
const STATED_MASS_SD: f64 = 0.012;
const OPERATING_SHARE: f64 = 0.25;
/// Operation before the log where the cylinder is not settled, s: four time constants of the wall and more.
const LEAD_S: f64 = 6.0 * 3600.0;

/// The fill, and how it is stated.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct FillDraw {
    /// Real pressure at 15 °C, Pa.
    pub pressure_pa: f64,
    /// Stated pressure at 15 °C, Pa.
    pub(crate) stated_pa: f64,
    /// Whether it is stated wrong on top of its usual error.
    pub is_wrong: bool,
    /// Operation before the log begins, s; 0: the cylinder begins settled.
    pub(crate) lead_s: f64,
}

impl FillDraw {
    /// The draw of a seed from a range of pressures, Pa.
    pub(super) fn draw(range_pa: (f64, f64), seed: u64) -> Self {
        let random = &mut Random::new(seed, Purpose::WorldFill);
        let pressure_pa = random.uniform(range_pa);
        let error = STATED_SD * random.normal();
        let is_wrong = random.happens(MISSTATED_SHARE);
        let stated_pa = pressure_pa * (1.0 + error) / if is_wrong { 1.0 - MISSTATEMENT } else { 1.0 };
        let lead_s = if random.happens(OPERATING_SHARE) { LEAD_S } else { 0.0 };
        Self { pressure_pa, stated_pa, is_wrong, lead_s }
    }

    /// The same cylinder with a part of the gas, stated as well as before.
    pub(super) fn part(self, part: f64) -> Self {
        Self { pressure_pa: part * self.pressure_pa, stated_pa: part * self.stated_pa, ..self }
    }

    /// The real fill.
    pub(super) const fn fill(&self) -> Fill {
        Fill::Settled { pressure_pa: self.pressure_pa, temperature_k: QUOTED_K }
    }

    /// What is told of it.
    pub(super) fn commissioning(&self) -> Commissioning {
        let told = Commissioning::filled(self.stated_pa, QUOTED_K);
        Commissioning { mass_sd: STATED_MASS_SD, settled: self.lead_s == 0.0, ..told }
    }
}
