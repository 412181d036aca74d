//! How many rows a cylinder may send.
//!
//! A broker delivers at once what it kept for hours, so the arrival of rows says nothing of their rate. Their own times do: a row that is at
//! least 1/N min after the one before is free. Every other row, one whose time stands still, goes back or advances too little, costs a token;
//! there are N, and N come back in a minute of the gateway. So a backlog of rows with advancing times loses none, and a cylinder that floods
//! gets at most 2 N rows into a minute of its own time. With the clock `arrival` a backlog has no times of its own, and pays.
use std::collections::HashMap;
use std::time::Instant;

/// Tokens by cylinder.
#[derive(Default)]
pub(super) struct Rates(HashMap<String, Tokens>);

struct Tokens {
    /// Time of the last row that was admitted, ns since 1970.
    last_ns: i64,
    left: f64,
    at: Instant,
}

impl Rates {
    /// Whether a row that comes now may be taken in.
    pub(super) fn admit(&mut self, name: &str, time_ns: i64, now: Instant, a_minute: u32) -> bool {
        let most = f64::from(a_minute);
        let Some(tokens) = self.0.get_mut(name) else {
            self.0.insert(name.to_owned(), Tokens { last_ns: time_ns, left: most, at: now });
            return true;
        };
        let elapsed_s = now.saturating_duration_since(tokens.at).as_secs_f64();
        (tokens.left, tokens.at) = ((tokens.left + elapsed_s * most / 60.0).min(most), now);
        let is_free = time_ns.saturating_sub(tokens.last_ns) >= 60_000_000_000 / i64::from(a_minute.max(1));
        if !is_free {
            if tokens.left < 1.0 {
                return false;
            }
            tokens.left -= 1.0;
        }
        tokens.last_ns = time_ns;
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    const SECOND: i64 = 1_000_000_000;

    fn admitted(rates: &mut Rates, times: impl Iterator<Item = i64>, now: Instant) -> usize {
        times.filter(|time| rates.admit("A", *time, now, 600)).count()
    }

    #[test]
    fn a_backlog_of_an_hour_loses_no_row() {
        let times = (0..3600).map(|k| k * SECOND);
        assert_eq!(admitted(&mut Rates::default(), times, Instant::now()), 3600);
    }

    #[test]
    fn times_that_stand_still_cost_tokens_which_come_back() {
        let (mut rates, now) = (Rates::default(), Instant::now());
        assert_eq!(admitted(&mut rates, std::iter::repeat_n(0, 10_000), now), 601);
        let later = now + Duration::from_secs(30);
        assert_eq!(admitted(&mut rates, std::iter::repeat_n(0, 10_000), later), 300);
        // Another one is not touched.
        assert!(rates.admit("B", 0, later, 600));
    }

    #[test]
    fn times_that_jump_back_and_forth_or_advance_too_little_are_bounded() {
        let now = Instant::now();
        let back_and_forth = (0..10_000).map(|k| k % 2 * 1_000_000 * SECOND);
        assert!(admitted(&mut Rates::default(), back_and_forth, now) <= 1202);
        // 100 rows a second, of an hour.
        let flood = (0..360_000).map(|k| k * SECOND / 100);
        assert!(admitted(&mut Rates::default(), flood, now) < 37_000);
    }

    #[test]
    fn no_time_makes_it_overflow() {
        let times = [i64::MIN, i64::MAX, i64::MIN, 0].into_iter();
        assert_eq!(admitted(&mut Rates::default(), times, Instant::now()), 4);
    }
}
