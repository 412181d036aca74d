//! A bench that was never run.
use super::{figure, summary, table};
use crate::evaluation::noise::Noise;
use crate::evaluation::performance::bench::{AlarmLevel, Judged, Outcome, Plan};
use crate::evaluation::performance::{Performance, Run, TrueLeak};
use crate::report::Provenance;
use crate::report::figure::{Item, Picture};
use crate::thermal::units::DAY_S;

/// 0.1 bar/h.
const SMALL: f64 = 1e4 / 3600.0;

/// Two leak rates a factor of ten apart, ten cylinders each; the smaller leak is found in so many, the larger one always.
fn judged(detector: &str, found: u64, delay_s: f64) -> Judged {
    let watched =
        |seed, leak, alarm_s| Run { seed, leak, from_s: 0.0, until_s: 8.0 * DAY_S, alarm_s, found: None };
    let leak = |rate_pa_s| Some(TrueLeak { rate_pa_s, onset_s: DAY_S });
    let tight = (0..10).map(|seed| watched(seed, None, None));
    let small = (0..10).map(|seed| watched(seed, leak(SMALL), (seed < found).then_some(DAY_S + delay_s)));
    let large = (0..10).map(|seed| watched(seed, leak(10.0 * SMALL), Some(DAY_S + 0.1 * delay_s)));
    let runs: Vec<Run> = tight.chain(small).chain(large).collect();
    let level = AlarmLevel { threshold: 1.5e5, sd: 1e4, factor: 45.0, tail: 3 };
    let performance = Performance::of(detector, &runs, |_| Some(1800.0));
    Judged { unit: "Pa".into(), level, performance, runs }
}

fn outcome() -> Outcome {
    Outcome {
        plan: Plan { rates_pa_s: vec![SMALL, 10.0 * SMALL], training: 10, tests: 10, ..Plan::default() },
        judged: vec![judged("ours", 10, 7200.0), judged("theirs, refitted", 3, 36_000.0)],
        noise: Some(Noise { sd: 0.2e5, correlation_time_s: 5400.0 }),
    }
}

#[test]
fn words_say_what_stands_behind_the_numbers() {
    let words = summary(&outcome()).to_text();
    for expected in [
        "40 simulated cylinders (well-mixed gas)",
        "10 tight ones, 0.219 cylinder-years",
        "one false alarm in 10 years, extrapolated by a factor of 45",
        "1.5 bar",
        "3 of 10",
        "an error of 0.2 bar wandering over 1.5 h",
    ] {
        assert!(words.contains(expected), "`{expected}` is missing in:\n{words}");
    }
    let ours = words.lines().find(|line| line.starts_with("ours")).unwrap();
    // Found at every rate within a day, so that only a bound is known; after 2 h never within one.
    assert!(ours.contains("<0.1"), "{ours}");
    assert!(words.lines().all(|line| line.chars().count() < 170));
}

#[test]
fn columns_have_a_row_for_each_detector_and_rate_and_leave_what_is_unknown_empty() {
    let provenance = Provenance { command: "c".into(), inputs: vec![], seed: Some(1) };
    let csv = table(&outcome()).to_csv(&provenance, &["a remark".into()]);
    let lines: Vec<&str> = csv.lines().filter(|line| !line.starts_with('#')).collect();
    assert_eq!(lines.len(), 5);
    let columns = lines[0].split(',').count();
    assert!(lines[1].starts_with("ours,Pa,150000,0,") && lines[1].split(',').count() == columns);
    assert!(lines[3].starts_with("\"theirs, refitted\",Pa,") && lines[3].split(',').count() == columns + 1);
    let of = |name: &str, line: &str| {
        let index = lines[0].split(',').position(|column| column == name).unwrap();
        line.split(',').nth(index).unwrap().to_owned()
    };
    assert_eq!((of("leak_bar_h", lines[1]).as_str(), of("delay_median_h", lines[1]).as_str()), ("0.1", "2"));
    assert_eq!((of("found_30d", lines[1]).as_str(), of("efficiency", lines[1]).as_str()), ("", "0.25"));
}

#[test]
fn the_figure_shows_every_detector_and_the_bound_and_no_delay_where_fewer_than_half_were_found() {
    let figure = figure(&outcome());
    let items = &figure.panels[0].items;
    let line = |wanted: &str| {
        items.iter().find_map(|item| match item {
            Item::Line { name, y, .. } if name == wanted => Some(y.clone()),
            _ => None,
        })
    };
    assert_eq!(line("ours"), Some(vec![2.0, 0.2]));
    let theirs = line("theirs, refitted").unwrap();
    assert!(theirs[0].is_nan() && theirs[1] == 1.0, "{theirs:?}");
    assert_eq!(line("shortest possible"), Some(vec![0.5, 0.5]));
    let provenance = Provenance { command: "c".into(), inputs: vec![], seed: Some(1) };
    assert!(Picture::from(figure).to_svg(&provenance).unwrap().contains("leak rate in bar/h"));
}
