//! A bank in outline: enough to go on from where the estimate is opened anyway, in few bytes.
use alloc::vec::Vec;
use serde::{Deserialize, Serialize};

use super::pack::Pack;
use super::{Bank, Covariances, Member};
use crate::filter::plant::Plant;
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
    covariances: Covariances<P>,
    slow_s: f64,
}

impl<P: Plant> Bank<P> {
    /// Means and covariances, rounded; each member has a variance of its own of the state `own`.
    pub(crate) fn outline(&self, own: usize) -> Outline<P> {
        let covariances = match &self.covariances {
            Covariances::Packs(packs) => Covariances::Packs(packs.iter().map(Pack::outline).collect()),
            singles => singles.clone(),
        };
        let mean: Vec<f64> = self.members[0].x.iter().copied().map(numbers::single).collect();
        let of_member =
            |member: &Member<P::Hypothesis>| member.x.iter().zip(&mean).map(|(x, mean)| x - mean).collect();
        let others = self.members.iter().skip(1);
        let apart = others.flat_map::<Vec<f64>, _>(of_member).map(numbers::coarse).collect();
        let own_variances = (0..self.members.len()).map(|index| numbers::single(self.variance(index, own)));
        Outline { own_variances: own_variances.collect(), mean, apart, covariances, slow_s: self.slow_s }
    }

    /// Become as the outline of this bank is; no reading has been refused lately.
    pub(crate) fn return_to(&mut self, outline: &Outline<P>, own: usize) {
        let Outline { mean, apart, .. } = outline;
        self.members[0].place_at(mean.iter().copied());
        for (member, apart) in self.members.iter_mut().skip(1).zip(apart.chunks(mean.len())) {
            member.place_at(mean.iter().zip(apart).map(|(mean, apart)| mean + apart));
        }
        match (&mut self.covariances, &outline.covariances) {
            (Covariances::Packs(packs), Covariances::Packs(outlines)) => {
                let variances = outline.own_variances.chunks(Pack::SIZE);
                for ((pack, outline), variances) in packs.iter_mut().zip(outlines).zip(variances) {
                    pack.return_to(outline, own, variances);
                }
            }
            (covariances, singles) => covariances.clone_from(singles),
        }
        self.slow_s = outline.slow_s;
    }
}
