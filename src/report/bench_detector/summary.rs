//! A bench in a few lines and two tables for people.
use crate::evaluation::performance::bench::{Judged, Outcome};
use crate::evaluation::performance::{CONFIDENCE, Horizon, Reached, Sensitivity, SmallestLeak};
use crate::report::{BAR_PER_HOUR, Report, number};
use crate::thermal::units::BAR_PA;
use crate::thermal::units::{DAY_S, HOUR_S, YEAR_S};

/// Columns of the smallest leak.
const HORIZONS: [Horizon; 3] = [Horizon::Hour, Horizon::Day, Horizon::Week];

/// What stands behind the numbers, what each detector reaches, and its delays.
pub fn summary(outcome: &Outcome) -> Report {
    let reached = outcome.judged.iter().map(reached).collect();
    let report = Report::new("Leak detectors side by side").text(campaign_text(outcome)).explained_rows(
        "",
        &header(),
        reached,
        explained(outcome),
    );
    delays(outcome, report).remark(bound(outcome))
}

/// How many cylinders for how long.
fn campaign_text(outcome: &Outcome) -> String {
    let plan = &outcome.plan;
    let (days, learnt) = (plan.watched_s / DAY_S, plan.learning_s / DAY_S);
    let years = |cylinders: u64| cylinders as f64 * plan.watched_s / YEAR_S;
    let truth = if plan.fast { "well-mixed gas" } else { "stratified gas" };
    format!(
        "{} simulated cylinders ({truth}) in winter railway weeks, {} d to learn from and {} d to watch each\n\
         training: {} tight ones, {} cylinder-years; test: {} tight ones, {} cylinder-years, and as many leaking for each rate\n",
        plan.cylinders(),
        number(learnt, 3),
        number(days, 3),
        plan.training,
        number(years(plan.training), 3),
        plan.tests,
        number(years(plan.tests), 3),
    )
}

fn header() -> [&'static str; 8] {
    [
        "detector",
        "threshold",
        "false alarms",
        "a year",
        "at most",
        "found within 1 h / bar/h",
        "24 h / bar/h",
        "7 d / bar/h",
    ]
}

/// One detector: false alarms and smallest leaks.
fn reached(judged: &Judged) -> Vec<String> {
    let performance = &judged.performance;
    let reliability = performance.reliability;
    let mut cells = vec![
        performance.detector.clone(),
        threshold(judged),
        reliability.alarms.to_string(),
        number(reliability.per_year(), 2),
        number(reliability.per_year_interval(CONFIDENCE).1, 2),
    ];
    cells.extend(HORIZONS.map(|horizon| performance.smallest(horizon).map_or_else(String::new, smallest)));
    cells
}

/// A threshold with its unit, pressures in bar.
fn threshold(judged: &Judged) -> String {
    let value = judged.level.threshold;
    match judged.unit.as_str() {
        "Pa" => format!("{} bar", number(value / BAR_PA, 3)),
        "log10(years)" => format!("{} years", number(10_f64.powf(value), 2)),
        unit => format!("{} {unit}", number(value, 3)),
    }
}

/// A smallest leak with its interval, in bar/h.
fn smallest(found: &SmallestLeak) -> String {
    let words = |reached: Reached| {
        let rate = number(reached.rate_pa_s() * BAR_PER_HOUR, 2);
        match reached {
            Reached::AtMost(_) => format!("<{rate}"),
            Reached::At(_) => rate,
            Reached::Above(_) => format!(">{rate}"),
        }
    };
    match found.rate {
        Reached::At(_) => {
            format!("{} ({} to {})", words(found.rate), words(found.interval.0), words(found.interval.1))
        }
        rate => words(rate),
    }
}

/// What the table's columns are, and how far the thresholds are extrapolated.
fn explained(outcome: &Outcome) -> String {
    let wished_years = outcome.plan.between_alarms_s / YEAR_S;
    let factor = outcome.judged.first().map_or(f64::NAN, |judged| judged.level.factor);
    let extrapolated = if factor > 1.0 {
        format!(", extrapolated by a factor of {} over the training", number(factor, 2))
    } else {
        String::new()
    };
    format!(
        "thresholds for one false alarm in {} years{extrapolated}; at most: upper 95 % bound of the test;\n\
         found: smallest leak that 95 % are found of, with its 95 % interval",
        number(wished_years, 3)
    )
}

/// Median delay of every detector at every rate, with the part that was found.
fn delays(outcome: &Outcome, report: Report) -> Report {
    let Some(first) = outcome.judged.first() else { return report };
    let names = outcome.judged.iter().map(|judged| judged.performance.detector.as_str());
    let header: Vec<&str> = ["leak / bar/h", "bound / h"].into_iter().chain(names).collect();
    let row = |(k, at): (usize, &Sensitivity)| {
        let mut cells = vec![number(at.rate_pa_s * BAR_PER_HOUR, 3)];
        cells.push(at.bound_s.map_or_else(String::new, |bound_s| number(bound_s / HOUR_S, 3)));
        cells.extend(outcome.judged.iter().map(|judged| delay(&judged.performance.sensitivity[k])));
        cells
    };
    let rows: Vec<Vec<String>> = first.performance.sensitivity.iter().enumerate().map(row).collect();
    report.rows("", &header, rows)
}

/// Median delay in hours; the number found where it is less than half.
fn delay(at: &Sensitivity) -> String {
    let delay = at.delay;
    match (delay.median_s, delay.found == delay.leaks) {
        (Some(median_s), true) => format!("{} h", number(median_s / HOUR_S, 2)),
        (Some(median_s), false) => {
            format!("{} h, {} of {}", number(median_s / HOUR_S, 2), delay.found, delay.leaks)
        }
        (None, _) => format!("{} of {}", delay.found, delay.leaks),
    }
}

/// What the delays are, and the noise behind their bound.
fn bound(outcome: &Outcome) -> String {
    let noise = outcome.noise.map_or_else(String::new, |noise| {
        format!(
            "\nbound: shortest mean delay that an error of {} bar wandering over {} h allows",
            number(noise.sd / BAR_PA, 2),
            number(noise.correlation_time_s / HOUR_S, 2)
        )
    });
    format!("median delay from the onset, and how many were found before the end where not all were{noise}")
}
