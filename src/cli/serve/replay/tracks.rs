//! Recorded logs as messages in the order of their times.
use super::payload::{Payload, written};
use crate::cli::fleet::{files, name_of};
use crate::cli::serve::mapping::Mapping;
use crate::estimator::log::Channel;
use crate::log::cylinders::{has_column, split};
use crate::log::{Cells, LogOptions, LogReader, MemoryLog};
use crate::thermal::units::{self, Unit};
use anyhow::{Context, bail};
use jiff::Timestamp;
use std::cmp::Reverse;
use std::collections::{BTreeSet, BinaryHeap};
use std::convert::Infallible;
use std::fs::File;
use std::path::{Path, PathBuf};

/// A reading of the configuration.
#[derive(Clone)]
struct Wanted {
    channel: Channel,
    unit: &'static Unit,
}

/// A log of a cylinder.
#[derive(Clone)]
struct Source {
    cylinder: String,
    topic: String,
    path: PathBuf,
    options: LogOptions,
}

/// Logs that can be played.
pub(super) struct Recording {
    sources: Vec<Source>,
    wanted: Vec<Wanted>,
    payload: Payload,
    /// Time of second 0 of logs without dates, since 1970, µs.
    zero_us: i64,
    pub cylinders: usize,
    pub rows: u64,
    /// First and last time, since 1970, µs.
    pub span_us: (i64, i64),
    /// What cannot be played of them.
    pub cautions: Vec<String>,
}

/// A message.
pub(super) struct Played {
    pub cylinder: String,
    pub topic: String,
    pub payload: String,
}

impl Recording {
    /// Reads logs, and the logs of folders, once from end to end.
    ///
    /// # Errors
    /// A log cannot be read, is of no cylinder, or has none of the readings; messages cannot be made in this form.
    pub(super) fn of(paths: &[PathBuf], mapping: &Mapping) -> anyhow::Result<Self> {
        let payload = Payload::of(mapping)?;
        let names: Vec<&str> = mapping.readings.iter().map(|reading| reading.name.as_str()).collect();
        let options = LogOptions {
            any_order: true,
            sensors: names.iter().filter_map(|name| Some(units::split(name)?.0.to_owned())).collect(),
            ..LogOptions::default()
        };
        let sources = sources(paths, mapping, &options)?;
        let mut recording = Self {
            wanted: wanted(&names, &options)?,
            payload,
            zero_us: 0,
            cylinders: sources.iter().map(|source| &source.cylinder).collect::<BTreeSet<_>>().len(),
            rows: 0,
            span_us: (i64::MAX, i64::MIN),
            cautions: Vec::new(),
            sources,
        };
        recording.survey()?;
        Ok(recording)
    }

    /// Counts rows, and finds out when they begin and end: logs without dates end now.
    fn survey(&mut self) -> anyhow::Result<()> {
        let (mut dated_us, mut second_us) = ((i64::MAX, i64::MIN), (i64::MAX, i64::MIN));
        let mut cautions = Vec::new();
        for source in &self.sources {
            let mut track = self.track(source)?;
            cautions.extend(track.caution.take());
            while let Some((time_us, _)) = track.next()? {
                let span_us = if track.reader.has_dates() { &mut dated_us } else { &mut second_us };
                *span_us = (span_us.0.min(time_us), span_us.1.max(time_us));
                self.rows += 1;
            }
            cautions.extend(track.reader.cautions().iter().map(ToString::to_string));
        }
        if second_us.0 <= second_us.1 {
            self.zero_us = Timestamp::now().as_second() * 1_000_000 - second_us.1;
            second_us = (second_us.0 + self.zero_us, second_us.1 + self.zero_us);
        }
        if self.rows == 0 {
            bail!("the logs have no row with one of the readings of the configuration");
        }
        self.span_us = (dated_us.0.min(second_us.0), dated_us.1.max(second_us.1));
        self.cautions = cautions;
        Ok(())
    }

    fn track(&self, source: &Source) -> anyhow::Result<Track> {
        let reader = LogReader::open(&source.path, &source.options)?;
        let at = |wanted: &Wanted| reader.channels().iter().position(|channel| *channel == wanted.channel);
        let places: Vec<_> = self.wanted.iter().map(|wanted| Some((at(wanted)?, wanted.unit))).collect();
        let used: BTreeSet<usize> = places.iter().flatten().map(|(at, _)| *at).collect();
        let shown = source.path.display();
        if used.is_empty() {
            bail!(
                "{shown}: no column is one of the readings of the configuration: name them in [[payload.reading]]"
            );
        }
        let names = reader.columns().readings.iter().enumerate();
        let left: Vec<&str> =
            names.filter(|(at, _)| !used.contains(at)).map(|(_, column)| column.header.as_str()).collect();
        let caution = (!left.is_empty()).then(|| {
            format!("{shown}: {} is no reading of the configuration, and is not played", left.join(", "))
        });
        let zero_us = if reader.has_dates() { 0 } else { self.zero_us };
        Ok(Track { source: source.clone(), reader, places, zero_us, caution })
    }

    /// The rows from the first on.
    pub(super) fn begin(&self) -> anyhow::Result<Tracks<'_>> {
        let mut tracks =
            Tracks { payload: &self.payload, tracks: Vec::new(), next: BinaryHeap::new(), rows: Vec::new() };
        for source in &self.sources {
            tracks.tracks.push(self.track(source)?);
            tracks.rows.push(Vec::new());
            tracks.fetch(tracks.tracks.len() - 1)?;
        }
        Ok(tracks)
    }
}

