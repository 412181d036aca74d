//! How often a stated 95 % interval holds the truth.
//!
//! A statement is judged once in two minutes at the most: closer ones say the same again. Rows of a world are far from independent; the table
//! takes simulations as independent, not rows.
use serde::{Deserialize, Serialize};

use super::{Gas, Moment};
use crate::judge::statement::Estimated;
use crate::world::{Overlay, World};

/// Shortest time between two judged statements, s.
const MIN_SPACING_S: f64 = 110.0;

/// Quantities in the order of the cells.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Quantity {
    /// Gas mass; its error in parts of the gas at the beginning.
    Mass,
    /// Mean gas temperature; its error in K.
    Gas,
    /// Leak rate; its error in parts of the gas per hour.
    Leak,
    /// Onset of a leak that is stated; its error in hours.
    Onset,
}

impl Quantity {
    /// All of them.
    pub(crate) const ALL: [Self; 4] = [Self::Mass, Self::Gas, Self::Leak, Self::Onset];
}

/// Sums of one quantity, period and state of the gas.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Cell {
    /// Intervals that held the truth.
    pub inside: u64,
    /// Intervals.
    pub stated: u64,
    /// Values, with an interval or without.
    pub values: u64,
    /// Sum of squared errors.
    pub squares: f64,
}

/// Cells by quantity; period: first day, later; gas: tight, lost, exchanged.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Coverage {
    /// Cells.
    pub cells: [[[Cell; 3]; 2]; 4],
    /// Time of the last judged statement, s.
    #[serde(skip)]
    last_s: Option<f64>,
}

impl Cell {
    fn take(&mut self, estimated: &Estimated, truth: f64, unit: f64) {
        let error = (estimated.value - truth) / unit;
        if error.is_finite() {
            self.values += 1;
            self.squares += error * error;
        }
        if let Some((low, high)) = estimated.interval {
            self.stated += 1;
            self.inside += u64::from((low..=high).contains(&truth));
        }
    }
}

impl Coverage {
    /// Take what is estimated at a row.
    pub(crate) fn take(&mut self, moment: &Moment<'_>, world: &World) {
        let fault = matches!(world.request.overlay, Overlay::Fault { .. });
        if fault || self.last_s.is_some_and(|last_s| moment.now_s - last_s < MIN_SPACING_S) {
            return;
        }
        self.last_s = Some(moment.now_s);
        let (truth, row, estimates) = (&world.truth, moment.row, &moment.statement.estimates);
        let whole_kg = truth.mass_kg[0];
        let mut judge = |quantity: Quantity, estimated: &Option<Estimated>, truth: f64, unit: f64| {
            if let Some(estimated) = estimated {
                self.cells[quantity as usize][moment.period][moment.gas as usize]
                    .take(estimated, truth, unit);
            }
        };
        judge(Quantity::Mass, &estimates.mass_kg, truth.mass_kg[row], whole_kg);
        judge(Quantity::Gas, &estimates.gas_mean_k, truth.gas_mean_k[row], 1.0);
        if moment.gas != Gas::Exchanged {
            let unit = whole_kg / 3600.0;
            judge(Quantity::Leak, &estimates.leak_kg_s, truth.outflow_kg_s[row], unit);
        }
        if let Some(onset_s) = stamped_onset_s(world).filter(|_| moment.gas == Gas::Lost) {
            judge(Quantity::Onset, &estimates.onset_s, onset_s, 3600.0);
        }
    }
}

/// Onset of the loss by the clock of the rows, without the steps of that clock, s.
fn stamped_onset_s(world: &World) -> Option<f64> {
    let onset_s = match world.request.overlay {
        Overlay::Leak { onset_s, .. } | Overlay::FastLoss { onset_s, .. } => onset_s,
        _ => return None,
    };
    Some(onset_s + world.log.time_s.first()? - world.truth.time_s.first()?)
}
