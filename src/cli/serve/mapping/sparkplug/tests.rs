use super::super::Reading;
use super::super::protobuf::{Properties, Property};
use super::*;
use crate::cli::serve::document::{PayloadFormat, TimeForm};
use proptest::prelude::*;

/// 2026-01-01, ms.
const T_MS: u64 = 1_767_225_600_000;
/// A birth with a pressure (single precision, alias 7), a temperature (16 bits, alias 8) and a door (alias 9), and data by alias alone with a
/// pressure after 60 s and a temperature after 50 s: written by pysparkplug 0.6.1 (Apache-2.0).
const BIRTH: &str = "0880d0eab6b733121e0a0c4761732f507265737375726510071880d0eab6b73320096500804843121d0a0c4761732f53686f756c64657210081880d0eab6b733200250e7ff0312130a04446f6f7210091880d0eab6b733200b70011801";
const DATA: &str = "08e0a4eeb6b733120e100718e0a4eeb6b7336500804743120d100818d0d6edb6b73350e8ff031802";

fn bytes(hexadecimal: &str) -> Vec<u8> {
    (0..hexadecimal.len())
        .step_by(2)
        .map(|at| u8::from_str_radix(&hexadecimal[at..at + 2], 16).unwrap())
        .collect()
}

fn mapping() -> Mapping {
    let reading = |name: &str, at: &str| Reading { name: name.to_owned(), at: at.to_owned() };
    Mapping {
        format: PayloadFormat::SparkplugB,
        topics: [("depot/n1/A".to_owned(), "A".to_owned()), ("depot/n2".to_owned(), "B".to_owned())].into(),
        pattern: super::super::Pattern::of("yard/n3/+", 2),
        time: String::new(),
        form: TimeForm::Rfc3339,
        readings: vec![reading("pressure_bar", "Gas/Pressure"), reading("shoulder_degc", "Gas/Shoulder")],
        message_bytes: 1000,
        prefix: "cylwatch".to_owned(),
    }
}

type Heard = Result<(Vec<(i64, Vec<f64>)>, Option<String>), Refusal>;

/// Rows in seconds since 2026, and the topic of a command.
fn hear(nodes: &mut Nodes, topic: &str, payload: &[u8]) -> Heard {
    let mapping = mapping();
    let origin = Origin::of(topic).unwrap();
    let is_cylinder = mapping.addressed(&origin.place()).is_some();
    let (rows, command) = nodes.hear(&mapping, (&origin, is_cylinder), payload, 3)?;
    let second = |row: &Accepted| row.time_ns / 1_000_000_000 - T_MS as i64 / 1000;
    Ok((rows.iter().map(|row| (second(row), row.cells.clone())).collect(), command.map(|(topic, _)| topic)))
}

fn payload(seq: u64, metrics: Vec<Metric>) -> Vec<u8> {
    Payload { timestamp: Some(T_MS), metrics, seq: Some(seq) }.encode_to_vec()
}

fn metric(name: &str, value: Value) -> Metric {
    Metric { name: Some(name.to_owned()), value: Some(value), ..Metric::default() }
}

#[test]
fn a_birth_and_data_by_alias_that_another_program_wrote_become_rows_in_the_order_of_their_times() {
    let mut nodes = Nodes::default();
    let (rows, command) = hear(&mut nodes, "spBv1.0/depot/DBIRTH/n1/A", &bytes(BIRTH)).unwrap();
    assert_eq!((rows, command), (vec![(0, vec![200.5, -25.0])], None));
    let (rows, command) = hear(&mut nodes, "spBv1.0/depot/DDATA/n1/A", &bytes(DATA)).unwrap();
    assert!(command.is_none() && rows.len() == 2);
    assert!(rows[0].0 == 50 && rows[0].1[0].is_nan() && rows[0].1[1] == -24.0, "{rows:?}");
    assert!(rows[1].0 == 60 && rows[1].1[0] == 199.5 && rows[1].1[1].is_nan(), "{rows:?}");
}

