//! The table for people.
use std::fmt::Write as _;

use super::clustered::{Rate, Share};
use super::report::{CandidateReport, GroupReport, Leaks};
use super::{Provenance, Table};
use crate::judge::measures::{Class, Reached, SmallestLeak};
use crate::judge::plan::Role;

const NONE: &str = "–";

/// A column: its heading and what it says of a group; `None`: nothing.
type Column<'a> = (String, Box<dyn Fn(&GroupReport) -> Option<String> + 'a>);

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
    write_table(text, &format!("False statements by vessel and climate{title}"), &places, &false_statements());
    write_table(text, &format!("Verdicts of tight cylinders{title}, % of the time"), &axes, &verdicts());
    write_table(text, &format!("Smallest leak found with 95 %{title}"), &axes, &smallest());
    if let Some(leaks) = axes.first().and_then(|all| all.leaks.as_ref()) {
        write_delays(text, title, leaks);
    }
    write_table(text, &format!("Coverage of 95 % intervals{title}, %"), &axes, &coverage());
    write_table(text, &format!("Innovations of the pressure{title}"), &axes, &innovations());
    write_table(text, &format!("Fast losses{title}"), &axes, &fast_losses());
    write_table(text, &format!("Exchanges of gas called what they are{title}, %"), &axes, &exchanges());
    write_faults(text, title, &axes);
    write_table(text, &format!("Contradictions{title}"), &axes, &contradictions());
    if let Some(of) = axes.first().and_then(|all| all.disagreements.as_ref()).filter(|of| of.disagreeing > 0) {
        let by_rule: Vec<String> = of.by_rule.iter().map(|(rule, count)| format!("{rule}: {count}")).collect();
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

fn column<'a>(name: impl Into<String>, say: impl Fn(&GroupReport) -> Option<String> + 'a) -> Column<'a> {
    (name.into(), Box::new(say))
}

fn false_statements() -> Vec<Column<'static>> {
    vec![
        column("tight worlds", |of| of.tight.leaks.map(|_| of.tight.worlds.to_string())),
        column("failed", |of| (of.failed > 0).then(|| of.failed.to_string())),
        column("simulations", |of| of.tight.leaks.map(|rate| rate.simulations.to_string())),
        column("tight years", |of| of.tight.leaks.map(|rate| short(rate.cylinder_years))),
        column("losses", |of| of.tight.losses.map(rate)),
        column("leaks", |of| of.tight.leaks.map(rate)),
        column("simulations with", |of| of.tight.leaks.map(|rate| rate.simulations_with.to_string())),
        column("exchanges", |of| of.tight.exchanges.map(rate)),
        column("sensor faults", |of| of.tight.sensor_faults.map(rate)),
        column("unknown after a day, %", |of| of.tight.unknown_later.map(percent)),
    ]
}

fn verdicts() -> Vec<Column<'static>> {
    let of_period = |period: usize, title: &'static str| {
        Class::ALL.into_iter().map(move |class| {
            column(format!("{class}, {title}"), move |of| {
                let shares = of.tight.shares[period].as_ref()?;
                Some(short(100.0 * shares.get(&class.to_string())?))
            })
        })
    };
    of_period(0, "first day").chain(of_period(1, "later")).collect()
}

fn smallest() -> Vec<Column<'static>> {
    let horizon = |name: &'static str| {
        column(format!("{name}, %/h (bar/h)"), move |of| {
            let leaks = of.leaks.as_ref()?;
            leaks.smallest_percent_h.get(name)?.as_ref().map(|leak| smallest_words(leak, leaks.bar_per_percent))
        })
    };
    vec![
        column("runs", |of| of.leaks.as_ref().map(|leaks| leaks.runs.to_string())),
        column("simulations", |of| of.leaks.as_ref().map(|leaks| leaks.simulations.to_string())),
        horizon("1 h"),
        horizon("24 h"),
        horizon("7 d"),
    ]
}

fn smallest_words(leak: &SmallestLeak, bar: f64) -> String {
    let value = |reached: Reached| match reached {
        Reached::AtMost(rate) => format!("≤ {}", short(rate)),
        Reached::At(rate) => short(rate),
        Reached::Above(rate) => format!("> {}", short(rate)),
    };
    let (low, high) = leak.interval;
    let rate = leak.rate.rate_pa_s() * bar;
    format!("{} [{}, {}] ({})", value(leak.rate), value(low), value(high), short(rate))
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

fn coverage() -> Vec<Column<'static>> {
    let mut columns = Vec::new();
    for (quantity, name) in ["mass", "gas", "leak", "onset"].into_iter().enumerate() {
        for gas in ["tight", "lost", "exchanged"] {
            for period in ["first day", "later"] {
                columns.push(column(format!("{name}, {gas}, {period}"), move |of: &GroupReport| {
                    let row = of.coverage.iter().find(|row| {
                        row.quantity as usize == quantity && row.gas == gas && row.period == period
                    })?;
                    row.held.map(percent)
                }));
            }
        }
    }
    let rms = |name: &'static str, quantity: usize, unit: f64| {
        column(name, move |of: &GroupReport| {
            let later = |row: &&super::report::CoverageRow| {
                row.quantity as usize == quantity && row.gas == "tight" && row.period == "later"
            };
            of.coverage.iter().find(later)?.rms.map(|rms| short(unit * rms))
        })
    };
    columns.push(rms("mass rms, tight, later, % of the gas", 0, 100.0));
    columns.push(rms("gas rms, tight, later, K", 1, 1.0));
    columns
}

