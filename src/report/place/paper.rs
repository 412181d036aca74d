//! The same places by the paper's own measure, beside the observer's.
use super::{GRAM_PER_HOUR, KELVIN, PlacementReport};
use crate::estimator::placement::study::PublishedComparison;
use crate::estimator::placement::{PublishedRecord, PublishedScore, Spread};
use crate::report::{Report, number};

impl PlacementReport<'_> {
    /// Each thermometer by the fit of a first-order model, and by what the observer knows with it.
    pub(super) fn by_paper(&self) -> Report {
        let Some(by_paper) = &self.study.published else { return Report::default() };
        let (identified, validated) = (PublishedRecord::Identification, PublishedRecord::Validation);
        let header = [
            "place",
            "fit % [95 %]",
            "MSE K2",
            "valid. % [95 %]",
            "MSE K2",
            "tau s",
            "rank",
            "gas K",
            "finds g/h",
            "rank",
        ];
        let mse = |score: &PublishedScore, record| score.on(record).mse_k2.mean;
        let better = |score: &PublishedScore| {
            by_paper.scores.iter().filter(|of| mse(of, validated) < mse(score, validated)).count()
        };
        let gas_sd_k = |name: &str| {
            let of_name = self.study.positions.iter().find(|of| self.name(of.sensor) == name);
            of_name.and_then(|of| of.steady)
        };
        let known = |score: &PublishedScore| gas_sd_k(&score.name);
        let row = |score: &PublishedScore| {
            let steady = known(score);
            let ahead = steady.map(|own| {
                let others = by_paper.scores.iter().filter_map(known);
                1 + others.filter(|other| other.smallest_leak_kg_s < own.smallest_leak_kg_s).count()
            });
            vec![
                score.name.clone(),
                spread(&score.on(identified).fit_percent),
                number(mse(score, identified), 2),
                spread(&score.on(validated).fit_percent),
                number(mse(score, validated), 2),
                number(score.time_constant_s.mean, 3),
                (1 + better(score)).to_string(),
                steady.map_or(String::new(), |of| KELVIN.number(of.gas_sd_k)),
                steady.map_or(String::new(), |of| GRAM_PER_HOUR.number(of.smallest_leak_kg_s)),
                ahead.map_or(String::new(), |rank| rank.to_string()),
            ]
        };
        let mut scores: Vec<&PublishedScore> = by_paper.scores.iter().collect();
        scores.sort_by(|a, b| mse(a, validated).total_cmp(&mse(b, validated)));
        let rows: Vec<Vec<String>> = scores.into_iter().map(row).collect();
        let explained = "fit: of a first-order model from the place to the mean gas temperature, identified on the paper's \
                         scenarios 1 and 2 and validated on 3 and 4, over drawn specimens of the sensor; rank: by the \
                         validation's MSE. Right: the observer with the place alone beside what is required; rank: by the \
                         smallest leak that it finds";
        Report::default()
            .explained_rows("Places by the paper's measure and by the observer's", &header, rows, explained)
            .remark(self.question(by_paper))
    }

    /// The paper's question: is the valve the better place than the shoulder?
    fn question(&self, by_paper: &PublishedComparison) -> String {
        if by_paper.valve_against_shoulder.is_empty() {
            return String::new();
        }
        let mut lines = String::from(
            "The paper ranks the valve (98.48 %) above the shoulder (97.1 %). Here the valve is ahead by\n",
        );
        for (record, duel) in &by_paper.valve_against_shoulder {
            let Spread { mean, low, high } = duel.ahead_percent;
            let verdict = match (low > 0.0, high < 0.0) {
                (true, _) => "the paper's ranking holds",
                (_, true) => "it turns",
                _ if duel.share > 0.5 => "it holds more often than not",
                _ => "it turns more often than not",
            };
            lines.push_str(&format!(
                "  {:16} {mean:+.2} % [{low:+.2}, {high:+.2}], better with {:.0} % of the specimens: {verdict}\n",
                record.description(),
                100.0 * duel.share
            ));
        }
        let of = |name: &str| {
            let place = self.study.positions.iter().find(|of| self.name(of.sensor) == name)?;
            place.steady
        };
        if let (Some(valve), Some(shoulder)) = (of("valve"), of("shoulder")) {
            let more = |valve: f64, shoulder: f64| 100.0 * (valve / shoulder - 1.0);
            lines.push_str(&format!(
                "  by the observer with the valve, not the shoulder: gas temperature sd {:+.0} %, smallest leak {:+.0} %\n",
                more(valve.gas_sd_k, shoulder.gas_sd_k),
                more(valve.smallest_leak_kg_s, shoulder.smallest_leak_kg_s),
            ));
        }
        lines
    }
}

/// `98.5 [97.4, 99.0]`
fn spread(of: &Spread) -> String {
    format!("{:.2} [{:.1}, {:.1}]", of.mean, of.low, of.high)
}
