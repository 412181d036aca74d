//! The table for people.
mod columns;

use std::fmt::Write as _;

use self::columns::{
    Column, contradictions, coverage, exchanges, false_statements, fast_losses, innovations, smallest,
    verdicts,
};
use super::report::{CandidateReport, GroupReport, Leaks};
use super::{Provenance, Table};
use crate::judge::plan::Role;
use crate::judge::score::coverage::Quantity;

const NONE: &str = "–";

impl Table {
    /// As Markdown.
    pub fn to_markdown(&self) -> String {
        let mut text = heading(&self.provenance);
        for candidate in &self.candidates {
            let _ = write!(text, "\n## {}\n", candidate.name);
            write_threshold(&mut text, candidate);
            write_failures(&mut text, &candidate.failures);
            for (role, title) in [(Role::Judge, ""), (Role::Tune, ", families that tune")] {
                let of: Vec<&GroupReport> = candidate.groups.iter().filter(|of| of.role == role).collect();
                if !of.is_empty() {
                    write_role(&mut text, title, &of);
                }
            }
        }
        text
    }
}

fn heading(provenance: &Provenance) -> String {
    let Provenance { title, plan_sha256, version, worlds, finished, .. } = provenance;
    let partial = if finished < worlds { " (partial)" } else { "" };
    let mut text = format!(
        "# {title}{partial}\n\nPlan {}, cylwatch-evaluation {version}, {finished} of {worlds} worlds.\n",
        &plan_sha256[..12]
    );
    let list = |all: &[String]| if all.is_empty() { NONE.to_owned() } else { all.join(", ") };
    let _ = writeln!(text, "Tuned on: {}. Judged on: {}.", list(&provenance.tune), list(&provenance.judge));
    if !provenance.left_out.is_empty() {
        let _ = writeln!(text, "Left out of tuning: {}.", list(&provenance.left_out));
    }
    if provenance.failed_worlds > 0 {
        let _ = writeln!(text, "\n{} worlds could not be made:", provenance.failed_worlds);
        write_failures(&mut text, &provenance.failures);
    }
    let _ = writeln!(
        text,
        "\nRates are per ten years with Poisson's 95 % interval, then in brackets the interval that takes simulations as independent, not \
         worlds. Intervals of shares take simulations as independent."
    );
    text
}

fn write_threshold(text: &mut String, candidate: &CandidateReport) {
    if let Some(tuned) = &candidate.threshold {
        let _ = writeln!(
            text,
            "\nThreshold {} ± {} from {} worlds, {} cylinder-years; the wished time is {} times as long.",
            short(tuned.level.threshold),
            short(tuned.level.sd),
            tuned.worlds,
            short(tuned.cylinder_years),
            short(tuned.level.factor),
        );
    }
}

fn write_failures(text: &mut String, failures: &[String]) {
    if !failures.is_empty() {
        let _ = writeln!(text);
    }
    failures.iter().for_each(|failure| {
        let _ = writeln!(text, "* failed: {failure}");
    });
}

fn write_role(text: &mut String, title: &str, groups: &[&GroupReport]) {
    let axes: Vec<&GroupReport> = groups.iter().copied().filter(|of| of.is_of_one_axis).collect();
    let places: Vec<&GroupReport> =
        groups.iter().copied().filter(|of| !of.is_of_one_axis && !of.is_family).collect();
    write_table(text, &format!("False statements{title}"), &axes, &false_statements());
    write_table(
        text,
        &format!("False statements by vessel and climate{title}"),
        &places,
        &false_statements(),
    );
    write_table(text, &format!("Verdicts of tight cylinders{title}, % of the time"), &axes, &verdicts());
    write_table(text, &format!("Smallest leak found with 95 %{title}"), &axes, &smallest());
    if let Some(leaks) = axes.first().and_then(|all| all.leaks.as_ref()) {
        write_delays(text, title, leaks);
    }
    for (quantity, name) in Quantity::ALL.into_iter().zip(["mass", "gas temperature", "leak rate", "onset"]) {
        let title = format!("Coverage of 95 % intervals of the {name}{title}, %");
        write_table(text, &title, &axes, &coverage(quantity));
    }
    write_table(text, &format!("Innovations of the pressure{title}"), &axes, &innovations());
    write_table(text, &format!("Fast losses{title}"), &axes, &fast_losses());
    write_table(text, &format!("Exchanges of gas called what they are{title}, %"), &axes, &exchanges());
    write_faults(text, title, &axes);
    write_table(text, &format!("Contradictions{title}"), &axes, &contradictions());
    if let Some(of) = axes.first().and_then(|all| all.disagreements.as_ref()).filter(|of| of.disagreeing > 0)
    {
        let by_rule: Vec<String> =
            of.by_rule.iter().map(|(rule, count)| format!("{rule}: {count}")).collect();
        let _ = writeln!(text, "\n{}.", by_rule.join("; "));
    }
}

