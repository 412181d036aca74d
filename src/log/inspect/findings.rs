//! From the counts to the inspection: columns, times, oddities.
use super::column::Column;
use super::proposal::propose;
use super::*;
use crate::log::Kind;
use crate::log::columns::{self, TimeForm, TruthQuantity};
use crate::log::label::Label;

/// An interval longer than this many usual ones is a gap.
const GAP: f64 = 5.0;
/// Share of empty cells from which on a column is named.
const MISSING_SHARE: f64 = 0.2;
/// A value that stays for longer than this, s, is named.
const LONG_RUN_S: f64 = 6.0 * 3600.0;

impl Inspector {
    /// What came out.
    pub fn finish(mut self) -> Inspection {
        let times = self.times();
        let mut columns = self.columns();
        propose(&mut columns);
        if times.supposed.is_some() || columns.iter().any(|column| column.proposal.is_some()) {
            // The proposals mend a header without time or readings.
            self.refusals.retain(|refusal| !refusal.message.contains("there is no column"));
        }
        let oddities = oddities(&times, &columns);
        let contradicted = self.reader.cautions().iter().find(|caution| caution.kind == Kind::Contradicted);
        if let Some(caution) = contradicted {
            let message =
                format!("{}: the row has the time of the one above and says something else", caution.first);
            self.refusals.push(Refusal { message, count: caution.count, monitor_takes_it: true });
        }
        if let (count @ 1.., Some(first), None) =
            (times.steps_back.0, times.steps_back.1, &times.supposed_zone)
        {
            let message = format!(
                "{}:{}: the time is {} s before that of the row above: sort the rows by time, and look for a clock that \
                 was set back",
                self.name, first.line, -first.length_s
            );
            self.refusals.push(Refusal { message, count, monitor_takes_it: true });
        }
        let survey = &self.survey;
        let form = Form {
            separator: char::from(survey.separator),
            decimal_comma: self.counts().iter().any(|column| column.with_comma > 0),
            encoding: if survey.is_windows_1252 { "Windows-1252" } else { "UTF-8" },
            packing: survey.packing,
            is_parquet: self.is_parquet,
            header_line: survey.header_line,
            lines_above: survey.lines_above,
        };
        let uses = uses::uses(&self.name, &self.options, &times, &columns, &self.refusals);
        // What the proposals mend is no caution any more.
        let is_mended = |caution: &&Caution| match caution.kind {
            Kind::WithoutZone => times.supposed_zone.is_some(),
            Kind::SetAside => columns.iter().any(|column| column.proposal.is_some()),
            _ => false,
        };
        let cautions = self.reader.cautions().iter().filter(|caution| !is_mended(caution)).cloned().collect();
        Inspection {
            name: self.name,
            form,
            times,
            columns,
            refusals: self.refusals,
            cautions,
            oddities,
            uses,
        }
    }

    fn counts(&self) -> &[Column] {
        self.reader.tap().map_or(&[], |tap| &tap.columns)
    }

    fn times(&self) -> Times {
        let (sampling, time) = (self.reader.sampling(), &self.reader.columns().time);
        let clock = self.reader.tap().map(|tap| &tap.clock);
        let interval_s = clock.map_or(f64::NAN, |clock| clock.quantile(0.5));
        let jitter_s = clock.map_or(f64::NAN, |clock| clock.quantile(0.95) - clock.quantile(0.05));
        let without_zone = self.reader.cautions().iter().any(|caution| caution.kind == Kind::WithoutZone);
        let zone = (time.form == TimeForm::Date).then(|| match (&self.options.zone, without_zone) {
            (None, true) => "UTC, supposed".to_owned(),
            (None, false) => "in the file".to_owned(),
            (Some(zone), _) => format!("{zone}, unless the file says another"),
        });
        let steps_back = clock.map_or((0, None), |clock| (clock.steps_back, clock.first_back));
        let supposed_zone = match steps_back {
            (1, Some(back)) if without_zone => self.reader.origin_instant().and_then(|o| zone_of(o, &back)),
            _ => None,
        };
        Times {
            column: (time.form != TimeForm::Rows).then(|| time.header.clone()),
            supposed: self.survey.time.clone(),
            origin: self.reader.origin_instant(),
            zone,
            shown_zone: self.reader.zone().cloned(),
            supposed_zone,
            rows: sampling.rows(),
            span_s: sampling.span_s(),
            interval_s,
            jitter_s,
            gaps: clock.map_or_else(Vec::new, |clock| clock.above(GAP * interval_s)),
            steps_back,
        }
    }