#[test]
fn topics_name_places_and_one_filter_hears_all_of_a_node() {
    for (topic, place) in [
        ("spBv1.0/depot/DDATA/n1/A", Some("depot/n1/A")),
        ("spBv1.0/depot/NBIRTH/n2", Some("depot/n2")),
        ("spBv1.0/depot/NCMD/n2", None),
        ("spBv1.0/STATE/host", None),
        ("spBv1.0/depot/DDATA/n1", None),
        ("spBv1.0/depot/DDATA/n1/A/B", None),
        ("spAv1.0/depot/DDATA/n1/A", None),
    ] {
        assert_eq!(Origin::of(topic).map(|origin| origin.place()).as_deref(), place, "{topic}");
    }
    let filters = mapping().filters();
    let expected =
        ["cylwatch/+/acknowledge", "spBv1.0/depot/+/n1/#", "spBv1.0/depot/+/n2/#", "spBv1.0/yard/+/n3/#"];
    assert_eq!(filters, expected);
}

#[test]
fn who_cannot_be_understood_is_asked_for_a_birth_once() {
    let mut nodes = Nodes::default();
    let asked = Some("spBv1.0/depot/NCMD/n1".to_owned());
    // The gateway has started after the node: aliases are not known.
    let (rows, command) = hear(&mut nodes, "spBv1.0/depot/DDATA/n1/A", &bytes(DATA)).unwrap();
    assert_eq!((rows.len(), command), (0, asked.clone()));
    let again = hear(&mut nodes, "spBv1.0/depot/DDATA/n1/A", &bytes(DATA)).unwrap();
    assert_eq!(again, (vec![], None));
    // Names are understood without a birth.
    let by_name = payload(3, vec![metric("Gas/Pressure", Value::Double(200.0))]);
    assert_eq!(hear(&mut nodes, "spBv1.0/depot/DDATA/n1/A", &by_name).unwrap().0.len(), 1);
    // A message is missing.
    nodes = Nodes::default();
    let session = |number| metric(SESSION, Value::Long(number));
    hear(&mut nodes, "spBv1.0/depot/NBIRTH/n1", &payload(0, vec![session(4)])).unwrap();
    hear(&mut nodes, "spBv1.0/depot/DBIRTH/n1/A", &bytes(BIRTH)).unwrap();
    // A device that is no cylinder counts as well.
    hear(&mut nodes, "spBv1.0/depot/DDATA/n1/Z", &payload(2, vec![])).unwrap();
    assert_eq!(hear(&mut nodes, "spBv1.0/depot/DDATA/n1/A", &payload(3, vec![])).unwrap().1, None);
    assert_eq!(hear(&mut nodes, "spBv1.0/depot/DDATA/n1/A", &payload(5, vec![])).unwrap().1, asked);
}

#[test]
fn numbers_of_messages_begin_again_after_255_and_a_death_of_another_session_is_passed_over() {
    let mut nodes = Nodes::default();
    let session = |number| metric(SESSION, Value::Long(number));
    let death =
        |number| Payload { timestamp: None, metrics: vec![session(number)], seq: None }.encode_to_vec();
    hear(&mut nodes, "spBv1.0/depot/NBIRTH/n1", &payload(254, vec![session(4)])).unwrap();
    hear(&mut nodes, "spBv1.0/depot/DBIRTH/n1/A", &payload(255, vec![metric("Gas/Pressure", Value::Int(3))]))
        .unwrap();
    assert_eq!(hear(&mut nodes, "spBv1.0/depot/DDATA/n1/A", &payload(0, vec![])).unwrap().1, None);
    hear(&mut nodes, "spBv1.0/depot/NDEATH/n1", &death(3)).unwrap();
    assert_eq!(hear(&mut nodes, "spBv1.0/depot/DDATA/n1/A", &payload(1, vec![])).unwrap().1, None);
    hear(&mut nodes, "spBv1.0/depot/NDEATH/n1", &death(4)).unwrap();
    assert!(hear(&mut nodes, "spBv1.0/depot/DDATA/n1/A", &payload(2, vec![])).unwrap().1.is_some());
}

