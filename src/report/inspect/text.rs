//! An inspection in words and tables for a terminal, and as a report for a page: the same parts, but command lines are
//! not broken in a terminal, where they are copied from.
use crate::log::Packing;
use crate::log::inspect::{ColumnReport, Inspection, Role, Times, Use};
use crate::report::Clock;
use crate::report::estimate::duration;
use crate::report::table::hanging;
use crate::report::{Report, aligned, number, quoted};

/// Longest name in a table, letters.
const NAME: usize = 26;
/// Significant digits of a value.
const DIGITS: usize = 6;
/// Jumps, gaps and cautions of one kind that are listed.
const MAX_LISTED: usize = 12;

/// All of it.
pub(crate) fn text(inspection: &Inspection) -> String {
    let mut text = format!("{}: {}\n", inspection.name, form(inspection));
    text.push('\n');
    for (what, words) in times(&inspection.times) {
        for (k, line) in words.lines().enumerate() {
            text.push_str(&format!("{:10}  {line}\n", if k == 0 { what } else { "" }));
        }
    }
    text.push('\n');
    text.push_str(&aligned(&COLUMNS, &columns(&inspection.columns)));
    for (title, items) in lists(inspection) {
        list(&mut text, title, &items);
    }
    text.push_str("\nwhat can be done with it\n");
    let refused: Vec<&str> = inspection.refusals.iter().map(|refusal| refusal.message.as_str()).collect();
    inspection.uses.iter().for_each(|one| text.push_str(&usage(one, &refused)));
    text.push_str(&format!("  {VESSEL}\n"));
    text
}

/// What stands below the command lines.
const VESSEL: &str = "In place of nitrogen-20l write your own vessel file, see `cylwatch init`.";

/// The same for a page.
pub(crate) fn summary(inspection: &Inspection) -> Report {
    let facts = std::iter::once(("form", form(inspection))).chain(times(&inspection.times));
    let mut report = Report::new(format!("The log {}", inspection.name))
        .facts(facts)
        .heading("Columns")
        .rows("", &COLUMNS, columns(&inspection.columns));
    for (title, items) in lists(inspection).into_iter().filter(|(_, items)| !items.is_empty()) {
        let rows = items.into_iter().map(|item| vec![item]).collect();
        report = report.rows::<&str>(title, &[], rows);
    }
    let row = |one: &Use| {
        let line: Vec<String> = one.line.iter().map(|word| quoted(word)).collect();
        let can = match (one.lacks.is_empty(), one.but.is_empty()) {
            (false, _) => format!("no, it lacks {}", one.lacks.join("; ")),
            (true, false) => format!("yes, but {}", one.but.join("; ")),
            (true, true) => "yes".to_owned(),
        };
        vec![one.command.to_owned(), can, if one.lacks.is_empty() { line.join(" ") } else { String::new() }]
    };
    let uses = inspection.uses.iter().map(row).collect();
    report.heading("What can be done with it").explained_rows(
        "",
        &["command", "possible", "line"],
        uses,
        VESSEL,
    )
}

