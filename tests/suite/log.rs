//! Logs as they come from loggers: what is taken, what is cautioned about, what is refused.
use approx::assert_relative_eq;
use cylwatch::estimator::log::Quantity;
use cylwatch::log::{Caution, Kind, LogError, LogOptions, LogReader, Row};

/// Rows and cautions of a text.
fn read_with(text: &[u8], options: &LogOptions) -> Result<(Vec<Row>, Vec<Caution>), LogError> {
    let mut reader = LogReader::from_text(Box::new(std::io::Cursor::new(text.to_vec())), "log.csv", options)?;
    let mut rows = Vec::new();
    while let Some(row) = reader.next_row()? {
        rows.push(row.clone());
    }
    Ok((rows, reader.cautions().to_vec()))
}

fn read(text: &str) -> (Vec<Row>, Vec<Caution>) {
    read_with(text.as_bytes(), &LogOptions::default()).unwrap()
}

/// The message of a refused text, which has to contain all words.
fn refused(text: impl AsRef<[u8]>, words: &[&str]) -> String {
    let message = read_with(text.as_ref(), &LogOptions::default()).unwrap_err().to_string();
    for word in words {
        assert!(message.contains(word), "`{word}` is missing in: {message}");
    }
    message
}

/// The only caution of a text.
fn caution(text: &str) -> (Vec<Row>, Caution) {
    let (rows, cautions) = read(text);
    let [caution] = &cautions[..] else { panic!("{cautions:?}") };
    (rows, caution.clone())
}

const HEAD: &str = "time_s,shoulder_degc,pressure_bar\n";

#[test]
fn units_become_si_and_gaps_nan() {
    let (rows, cautions) = read(
        "# a remark\n#another\n\ntime_min,shoulder_degc,valve_k,pressure_barg,gas_mean_degc,mass_g\n\
         0,15,280.5,199,14.5,4500\n0.5,,NA,NaN,,null\n",
    );
    assert!(cautions.is_empty(), "{cautions:?}");
    assert_eq!((rows[0].time_s, rows[1].time_s, rows[1].number), (0.0, 30.0, 6));
    assert_relative_eq!(rows[0].readings[..], [288.15, 280.5, 200.01325e5], max_relative = 1e-12);
    assert_relative_eq!(rows[0].truth.gas_mean_k, 287.65);
    assert_relative_eq!(rows[0].truth.mass_kg, 4.5);
    assert!(rows[1].readings.iter().all(|value| value.is_nan()) && rows[1].truth.mass_kg.is_nan());
}

#[test]
fn a_log_in_memory_has_its_channels_and_rows() {
    let text = format!("{HEAD}0,15,200\n10,16,\n");
    let mut reader =
        LogReader::from_text(Box::new(std::io::Cursor::new(text)), "x", &LogOptions::default()).unwrap();
    let log = reader.read_all().unwrap();
    assert_eq!((log.channels[1].name.as_str(), log.channels[1].quantity), ("pressure", Quantity::Pressure));
    assert_eq!(log.time_s, [0.0, 10.0]);
    assert_eq!(log.row(1)[0], 289.15);
    assert!(log.row(1)[1].is_nan());
}

#[test]
fn byte_order_mark_carriage_returns_blank_lines_quotes_and_a_last_line_without_end_are_no_fault() {
    let text =
        "\u{feff}\"time_s\",shoulder_degc,\"note, long\"\r\n0,15,\"a,b\"\r\n\r\n,,\r\n10,\"16\",x\r\n20,17,";
    let (rows, caution) = caution(text);
    assert_eq!((caution.kind, caution.column.as_str()), (Kind::SetAside, "note, long"));
    let times: Vec<f64> = rows.iter().map(|row| row.time_s).collect();
    assert_eq!(times, [0.0, 10.0, 20.0]);
    assert_eq!((rows[2].readings[0], rows[2].number), (290.15, 6));
}

#[test]
fn semicolons_and_tabs_separate_and_allow_a_decimal_comma_with_one_caution() {
    let (rows, cautions) = read("time_s;shoulder_degc;pressure_bar\n0;15,5;200\n0,5;15,75;200.5\n");
    assert_relative_eq!(rows[1].readings[..], [288.9, 200.5e5]);
    assert_eq!(rows[1].time_s, 0.5);
    let kinds: Vec<(Kind, &str, u64)> =
        cautions.iter().map(|c| (c.kind, c.column.as_str(), c.count)).collect();
    assert_eq!(kinds, [(Kind::DecimalComma, "", 3)]);
    assert_eq!(read("time_s\tshoulder_degc\n0\t15\n").0[0].readings, [288.15]);
}