#[test]
fn null_bad_and_stale_values_are_missing_and_words_are_no_numbers() {
    let mut nodes = Nodes::default();
    let topic = "spBv1.0/depot/NDATA/n2";
    let quality = |int: u32| Properties {
        keys: vec!["Quality".to_owned()],
        values: vec![Property { int: Some(int), long: None }],
    };
    let pressure =
        |int| Metric { properties: Some(quality(int)), ..metric("Gas/Pressure", Value::Double(200.0)) };
    let shoulder = metric("Gas/Shoulder", Value::Double(15.0));
    for (quality, is_there) in [(192, true), (0, false), (500, false)] {
        let (rows, _) =
            hear(&mut nodes, topic, &payload(0, vec![pressure(quality), shoulder.clone()])).unwrap();
        assert_eq!(!rows[0].1[0].is_nan(), is_there, "{quality}");
    }
    let null = Metric { is_null: Some(true), value: None, ..pressure(192) };
    assert_eq!(hear(&mut nodes, topic, &payload(1, vec![null])).unwrap().0, []);
    for value in [
        Value::String("200".into()),
        Value::Boolean(true),
        Value::Bytes(vec![1]),
        Value::Double(f64::NAN),
        Value::Float(f32::INFINITY),
    ] {
        let refused = hear(&mut nodes, topic, &payload(2, vec![metric("Gas/Pressure", value)]));
        assert_eq!(refused, Err(Refusal::NoNumber));
    }
    let late = Metric { timestamp: Some(u64::MAX), ..pressure(192) };
    assert_eq!(hear(&mut nodes, topic, &payload(3, vec![late])), Err(Refusal::NoTime));
    assert_eq!(hear(&mut nodes, topic, &[0xff; 9]), Err(Refusal::NoSparkplug));
    assert_eq!(hear(&mut nodes, topic, &[0; 1001]), Err(Refusal::TooLarge));
}

#[test]
fn nodes_without_end_are_not_kept() {
    let mut nodes = Nodes::default();
    let mapping = mapping();
    for number in 0..100 {
        let topic = format!("spBv1.0/depot/DDATA/n{number}/A");
        let heard = nodes.hear(&mapping, (&Origin::of(&topic).unwrap(), true), &payload(0, vec![]), 3);
        assert_eq!(heard.is_err(), number >= 3);
    }
    assert_eq!(nodes.0.len(), 3);
}

proptest! {
    /// A valid message with bytes that are changed, left out or doubled.
    #[test]
    fn nearly_valid_payloads_give_rows_or_a_refusal(
        birth: bool,
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>(), 0_u8..4), 0..6),
    ) {
        let mut payload = bytes(if birth { BIRTH } else { DATA });
        for (at, byte, how) in changes {
            let at = at.index(payload.len());
            match how {
                0 => payload[at] = byte,
                1 => payload[at] ^= 1 << (byte % 8),
                2 if payload.len() > 1 => _ = payload.remove(at),
                _ => payload.insert(at, byte),
            }
        }
        let mut nodes = Nodes::default();
        hear(&mut nodes, "spBv1.0/depot/DBIRTH/n1/A", &bytes(BIRTH)).unwrap();
        let topic = if birth { "spBv1.0/depot/DBIRTH/n1/A" } else { "spBv1.0/depot/DDATA/n1/A" };
        if let Ok((rows, _)) = hear(&mut nodes, topic, &payload) {
            prop_assert!(rows.iter().all(|(_, cells)| cells.iter().all(|cell| !cell.is_infinite())));
        }
    }
}