/// What is proposed, refused, cautioned about and odd, with titles.
fn lists(inspection: &Inspection) -> [(&'static str, Vec<String>); 4] {
    let refused = inspection.refusals.iter().map(|refusal| match refusal.count {
        1 => refusal.message.clone(),
        count => format!("{} ({count} times)", refusal.message),
    });
    [
        ("proposed, look whether they are right", proposals(inspection)),
        ("a command would refuse it", refused.collect()),
        ("a command would caution", inspection.cautions.iter().map(ToString::to_string).collect()),
        ("odd", inspection.oddities.clone()),
    ]
}

fn form(inspection: &Inspection) -> String {
    let form = &inspection.form;
    let mut words = vec![match (form.is_parquet, form.separator) {
        (true, _) => "Parquet",
        (false, ';') => "semicolons",
        (false, '\t') => "tabs",
        (false, _) => "commas",
    }];
    if !form.is_parquet {
        words.push(if form.decimal_comma { "decimal comma" } else { "decimal point" });
        words.push(form.encoding);
        words.extend((form.packing == Packing::Gzip).then_some("gzip"));
    }
    let mut text = words.join(", ");
    if !form.is_parquet {
        text.push_str(&format!(", header in line {}", form.header_line));
    }
    match form.lines_above {
        0 => {}
        1 => text.push_str(", 1 line above it"),
        lines => text.push_str(&format!(", {lines} lines above it")),
    }
    text
}

fn times(times: &Times) -> Vec<(&'static str, String)> {
    let clock = Clock::new(times.origin, times.shown_zone.clone());
    let mut rows: Vec<(&'static str, String)> = Vec::new();
    let mut say = |what, words: String| rows.push((what, words));
    match (&times.column, &times.supposed) {
        (None, _) => say("time", "none found: rows are counted instead".to_owned()),
        (Some(column), Some(map)) => {
            say("time", format!("{column}, supposed: --map {}", quoted(&map.to_string())))
        }
        (Some(column), None) => say("time", column.clone()),
    }
    match (&times.zone, &times.supposed_zone) {
        (_, Some(zone)) => say("zone", format!("supposed, by where the clock goes back: --zone {zone}")),
        (Some(zone), None) => say("zone", zone.clone()),
        (None, None) => {}
    }
    if times.rows > 0 && times.column.is_some() {
        let (from, to) = times.span_s;
        say("from, to", format!("{}, {}", clock.text(from), clock.text(to)));
        say("length", format!("{}, {} rows", duration(to - from), times.rows));
    } else {
        say("length", format!("{} rows", times.rows));
    }
    if times.interval_s.is_finite() && times.column.is_some() {
        let (usual, jitter) = (duration(times.interval_s), duration(times.jitter_s));
        say("interval", format!("median {usual}, 90 of 100 within {jitter} of each other"));
        let gap = |gap: &crate::log::inspect::Interval| {
            format!("{} from {} on (line {})", duration(gap.length_s), clock.text(gap.begin_s), gap.line)
        };
        let gaps: Vec<String> = times.gaps.iter().take(MAX_LISTED).map(gap).collect();
        say("gaps", if gaps.is_empty() { "none".to_owned() } else { gaps.join("\n") });
    }
    if let (count @ 1.., Some(first)) = times.steps_back {
        say(
            "steps back",
            format!("{count}, the first by {} in line {}", duration(-first.length_s), first.line),
        );
    }
    rows
}

const COLUMNS: [&str; 9] = ["column", "taken for", "values", "empty", "min", "median", "max", "step", "run"];

fn columns(columns: &[ColumnReport]) -> Vec<Vec<String>> {
    let row = |column: &ColumnReport| {
        let (numbers, missing, others) = column.cells;
        let all = (numbers + missing + others).max(1);
        let empty = format!("{} %", number(100.0 * missing as f64 / all as f64, 3));
        let mut cells = vec![short(&column.header), role(&column.role), numbers.to_string(), empty];
        if !column.has_numbers() || column.role == Role::Time {
            if let Some(text) = column.text.as_ref().filter(|_| column.role != Role::Time) {
                cells[1].push_str(&format!(", as {text}"));
            }
            cells.extend(std::iter::repeat_n(String::new(), 5));
            return cells;
        }
        cells.extend(column.range.map(|value| number(value, DIGITS)));
        cells.push(if column.step.is_finite() { number(column.step, 3) } else { "none".to_owned() });
        cells.push(column.longest.count.to_string());
        cells
    };
    columns.iter().map(row).collect()
}

fn role(role: &Role) -> String {
    match role {
        Role::Time => "time".to_owned(),
        Role::Reading(name, unit) => format!("{name}, {unit}"),
        Role::Truth(name, unit) => format!("{name}, {unit} (true)"),
        Role::Simulated => "true, not read".to_owned(),
        Role::Aside => "set aside".to_owned(),
    }
}

fn proposals(inspection: &Inspection) -> Vec<String> {
    let of_time = inspection.times.supposed.iter().map(|map| format!("--map {}", quoted(&map.to_string())));
    let of_columns = inspection
        .columns
        .iter()
        .filter_map(|column| column.proposal.as_ref())
        .map(|proposal| format!("--map {}  {}", quoted(&proposal.mapping.to_string()), proposal.reason));
    of_time.chain(of_columns).collect()
}

/// `refused`: what is said above.
fn usage(usage: &Use, refused: &[&str]) -> String {
    let Use { command, lacks, but, line } = usage;
    let mut text = format!("  {command:10}");
    if lacks.is_empty() {
        text.push_str(if but.is_empty() { "yes\n" } else { "yes, but\n" });
        but.iter().for_each(|words| text.push_str(&hanging(words, "    - ", "      ")));
        let line: Vec<String> = line.iter().map(|word| quoted(word)).collect();
        text.push_str(&format!("    {}\n", line.join(" ")));
    } else {
        let (above, own): (Vec<&String>, Vec<&String>) =
            lacks.iter().partition(|words| refused.contains(&words.as_str()));
        text.push_str(match (above.is_empty(), own.is_empty()) {
            (true, _) => "no, it lacks\n",
            (false, true) => "no, it would refuse the log, see above\n",
            (false, false) => "no, it would refuse the log, see above, and it lacks\n",
        });
        own.iter().for_each(|words| text.push_str(&hanging(words, "    - ", "      ")));
    }
    text
}

fn list(text: &mut String, title: &str, items: &[String]) {
    if items.is_empty() {
        return;
    }
    text.push_str(&format!("\n{title}\n"));
    for item in items.iter().take(MAX_LISTED) {
        text.push_str(&hanging(item, "  ", "    "));
    }
    if items.len() > MAX_LISTED {
        text.push_str(&format!("  and {} more, all of them with --format json\n", items.len() - MAX_LISTED));
    }
}

/// A name that fits the table.
fn short(name: &str) -> String {
    let shown: String = name.chars().flat_map(char::escape_debug).collect();
    match shown.chars().count() {
        0 => "\"\"".to_owned(),
        1..=NAME => shown,
        _ => shown.chars().take(NAME - 3).collect::<String>() + "...",
    }
}