#[test]
fn dates_count_from_the_first_one_whatever_their_zone() {
    let text = "time,shoulder_degc\n2026-10-25T02:59:50+02:00,15\n2026-10-25T02:00:00+01:00,16\n";
    let mut reader =
        LogReader::from_text(Box::new(text.as_bytes()), "log.csv", &LogOptions::default()).unwrap();
    assert_eq!(reader.next_row().unwrap().map(|row| row.time_s), Some(0.0));
    assert_eq!(reader.next_row().unwrap().map(|row| row.time_s), Some(10.0));
    assert_eq!(reader.origin().as_deref(), Some("2026-10-25T00:59:50Z"));
    let (_, caution) = caution("time,shoulder_degc\n2026-10-25 02:59:50,15\n2026-10-25 03:00:00,16\n");
    assert_eq!((caution.kind, caution.count), (Kind::WithoutZone, 2));
    assert!(caution.to_string().starts_with("log.csv:2: time = 2026-10-25 02:59:50 has no zone"));
}

#[test]
fn readings_that_cannot_be_are_missing_and_counted_with_the_place_of_the_first() {
    let text = format!("{HEAD}0,15,inf\n1,OL,-200\n2,-127,200\n3,850,1e9\n4,-300,200\n5,16,200\n");
    let (rows, cautions) = read(&text);
    assert_eq!(rows.len(), 6);
    assert_eq!(rows.iter().filter(|row| row.readings[0].is_nan()).count(), 4);
    assert_eq!(rows.iter().filter(|row| row.readings[1].is_nan()).count(), 3);
    let said: Vec<String> = cautions.iter().map(Caution::to_string).collect();
    // Rows are checked one behind: of two kinds the order is that of reading.
    for words in [
        "log.csv:2: pressure_bar = inf is infinite; 1 value taken as missing",
        "log.csv:3: shoulder_degc = OL is no number; 1 value taken as missing",
        "log.csv:3: pressure_bar = -200 lies outside of 0 to 1500; 2 values taken as missing",
        "log.csv:4: shoulder_degc = -127 lies outside of -100 to 200; 3 values taken as missing",
    ] {
        assert!(said.iter().any(|said| said == words), "{words} is missing in {said:#?}");
    }
    assert_eq!(said.len(), 4);
}

#[test]
fn a_sensor_range_is_narrower_where_it_is_given() {
    let text = format!("{HEAD}0,15,200\n1,15,251\n");
    let mut reader =
        LogReader::from_text(Box::new(std::io::Cursor::new(text)), "log.csv", &LogOptions::default())
            .unwrap();
    reader.set_range(1, 0.0, 250e5);
    while reader.next_row().unwrap().is_some() {}
    assert!(reader.cautions()[0].to_string().contains("pressure_bar = 251 lies outside of 0 to 250"));
}

#[test]
fn a_column_without_a_usable_reading_is_named_and_a_log_without_any_refused() {
    let (_, cautions) = read(&format!("{HEAD}0,850,200\n1,850,201\n"));
    let said: Vec<String> = cautions.iter().map(Caution::to_string).collect();
    assert!(said[1].contains("shoulder_degc has no usable reading"), "{said:?}");
    refused(
        "time_s,shoulder_degc\n0,850\n1,850\n",
        &["log.csv has no row", "shoulder_degc = 850", "-100 to 200", "look at the unit"],
    );
    refused(HEAD, &["no row with a reading of shoulder_degc, pressure_bar"]);
    refused(format!("{HEAD}0,,\n"), &["no row with a reading"]);
}

#[test]
fn a_reading_that_stands_still_while_another_moves_is_used_and_cautioned_about() {
    let mut text = String::from("time_min,shoulder_degc,valve_degc\n");
    for minute in 0..120 {
        text.push_str(&format!("{minute},15.25,{}\n", 15.0 - 0.1 * f64::from(minute)));
    }
    let (rows, caution) = caution(&text);
    assert!(rows.iter().all(|row| row.readings[0] == 288.4));
    assert_eq!((caution.kind, caution.column.as_str(), caution.count), (Kind::Stuck, "shoulder_degc", 60));
    assert!(caution.to_string().starts_with("log.csv:62: shoulder_degc stands still at 15.25 while others"));
}

