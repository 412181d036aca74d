//! Calls from a program: the commands on logs in memory, and step by step.
use crate::support;
use cylwatch::log::LogError;
use cylwatch::report::{Table, Values};
use cylwatch::run::{self, Call, Cells, MemoryLog, MonitorSteps, ObserverSteps, RowsWanted, StepTime};

const VESSEL: &str = "nitrogen-20l";

/// A day of a cylinder in air that swings by 8 K, with a row a minute and a thermometer that is missing for a while.
fn columns() -> [(&'static str, Vec<f64>); 3] {
    let minutes = || (0..1440).map(f64::from);
    let warm = |minute: f64| 4.0 * (minute / 230.0).sin();
    let noise = |minute: f64| 0.02 * (7.3 * minute).sin();
    let shoulder =
        minutes().map(|m| if (50.0..70.0).contains(&m) { f64::NAN } else { 15.0 + warm(m) + noise(m) });
    [
        ("time_s", minutes().map(|minute| 60.0 * minute).collect()),
        ("shoulder_degc", shoulder.collect()),
        (
            "pressure_bar",
            minutes().map(|minute| 200.0 + 0.7 * warm(minute - 20.0) + noise(minute + 3.0)).collect(),
        ),
    ]
}

fn log() -> MemoryLog {
    let columns = columns().map(|(name, cells)| (name.to_owned(), Cells::Numbers(cells)));
    MemoryLog { name: "frame".to_owned(), columns: columns.into() }
}

fn csv() -> String {
    let [(time, times), (shoulder, temperatures), (pressure, pressures)] = columns();
    let mut text = format!("{time},{shoulder},{pressure}\n");
    for ((time, temperature), pressure) in times.iter().zip(&temperatures).zip(&pressures) {
        text.push_str(&format!("{time},{temperature},{pressure}\n"));
    }
    text
}

/// Lines that are not about where the rows come from.
fn body(csv: &str) -> Vec<&str> {
    csv.lines().filter(|line| !line.starts_with('#')).collect()
}

/// Cells with all their bits.
fn bits(table: &Table) -> Vec<Vec<u64>> {
    let bits = |values: &Values| match values {
        Values::Numbers(_, cells) => cells.iter().map(|cell| cell.to_bits()).collect(),
        _ => Vec::new(),
    };
    table.columns.iter().map(|column| bits(&column.values)).collect()
}

/// Adds the rows of a table to those of another.
fn extend(all: &mut Vec<Vec<u64>>, table: &Table) {
    all.resize(all.len().max(table.columns.len()), Vec::new());
    all.iter_mut().zip(bits(table)).for_each(|(all, more)| all.extend(more));
}

fn row(index: usize) -> (StepTime, [(&'static str, f64); 2]) {
    let [(_, times), (shoulder, temperatures), (pressure, pressures)] = columns();
    (StepTime::Second(times[index]), [(shoulder, temperatures[index]), (pressure, pressures[index])])
}

#[test]
fn a_log_in_memory_gives_the_rows_and_the_summary_that_the_command_writes_for_its_csv() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("log.csv"), csv()).unwrap();
    for (command, call) in [("monitor", run::monitor as fn(Call) -> _), ("estimate", run::estimate)] {
        let told = support::run(folder.path(), &[command, VESSEL, "log.csv", "-o", "rows.csv"]);
        support::run(folder.path(), &[command, VESSEL, "log.csv", "-o", "rows.json"]);
        let outcome = call(Call::new(VESSEL).log(log())).unwrap();
        let rows = std::fs::read_to_string(folder.path().join("rows.csv")).unwrap();
        assert_eq!(body(&outcome.to_csv()), body(&rows), "{command}");
        let json = std::fs::read_to_string(folder.path().join("rows.json")).unwrap();
        let json: serde_json::Value = serde_json::from_str(&json).unwrap();
        assert_eq!((&outcome.summary, i32::from(outcome.exit_code)), (&json["summary"], told.code.unwrap()));
        let file = call(Call::new(VESSEL).log_file(&folder.path().join("log.csv"))).unwrap();
        assert_eq!(bits(&file.rows), bits(&outcome.rows), "{command}");
        assert!(outcome.to_html().unwrap().contains("<svg"));
    }
}

#[test]
fn a_call_hands_out_the_cautions_that_the_command_writes() {
    let folder = tempfile::tempdir().unwrap();
    let local = "time,shoulder_degc,pressure_bar\n2026-01-12 00:00,15,200\n2026-01-12 00:01,15,200\n2026-01-12 00:02,15,200\n";
    let file = folder.path().join("local.csv");
    std::fs::write(&file, local).unwrap();
    let told = support::run(folder.path(), &["estimate", VESSEL, "local.csv"]).stderr;
    let told: Vec<&str> = told.lines().filter_map(|line| line.strip_prefix("caution: ")).collect();
    let cautions = run::estimate(Call::new(VESSEL).log_file(&file)).unwrap().cautions;
    // The command names the file as it was typed.
    let shown = file.display().to_string();
    let cautions: Vec<String> = cautions.iter().map(|words| words.replace(&shown, "local.csv")).collect();
    assert!(told.iter().any(|words| words.contains("no zone")), "{told:?}");
    assert_eq!(cautions, told);
}

#[test]
fn a_monitor_that_is_saved_and_restored_at_rows_is_the_whole_log_bit_by_bit() {
    let mut steps = MonitorSteps::new(Call::new(VESSEL)).unwrap();
    let mut rows = Vec::new();
    for index in 0..1440 {
        if index % 97 == 0 {
            let state = steps.save().unwrap();
            steps = MonitorSteps::new(Call::new(VESSEL)).unwrap();
            steps.restore(&state).unwrap();
            assert_eq!(steps.save().unwrap(), state);
        }
        let (time, readings) = row(index);
        extend(&mut rows, &steps.step(time, &readings).unwrap().0);
    }
    extend(&mut rows, &steps.finish().unwrap().0);
    assert_eq!(rows, bits(&run::monitor(Call::new(VESSEL).log(log())).unwrap().rows));
}

/// The rows of a log from one to another.
fn part(rows: std::ops::Range<usize>) -> MemoryLog {
    let columns =
        columns().map(|(name, cells)| (name.to_owned(), Cells::Numbers(cells[rows.clone()].to_vec())));
    MemoryLog { name: "frame".to_owned(), columns: columns.into() }
}

#[test]
fn steps_by_tables_are_steps_by_rows_bit_by_bit_and_leave_the_state_file_of_the_command() {
    let mut single = MonitorSteps::new(Call::new(VESSEL)).unwrap();
    let mut tables = MonitorSteps::new(Call::new(VESSEL)).unwrap();
    assert_eq!(tables.state_file().unwrap(), None);
    let (mut from, mut rows, mut by_tables) = (0, Vec::new(), Vec::new());
    for to in [1, 2, 60, 700, 1440] {
        let told = tables.steps(&part(from..to), RowsWanted::Every).unwrap();
        extend(&mut by_tables, &told.0);
        let mut events = Vec::new();
        for index in from..to {
            let (time, readings) = row(index);
            let told = single.step(time, &readings).unwrap();
            extend(&mut rows, &told.0);
            events.extend(told.1);
        }
        assert_eq!((told.1, tables.save().unwrap()), (events, single.save().unwrap()), "{to}");
        from = to;
    }
    assert_eq!(by_tables, rows);
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("log.csv"), csv()).unwrap();
    // Without a table of rows, as `fleet` saves it.
    support::run(folder.path(), &["monitor", VESSEL, "log.csv", "--state", "state", "-o", "rows.json"]);
    let state = std::fs::read(folder.path().join("state")).unwrap();
    assert_eq!(tables.state_file().unwrap(), Some(state));
}

