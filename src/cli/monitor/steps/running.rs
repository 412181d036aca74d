//! A monitor that has begun: rows in, outputs out, and its state.
use super::*;

impl Running {
    pub(super) fn push(&mut self, row: &Row) -> anyhow::Result<Vec<Output>> {
        let readings: Vec<f64> = self.selection.readings(row).collect();
        let outputs = self.monitor.step(row.time_s, &readings)?;
        self.last_stamp_s = row.time_s;
        self.seen.row(row.time_s);
        Ok(outputs)
    }

    /// Adds outputs to what comes out.
    pub(super) fn tell(&mut self, outputs: Vec<Output>, out: &mut Out) -> anyhow::Result<()> {
        for output in outputs {
            self.naming.clock.note(output.estimate.time_s, output.stamp_s);
            self.seen.output(&output);
            out.told.extend(course::told(&output, &self.naming));
            if out.wanted == RowsWanted::Every {
                self.keep(&output, out)?;
            }
            self.last = Some(output);
        }
        Ok(())
    }

    /// Adds an output as a row.
    pub(super) fn keep(&mut self, output: &Output, out: &mut Out) -> anyhow::Result<()> {
        let leak_pa_s = output.estimate.leak_kg_s * self.slope.at(output.estimate.mass_kg)?;
        out.rows.keep(&MonitorRow::new(output, leak_pa_s, &self.naming.clock), &mut out.table);
        Ok(())
    }

    pub(super) fn state(&self) -> anyhow::Result<State> {
        Ok(State {
            table: None,
            identity: self.identity.clone(),
            origin: self.origin.map(|origin| origin.to_string()),
            clock: self.naming.clock.shown().clone(),
            last_stamp_s: self.last_stamp_s,
            log_starts_s: self.log_starts_s.clone(),
            full_pa: self.full_pa,
            settled: self.settled,
            stated: self.stated,
            last: self.last.clone(),
            monitor: self.monitor.save()?,
        })
    }
}