/// A table with a row for each group that has something to say, and the columns that say something.
fn write_table(text: &mut String, title: &str, groups: &[&GroupReport], columns: &[Column<'_>]) {
    let cells: Vec<(&str, Vec<Option<String>>)> = groups
        .iter()
        .map(|of| (of.group.as_str(), columns.iter().map(|(_, say)| say(of)).collect::<Vec<_>>()))
        .filter(|(_, cells): &(&str, Vec<Option<String>>)| cells.iter().any(Option::is_some))
        .collect();
    let said: Vec<usize> =
        (0..columns.len()).filter(|column| cells.iter().any(|(_, cells)| cells[*column].is_some())).collect();
    if said.is_empty() {
        return;
    }
    let headings: Vec<&str> = said.iter().map(|column| columns[*column].0.as_str()).collect();
    let _ = writeln!(text, "\n### {title}\n\n| group | {} |", headings.join(" | "));
    let _ = writeln!(text, "|---|{}", "---:|".repeat(said.len()));
    for (name, cells) in &cells {
        let row: Vec<&str> = said.iter().map(|column| cells[*column].as_deref().unwrap_or(NONE)).collect();
        let _ = writeln!(text, "| {name} | {} |", row.join(" | "));
    }
}

fn write_delays(text: &mut String, title: &str, leaks: &Leaks) {
    let _ = writeln!(
        text,
        "\n### Delay of detection, all worlds{title}\n\n\
         | %/h | bar/h | leaks | found | 1 h | 24 h | 7 d | median, h | mean of those found, h | bound, h | bound/mean |\n\
         |---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|"
    );
    let hours = |seconds: Option<f64>| seconds.map_or(NONE.to_owned(), |seconds| short(seconds / 3600.0));
    for row in &leaks.by_rate {
        let within: Vec<String> = row.found.iter().map(|(hits, trials)| format!("{hits}/{trials}")).collect();
        let _ = writeln!(
            text,
            "| {} | {} | {} | {} | {} | {} | {} | {} | {} |",
            short(row.percent_h),
            short(row.percent_h * leaks.bar_per_percent),
            row.delay.leaks,
            row.delay.found,
            within.join(" | "),
            hours(row.delay.median_s),
            hours(row.delay.mean_found_s),
            hours(row.bound_s),
            row.efficiency.map_or(NONE.to_owned(), short),
        );
    }
    if let Some((sd, correlation_time_s)) = leaks.noise {
        let _ = writeln!(
            text,
            "\nNoise of the freest mass without a leak, the quietest candidate's: {} % of the gas, {} h.",
            short(100.0 * sd),
            short(correlation_time_s / 3600.0)
        );
    }
}

/// Recognised shares: a row for each fault, a column for each vessel.
fn write_faults(text: &mut String, title: &str, axes: &[&GroupReport]) {
    let shown = |of: &&&GroupReport| of.group == "all" || of.group.starts_with("vessel ");
    let columns: Vec<&&GroupReport> = axes.iter().filter(shown).filter(|of| !of.faults.is_empty()).collect();
    let Some(all) = columns.first() else { return };
    let names: Vec<&str> = columns.iter().map(|of| of.group.trim_start_matches("vessel ")).collect();
    let _ = writeln!(
        text,
        "\n### Fault table{title}: recognised of worlds (worlds with a false loss, with a false exchange)\n\n| row | {} |\n|---|{}",
        names.join(" | "),
        "---:|".repeat(names.len())
    );
    for fault in &all.faults {
        let cell = |of: &&&GroupReport| {
            let found = of.faults.iter().find(|row| row.row == fault.row)?;
            let share = found.recognised?;
            let wrong = match (found.false_losses, found.false_exchanges) {
                (0, 0) => String::new(),
                (losses, exchanges) => format!(" ({losses}, {exchanges})"),
            };
            Some(format!("{:.0}/{}{wrong}", share.share * share.trials, share.trials))
        };
        let cells: Vec<String> =
            columns.iter().map(|of| cell(of).unwrap_or_else(|| NONE.to_owned())).collect();
        let _ = writeln!(text, "| {} | {} |", fault.row, cells.join(" | "));
    }
}

/// Three digits.
fn short(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        let words = if value == 0.0 {
            "0"
        } else if value == f64::INFINITY {
            "∞"
        } else {
            NONE
        };
        return words.to_owned();
    }
    let digits = 2 - value.abs().log10().floor() as i32;
    if (-3..=6).contains(&digits) {
        let text = format!("{value:.*}", digits.max(0) as usize);
        return match text.contains('.') {
            true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
            false => text,
        };
    }
    format!("{value:.2e}")
}

#[cfg(test)]
mod tests {
    use super::short;

    #[test]
    fn numbers_have_three_digits() {
        let numbers = [0.0, 1.0, 0.123_45, 12.345, 999.6, 12_345.0, 1.5e-7, 1e9, 99.96];
        let texts = ["0", "1", "0.123", "12.3", "1000", "12345", "1.50e-7", "1.00e9", "100"];
        assert_eq!(numbers.map(short), texts);
    }
}