    fn columns(&self) -> Vec<ColumnReport> {
        let found = self.reader.columns();
        let role = |index: usize| {
            let time = &found.time;
            if time.form != TimeForm::Rows && (index == time.index || Some(index) == time.clock) {
                return Role::Time;
            }
            let reading = found.readings.iter().find(|column| column.index == index);
            let truth = found.truth.iter().find(|column| column.index == index);
            match (reading, truth) {
                (Some(column), _) => Role::Reading(column.meaning.name.clone(), column.unit.suffix),
                (_, Some(column)) => Role::Truth(truth_name(column.meaning), column.unit.suffix),
                _ if columns::is_ours(&Label::of(&self.survey.names[index]).own(), &[]) => Role::Simulated,
                _ => Role::Aside,
            }
        };
        let report = |(index, (header, counts)): (usize, (&String, &Column))| ColumnReport {
            header: header.clone(),
            role: role(index),
            unit: Label::of(header).unit.map(str::to_owned),
            cells: (counts.numbers, counts.missing, counts.others),
            text: counts.text.clone(),
            range: match counts.numbers {
                0 => [f64::NAN; 3],
                _ => [counts.low, counts.median(), counts.high],
            },
            step: counts.step(),
            longest: counts.longest,
            jumps: counts.jumps(),
            proposal: None,
        };
        self.survey.names.iter().zip(self.counts()).enumerate().map(report).collect()
    }
}

fn truth_name(truth: TruthQuantity) -> &'static str {
    match truth {
        TruthQuantity::GasMean => "gas_mean",
        TruthQuantity::Mass => "mass",
        TruthQuantity::Outflow => "outflow",
    }
}

/// Whether a column is a pressure, or is proposed as one.
fn is_pressure(column: &ColumnReport) -> bool {
    let proposed = column.proposal.as_ref().map(|proposal| &proposal.mapping.ours);
    column.role.quantity().as_ref().or(proposed).is_some_and(|name| name.starts_with("pressure"))
}

/// Zones whose clocks go back at local times of their own, the last in all of North America.
const ZONES: [&str; 4] = ["Europe/Berlin", "Europe/London", "Europe/Athens", "America/New_York"];

/// The zone whose clock goes back where that of a log does, whose local times count as UTC.
fn zone_of(origin: jiff::Timestamp, back: &Interval) -> Option<Zone> {
    let local = |time_s: f64| {
        let instant = origin.checked_add(jiff::SignedDuration::from_secs_f64(time_s)).ok()?;
        Some(jiff::tz::Offset::UTC.to_datetime(instant))
    };
    let (from, to) = (local(back.begin_s)?, local(back.begin_s + back.length_s)?);
    let zones = ZONES.iter().filter_map(|name| name.parse::<Zone>().ok());
    zones.into_iter().find(|zone| zone.goes_back(from, to))
}

/// What looks odd and costs no caution of the reader.
fn oddities(times: &Times, columns: &[ColumnReport]) -> Vec<String> {
    let mut said = Vec::new();
    let hours = times.gaps.iter().chain(&times.steps_back.1);
    if let Some(hour) = hours.into_iter().find(|interval| interval.is_summer_time(times.interval_s)) {
        let remedy = match &times.supposed_zone {
            Some(zone) => format!("as in {zone}; another place with the same summer time does as well"),
            None => "say its zone, as --zone Europe/Berlin".to_owned(),
        };
        said.push(format!(
            "line {}: the clock is set by an hour: a local time with summer time; {remedy}",
            hour.line
        ));
    }
    for column in columns.iter().filter(|column| !matches!(column.role, Role::Time | Role::Simulated)) {
        let header = &column.header;
        let (numbers, missing, _) = column.cells;
        if numbers > 0 && missing as f64 > MISSING_SHARE * (numbers + missing) as f64 {
            let percent = 100.0 * missing as f64 / (numbers + missing) as f64;
            said.push(format!("{header}: {percent:.0} % of the cells are empty"));
        }
        let run = column.longest;
        if run.count > 30 && run.duration_s > LONG_RUN_S && column.range[0] < column.range[2] {
            let hours = run.duration_s / 3600.0;
            let (line, value) = (run.line, run.value);
            said.push(format!(
                "{header}: stays at {value} for {hours:.1} h from line {line} on; stuck, or at rest"
            ));
        }
        // A tunnel moves thermometers at once, and they stay.
        let is_pressure = is_pressure(column);
        for jump in column.jumps.iter().filter(|jump| jump.is_spike || is_pressure) {
            let Jump { line, from, to, is_spike } = jump;
            let word = if *is_spike { "a spike" } else { "a jump" };
            said.push(format!("{header}: {word} from {from} to {to} at line {line}"));
        }
    }
    said
}
