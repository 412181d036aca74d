//! When rows come.
use crate::world::RowPattern;
use crate::world::rows::Rows;
use crate::world::statistics::{Law, assert_law, assert_share};
use cylwatch_thermal::units::DAY_S;

#[test]
fn rows_are_measured_within_two_percent_of_their_interval_and_one_second() {
    for &pattern in RowPattern::ALL {
        let interval_s = pattern.interval_s();
        let rows = Rows::draw(pattern, 5000.0 * interval_s, 1, true);
        let most_s = (0.02 * interval_s).min(1.0);
        let early_s: Vec<f64> = rows.time_s[1..rows.time_s.len() - 1]
            .iter()
            .map(|t| t - (t / interval_s).round() * interval_s)
            .collect();
        assert_law("jitter", &early_s, Law::Uniform(-most_s, most_s));
        assert_eq!(rows.time_s, rows.stamp_s);
    }
}

#[test]
fn up_to_one_percent_of_the_rows_are_lost() {
    let lost: Vec<f64> = (0..300)
        .map(|seed| {
            1.0 - Rows::draw(RowPattern::Minute, 20.0 * DAY_S, seed, true).time_s.len() as f64 / 28_801.0
        })
        .collect();
    // A share of 28801 trials has a standard deviation of up to 0.0006 of its own.
    assert!(lost.iter().all(|&share| (0.0..0.0125).contains(&share)));
    let mean = crate::world::statistics::mean(&lost);
    assert!((mean - 0.005).abs() < 4.0 * 0.01 / 12_f64.sqrt() / 300_f64.sqrt(), "{mean}");
}

#[test]
fn gaps_begin_once_in_ten_days_and_last_two_minutes_to_six_hours() {
    let all: Vec<Rows> =
        (0..60).map(|seed| Rows::draw(RowPattern::Minute, 100.0 * DAY_S, seed, false)).collect();
    let mut between_s = Vec::new();
    let mut lasting_s = Vec::new();
    for rows in &all {
        let mut before_s = 0.0;
        for &(begin_s, end_s) in &rows.gaps_s {
            between_s.push(begin_s - before_s);
            lasting_s.push(end_s - begin_s);
            before_s = end_s;
            let inside = rows.time_s.iter().filter(|&&t| t >= begin_s && t < end_s).count();
            assert_eq!(inside, 0);
        }
    }
    assert_law("duration", &lasting_s, Law::Logarithmic(120.0, 6.0 * 3600.0));
    // A gap that would begin after the end is not seen: 100 d are ten means, which takes away one in some twenty of the long ones.
    let shorter: Vec<f64> = between_s.iter().copied().filter(|&t| t < 10.0 * DAY_S).collect();
    let share = 1.0 - (-1.0_f64).exp();
    let scaled: Vec<f64> = shorter.iter().map(|t| (1.0 - (-t / (10.0 * DAY_S)).exp()) / share).collect();
    assert_law("time between gaps", &scaled, Law::Uniform(0.0, 1.0));
}

#[test]
fn the_clock_is_set_once_between_day_twenty_and_sixty_and_stamps_always_increase() {
    let mut at_s = Vec::new();
    let mut forward_s = Vec::new();
    for seed in 0..400 {
        let rows = Rows::draw(RowPattern::FiveMinutes, 61.0 * DAY_S, seed, false);
        let (set_s, by_s) = rows.clock.unwrap();
        at_s.push(set_s);
        forward_s.extend((by_s > 0.0).then_some(by_s));
        assert!(by_s >= -150.0);
        assert!(rows.stamp_s.windows(2).all(|pair| pair[1] > pair[0]));
        for (t, stamp) in rows.time_s.iter().zip(&rows.stamp_s) {
            assert_eq!(*stamp, if *t < set_s { *t } else { t + by_s });
        }
    }
    assert_law("when", &at_s, Law::Uniform(20.0 * DAY_S, 60.0 * DAY_S));
    assert_law("forward", &forward_s, Law::Logarithmic(1.0, 3600.0));
    assert_share("forward", forward_s.len(), 400, 0.5);
    assert_eq!(Rows::draw(RowPattern::FiveMinutes, 20.0 * DAY_S, 1, false).clock, None);
}

#[test]
fn rows_that_are_taken_away_leave_the_others_as_they_were() {
    let whole = Rows::draw(RowPattern::Minute, DAY_S, 3, true);
    let mut less = whole.clone();
    less.remove((3600.0, 7200.0));
    let kept: Vec<f64> = whole.time_s.iter().copied().filter(|t| !(3600.0..7200.0).contains(t)).collect();
    assert_eq!(less.time_s, kept);
    assert_eq!(less.stamp_s, kept);
    assert_eq!(less.gaps_s, [(3600.0, 7200.0)]);
}
