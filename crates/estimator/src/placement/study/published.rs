//! The same positions by the paper's own measure, so that both answers stand side by side.
use serde::{Deserialize, Serialize};

use super::Placement;
use crate::EstimatorError;
use crate::placement::{PublishedDuel, PublishedRecord, PublishedScore, published_scores};

/// Positions by the fit of a first-order transfer function.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PublishedComparison {
    /// Each thermometer among the candidates.
    pub scores: Vec<PublishedScore>,
    /// The paper's question on each record: the valve against the shoulder; empty where one of them is no candidate.
    pub valve_against_shoulder: Vec<(PublishedRecord, PublishedDuel)>,
}

impl PublishedComparison {
    /// The thermometer of a layout that does best on a record, by its mean square error; `None`: the layout has none.
    pub fn best_of(&self, names: &[&str], record: PublishedRecord) -> Option<&PublishedScore> {
        let of_layout = self.scores.iter().filter(|score| names.contains(&&*score.name));
        of_layout.min_by(|a, b| a.on(record).mse_k2.mean.total_cmp(&b.on(record).mse_k2.mean))
    }
}

impl Placement {
    /// Every thermometer by the paper's measure.
    ///
    /// # Errors
    /// As [`published_scores`].
    pub(crate) fn by_paper(&self) -> Result<PublishedComparison, EstimatorError> {
        let found = published_scores(&self.vessel, &self.candidates.sensors(), &self.settings.published)?;
        let duel = |record| Some((record, found.duel("valve", "shoulder", record)?));
        let valve_against_shoulder = PublishedRecord::ALL.into_iter().filter_map(duel).collect();
        Ok(PublishedComparison { scores: found.scores, valve_against_shoulder })
    }
}
