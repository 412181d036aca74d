//! What a cylinder is monitored by: its vessel and options, as a call of `monitor`.
use super::Checked;
use crate::cli::fleet::{as_columns, vessel_beside};
use crate::cli::monitor::Steps;
use crate::cli::monitor_steps;
use crate::cli::serve::document::OptionsTable;
use crate::report::Input;
use anyhow::anyhow;
use serde_json::Value;
use std::collections::BTreeMap;
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// The call of `monitor` for a cylinder, and when it is silent.
#[derive(Clone, PartialEq)]
pub(in crate::cli::serve) struct Assigned {
    call: Vec<OsString>,
    /// SHA-256 of the files that it names: they may change while the gateway runs.
    files: Vec<String>,
    pub silent_after: Duration,
}

impl Assigned {
    /// Of tables at their paths; a later one counts more.
    pub(super) fn new(
        vessel: &str,
        tables: &[(String, &OptionsTable)],
        silent_after: Duration,
        checked: &Checked<'_>,
    ) -> anyhow::Result<Self> {
        let mut words: BTreeMap<String, String> = BTreeMap::new();
        let vessel = vessel_beside(checked.folder, vessel);
        let mut files = vec![PathBuf::from(&vessel)];
        for (path, table) in tables {
            let Value::Object(values) = serde_json::to_value(table)? else { continue };
            for (field, value) in values {
                files.extend(value.as_str().map(|file| checked.folder.join(file)));
                match checked.word(&format!("{path}.{field}"), &value) {
                    Some(word) => _ = words.insert(field, word),
                    None if value == Value::Bool(false) => _ = words.remove(&field),
                    None => {}
                }
            }
        }
        let call = ["monitor".into(), vessel.into(), "<messages>".into()];
        let call = call.into_iter().chain(words.into_values().map(OsString::from)).collect();
        // A vessel of the program is no file.
        let files = files.iter().filter_map(|file| std::fs::read(file).ok());
        let files = files.map(|bytes| Input::of("", &bytes).sha256).collect();
        Ok(Self { call, files, silent_after })
    }

    /// The vessel as it is named, without its folder.
    pub(in crate::cli::serve) fn vessel(&self) -> String {
        let name = self.call.get(1).and_then(|vessel| Path::new(vessel).file_name());
        name.map(|name| name.to_string_lossy().into_owned()).unwrap_or_default()
    }

    /// A monitor that has not begun.
    pub(in crate::cli::serve) fn monitor(&self) -> anyhow::Result<Steps> {
        monitor_steps(&self.call, Vec::new())
            .map_err(|error| anyhow!("{}", as_columns(&format!("{error:#}"))))
    }
}
