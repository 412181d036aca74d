//! Counts and gauges in the text format of Prometheus, version 0.0.4. No label has the name of a cylinder: there is no end of them.
use super::Site;
use crate::cli::serve::status::{BOUNDS_S, Histogram};
use crate::report::Provenance;
use std::fmt::{Display, Write};
use std::path::Path;

/// Content type.
pub(super) const FORMAT: &str = "text/plain; version=0.0.4; charset=utf-8";

/// The text while it is written.
#[derive(Default)]
struct Text(String);

impl Text {
    fn family(&mut self, name: &str, kind: &str, help: &str) {
        // Nothing fails to be written to a string.
        _ = writeln!(self.0, "# HELP cylwatch_{name} {}", help.replace('\\', "\\\\").replace('\n', "\\n"));
        _ = writeln!(self.0, "# TYPE cylwatch_{name} {kind}");
    }

    fn sample(&mut self, name: &str, label: Option<(&str, &str)>, value: impl Display) {
        _ = match label {
            None => writeln!(self.0, "cylwatch_{name} {value}"),
            Some((label, of)) => writeln!(self.0, "cylwatch_{name}{{{label}=\"{}\"}} {value}", escaped(of)),
        };
    }

    fn one(&mut self, name: &str, kind: &str, help: &str, value: impl Display) {
        self.family(name, kind, help);
        self.sample(name, None, value);
    }

    fn by_label(&mut self, name: &str, help: &str, label: &str, counts: impl Iterator<Item = (String, u64)>) {
        self.family(name, "counter", help);
        counts.for_each(|(of, count)| self.sample(name, Some((label, &of)), count));
    }

    fn histogram(&mut self, name: &str, help: &str, histogram: &Histogram) {
        self.family(name, "histogram", help);
        let counts = histogram.cumulative();
        let bounds = BOUNDS_S.iter().map(ToString::to_string).chain(["+Inf".to_owned()]);
        for (bound, count) in bounds.zip(counts) {
            self.sample(&format!("{name}_bucket"), Some(("le", &bound)), count);
        }
        self.sample(&format!("{name}_sum"), None, histogram.sum_s());
        self.sample(&format!("{name}_count"), None, counts[BOUNDS_S.len()]);
    }
}

fn escaped(value: &str) -> String {
    value.replace('\\', "\\\\").replace('"', "\\\"").replace('\n', "\\n")
}

/// Bytes of the files of a folder.
fn bytes(folder: &Path) -> u64 {
    let files = std::fs::read_dir(folder).into_iter().flatten().flatten();
    files.filter_map(|file| file.metadata().ok()).map(|file| file.len()).sum()
}

/// All of it.
pub(super) fn text(site: &Site) -> String {
    let mut text = Text::default();
    gateway(site, &mut text);
    let counts = &site.counts;
    text.by_label(
        "http_responses_total",
        "Answers over HTTP by status.",
        "status",
        counts.answered().into_iter().map(|(status, count)| (status.to_string(), count)),
    );
    text.by_label(
        "http_refused_total",
        "Connections and requests over HTTP that were refused, by limit.",
        "limit",
        counts.refused().map(|(limit, count)| (limit.label().to_owned(), count)),
    );
    text.0
}

fn gateway(site: &Site, text: &mut Text) {
    let status = &site.status;
    text.family("build_info", "gauge", "Version of the program.");
    text.sample("build_info", Some(("version", Provenance::VERSION)), 1);
    let started_s = status.started.as_millisecond() as f64 / 1e3;
    text.one("start_time_seconds", "gauge", "Start of the gateway, since 1970.", started_s);
    text.one("rows_total", "counter", "Rows that were taken in.", status.rows.count());
    text.by_label(
        "messages_refused_total",
        "Messages that were left out, by reason.",
        "reason",
        status.refusals().into_iter().map(|(refusal, count)| (refusal.label().to_owned(), count)),
    );
    text.one("cylinders", "gauge", "Cylinders that have a monitor.", status.cylinders());
    text.one(
        "newest_row_age_seconds",
        "gauge",
        "Age of the newest row by its own time; not a number before the first row.",
        status.newest_row_age_s().unwrap_or(f64::NAN),
    );
    text.one(
        "most_silent_seconds",
        "gauge",
        "Time since the last row of the most silent cylinder.",
        status.most_silent_s(),
    );
    text.histogram("step_seconds", "Time that a row takes in its monitor.", &status.step);
    text.histogram("journal_write_seconds", "Time until rows are in the journal, on disk.", &status.journal);
    text.histogram(
        "publish_seconds",
        "Time from a message until what it leads to is handed to the connection.",
        &status.publish,
    );
    text.one("states_saved_total", "counter", "States that were saved.", status.states_saved.count());
    text.one(
        "states_failed_total",
        "counter",
        "States that could not be saved.",
        status.states_failed.count(),
    );
    text.one("journal_bytes", "gauge", "Bytes of the journal on disk.", bytes(&site.journal));
    text.one("outbox_messages", "gauge", "Messages that have not arrived at the broker.", status.outbox());
    text.one(
        "broker_connected",
        "gauge",
        "Whether the broker is connected.",
        u8::from(status.is_connected()),
    );
    text.one("disk_writable", "gauge", "Whether the disk can be written.", u8::from(status.is_writable()));
}

#[cfg(test)]
mod tests;