/// A log while it is read.
struct Track {
    source: Source,
    reader: LogReader,
    /// Where the readings of the configuration are in a row, and their units; `None`: the log has it not.
    places: Vec<Option<(usize, &'static Unit)>>,
    zero_us: i64,
    caution: Option<String>,
}

impl Track {
    /// The next row that has a reading: its time since 1970, µs, and its cells.
    fn next(&mut self) -> anyhow::Result<Option<(i64, Vec<f64>)>> {
        while let Some(row) = self.reader.next_row()? {
            let cell = |place: &Option<(usize, &'static Unit)>| {
                place.map_or(f64::NAN, |(at, unit)| match row.readings[at] {
                    missing if missing.is_nan() => missing,
                    si => written(unit, si),
                })
            };
            let cells: Vec<f64> = self.places.iter().map(cell).collect();
            let after_us = (row.time_s * 1e6).round() as i64;
            let origin_us =
                self.reader.origin_instant().map_or(self.zero_us, |origin| origin.as_microsecond());
            if cells.iter().any(|cell| !cell.is_nan()) {
                return Ok(Some((origin_us + after_us, cells)));
            }
        }
        Ok(None)
    }
}

/// Logs while they are played.
pub(super) struct Tracks<'a> {
    payload: &'a Payload,
    tracks: Vec<Track>,
    /// Times of the next rows of the tracks, the earliest first.
    next: BinaryHeap<Reverse<(i64, usize)>>,
    /// Cells of these.
    rows: Vec<Vec<f64>>,
}

impl Tracks<'_> {
    fn fetch(&mut self, at: usize) -> anyhow::Result<()> {
        if let Some((time_us, cells)) = self.tracks[at].next()? {
            self.next.push(Reverse((time_us, at)));
            self.rows[at] = cells;
        }
        Ok(())
    }

    /// Time of the next row since 1970, µs; `None`: there is none.
    pub(super) fn next_us(&self) -> Option<i64> {
        self.next.peek().map(|Reverse((time_us, _))| *time_us)
    }

    /// The next row as a message.
    pub(super) fn take(&mut self) -> anyhow::Result<Option<Played>> {
        let Some(Reverse((time_us, at))) = self.next.pop() else { return Ok(None) };
        let payload = self.payload.text(time_us, &self.rows[at]);
        self.fetch(at)?;
        let Source { cylinder, topic, .. } = &self.tracks[at].source;
        Ok(Some(Played { cylinder: cylinder.clone(), topic: topic.clone(), payload }))
    }
}

/// What the readings of the configuration are.
fn wanted(names: &[&str], options: &LogOptions) -> anyhow::Result<Vec<Wanted>> {
    let column = |name: &str| (name.to_owned(), Cells::Numbers(Vec::new()));
    let columns = ["time_s"].iter().chain(names).map(|name| column(name)).collect();
    let log = MemoryLog { name: "the configuration".to_owned(), columns };
    let reader = LogReader::from_memory(log, options)?;
    let find = |name: &&str| {
        let column = reader.columns().readings.iter().find(|column| column.header == **name);
        let column = column.with_context(|| format!("{name} is no column of a log that can be played"))?;
        Ok(Wanted { channel: column.meaning.clone(), unit: column.unit })
    };
    names.iter().map(find).collect()
}

fn sources(paths: &[PathBuf], mapping: &Mapping, options: &LogOptions) -> anyhow::Result<Vec<Source>> {
    let mut named = Vec::new();
    for path in paths {
        if path.is_dir() {
            let (files, faults) = files(path, &[])?;
            if let Some(fault) = faults.first() {
                bail!("{}: {}: {}", fault.file, fault.reason, fault.remedy);
            }
            named.extend(files);
        } else {
            named.push((path.clone(), None));
        }
    }
    let mut sources = Vec::new();
    for (path, of_folder) in named {
        let is_shared = of_folder.is_none() && has_column(&path, options)?;
        let cylinders = match of_folder {
            Some(name) => [name].into(),
            None if is_shared => cylinders(&path, options)?,
            None => [name_of(&path)].into(),
        };
        for cylinder in cylinders {
            let topic = mapping.topic(&cylinder).with_context(|| {
                format!(
                    "{}: the configuration has no topic for cylinder {cylinder}: add a [[cylinder]] or a [pattern], or name the \
                     file as the cylinder",
                    path.display()
                )
            })?;
            let options = LogOptions { cylinder: is_shared.then(|| cylinder.clone()), ..options.clone() };
            sources.push(Source { cylinder, topic, path: path.clone(), options });
        }
    }
    Ok(sources)
}

/// The cylinders of a log that names them in a column.
fn cylinders(path: &Path, options: &LogOptions) -> anyhow::Result<BTreeSet<String>> {
    let shown = path.display().to_string();
    let file = File::open(path).with_context(|| format!("{shown} cannot be read"))?;
    let mut names = BTreeSet::new();
    let rest = split((file, u64::MAX), &shown, options, |name, _| {
        if !names.contains(name) {
            names.insert(name.to_owned());
        }
        Ok::<(), Infallible>(())
    });
    match rest {
        Ok(rest) => rest.damage.map_or(Ok(names), |damage| Err(damage.into())),
        Err(never) => match never {},
    }
}