fn innovations() -> Vec<Column<'static>> {
    let mut columns = Vec::new();
    for regime in crate::world::Regime::ALL {
        let name = format!("{regime:?}").to_lowercase();
        let of_regime = move |of: &GroupReport| of.innovations.iter().find(|row| row.regime == regime).cloned();
        columns.push(column(format!("NIS {name}"), move |of| of_regime(of)?.nis.map(short)));
        for (lag, title) in ["1 min", "10 min"].into_iter().enumerate() {
            columns.push(column(format!("{title} {name}"), move |of| {
                of_regime(of)?.autocorrelation[lag].map(|rho| format!("{rho:.2}"))
            }));
        }
    }
    columns
}

fn exchanges() -> Vec<Column<'static>> {
    let of = |name: &'static str, direction: usize| {
        column(name, move |of: &GroupReport| of.recognised_exchanges[direction].map(percent))
    };
    vec![of("discharge", 0), of("refill", 1)]
}

fn fast_losses() -> Vec<Column<'static>> {
    let mut columns = Vec::new();
    // An announced discharge is none, and must not be told.
    columns.push(column("announced discharge: told as a loss, %", |of: &GroupReport| {
        of.fast.iter().find(|row| row.kind == "discharge, announced")?.told.map(percent)
    }));
    for kind in ["fast loss", "discharge, not announced"] {
        let of_kind = move |of: &GroupReport| of.fast.iter().find(|row| row.kind == kind).cloned();
        columns.push(column(format!("{kind}: n"), move |of| {
            of_kind(of)?.told.map(|share| format!("{} in {}", share.trials, share.simulations))
        }));
        columns.push(column(format!("{kind}: in time, %"), move |of| of_kind(of)?.in_time.map(percent)));
        columns.push(column(format!("{kind}: told, %"), move |of| of_kind(of)?.told.map(percent)));
        columns.push(column(format!("{kind}: median delay, min"), move |of| {
            of_kind(of)?.median_delay_s.map(|delay_s| short(delay_s / 60.0))
        }));
        columns.push(column(format!("{kind}: told before"), move |of| {
            Some(of_kind(of)?.before).filter(|before| *before > 0).map(|before| before.to_string())
        }));
    }
    columns
}

/// Recognised shares: a row for each fault, a column for each vessel.
fn write_faults(text: &mut String, title: &str, axes: &[&GroupReport]) {
    let shown = |of: &&&GroupReport| of.group == "all" || of.group.starts_with("vessel ");
    let columns: Vec<&&GroupReport> =
        axes.iter().filter(shown).filter(|of| !of.faults.is_empty()).collect();
    let Some(all) = columns.first() else { return };
    let names: Vec<&str> = columns.iter().map(|of| of.group.trim_start_matches("vessel ")).collect();
    let _ = writeln!(
        text,
        "\n### Fault table{title}: recognised of worlds (false leaks)\n\n| row | {} |\n|---|{}",
        names.join(" | "),
        "---:|".repeat(names.len())
    );
    for fault in &all.faults {
        let cell = |of: &&&GroupReport| {
            let found = of.faults.iter().find(|row| row.row == fault.row)?;
            let share = found.recognised?;
            let leaks = if found.false_leaks > 0 { format!(" ({})", found.false_leaks) } else { String::new() };
            Some(format!("{:.0}/{}{leaks}", share.share * share.trials, share.trials))
        };
        let cells: Vec<String> =
            columns.iter().map(|of| cell(of).unwrap_or_else(|| NONE.to_owned())).collect();
        let _ = writeln!(text, "| {} | {} |", fault.row, cells.join(" | "));
    }
}

fn contradictions() -> Vec<Column<'static>> {
    vec![
        column("rows", |of| of.disagreements.as_ref().map(|found| found.rows.to_string())),
        column("contradicting", |of| of.disagreements.as_ref().map(|found| found.disagreeing.to_string())),
    ]
}

fn rate(rate: Rate) -> String {
    let ((low, high), (wide_low, wide_high)) = (rate.poisson, rate.by_simulation);
    let [value, low, high] = [rate.per_ten_years, low, high].map(short);
    format!("{} = {value}, {low} to {high} [{}, {}]", rate.count, short(wide_low), short(wide_high))
}

fn percent(share: Share) -> String {
    let (low, high) = share.by_simulation;
    let [value, low, high] = [share.share, low, high].map(|part| short(100.0 * part));
    format!("{value} [{low}, {high}]")
}

/// Three digits.
fn short(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        let words = if value == 0.0 { "0" } else if value == f64::INFINITY { "∞" } else { NONE };
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