#[test]
fn the_last_row_alone_is_the_last_of_all_rows_and_events_stay() {
    let of = |wanted| MonitorSteps::new(Call::new(VESSEL)).unwrap().steps(&log(), wanted).unwrap();
    let (every, last) = (of(RowsWanted::Every), of(RowsWanted::Last));
    let end: Vec<Vec<u64>> =
        bits(&every.0).iter().map(|cells| cells.last().copied().into_iter().collect()).collect();
    assert_eq!((bits(&last.0), last.1), (end, every.1));
}

#[test]
fn a_table_that_steps_cannot_take_is_refused_with_its_row_or_column() {
    let words = |change: fn(&mut MemoryLog)| {
        let mut table = part(0..3);
        change(&mut table);
        let mut steps = MonitorSteps::new(Call::new(VESSEL)).unwrap();
        steps.steps(&table, RowsWanted::Every).unwrap_err()
    };
    let untimed = words(|table| table.columns[0].1 = Cells::Numbers(vec![0.0, f64::NAN, 60.0]));
    assert_eq!((untimed.line(), untimed.remedy()), (Some(2), Some("leave the row out")), "{untimed}");
    for (change, expected) in [
        ((|table| table.columns[0].0 = "t".to_owned()) as fn(&mut MemoryLog), "no column of time"),
        (|table| table.columns[1].1 = Cells::Texts(vec![None; 3]), "shoulder_degc has texts"),
        (|table| table.columns[2].1 = Cells::Numbers(vec![1.0]), "pressure_bar is not as long"),
        (|table| table.columns[1].0 = "time_h".to_owned(), "two columns of time"),
        (
            |table| {
                table.columns[0] =
                    ("time".to_owned(), Cells::Instants { nanoseconds: vec![Some(0); 3], zone: None })
            },
            "no zone",
        ),
    ] {
        let error = words(change);
        assert!(error.to_string().contains(expected) && error.remedy().is_some(), "{error}");
    }
}

