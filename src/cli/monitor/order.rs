//! Refuses logs whose rows are in no order of time.
//!
//! A row that comes late now and then is left out, and a clock that is set back steps back once. Where one row in ten steps back by more
//! than the lateness, the log is not in the order of time, and everything said of it would be wrong.
use anyhow::bail;

/// Rows that are looked at before a log is refused, and the part of them that may step back.
const MIN_ROWS: u64 = 20;
const BACKWARD_PART: u64 = 10;

/// Counts rows that step back in time.
pub(super) struct Order {
    lateness_s: f64,
    last_s: f64,
    rows: u64,
    back: u64,
}

impl Order {
    /// No row has come.
    pub(super) fn new(lateness_s: f64) -> Self {
        Self { lateness_s, last_s: f64::NEG_INFINITY, rows: 0, back: 0 }
    }

    /// Takes the time of a row that stands at `place`.
    pub(super) fn check(&mut self, time_s: f64, place: String) -> anyhow::Result<()> {
        self.rows += 1;
        self.back += u64::from(time_s < self.last_s - self.lateness_s);
        self.last_s = time_s;
        if self.rows >= MIN_ROWS && self.back * BACKWARD_PART > self.rows {
            let (back, rows, lateness_s) = (self.back, self.rows, self.lateness_s);
            bail!(
                "{place}: {back} of {rows} rows are earlier than the row before them by more than --lateness-s \
                 {lateness_s}: sort the log by time, or state how late a row may come"
            );
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn accepted(times_s: impl IntoIterator<Item = f64>, lateness_s: f64) -> bool {
        let mut order = Order::new(lateness_s);
        times_s.into_iter().all(|time_s| order.check(time_s, String::new()).is_ok())
    }

    #[test]
    fn one_row_in_ten_may_step_back_and_no_more() {
        let minutes = |row: u32| 60.0 * f64::from(row);
        assert!(accepted((0..200).map(minutes), 0.0));
        let late = |row: u32| if row % 20 == 19 { minutes(row) - 600.0 } else { minutes(row) };
        assert!(accepted((0..200).map(late), 0.0));
        let shuffled = |row: u32| minutes(row * 77 % 200);
        assert!(!accepted((0..200).map(shuffled), 0.0));
        assert!(accepted((0..200).map(shuffled), 1e6));
    }

    #[test]
    fn a_clock_that_is_set_back_is_in_order() {
        assert!(accepted(
            (0..200u32).map(|row| 60.0 * f64::from(row) - if row > 100 { 3600.0 } else { 0.0 }),
            0.0
        ));
    }
}
