//! A bank in outline: enough to go on from where the estimate is opened anyway, in few bytes.
use alloc::vec::Vec;
use serde::{Deserialize, Serialize};

use super::pack::Pack;
use super::single::Single;
use super::{Bank, Covariances};
use crate::filter::plant::Plant;
use crate::filter::ud_bank::Factors;
use crate::numbers;

/// Means of the members and the covariance of the first, rounded; the others differ from it in the variance of one state.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(bound(serialize = "", deserialize = ""))]
pub(crate) struct Outline<P: Plant> {
    /// Mean of the first member (n), and how far that of each other one is from it (n), one after the other.
    #[serde(with = "numbers")]
    mean: Vec<f64>,
    #[serde(with = "numbers")]
    apart: Vec<f64>,
    #[serde(with = "numbers")]
    own_variances: Vec<f64>,
    covariances: Kept<P>,
    slow_s: f64,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(bound(serialize = "", deserialize = ""))]
enum Kept<P: Plant> {
    /// Of each pack the first member.
    Packs(Vec<Factors>),
    #[serde(skip)]
    Singles(Vec<Single<P>>),
}

impl<P: Plant> Outline<P> {
    /// Whether it is that of a bank with so many states and members.
    pub(crate) fn is_like(&self, states: usize, members: usize) -> bool {
        let packs = match &self.covariances {
            Kept::Packs(packs) => {
                packs.len() == members.div_ceil(Pack::SIZE) && packs.iter().all(|pack| pack.is_like(states))
            }
            Kept::Singles(_) => false,
        };
        let apart = states * members.saturating_sub(1);
        packs && [self.mean.len(), self.apart.len(), self.own_variances.len()] == [states, apart, members]
    }
}

impl<P: Plant> Bank<P> {
    /// Memory for an outline.
    pub(crate) fn outline(&self, states: usize) -> Outline<P> {
        let members = self.members.room();
        let covariances = match &self.covariances {
            Covariances::Packs(packs) => {
                Kept::Packs(packs.iter().map(|_| Factors::with_room(states)).collect())
            }
            Covariances::Singles(_) => Kept::Singles(Vec::new()),
        };
        Outline {
            mean: Vec::with_capacity(states),
            apart: Vec::with_capacity(states * members.saturating_sub(1)),
            own_variances: Vec::with_capacity(members),
            covariances,
            slow_s: 0.0,
        }
    }

    /// Write means and covariances, rounded, over another outline; each member has a variance of its own of the state `own`.
    pub(crate) fn write_outline(&self, own: usize, outline: &mut Outline<P>) {
        let Outline { mean, apart, own_variances, covariances, slow_s } = outline;
        match (&self.covariances, covariances) {
            (Covariances::Packs(packs), Kept::Packs(kept)) => {
                for (pack, kept) in packs.iter().zip(kept) {
                    pack.bank.write_outline(kept, numbers::coarse);
                }
            }
            (Covariances::Singles(all), kept) => *kept = Kept::Singles(all.clone()),
            (Covariances::Packs(_), Kept::Singles(_)) => {}
        }
        mean.clear();
        mean.extend(self.members[0].x.iter().copied().map(numbers::single));
        apart.clear();
        for member in self.members.iter().skip(1) {
            apart.extend(member.x.iter().zip(&*mean).map(|(x, mean)| numbers::coarse(x - mean)));
        }
        own_variances.clear();
        own_variances.extend((0..self.members.len()).map(|index| numbers::single(self.variance(index, own))));
        *slow_s = self.slow_s;
    }

    /// Become as the outline of this bank is; no reading has been refused lately.
    pub(crate) fn return_to(&mut self, outline: &Outline<P>, own: usize) {
        let Outline { mean, apart, .. } = outline;
        self.members[0].place_at(mean.iter().copied());
        for (member, apart) in self.members.iter_mut().skip(1).zip(apart.chunks(mean.len())) {
            member.place_at(mean.iter().zip(apart).map(|(mean, apart)| mean + apart));
        }
        match (&mut self.covariances, &outline.covariances) {
            (Covariances::Packs(packs), Kept::Packs(outlines)) => {
                let variances = outline.own_variances.chunks(Pack::SIZE);
                for ((pack, outline), variances) in packs.iter_mut().zip(outlines).zip(variances) {
                    pack.return_to(outline, own, variances);
                }
            }
            (covariances, Kept::Singles(all)) => *covariances = Covariances::Singles(all.clone()),
            (Covariances::Singles(_), Kept::Packs(_)) => {}
        }
        self.slow_s = outline.slow_s;
    }
}
