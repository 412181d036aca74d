//! The text, read by a strict reader of the format.
use super::*;
use crate::cli::serve::config::Page;
use crate::cli::serve::http::limits::Limit;
use crate::cli::serve::mapping::Refusal;
use crate::cli::serve::status::{Status, Turn};
use std::collections::BTreeMap;
use std::sync::Arc;
use std::time::{Duration, Instant};

fn site(folder: &Path) -> Site {
    let page = Page { listen: ([127, 0, 0, 1], 0).into(), token: None, tls: None, host_names: Vec::new() };
    let origin = Provenance { command: String::new(), inputs: Vec::new(), seed: None };
    Site::new(page, Arc::new(Status::default()), folder.to_owned(), origin)
}

/// Name, labels and value of a sample.
type Sample = (String, Vec<(String, String)>, f64);

fn is_name(name: &str) -> bool {
    let starts = name.starts_with(|letter: char| letter.is_ascii_alphabetic() || letter == '_');
    starts && name.chars().all(|letter| letter.is_ascii_alphanumeric() || letter == '_')
}

fn sample(line: &str) -> Sample {
    let (head, value) = line.rsplit_once(' ').unwrap();
    let (name, labels) = match head.split_once('{') {
        None => (head, Vec::new()),
        Some((name, rest)) => {
            let (label, value) = rest.strip_suffix("\"}").unwrap().split_once("=\"").unwrap();
            assert!(is_name(label) && !value.contains(['"', '\\', '\n']), "{line}");
            (name, vec![(label.to_owned(), value.to_owned())])
        }
    };
    assert!(is_name(name) && name.starts_with("cylwatch_"), "{line}");
    (name.to_owned(), labels, value.parse().unwrap())
}

/// Samples by their families. Each family stands once, HELP and TYPE first; histograms have sorted buckets that do not fall, `+Inf`, sum and count.
fn read(text: &str) -> BTreeMap<String, Vec<Sample>> {
    assert!(text.ends_with('\n'));
    let mut families: BTreeMap<String, Vec<Sample>> = BTreeMap::new();
    let mut lines = text.lines().peekable();
    while let Some(line) = lines.next() {
        let (name, help) = line.strip_prefix("# HELP ").unwrap().split_once(' ').unwrap();
        let kind = lines.next().unwrap().strip_prefix(&format!("# TYPE {name} ")).unwrap();
        assert!(help.ends_with('.') && ["counter", "gauge", "histogram"].contains(&kind), "{line}");
        assert_eq!(kind == "counter", name.ends_with("_total"), "{line}");
        let mut samples = Vec::new();
        while let Some(line) = lines.next_if(|line| !line.starts_with('#')) {
            samples.push(sample(line));
        }
        if kind == "histogram" {
            is_histogram(name, &samples);
        } else {
            assert!(samples.iter().all(|(of, _, _)| of == name), "{samples:?}");
        }
        assert!(families.insert(name.to_owned(), samples).is_none(), "{name} stands twice");
    }
    families
}

fn is_histogram(name: &str, samples: &[Sample]) {
    let (buckets, rest) = samples.split_at(samples.len() - 2);
    let bounds: Vec<f64> =
        buckets.iter().map(|(_, labels, _)| labels[0].1.replace('+', "").parse().unwrap()).collect();
    assert!(buckets.iter().all(|(of, labels, _)| *of == format!("{name}_bucket") && labels[0].0 == "le"));
    assert!(bounds.is_sorted_by(|a, b| a < b) && bounds.last() == Some(&f64::INFINITY), "{bounds:?}");
    assert_eq!(buckets.last().unwrap().1[0].1, "+Inf");
    assert!(buckets.is_sorted_by(|a, b| a.2 <= b.2), "{buckets:?}");
    assert_eq!([&rest[0].0, &rest[1].0], [&format!("{name}_sum"), &format!("{name}_count")]);
    assert_eq!(buckets.last().unwrap().2, rest[1].2);
}

#[test]
fn the_text_is_of_the_format_and_has_every_count() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("1.rows"), [0; 1234]).unwrap();
    let site = site(folder.path());
    let status = &site.status;
    status.turn(&Turn {
        cylinders: 7,
        outbox: 5,
        is_connected: true,
        is_writable: false,
        most_silent: Some(Instant::now()),
    });
    (0..3).for_each(|_| status.row(0));
    (0..2).for_each(|_| status.refused(Refusal::NoJson));
    status.step.observe(Duration::from_micros(30));
    status.publish.observe(Duration::from_secs(100));
    site.counts.answer(200);
    site.counts.refuse(Limit::Host);
    let families = read(&text(&site));
    let value = |name: &str, of: &str| {
        let is = |(sample, labels, _): &&Sample| {
            *sample == format!("cylwatch_{name}") && labels.iter().all(|(_, value)| value == of)
        };
        let family = families.values().flatten().find(is);
        family.unwrap_or_else(|| panic!("{name} {of} is missing")).2
    };
    for (name, of, expected) in [
        ("cylinders", "", 7.0),
        ("outbox_messages", "", 5.0),
        ("broker_connected", "", 1.0),
        ("disk_writable", "", 0.0),
        ("rows_total", "", 3.0),
        ("messages_refused_total", "no_json", 2.0),
        ("messages_refused_total", "again", 0.0),
        ("journal_bytes", "", 1234.0),
        ("step_seconds_bucket", "0.00002", 0.0),
        ("step_seconds_bucket", "0.00005", 1.0),
        ("publish_seconds_bucket", "10", 0.0),
        ("publish_seconds_bucket", "+Inf", 1.0),
        ("publish_seconds_sum", "", 100.0),
        ("journal_write_seconds_count", "", 0.0),
        ("http_responses_total", "200", 1.0),
        ("http_refused_total", "host", 1.0),
        ("http_refused_total", "streams", 0.0),
        ("build_info", Provenance::VERSION, 1.0),
    ] {
        assert_eq!(value(name, of), expected, "{name} {of}");
    }
    assert_eq!(families["cylwatch_messages_refused_total"].len(), Refusal::ALL.len());
    assert!(value("newest_row_age_seconds", "") > 1.7e9 && value("most_silent_seconds", "") < 60.0);
}

#[test]
fn what_would_end_a_label_or_a_line_is_escaped() {
    let mut text = Text::default();
    text.one("x", "gauge", "a\\b\nc.", 1);
    text.sample("x", Some(("l", "a\"b\\c\nd")), 2);
    let expected = "# HELP cylwatch_x a\\\\b\\nc.\n# TYPE cylwatch_x gauge\ncylwatch_x 1\ncylwatch_x{l=\"a\\\"b\\\\c\\nd\"} 2\n";
    assert_eq!(text.0, expected);
}
