//! The judge's table in a few lines and two tables, for a report.
use crate::evaluation::judge::measures::{Delay, Reached, SmallestLeak};
use crate::evaluation::judge::table::{CandidateReport, LeakRow, Table};
use crate::report::{Report, number};
use crate::thermal::units::HOUR_S;

/// Columns of the smallest leak, by their names in the judge's table.
const HORIZONS: [&str; 3] = ["1 h", "24 h", "7 d"];

/// What stands behind the numbers, what each detector reaches, and its delays.
pub fn summary(table: &Table) -> Report {
    let of = &table.provenance;
    let words = format!(
        "{} of {} worlds are finished. Thresholds are for one false alarm in {} years, from the families {}; judged on {}.",
        of.finished,
        of.worlds,
        number(of.between_false_alarms_y, 3),
        of.tune.join(", "),
        of.judge.join(", "),
    );
    let header = [
        "detector",
        "threshold",
        "extrapolated",
        "false losses",
        "in ten years",
        "1 h / %/h",
        "24 h / %/h",
        "7 d / %/h",
    ];
    let reached = table.candidates.iter().map(reached).collect();
    let explained = "threshold: of the detector's own statistic; extrapolated: by this factor over the time behind it; false losses: in tight \
                     cylinders, with the 95 % interval of their rate; 1 h, 24 h, 7 d: smallest leak that 95 % are found of within it, \
                     in % of the gas per hour, with its 95 % interval";
    let report = Report::new(of.title.clone()).text(words).explained_rows("", &header, reached, explained);
    delays(table, report)
}

/// One detector: threshold, false losses and smallest leaks.
fn reached(candidate: &CandidateReport) -> Vec<String> {
    let losses = candidate.judged().and_then(|all| all.tight.losses);
    let level = candidate.threshold.map(|tuned| tuned.level);
    let mut cells = vec![
        candidate.name.clone(),
        level.map_or_else(String::new, |level| number(level.threshold, 3)),
        level.map_or_else(String::new, |level| number(level.factor, 2)),
        losses.map_or_else(String::new, |rate| rate.count.to_string()),
        losses.map_or_else(String::new, |rate| {
            let (low, high) = rate.by_simulation;
            format!("{} ({} to {})", number(rate.per_ten_years, 2), number(low, 2), number(high, 2))
        }),
    ];
    let leaks = super::leaks(candidate);
    let found = |name| leaks.and_then(|leaks| leaks.smallest_percent_h.get(name)?.as_ref());
    cells.extend(HORIZONS.map(|name| found(name).map_or_else(String::new, smallest)));
    cells
}

/// A smallest leak with its interval.
fn smallest(found: &SmallestLeak) -> String {
    let words = |reached: Reached| match reached {
        Reached::AtMost(rate) => format!("<{}", number(rate, 2)),
        Reached::At(rate) => number(rate, 2),
        Reached::Above(rate) => format!(">{}", number(rate, 2)),
    };
    let (low, high) = found.interval;
    match found.rate {
        Reached::At(_) => format!("{} ({} to {})", words(found.rate), words(low), words(high)),
        rate => words(rate),
    }
}

/// Median delay of every detector at every rate, with the part that was found.
fn delays(table: &Table, report: Report) -> Report {
    let judged = || table.candidates.iter().filter_map(|of| Some((of.name.as_str(), super::leaks(of)?)));
    let Some((_, first)) = judged().next() else { return report };
    let header: Vec<&str> =
        ["leak / %/h", "bar/h", "bound / h"].into_iter().chain(judged().map(|(name, _)| name)).collect();
    let row = |at: &LeakRow| {
        let of_rate =
            |rows: &[LeakRow]| rows.iter().find(|row| row.percent_h == at.percent_h).map(|row| row.delay);
        let mut cells = vec![number(at.percent_h, 3), number(at.percent_h * first.bar_per_percent, 2)];
        cells.push(at.bound_s.map_or_else(String::new, |bound_s| number(bound_s / HOUR_S, 3)));
        cells.extend(judged().map(|(_, leaks)| of_rate(&leaks.by_rate).map_or_else(String::new, delay)));
        cells
    };
    let rows = first.by_rate.iter().map(row).collect();
    report.explained_rows(
        "",
        &header,
        rows,
        "median delay from the onset, and how many were found where not all were",
    )
}

/// Median delay in hours; the number found where it is less than half.
fn delay(delay: Delay) -> String {
    let of = format!("{} of {}", delay.found, delay.leaks);
    match delay.median_s.map(|median_s| number(median_s / HOUR_S, 2)) {
        Some(hours) if delay.found == delay.leaks => format!("{hours} h"),
        Some(hours) => format!("{hours} h, {of}"),
        None => of,
    }
}