#[test]
fn rows_of_one_time_are_joined_left_out_or_refused() {
    let (rows, cautions) = read(&format!("{HEAD}0,15,200\n0,15,200\n1,16,\n1,,201\n2,17,202\n"));
    assert_eq!(rows.len(), 3);
    assert_eq!(rows[1].readings, [289.15, 201e5]);
    assert_eq!(
        cautions.iter().map(Caution::to_string).collect::<Vec<_>>(),
        [
            "log.csv:3: the row repeats the one above; 1 row left out",
            "log.csv:5: the row has the time of the one above; 1 row joined with it"
        ]
    );
    refused(
        format!("{HEAD}0,15,200\n0,15.5,200\n"),
        &["log.csv:3: shoulder_degc = 15.5", "log.csv:2 says 15 for the same time", "more digits"],
    );
}

#[test]
fn time_that_runs_backwards_is_refused_with_both_rows() {
    refused(
        format!("{HEAD}0,15,200\n60,15,200\n50,15,200\n"),
        &["log.csv:4: time 50 s is 10 s before", "log.csv:3", "sort the rows"],
    );
}

#[test]
fn a_row_without_a_time_is_left_out_and_a_time_that_is_none_refused() {
    let (rows, caution) = caution(&format!("{HEAD}0,15,200\n,16,200\nNaN,16,200\n1,17,200\n"));
    assert_eq!((rows.len(), caution.kind, caution.count), (2, Kind::WithoutTime, 2));
    refused(format!("{HEAD}0,15,200\nsoon,15,200\n"), &["log.csv:3: time_s = soon must be a finite number"]);
    refused(format!("{HEAD}inf,15,200\n"), &["log.csv:2: time_s = inf"]);
    refused("time,shoulder_degc\n12.5,15\n", &["time = 12.5", "RFC 3339", "time_s"]);
}

#[test]
fn a_row_of_another_width_is_refused_unless_it_is_the_last_and_cut_off() {
    refused(
        format!("{HEAD}0,15,200\n1,15\n2,15,200\n"),
        &["log.csv:3: the number of cells is 2 and the header's 3"],
    );
    refused(format!("{HEAD}0,15,200\n1,15\n"), &["log.csv:3: the number of cells is 2"]);
    refused(format!("{HEAD}0,15,5,200\n"), &["cells is 4", "decimal comma"]);
    assert_eq!(read(&format!("{HEAD}0,15,200,,\n")).0.len(), 1);
    let (rows, caution) = caution(&format!("{HEAD}0,15,200\n1,15"));
    assert_eq!((rows.len(), caution.kind), (1, Kind::CutOff));
    assert_eq!(caution.to_string(), "log.csv:3: the last row is cut off and left out");
}

#[test]
fn the_header_in_the_middle_is_left_out_and_another_header_refused() {
    let (rows, caution) = caution(&format!("{HEAD}0,15,200\n{HEAD}1,15,200\n"));
    assert_eq!((rows.len(), caution.kind, caution.first.as_str()), (2, Kind::HeaderAgain, "log.csv:3"));
    refused(
        format!("{HEAD}0,15,200\ntime_s,valve_degc,pressure_bar\n1,2,3\n"),
        &["log.csv:3: time_s = time_s"],
    );
}

#[test]
fn what_is_no_text_is_refused() {
    refused("", &["log.csv has no header"]);
    refused("# only a remark\n", &["log.csv has no header"]);
    let utf16: Vec<u8> = "\u{feff}time_s,shoulder_degc\n".encode_utf16().flat_map(u16::to_le_bytes).collect();
    refused("time_s,shoulder_degc\r0,15\r", &["log.csv:1", "carriage returns", "line feeds"]);
    refused(utf16, &["log.csv:1", "UTF-16", "save the log as UTF-8"]);
    refused(b"PK\x03\x04\0", &["log.csv is a ZIP archive or a workbook", "save the sheet as CSV"]);
    refused(b"PAR1\0", &["log.csv is a Parquet file", "ending .parquet"]);
    // A foreign remark in a column that nobody reads does no harm.
    let (rows, _) = read_with(b"time_s,shoulder_degc,note\n0,15,20 \xb0C\n", &LogOptions::default()).unwrap();
    assert_eq!(rows[0].readings, [288.15]);
    let damaged = [HEAD.as_bytes(), &[0; 40], b"\n1,15,200\n"].concat();
    refused(damaged, &["log.csv:2", "number of cells is 1"]);
}

