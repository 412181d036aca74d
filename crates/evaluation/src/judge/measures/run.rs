//! What a detector did about one leak.

/// One run of one detector over one leaking cylinder.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Run {
    /// Rate of the leak, part of the gas per hour, as the case names it: runs of one case have the same.
    pub part_per_h: f64,
    /// When it began, s.
    pub onset_s: f64,
    /// End of the run, s.
    pub until_s: f64,
    /// First alarm, s.
    pub alarm_s: Option<f64>,
}

impl Run {
    /// From the onset to the alarm, s; `None`: not found, or an alarm before it.
    pub(crate) fn delay_s(&self) -> Option<f64> {
        let delay_s = self.alarm_s? - self.onset_s;
        (delay_s >= 0.0).then_some(delay_s)
    }

    /// Time for which the leak was watched, s; `None`: an alarm before it, after which the run says nothing about the leak.
    pub(crate) fn watched_s(&self) -> Option<f64> {
        let is_false = self.alarm_s.is_some_and(|alarm_s| alarm_s < self.onset_s);
        (!is_false).then_some(self.until_s - self.onset_s)
    }

    /// Whether the leak was found so soon; `None`: an alarm before it, or it was not watched for so long.
    pub(crate) fn found_within(&self, horizon_s: f64) -> Option<bool> {
        let watched_s = self.watched_s()?;
        match self.delay_s() {
            Some(delay_s) if delay_s <= horizon_s => Some(true),
            _ => (watched_s >= horizon_s).then_some(false),
        }
    }
}

/// Runs by the rate of their leak, increasing.
pub(crate) fn by_rate(runs: &[Run]) -> Vec<(f64, Vec<Run>)> {
    let mut sorted = runs.to_vec();
    sorted.sort_by(|a, b| a.part_per_h.total_cmp(&b.part_per_h));
    let group = |chunk: &[Run]| (chunk[0].part_per_h, chunk.to_vec());
    sorted.chunk_by(|a, b| a.part_per_h == b.part_per_h).map(group).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const RUN: Run = Run { part_per_h: 1.0, onset_s: 100.0, until_s: 200.0, alarm_s: None };

    #[test]
    fn an_alarm_before_the_onset_is_false_and_says_nothing_about_the_leak() {
        let run = Run { alarm_s: Some(60.0), ..RUN };
        assert_eq!((run.delay_s(), run.watched_s(), run.found_within(10.0)), (None, None, None));
    }

    #[test]
    fn a_leak_that_was_not_watched_for_so_long_is_neither_found_nor_missed() {
        let found = Run { alarm_s: Some(130.0), ..RUN };
        assert_eq!([20.0, 30.0, 500.0].map(|s| found.found_within(s)), [Some(false), Some(true), Some(true)]);
        assert_eq!([50.0, 100.0, 101.0].map(|s| RUN.found_within(s)), [Some(false), Some(false), None]);
    }

    #[test]
    fn runs_are_grouped_by_their_rate() {
        let groups = by_rate(&[3.0, 1.0, 3.0].map(|part_per_h| Run { part_per_h, ..RUN }));
        let sizes: Vec<(f64, usize)> = groups.iter().map(|(rate, runs)| (*rate, runs.len())).collect();
        assert_eq!(sizes, [(1.0, 1), (3.0, 2)]);
    }
}
