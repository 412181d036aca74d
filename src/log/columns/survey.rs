//! The columns of a log that is inspected: what there is, also where a run would refuse it.
use super::*;

/// What the columns mean, and why a run would refuse them. Columns that are wrong are taken for unknown; without a time the
/// rows are counted.
///
/// # Errors
/// A mapping that cannot be.
pub(in crate::log) fn survey(
    names: &[String],
    at: &str,
    options: &LogOptions,
    cautions: &mut Cautions,
) -> Result<(Columns, Option<LogError>), LogError> {
    let before = cautions.clone();
    let refusal = match Columns::find(names, at, options, cautions) {
        Ok(columns) => return Ok((columns, None)),
        Err(refusal @ LogError::Mapping { .. }) => return Err(refusal),
        Err(refusal) => refusal,
    };
    *cautions = before;
    let mut found = found(names, at, options, |_| Ok(Meaning::Unknown))?;
    pair(&mut found);
    set_aside(&found, at, options, cautions);
    let none = TimeColumn { index: 0, header: "row".to_owned(), form: TimeForm::Rows, clock: None };
    let columns = Columns {
        time: time(&found, at).unwrap_or(none),
        readings: readings(&found, at, options, cautions).unwrap_or_default(),
        truth: truth(&found, at).unwrap_or_default(),
    };
    Ok((columns, Some(refusal)))
}
