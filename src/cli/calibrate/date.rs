//! The date that a vessel file records.
use anyhow::Context;
use jiff::Timestamp;

/// Variable of reproducible builds: seconds since 1970.
const EPOCH: &str = "SOURCE_DATE_EPOCH";

/// What was given, else what the environment says, else now; in UTC.
pub(super) fn date(given: Option<&str>) -> anyhow::Result<String> {
    let of_text = |text: &str| {
        text.parse::<Timestamp>()
            .ok()
            .with_context(|| format!("--date {text}: write date, time and zone, as 2026-03-01T12:00:00Z"))
    };
    let of_seconds = |seconds: &str| {
        let timestamp = seconds.parse().ok().and_then(|seconds| Timestamp::from_second(seconds).ok());
        timestamp.with_context(|| {
            format!("{EPOCH} = {seconds} must be whole seconds since 1970: unset it, or correct it")
        })
    };
    let timestamp = match (given, std::env::var(EPOCH)) {
        (Some(text), _) => of_text(text)?,
        (None, Ok(seconds)) => of_seconds(&seconds)?,
        (None, Err(_)) => Timestamp::now(),
    };
    // A fraction of a second says nothing here.
    Ok(Timestamp::from_second(timestamp.as_second()).unwrap_or(timestamp).to_string())
}
