//! A table that was never judged.
use super::{figure, summary};
use crate::evaluation::judge::measures::{AlarmLevel, Delay, Reached, Run, SmallestLeak};
use crate::evaluation::judge::plan::Role;
use crate::evaluation::judge::table::{
    CandidateReport, GroupReport, LeakRow, Leaks, Provenance, Table, Tight, Tuned,
};
use crate::report::figure::{Item, Picture};
use crate::thermal::units::HOUR_S;

/// Leaks of 0.05 and 0.5 %/h, ten of each; the smaller one is found in so many, the larger one always and ten times as soon.
fn leaks(found: u64, delay_h: f64) -> Leaks {
    let row = |percent_h: f64, found: u64, delay_h: f64| {
        let alarm_s = |n: u64| (n < found).then_some(delay_h * HOUR_S);
        let runs: Vec<Run> = (0..10)
            .map(|n| Run { part_per_h: 1.0, onset_s: 0.0, until_s: 1e6, alarm_s: alarm_s(n) })
            .collect();
        LeakRow {
            percent_h,
            found: Vec::new(),
            delay: Delay::of(&runs),
            bound_s: Some(1800.0),
            efficiency: None,
        }
    };
    let day = SmallestLeak {
        probability: 0.95,
        rate: Reached::At(0.4),
        interval: (Reached::At(0.3), Reached::Above(0.5)),
    };
    let week = SmallestLeak { rate: Reached::AtMost(0.05), ..day };
    let smallest = [("24 h", Some(day)), ("7 d", Some(week)), ("1 h", None)];
    Leaks {
        runs: 20,
        simulations: 10,
        bar_per_percent: 2.0,
        smallest_percent_h: smallest.into_iter().map(|(name, of)| (name.to_owned(), of)).collect(),
        noise: None,
        by_rate: vec![row(0.05, found, delay_h), row(0.5, 10, 0.1 * delay_h)],
    }
}

fn candidate(name: &str, threshold: Option<Tuned>, leaks: Option<Leaks>) -> CandidateReport {
    let tight = Tight {
        shares: [None, None],
        unknown_later: None,
        worlds: 0,
        losses: None,
        leaks: None,
        leaks_in_first_day: 0,
        exchanges: None,
        sensor_faults: None,
    };
    let all = GroupReport {
        role: Role::Judge,
        group: "all".into(),
        is_all: true,
        is_of_one_axis: true,
        is_family: false,
        worlds: 20,
        failed: 0,
        simulations: 10,
        cylinder_years: 1.0,
        tight,
        lost_shares: [None, None],
        leaks,
        free_mass_noise: None,
        coverage: Vec::new(),
        innovations: Vec::new(),
        fast: Vec::new(),
        recognised_exchanges: [None, None],
        faults: Vec::new(),
        disagreements: None,
    };
    CandidateReport {
        name: name.into(),
        threshold,
        failures: Vec::new(),
        contradictions: Vec::new(),
        groups: vec![all],
    }
}

fn table() -> Table {
    let level = AlarmLevel { threshold: 0.0075, sd: 1e-3, factor: 45.0, tail: 3 };
    let tuned = Tuned { level, worlds: 10, cylinder_years: 0.2 };
    Table {
        provenance: Provenance {
            title: "Two detectors".into(),
            plan_sha256: String::new(),
            version: "0",
            worlds: 40,
            finished: 30,
            tune: vec!["*/hall/*/*/*".into()],
            judge: vec!["*/railway/*/*/*".into()],
            left_out: Vec::new(),
            between_false_alarms_y: 10.0,
            failed_worlds: 0,
            failures: Vec::new(),
        },
        candidates: vec![
            candidate("watches no leak", None, None),
            candidate("ours", None, Some(leaks(10, 2.0))),
            candidate("theirs", Some(tuned), Some(leaks(3, 10.0))),
        ],
    }
}

#[test]
fn words_say_what_stands_behind_the_numbers() {
    let words = summary(&table()).to_text();
    for expected in
        ["30 of 40 worlds", "one false alarm in 10 years", "*/hall/*/*/*", "0.4 (0.3 to >0.5)", "<0.05"]
    {
        assert!(words.contains(expected), "`{expected}` is missing in:\n{words}");
    }
    let row = |first: &str| {
        let line = words.lines().find(|line| line.trim_start().starts_with(first)).unwrap();
        line.split("  ").map(str::trim).filter(|cell| !cell.is_empty()).map(str::to_owned).collect::<Vec<_>>()
    };
    assert_eq!(row("0.05 "), ["0.05", "0.1", "0.5", "2 h", "3 of 10"]);
    assert_eq!(row("theirs")[1..3], ["0.0075", "45"]);
}

#[test]
fn the_figure_shows_every_detector_and_the_bound_and_no_delay_where_fewer_than_half_were_found() {
    let figure = figure(&table());
    let items = &figure.panels[0].items;
    let line = |wanted: &str| {
        items.iter().find_map(|item| match item {
            Item::Line { name, y, .. } if name == wanted => Some(y.clone()),
            _ => None,
        })
    };
    assert_eq!(line("ours"), Some(vec![2.0, 0.2]));
    let theirs = line("theirs").unwrap();
    assert!(theirs[0].is_nan() && theirs[1] == 1.0, "{theirs:?}");
    assert_eq!(line("shortest possible"), Some(vec![0.5, 0.5]));
    assert_eq!(line("watches no leak"), None);
    let provenance = crate::report::Provenance { command: "c".into(), inputs: vec![], seed: None };
    assert!(
        Picture::from(figure).to_svg(&provenance).unwrap().contains("leak rate in % of the gas per hour")
    );
}
