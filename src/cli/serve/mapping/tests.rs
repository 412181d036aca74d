use super::*;

pub(super) fn mapping(form: TimeForm) -> Mapping {
    let reading = |name: &str, at: &str| Reading { name: name.to_owned(), at: at.to_owned() };
    Mapping {
        format: PayloadFormat::Json,
        topics: [("plant/a".to_owned(), "A".to_owned())].into(),
        pattern: Pattern::of("train/+/gas", 3),
        time: "/t".to_owned(),
        form,
        readings: vec![reading("pressure_bar", "/data/p"), reading("shoulder_degc", "/data/temps/0")],
        message_bytes: 100,
        prefix: "out/gas".to_owned(),
    }
}

#[test]
fn a_topic_finds_its_cylinder_and_no_other() {
    let mapping = mapping(TimeForm::Rfc3339);
    for (topic, expected) in [
        ("plant/a", Some(Addressed::Named("A"))),
        ("train/7/gas", Some(Addressed::ByPattern("7"))),
        ("out/gas/A/acknowledge", Some(Addressed::Acknowledge("A"))),
        ("train/7/8/gas", None),
        ("train//gas", None),
        ("train/gas", None),
        ("plant/a/", None),
        ("out/gas/a/b/acknowledge", None),
        ("", None),
    ] {
        assert_eq!(mapping.addressed(topic), expected, "{topic}");
    }
    assert_eq!(mapping.filters(), ["out/gas/+/acknowledge", "plant/a", "train/+/gas"]);
}

#[test]
fn a_filter_has_one_level_for_the_name() {
    for (filter, topic) in [("+", "a"), ("+/x", "a/x"), ("x/+", "x/a"), ("x/+/y/z", "x/a/y/z")] {
        let pattern = Pattern::of(filter, 1).unwrap();
        assert_eq!(pattern.name(topic), Some("a"));
        assert_eq!(pattern.filter(), filter);
    }
    for filter in ["x", "+/+", "x/#", "x/a+", "+/#"] {
        assert_eq!(Pattern::of(filter, 1), None, "{filter}");
    }
}

#[test]
fn a_topic_that_a_pattern_covers_is_subscribed_once() {
    let mut mapping = mapping(TimeForm::Rfc3339);
    mapping.topics.insert("train/9/gas".to_owned(), "nine".to_owned());
    assert_eq!(mapping.filters().len(), 3);
    assert_eq!(mapping.addressed("train/9/gas"), Some(Addressed::Named("nine")));
}

#[test]
fn times_of_every_form_are_one_instant() {
    let payload = |time: &str| format!("{{\"t\":{time},\"data\":{{\"p\":1}}}}");
    let at = |time: &str, form| mapping(form).row(payload(time).as_bytes(), 7).unwrap().time_ns;
    let expected = 1_767_225_600_250_000_000;
    assert_eq!(at("\"2026-01-01T01:00:00.25+01:00\"", TimeForm::Rfc3339), expected);
    assert_eq!(at("1767225600.25", TimeForm::Seconds), expected);
    assert_eq!(at("1767225600250", TimeForm::Milliseconds), expected);
    assert_eq!(at("\"whatever\"", TimeForm::Arrival), 7);
    for (time, form) in [
        ("\"2026-01-01\"", TimeForm::Rfc3339),
        ("1767225600", TimeForm::Rfc3339),
        ("1e300", TimeForm::Seconds),
        ("null", TimeForm::Milliseconds),
    ] {
        assert_eq!(mapping(form).row(payload(time).as_bytes(), 7), Err(Refusal::NoTime), "{time}");
    }
}

#[test]
fn readings_are_found_by_their_pointers_and_may_be_missing() {
    let mapping = mapping(TimeForm::Seconds);
    let row = |payload: &str| mapping.row(payload.as_bytes(), 0);
    let cells = row("{\"t\":0,\"data\":{\"p\":200.1,\"temps\":[15.3]}}").unwrap().cells;
    assert_eq!(cells, [200.1, 15.3]);
    let cells = row("{\"t\":0,\"data\":{\"p\":null,\"temps\":[15.3]}}").unwrap().cells;
    assert!(cells[0].is_nan() && cells[1] == 15.3);
    for (payload, refusal) in [
        ("{\"t\":0,\"data\":{}}", Refusal::NoReading),
        ("{\"t\":0,\"data\":{\"p\":\"200\"}}", Refusal::NoNumber),
        ("{\"t\":0,\"data\":{\"p\":1}", Refusal::NoJson),
        ("", Refusal::NoJson),
        ("{\"data\":{\"p\":1}}", Refusal::NoTime),
        (&"[".repeat(99), Refusal::NoJson),
        (&" ".repeat(101), Refusal::TooLarge),
    ] {
        assert_eq!(row(payload), Err(refusal), "{payload}");
    }
}

proptest::proptest! {
    #[test]
    fn no_bytes_make_it_panic(payload: Vec<u8>, topic: String) {
        let mapping = mapping(TimeForm::Seconds);
        _ = mapping.row(&payload, 0);
        _ = mapping.addressed(&topic);
    }

    #[test]
    fn a_number_arrives_with_all_its_bits(value: f64) {
        proptest::prop_assume!(value.is_finite());
        let payload = format!("{{\"t\":0,\"data\":{{\"p\":{value:?}}}}}");
        let row = Mapping { message_bytes: 1000, ..mapping(TimeForm::Seconds) }.row(payload.as_bytes(), 0).unwrap();
        proptest::prop_assert_eq!(row.cells[0].to_bits(), value.to_bits());
    }
}
