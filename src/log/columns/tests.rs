use super::*;
use crate::log::Mapping;

fn find(names: &str, options: &LogOptions) -> (Result<Columns, LogError>, Cautions) {
    let names: Vec<String> = names.split(',').map(str::to_owned).collect();
    let mut cautions = Cautions::default();
    (Columns::find(&names, "log.csv:3", options, &mut cautions), cautions)
}

fn columns(names: &str) -> Columns {
    find(names, &LogOptions::default()).0.unwrap()
}

fn refusal(names: &str, maps: &[&str]) -> String {
    find(names, &mapped(maps)).0.unwrap_err().to_string()
}

fn mapped(maps: &[&str]) -> LogOptions {
    let mappings = maps.iter().map(|map| map.parse().unwrap()).collect();
    LogOptions { mappings, ..LogOptions::default() }
}

/// Name, header and unit of the readings.
fn readings(columns: &Columns) -> Vec<(&str, &str, &str)> {
    columns.readings.iter().map(|c| (c.meaning.name.as_str(), c.header.as_str(), c.unit.suffix)).collect()
}

#[test]
fn every_known_name_is_a_reading_in_any_of_its_units() {
    let found =
        columns("time_min,shoulder_degC,Valve_K,ambient_degc,wall_mid_low_k,gas_1_degc,pressure_barg");
    assert_eq!(found.time.header, "time_min");
    assert_eq!(
        readings(&found),
        [
            ("shoulder", "shoulder_degC", "degc"),
            ("valve", "Valve_K", "k"),
            ("ambient", "ambient_degc", "degc"),
            ("wall_mid_low", "wall_mid_low_k", "k"),
            ("gas_1", "gas_1_degc", "degc"),
            ("pressure", "pressure_barg", "barg"),
        ]
    );
}

#[test]
fn truth_is_no_reading() {
    let found = columns("time,shoulder_degc,gas_mean_degc,mass_g,outflow_g_h");
    assert_eq!(found.time.form, TimeForm::Date);
    assert_eq!(readings(&found).len(), 1);
    let truth: Vec<TruthQuantity> = found.truth.iter().map(|column| column.meaning).collect();
    assert_eq!(truth, [TruthQuantity::GasMean, TruthQuantity::Mass, TruthQuantity::Outflow]);
}

#[test]
fn in_a_simulated_log_only_what_was_measured_is_read_and_the_pressure() {
    let names = "time_s,ambient_degc,gas_1_degc,wall_bottom_degc,shoulder_degc,valve_degc,pressure_bar,\
                 measured_shoulder_degc,measured_mine_degc";
    let (found, cautions) = find(names, &LogOptions::default());
    let found = found.unwrap();
    let expected = [
        ("pressure", "pressure_bar", "bar"),
        ("shoulder", "measured_shoulder_degc", "degc"),
        ("mine", "measured_mine_degc", "degc"),
    ];
    assert_eq!(readings(&found), expected);
    assert_eq!(cautions.list().len(), 1);
    assert_eq!(
        (cautions.list()[0].kind, cautions.list()[0].column.as_str()),
        (Kind::Perfect, "pressure_bar")
    );
    let found = columns("time_s,pressure_bar,measured_pressure_bar,shoulder_degc");
    assert_eq!(readings(&found), [("pressure", "measured_pressure_bar", "bar")]);
}

#[test]
fn names_of_sensors_make_readings_of_foreign_and_of_true_columns() {
    let options = LogOptions { sensors: vec!["T7".into(), "wall_bottom".into()], ..LogOptions::default() };
    let (found, cautions) = find("time_s,t7_degc,wall_bottom_degc,measured_shoulder_degc", &options);
    let found = found.unwrap();
    let names: Vec<&str> = readings(&found).iter().map(|(name, _, _)| *name).collect();
    assert_eq!(names, ["t7", "wall_bottom", "shoulder"]);
    assert!(cautions.list().is_empty());
}

#[test]
fn a_mapping_brings_its_unit_or_takes_that_of_the_file() {
    let maps = ["time=Zeit", "shoulder_degc=T1 (C)", "pressure=P_raw_barg", "measured_valve_k=T2"];
    let (found, cautions) = find("Zeit,T1 (C),P_raw_barg,T2,Valve_degc,Note", &mapped(&maps));
    let found = found.unwrap();
    assert_eq!(
        readings(&found),
        [("shoulder", "T1 (C)", "degc"), ("pressure", "P_raw_barg", "barg"), ("valve", "T2", "k")]
    );
    assert_eq!((found.time.header.as_str(), found.time.form), ("Zeit", TimeForm::Date));
    assert_eq!(cautions.list()[0].column, "Note");
}

#[test]
fn a_mapping_that_cannot_be_says_why() {
    let refusals = [
        (&["shoulder_degc=T2"][..], "no column T2; it has time_s, T1, T1"),
        (&["shoulder_degc=T1"], "several columns T1"),
        (&["sholder_degc=time_s"], "sholder_degc is nothing that is read"),
        (&["shoulder=T1"], "several"),
        (&["shoulder_bar=time_s"], "_bar, which is no unit of temperature"),
        (&["shoulder_degc=time_s", "valve_degc=time_s"], "mapped twice"),
    ];
    for (maps, words) in refusals {
        let error = refusal("time_s,T1,T1", maps);
        assert!(error.contains("--map") && error.contains(words), "{error}");
    }
    for bad in ["shoulder", "=x", "x="] {
        assert!(bad.parse::<Mapping>().unwrap_err().to_string().contains("OURS=THEIRS"));
    }
}

