//! Verdicts against time in bounded memory.
use crate::detector::monitor::Verdict;
use crate::report::figure::Stretch;
use crate::report::figure::style::Rgb;

/// Most stretches that are kept: more than a figure has columns.
const MAX_STRETCHES: usize = 2048;

/// Verdicts one after the other. When there are too many stretches, those shorter than a column are joined with the one before, and
/// the worse verdict of the two stands: a leak is never too short to be seen.
#[derive(Clone, Debug, Default)]
pub(crate) struct VerdictStrip {
    /// Begin, end, s, and verdict.
    stretches: Vec<(f64, f64, Verdict)>,
}

impl VerdictStrip {
    /// Adds a verdict that holds from a time on, s. A time before the last one has no place.
    pub(crate) fn push(&mut self, time_s: f64, verdict: Verdict) {
        let Some(last) = self.stretches.last_mut() else {
            self.stretches.push((time_s, time_s, verdict));
            return;
        };
        if time_s < last.1 {
            return;
        }
        last.1 = time_s;
        if appearance(last.2) != appearance(verdict) {
            self.stretches.push((time_s, time_s, verdict));
        }
        if self.stretches.len() > MAX_STRETCHES {
            self.thin();
        }
    }

    /// Joins what is shorter than one of `MOST / 2` columns.
    fn thin(&mut self) {
        let (Some(first), Some(last)) = (self.stretches.first(), self.stretches.last()) else { return };
        let (start_s, width_s) = (first.0, (last.1 - first.0) / (MAX_STRETCHES / 2) as f64);
        let column = |time_s: f64| ((time_s - start_s) / width_s) as u64;
        self.stretches.dedup_by(|next, kept| {
            let joined = appearance(next.2) == appearance(kept.2) || column(next.0) == column(kept.0);
            if joined {
                kept.1 = next.1;
                kept.2 = if priority(next.2) > priority(kept.2) { next.2 } else { kept.2 };
            }
            joined
        });
    }

    /// The strip, shifted by an origin, s.
    pub(crate) fn stretches(&self, origin_s: f64) -> Vec<Stretch> {
        let stretch = |&(from, to, verdict): &(f64, f64, Verdict)| {
            let (name, color) = appearance(verdict);
            Stretch { from: from - origin_s, to: to - origin_s, name: name.to_owned(), color }
        };
        self.stretches.iter().map(stretch).collect()
    }
}

/// Name and colour. All reasons not to know look alike.
fn appearance(verdict: Verdict) -> (&'static str, Rgb) {
    let color = match verdict {
        Verdict::Tight => Rgb::GREEN,
        Verdict::Leak => Rgb::VERMILLION,
        Verdict::Discharge => Rgb::ORANGE,
        Verdict::Refill => Rgb::SKY,
        Verdict::SensorFault => Rgb::PURPLE,
        Verdict::Unknown(_) => Rgb(180, 180, 180),
    };
    (verdict.as_str(), color)
}

/// What must not be hidden by what.
fn priority(verdict: Verdict) -> u8 {
    match verdict {
        Verdict::Tight => 0,
        Verdict::Refill => 1,
        Verdict::Unknown(_) => 2,
        Verdict::SensorFault => 3,
        Verdict::Discharge => 4,
        Verdict::Leak => 5,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::detector::monitor::Reason;

    #[test]
    fn equal_verdicts_are_one_stretch_and_a_late_row_changes_nothing() {
        let mut strip = VerdictStrip::default();
        for (time_s, verdict) in [
            (0.0, Verdict::Unknown(Reason::Learning)),
            (60.0, Verdict::Unknown(Reason::Gap)),
            (120.0, Verdict::Tight),
            (90.0, Verdict::Leak),
            (180.0, Verdict::Tight),
        ] {
            strip.push(time_s, verdict);
        }
        let found: Vec<(f64, f64, String)> =
            strip.stretches(60.0).into_iter().map(|s| (s.from, s.to, s.name)).collect();
        assert_eq!(found, [(-60.0, 60.0, "unknown".to_owned()), (60.0, 120.0, "tight".to_owned())]);
    }

    #[test]
    fn flicker_over_a_year_stays_in_bounded_memory_and_a_short_leak_is_still_there() {
        let mut strip = VerdictStrip::default();
        for k in 0..500_000_u32 {
            let verdict = match k {
                250_000 => Verdict::Leak,
                _ if k % 2 == 0 => Verdict::Tight,
                _ => Verdict::Unknown(Reason::NoPressure),
            };
            strip.push(60.0 * f64::from(k), verdict);
            assert!(strip.stretches.len() <= MAX_STRETCHES);
        }
        assert!(strip.stretches.windows(2).all(|pair| pair[0].1 <= pair[1].0));
        let leaks: Vec<_> = strip.stretches.iter().filter(|stretch| stretch.2 == Verdict::Leak).collect();
        assert_eq!(leaks.len(), 1);
        assert!(leaks[0].0 <= 60.0 * 250_000.0 && leaks[0].1 >= 60.0 * 250_000.0);
    }
}
