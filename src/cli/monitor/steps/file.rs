//! What a program needs that keeps state files itself: a check of readings before there are rows, going on from a file,
//! acknowledgements, and what the page of a fleet says.
use super::*;
use crate::cli::monitor::session::row_counts;
use crate::detector::monitor::intake::Counts;
use crate::report::fleet::Finding;
use crate::report::monitor::Summary;

/// A time of rows that have dates.
const DATES: StepTime = StepTime::Instant(0, String::new());

/// Why a state file is not gone on with.
pub(in crate::cli) enum NotResumed {
    /// It is no whole state of this version.
    Damaged(String),
    /// It is one of another vessel, other sensors or other options.
    Other(anyhow::Error),
}

impl Steps {
    /// Finds out whether rows with these readings can be taken in.
    pub(in crate::cli) fn check(&self, names: &[String]) -> anyhow::Result<()> {
        let frame = Frame::of(names, DATES);
        let (_, mut log) = frame.opened(&self.documents, true, &self.log_options())?;
        Selection::new(
            &mut log.reader,
            self.sensors.clone(),
            &self.beginning.vessel,
            &[],
            &Messages::kept(),
        )?;
        Ok(())
    }

    /// Goes on from the bytes of a state file that knows rows with dates and these readings.
    ///
    /// # Errors
    /// The state is damaged, or belongs to something else; all stays as it is.
    pub(in crate::cli) fn resume(&mut self, names: &[String], file: &[u8]) -> Result<(), NotResumed> {
        let state = State::from_bytes(file).map_err(|reason| NotResumed::Damaged(reason.to_string()))?;
        let frame = Frame::of(names, DATES);
        let running = self.resumed(&frame, &state).map_err(NotResumed::Other)?;
        (self.frame, self.running) = (frame.head(), Some(running));
        Ok(())
    }

    /// Whether the fill is known, so that rows are taken in one by one.
    pub(in crate::cli) fn has_begun(&self) -> bool {
        self.running.is_some()
    }

    /// Time of the last row since 1970, s, where rows have dates.
    pub(in crate::cli) fn last_row_s(&self) -> Option<f64> {
        let running = self.running.as_ref()?;
        let origin_s = running.origin?.as_nanosecond() as f64 * 1e-9;
        Some(origin_s + running.last_stamp_s).filter(|time_s| time_s.is_finite())
    }

    /// Acknowledges and confirms all alarms, as `--acknowledge` does.
    pub(in crate::cli) fn acknowledge(&mut self, comment: &str) -> Vec<Told> {
        let Some(Running { monitor, naming, .. }) = &mut self.running else { return Vec::new() };
        monitor.acknowledge(comment).iter().map(|alarm| course::told_alarm(alarm, naming)).collect()
    }

    /// What the page of a fleet says of the cylinder; `None`: no row has come out yet. The course is that since the start; of a monitor that
    /// goes on from a state its first row is that of the state.
    pub(in crate::cli) fn finding(&self) -> Option<Finding> {
        self.running.as_ref()?.finding(&self.options)
    }
}

impl Running {
    fn finding(&self, options: &Options) -> Option<Finding> {
        let counts = self.monitor.intake().counts();
        let clock = &self.naming.clock;
        let run = Summary {
            title: String::new(),
            sampling: self.seen.sampling.clone(),
            cautions: Vec::new(),
            naming: self.naming.clone(),
            last: self.last.clone()?,
            alarms: self.monitor.alarms().clone(),
            limits: options.limits,
            known_rows: 0,
            held_rows: self.monitor.intake().held() as u64,
            row_counts: row_counts(counts, &Counts::default()),
            loss_found: self.seen.loss_found,
            continued: counts.rows > self.seen.sampling.rows(),
        };
        let found = Finding::of(&run, self.seen.trace.means());
        let span_s = (self.log_starts_s.first().copied().unwrap_or(f64::NAN), self.last_stamp_s);
        let date = |time_s: f64| clock.date_of_log(time_s).unwrap_or_default();
        Some(Finding { rows: counts.rows, span_s, span: (date(span_s.0), date(span_s.1)), ..found })
    }
}