#[test]
fn a_unit_that_is_missing_wrong_or_foreign_is_refused_with_the_right_one() {
    let refusals = [
        ("time_s,shoulder", "shoulder has no unit: write shoulder_degc, or another of _degc, _k"),
        ("time_s,wall_middle", "wall_middle has no unit"),
        ("time_s,pressure_degc", "pressure_degc is in _degc, which is no unit of pressure: use one of _bar"),
        ("time_s,shoulder_c", "did you mean shoulder_degc?"),
        ("time_s,wall_top_celsius", "did you mean wall_top_degc?"),
        ("time_s,pressure_torr", "which is no unit of pressure: use one of _bar, _pa"),
        ("time_s,pressure_baar", "did you mean pressure_bar?"),
        ("time_s,pressure_hpa", "did you mean pressure_mbar?"),
        ("time_ms,shoulder_degc", "time_ms is in _ms, which is no unit of time"),
        ("time_s,shoulder_degc,mass", "mass has no unit: write mass_kg"),
    ];
    for (names, words) in refusals {
        let error = refusal(names, &[]);
        assert!(error.starts_with("log.csv:3: column ") && error.contains(words), "{error}");
    }
}

#[test]
fn one_quantity_twice_is_refused() {
    for names in [
        "time_s,shoulder_degc,shoulder_k",
        "time_s,time_min,shoulder_degc",
        "time,time,shoulder_degc",
        "time_s,shoulder_degc,mass_kg,mass_g",
        "time_s,measured_shoulder_degc,measured_shoulder_k",
    ] {
        let error = refusal(names, &[]);
        assert!(error.contains("says again what") && error.contains("line 3"), "{error}");
    }
}

#[test]
fn elapsed_time_goes_before_dates() {
    let found = columns("time,time_s,shoulder_degc");
    assert_eq!(found.time.header, "time_s");
}

#[test]
fn without_time_or_reading_the_columns_that_are_there_are_listed() {
    let error = refusal("Zeit,shoulder_degc", &[]);
    assert!(error.contains("no column of time") && error.contains("Zeit, shoulder_degc"), "{error}");
    let error = refusal("time_s,T1,T2", &[]);
    assert!(error.contains("no column to estimate from") && error.contains("T1, T2"), "{error}");
}

#[test]
fn what_nobody_knows_is_set_aside_once_with_a_guess() {
    let (_, cautions) = find(
        "time_s,shoulder_degc,note,gas_type,valve_state,wall_thickness_mm,vlave_degc",
        &LogOptions::default(),
    );
    let [caution] = cautions.list() else { panic!("{:?}", cautions.list()) };
    assert_eq!(caution.column, "note, gas_type, valve_state, wall_thickness_mm, vlave_degc");
    assert!(caution.to_string().ends_with("did you mean valve_degc?"), "{caution}");
}

#[test]
fn date_and_time_of_day_are_found_in_two_columns_and_in_one() {
    for (names, header, clock) in [
        ("Datum,Zeit,shoulder_degc", "Datum+Zeit", Some(1)),
        ("DATUM:,ZEIT:,shoulder_degc", "DATUM:+ZEIT:", Some(1)),
        ("Date,Time,shoulder_degc", "Date+Time", Some(1)),
        ("Datum/Zeit,shoulder_degc", "Datum/Zeit", None),
        ("time,shoulder_degc,Note", "time", None),
    ] {
        let time = columns(names).time;
        assert_eq!((time.header.as_str(), time.clock, time.form), (header, clock, TimeForm::Date), "{names}");
    }
    let (found, _) = find("Tag [d.m.y],Wann,shoulder_degc", &mapped(&["time=Tag+Wann"]));
    assert_eq!(found.unwrap().time.clock, Some(1));
    let found = columns("Datum,Zeit,time_s,shoulder_degc");
    assert_eq!((found.time.header.as_str(), found.time.clock), ("time_s", None));
    let error = refusal("Datum,Zeit,shoulder_degc", &["time=Datum+Uhr"]);
    assert!(error.contains("no column Uhr; it has Datum, Zeit"), "{error}");
}

#[test]
fn units_in_brackets_are_units_and_may_not_contradict_a_mapping() {
    let found = columns("time_s,Shoulder [°C],Pressure [bar],Valve (K)");
    assert_eq!(readings(&found).iter().map(|(_, _, unit)| *unit).collect::<Vec<_>>(), ["degc", "bar", "k"]);
    let names = "Zeit [s],Druck [bar],T1 [°C],P2 [mbar],P3 [torr]";
    for maps in
        [["pressure_bar=Druck", "shoulder=T1"], ["pressure_barg=Druck [bar]", "shoulder_degc=T1 [°C]"]]
    {
        let (found, _) = find(names, &mapped(&[&maps[..], &["time=Zeit"]].concat()));
        let found = found.unwrap();
        assert_eq!(
            found.time.form,
            TimeForm::Number(crate::thermal::units::find("s", Dimension::Time).unwrap())
        );
        assert_eq!(found.readings.len(), 2);
    }
    for (map, words) in [
        ("pressure_bar=P2", "the header says mbar: write pressure_mbar=P2"),
        ("shoulder_k=T1", "the header says °C: write shoulder_degc=T1"),
        ("pressure_bar=P3", "in torr, which is no unit that is read"),
        ("pressure_bar=T1", "the header says °C"),
    ] {
        let error = refusal(names, &["time_s=Zeit", map]);
        assert!(error.contains("--map") && error.contains(words), "{error}");
    }
    let error = refusal("time_s,T1 [°C],T1 [K]", &["shoulder=T1"]);
    assert!(error.contains("T1 [°C] and T1 [K] are both called T1"), "{error}");
}