#[test]
fn a_quotation_mark_that_is_not_closed_ends_after_a_mebibyte() {
    let mut text = format!("{HEAD}0,15,200\n1,\"15,200\n");
    for row in 2..200_000 {
        text.push_str(&format!("{row},15,200\n"));
    }
    refused(text, &["log.csv:3", "longer than 1048576 bytes", "quotation mark"]);
}

#[test]
fn a_log_is_sampled_as_its_reader_says() {
    let mut text = String::from(HEAD);
    for row in 0..100 {
        let gap = if row >= 50 { 1000 } else { 0 };
        text.push_str(&format!("{},15,200\n", 10 * row + gap));
    }
    let mut reader =
        LogReader::from_text(Box::new(std::io::Cursor::new(text)), "x", &LogOptions::default()).unwrap();
    while reader.next_row().unwrap().is_some() {}
    let (sampling, gaps) = (reader.sampling(), reader.sampling().gaps());
    assert_eq!((sampling.rows(), sampling.duration_s(), sampling.usual_interval_s()), (100, 1990.0, 10.0));
    assert_eq!((gaps.count, gaps.longest_s), (1, 1010.0));
}

#[cfg(not(feature = "parquet"))]
#[test]
fn a_parquet_file_is_refused_with_how_to_build_for_it() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("log.parquet");
    std::fs::write(&path, "PAR1").unwrap();
    let error = LogReader::open(&path, &LogOptions::default()).err().unwrap().to_string();
    assert!(error.contains("log.parquet") && error.contains("--features parquet"), "{error}");
}

#[test]
fn in_any_order_late_rows_come_as_they_stand_and_contradictions_cost_a_caution() {
    let text = format!("{HEAD}0,15,200\n60,15,\n60,,200\n60,16,\n30,15,200\n90,15,200\n");
    let options = LogOptions { any_order: true, ..LogOptions::default() };
    let (rows, cautions) = read_with(text.as_bytes(), &options).unwrap();
    assert_eq!(rows.iter().map(|row| row.time_s).collect::<Vec<_>>(), [0.0, 60.0, 30.0, 90.0]);
    assert_eq!((rows[1].readings[0], rows[1].readings[1]), (288.15, 200e5));
    assert_eq!(
        cautions.iter().map(|caution| caution.kind).collect::<Vec<_>>(),
        [Kind::Joined, Kind::Contradicted]
    );
    assert!(cautions[1].to_string().starts_with("log.csv:5: the row has the time of the one above and says"));
}

#[test]
fn a_late_row_counts_and_is_no_interval() {
    let text = format!("{HEAD}0,15,200\n60,15,200\n120,15,200\n90,15,200\n180,15,200\n");
    let options = LogOptions { any_order: true, ..LogOptions::default() };
    let mut reader = LogReader::from_text(Box::new(std::io::Cursor::new(text)), "x", &options).unwrap();
    while reader.next_row().unwrap().is_some() {}
    let sampling = reader.sampling();
    assert_eq!((sampling.rows(), sampling.duration_s(), sampling.gaps().count), (5, 180.0, 0));
    assert_relative_eq!(sampling.usual_interval_s(), 60.0);
}

#[test]
fn dates_count_from_a_date_that_is_given_and_seconds_do_not() {
    let options =
        LogOptions { origin: Some("2026-01-01T00:00:00Z".parse().unwrap()), ..LogOptions::default() };
    let dated = "time,shoulder_degc\n2026-01-01T01:00:00Z,15\n2026-01-01T02:00:00+01:00,15\n2026-01-01T02:00:00Z,15\n";
    let (rows, _) = read_with(dated.as_bytes(), &options).unwrap();
    assert_eq!(rows.iter().map(|row| row.time_s).collect::<Vec<_>>(), [3600.0, 7200.0]);
    let (rows, _) = read_with(format!("{HEAD}5,15,200\n").as_bytes(), &options).unwrap();
    assert_eq!(rows[0].time_s, 5.0);
}