#[test]
fn an_observer_that_is_saved_and_restored_at_rows_is_the_whole_log_bit_by_bit() {
    let mut steps = ObserverSteps::new(Call::new(VESSEL)).unwrap();
    let mut rows = Vec::new();
    for index in 0..1440 {
        if index % 97 == 0 {
            let state = steps.save().unwrap();
            steps = ObserverSteps::new(Call::new(VESSEL)).unwrap();
            steps.restore(&state).unwrap();
        }
        let (time, readings) = row(index);
        extend(&mut rows, &steps.step(time, &readings).unwrap());
    }
    assert_eq!(rows, bits(&run::estimate(Call::new(VESSEL).log(log())).unwrap().rows));
    let late = steps.step(StepTime::Second(1e308), &row(0).1).unwrap_err();
    assert!(late.to_string().contains("after the row before it"), "{late}");
}

#[test]
fn what_a_caller_gives_wrong_is_refused_with_the_parts_of_the_message() {
    let call = || Call::new(VESSEL).log(log());
    let words = |call: Call| run::monitor(call).unwrap_err().to_string();
    assert!(words(call().option("limit-bra", Some("5"))).contains("--limit-bra"));
    assert!(words(call().option("output", Some("x.csv"))).contains("the result is in memory"));
    assert!(words(Call::new("-").log(log())).contains("standard input"));
    let mut backwards = log();
    if let Cells::Numbers(times) = &mut backwards.columns[0].1 {
        times[9] = -1.0;
    }
    let error = run::estimate(Call::new(VESSEL).log(backwards)).unwrap_err();
    assert_eq!((error.file(), error.line()), (Some("frame"), Some(10)));
    assert!(error.remedy().unwrap().starts_with("sort the rows"), "{error}");
    let stopped = run::monitor(call().stopped_by(|| true)).unwrap_err();
    assert!(stopped.is_stopped() && !error.is_stopped());
}

