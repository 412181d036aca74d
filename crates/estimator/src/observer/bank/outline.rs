//! What a bank is in outline: enough to go on from where gas is exchanged, in few bytes.
use serde::{Deserialize, Serialize};

use super::together::Together;
use super::{Bank, Covariances};
use crate::numbers;
use crate::observer::member::Member;

/// Means of the members and the covariance of the first, rounded; the others differ from it in the variance of their leak rate.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(in crate::observer) struct Outline {
    /// Mean of the first member (n), and how far that of each other one is from it (n), one after the other.
    #[serde(with = "numbers")]
    mean: Vec<f64>,
    #[serde(with = "numbers")]
    apart: Vec<f64>,
    #[serde(with = "numbers")]
    leak_variances: Vec<f64>,
    covariances: Covariances,
    slow_s: f64,
}

impl Bank {
    /// Means and covariances, rounded; `leak` is the state of the leak rate.
    pub fn outline(&self, leak: usize) -> Outline {
        let covariances = match &self.covariances {
            Covariances::Together(packs) => {
                Covariances::Together(packs.iter().map(Together::outline).collect())
            }
            separate => separate.clone(),
        };
        let mean: Vec<f64> = self.members[0].x.iter().copied().map(numbers::single).collect();
        let of_member = |member: &Member| member.x.iter().zip(&mean).map(|(x, mean)| x - mean).collect();
        let others = self.members.iter().skip(1);
        let apart = others.flat_map::<Vec<f64>, _>(of_member).map(numbers::coarse).collect();
        let leak_variances = (0..self.members.len()).map(|index| numbers::single(self.variance(index, leak)));
        Outline { leak_variances: leak_variances.collect(), mean, apart, covariances, slow_s: self.slow_s }
    }

    /// Become as the outline of this bank is; no reading has been refused lately.
    pub fn return_to(&mut self, outline: &Outline, leak: usize) {
        let Outline { mean, apart, .. } = outline;
        self.members[0].place_at(mean.iter().copied());
        for (member, apart) in self.members.iter_mut().skip(1).zip(apart.chunks(mean.len())) {
            member.place_at(mean.iter().zip(apart).map(|(mean, apart)| mean + apart));
        }
        match (&mut self.covariances, &outline.covariances) {
            (Covariances::Together(packs), Covariances::Together(outlines)) => {
                let variances = outline.leak_variances.chunks(Together::SIZE);
                for ((pack, outline), variances) in packs.iter_mut().zip(outlines).zip(variances) {
                    pack.return_to(outline, leak, variances);
                }
            }
            (own, separate) => own.clone_from(separate),
        }
        self.slow_s = outline.slow_s;
    }
}
