//! Where a message has its readings and its time, as JSON or as Sparkplug B.
use super::Checked;
use crate::cli::serve::document::{PayloadFormat, PayloadTable, ReadingTable, TimeForm};
use crate::cli::serve::mapping::Reading;
use anyhow::bail;
use std::collections::BTreeSet;

impl Checked<'_> {
    /// Readings with their places; the time is checked with them.
    pub(super) fn readings(&self, table: &PayloadTable) -> anyhow::Result<Vec<Reading>> {
        self.time(table)?;
        let format = table.format.unwrap_or_default();
        let mut names = BTreeSet::new();
        let mut readings = Vec::new();
        for (i, reading) in table.reading.iter().enumerate() {
            let path = format!("payload.reading[{i}]");
            let at = match format {
                PayloadFormat::Json => self.pointer(&path, reading)?,
                PayloadFormat::SparkplugB => self.metric(&path, reading)?,
            };
            if !names.insert(&reading.name) {
                self.refuse(&format!("{path}.name"), &reading.name, "named once", "leave one out")?;
            }
            readings.push(Reading { name: reading.name.clone(), at });
        }
        Ok(readings)
    }

    /// The place of a cylinder in Sparkplug.
    pub(super) fn place(&self, format: PayloadFormat, path: &str, topic: &str) -> anyhow::Result<()> {
        let levels = topic.split('/').count();
        if format == PayloadFormat::SparkplugB
            && (!(2..=3).contains(&levels) || topic.starts_with("spBv1.0/"))
        {
            self.refuse(
                path,
                topic,
                "GROUP/NODE or GROUP/NODE/DEVICE",
                "leave out the namespace and the type of the message",
            )?;
        }
        Ok(())
    }

    fn time(&self, table: &PayloadTable) -> anyhow::Result<()> {
        match (table.format.unwrap_or_default(), &table.time, table.clock) {
            (PayloadFormat::SparkplugB, None, None) => Ok(()),
            (PayloadFormat::SparkplugB, _, _) => bail!(
                "{}: payload time and clock are of JSON: leave them out, Sparkplug B has times of its own",
                self.at("payload")
            ),
            (PayloadFormat::Json, Some(time), _) => self.begins(time, "payload.time"),
            (PayloadFormat::Json, None, Some(TimeForm::Arrival)) => Ok(()),
            (PayloadFormat::Json, None, _) => bail!(
                "{}: payload time is missing: name its JSON pointer, or write clock = \"arrival\"",
                self.at("payload")
            ),
        }
    }

    fn begins(&self, pointer: &str, path: &str) -> anyhow::Result<()> {
        if pointer.starts_with('/') {
            return Ok(());
        }
        self.refuse(path, pointer, "a JSON pointer", "begin it with /, as in /data/p")
    }

    fn pointer(&self, path: &str, reading: &ReadingTable) -> anyhow::Result<String> {
        match (&reading.at, &reading.metric) {
            (Some(at), None) => self.begins(at, &format!("{path}.at")).map(|()| at.clone()),
            (_, Some(_)) => bail!(
                "{}: a metric is of Sparkplug B: write format = \"sparkplug-b\" in [payload], or a JSON pointer in at",
                self.at(&format!("{path}.metric"))
            ),
            (None, None) => {
                bail!("{}: {} has no place: name its JSON pointer in at", self.at(path), reading.name)
            }
        }
    }

    fn metric(&self, path: &str, reading: &ReadingTable) -> anyhow::Result<String> {
        match (&reading.metric, &reading.at) {
            (Some(metric), None) => Ok(metric.clone()),
            (_, Some(_)) => bail!(
                "{}: a JSON pointer is of JSON: name the metric in metric",
                self.at(&format!("{path}.at"))
            ),
            (None, None) => {
                bail!("{}: {} has no place: name its metric in metric", self.at(path), reading.name)
            }
        }
    }
}