#[test]
fn a_column_of_another_type_is_refused_only_where_it_is_read() {
    let with = |name: &str, cells: Cells| {
        let mut log = log();
        log.columns.retain(|(known, _)| known != name);
        log.columns.push((name.to_owned(), cells));
        run::monitor(Call::new(VESSEL).log(log))
    };
    let dates = |zone: Option<&str>| Cells::Instants {
        nanoseconds: (0..1440).map(|minute| Some(60_000_000_000 * minute)).collect(),
        zone: zone.map(|zone| zone.parse().unwrap()),
    };
    assert!(with("note", Cells::Other("List".to_owned())).is_ok());
    for (name, cells) in [
        ("pressure_bar", Cells::Other("List".to_owned())),
        ("pressure_bar", dates(None)),
        ("time_s", dates(None)),
        ("shoulder_degc", Cells::Numbers(vec![15.0])),
    ] {
        let error = with(name, cells).unwrap_err().to_string();
        assert!(error.contains(name) && error.contains("must have"), "{error}");
    }
    let mut dated = log();
    dated.columns[0] = ("time".to_owned(), dates(Some("Europe/Berlin")));
    let outcome = run::monitor(Call::new(VESSEL).log(dated)).unwrap();
    assert_eq!(outcome.zone.as_deref(), Some("Europe/Berlin"));
    assert!(outcome.to_csv().contains("1970-01-01T01:01:00+01:00"));
    let texts = |cells: &[f64]| Cells::Texts(cells.iter().map(|cell| Some(cell.to_string())).collect());
    let as_texts = with("pressure_bar", texts(&columns()[2].1)).unwrap();
    assert_eq!(bits(&as_texts.rows), bits(&run::monitor(Call::new(VESSEL).log(log())).unwrap().rows));
    assert!(matches!(
        cylwatch::log::LogReader::from_memory(MemoryLog::default(), &Default::default()),
        Err(LogError::NoTime { .. })
    ));
}

/// A log of a simulated run, named, with the air and what its sensors read.
fn simulated(scenario: &str, name: &str) -> MemoryLog {
    let rows = run::simulate(Call::new(VESSEL).scenario(scenario)).unwrap().rows;
    let wanted = ["time_s", "ambient_degc", "gas_mean_degc", "shoulder_degc", "valve_degc", "pressure_bar"];
    let columns = wanted.map(|name| {
        let read = format!("measured_{name}");
        let has = |wanted: &str| rows.columns.iter().find(|column| column.name == wanted);
        match &has(&read).or(has(name)).unwrap().values {
            Values::Numbers(_, cells) => (name.to_owned(), Cells::Numbers(cells.clone())),
            other => panic!("{other:?}"),
        }
    });
    MemoryLog { name: name.to_owned(), columns: columns.into() }
}

fn csv_of(log: &MemoryLog) -> String {
    let names: Vec<&str> = log.columns.iter().map(|(name, _)| name.as_str()).collect();
    let mut text = names.join(",") + "\n";
    for row in 0..log.columns[0].1.len() {
        let cell = |(_, cells): &(String, Cells)| match cells {
            Cells::Numbers(cells) => cells[row].to_string(),
            other => panic!("{other:?}"),
        };
        text += &(log.columns.iter().map(cell).collect::<Vec<_>>().join(",") + "\n");
    }
    text
}

/// JSON without what names the run.
fn without_call(mut document: serde_json::Value) -> serde_json::Value {
    document.as_object_mut().unwrap().shift_remove("provenance");
    document
}

#[test]
fn an_identification_of_a_log_in_memory_on_another_one_is_the_command_on_files() {
    let folder = tempfile::tempdir().unwrap();
    let logs = [simulated("tunnel-winter", "run.csv"), simulated("ramp-warm", "other.csv")];
    for log in &logs {
        std::fs::write(folder.path().join(&log.name), csv_of(log)).unwrap();
    }
    let asked =
        ["identify", "run.csv", "--input", "shoulder", "--output", "gas_mean", "--validate", "other.csv"];
    support::run(folder.path(), &[&asked[..], &["--out", "rows.csv"]].concat());
    support::run(folder.path(), &[&asked[..], &["--out", "model.json"]].concat());
    let [log, other] = logs;
    let call = Call::without_vessel().log(log).log_of_option(other).option("validate", Some("other.csv"));
    let call = call.option("input", Some("shoulder")).option("output", Some("gas_mean"));
    let outcome = run::identify(call).unwrap();
    let read = |name: &str| std::fs::read_to_string(folder.path().join(name)).unwrap();
    assert_eq!(body(&outcome.to_csv()), body(&read("rows.csv")));
    let document: serde_json::Value = serde_json::from_str(&read("model.json")).unwrap();
    assert_eq!(without_call(outcome.summary.clone()), without_call(document));
    let lag = &outcome.summary["coefficients"][1];
    assert_eq!((lag["name"].as_str(), lag["unit"].as_str()), (Some("time constant"), Some("s")));
    assert!(outcome.to_html().unwrap().contains("<svg"));
}

#[test]
fn a_calibration_of_logs_in_memory_is_the_command_and_its_vessel_is_the_next_calls() {
    let folder = tempfile::tempdir().unwrap();
    let log = simulated("shock-cold", "log.csv");
    std::fs::write(folder.path().join("log.csv"), csv_of(&log)).unwrap();
    let date = "2026-03-01T12:00:00Z";
    let asked =
        ["calibrate", VESSEL, "log.csv", "--fit", "outside-film", "--film-w-m2-k", "20", "--date", date];
    let told = support::run(folder.path(), &[&asked[..], &["--format", "csv", "-o", "new.toml"]].concat());
    let json = support::run(folder.path(), &[&asked[..], &["--format", "json"]].concat()).stdout;
    let call = || Call::new(VESSEL).option("fit", Some("outside-film")).option("film-w-m2-k", Some("20"));
    let outcome = run::calibrate(call().log(log).option("date", Some(date))).unwrap();
    assert_eq!(body(&outcome.to_csv()), body(&told.stdout));
    let document: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert_eq!(without_call(outcome.summary.clone()), without_call(document));
    let vessel = std::fs::read_to_string(folder.path().join("new.toml")).unwrap();
    // A log in memory has another hash than its file.
    let text =
        |vessel| body(vessel).into_iter().filter(|line| !line.starts_with("sha256")).collect::<Vec<_>>();
    assert_eq!(text(&outcome.vessel), text(&vessel));
    let next =
        |vessel: Call| bits(&run::monitor(vessel.log(simulated("tunnel-winter", "next"))).unwrap().rows);
    let calibrated = next(Call::of_text(outcome.vessel));
    assert_eq!(calibrated, next(Call::new(folder.path().join("new.toml"))));
    assert_ne!(calibrated, next(Call::new(VESSEL)));
}

#[test]
fn a_search_of_places_is_the_command_and_a_time_limit_makes_it_partial() {
    let folder = tempfile::tempdir().unwrap();
    let asked = ["place", VESSEL, "--wall-nodes", "2", "--scenario", "none", "--sensors", "2", "-o"];
    support::run(folder.path(), &[&asked[..], &["rows.csv"]].concat());
    let call = || {
        let call = Call::new(VESSEL).option("wall-nodes", Some("2")).option("sensors", Some("2"));
        call.option("scenario", Some("none"))
    };
    let outcome = run::place(call()).unwrap();
    let rows = std::fs::read_to_string(folder.path().join("rows.csv")).unwrap();
    assert_eq!((body(&outcome.to_csv()), outcome.exit_code), (body(&rows), 0));
    let ended = run::place(call().option("time-limit-s", Some("1e-6"))).unwrap();
    assert_eq!((ended.exit_code, ended.summary["partial"].as_bool()), (3, Some(true)));
    assert!(ended.cautions.iter().any(|words| words.contains("ended early")), "{:?}", ended.cautions);
}

#[test]
fn a_simulation_a_calibration_and_a_search_of_places_end_when_the_caller_wants_it() {
    type Run = fn(Call) -> Result<run::Outcome, run::RunError>;
    let calls: [(Run, Call); 3] = [
        (
            run::simulate,
            Call::new(VESSEL).scenario("railway-week").option("relative-tolerance", Some("1e-11")),
        ),
        (run::calibrate, Call::new(VESSEL).log(simulated("shock-cold", "log"))),
        (run::place, Call::new(VESSEL)),
    ];
    for (run, call) in calls {
        // What is read before is let through.
        let mut asked = 0;
        let stop = move || {
            asked += 1;
            asked > 2
        };
        let stopped = run(call.stopped_by(stop)).unwrap_err();
        assert!(stopped.is_stopped(), "{stopped}");
    }
}
