//! Messages that were good once: valid JSON, changed here and there. `PROPTEST_CASES` raises their number.
use super::*;
use proptest::prelude::*;

const GOOD: [&str; 3] = [
    r#"{"t":1767225600.25,"data":{"p":200.1,"temps":[15.3,14]}}"#,
    r#"{"t":-1e9,"data":{"p":null,"temps":[-1.5E2]},"more":{"a":[true,"\u00e9",[[]]]}}"#,
    r#"{"data":{"temps":[0],"p":1e-7},"t":1767225600}"#,
];

fn mapping() -> Mapping {
    Mapping { message_bytes: 200, prefix: "out".to_owned(), ..super::tests::mapping(TimeForm::Seconds) }
}

/// What can happen to bytes.
#[derive(Clone, Debug)]
enum Change {
    Put(usize, u8),
    Insert(usize, Vec<u8>),
    Remove(usize, usize),
    Repeat(usize, usize, usize),
}

fn change() -> impl Strategy<Value = Change> {
    let byte = prop_oneof![any::<u8>(), proptest::sample::select(b"{}[]:,.-+eE\"\\0919ntf \0".to_vec())];
    let words = ["NaN", "-0", "1e999", "null", "\"x\"", "[[[[", "{\"t\":", "\u{feff}", "9999999999999999999"];
    let word = proptest::sample::select(words.map(|word| word.as_bytes().to_vec()).to_vec());
    let at = 0..80usize;
    prop_oneof![
        (at.clone(), byte).prop_map(|(at, byte)| Change::Put(at, byte)),
        (at.clone(), word).prop_map(|(at, word)| Change::Insert(at, word)),
        (at.clone(), 1..9usize).prop_map(|(at, count)| Change::Remove(at, count)),
        (at, 1..9usize, 1..20usize).prop_map(|(at, count, times)| Change::Repeat(at, count, times)),
    ]
}

fn changed(bytes: &mut Vec<u8>, change: &Change) {
    let within = |at: usize, count: usize| at.min(bytes.len())..(at + count).min(bytes.len());
    match change {
        Change::Put(at, byte) => bytes.iter_mut().skip(*at).take(1).for_each(|old| *old = *byte),
        Change::Insert(at, word) => _ = bytes.splice(within(*at, 0), word.clone()),
        Change::Remove(at, count) => _ = bytes.drain(within(*at, *count)),
        Change::Repeat(at, count, times) => {
            let part = bytes[within(*at, *count)].repeat(*times);
            bytes.splice(within(*at, 0), part);
        }
    }
}

#[test]
fn what_is_changed_was_good() {
    for good in GOOD {
        assert!(mapping().row(good.as_bytes(), 0).is_ok(), "{good}");
    }
}

proptest! {
    #[test]
    fn a_changed_message_is_a_row_of_numbers_or_refused(
        good in 0..GOOD.len(),
        changes in proptest::collection::vec(change(), 1..6),
    ) {
        let mut bytes = GOOD[good].as_bytes().to_vec();
        changes.iter().for_each(|change| changed(&mut bytes, change));
        let row = mapping().row(&bytes, 0);
        let is_json = serde_json::from_slice::<Value>(&bytes).is_ok();
        match row {
            Err(Refusal::TooLarge) => prop_assert!(bytes.len() > 200),
            Err(Refusal::NoJson) => prop_assert!(!is_json),
            Err(refusal) => prop_assert!(is_json, "{refusal:?}"),
            Ok(row) => {
                prop_assert!(is_json && row.cells.len() == 2);
                prop_assert!(row.cells.iter().all(|cell| !cell.is_infinite()));
                prop_assert!(row.cells.iter().any(|cell| !cell.is_nan()));
            }
        }
    }

    #[test]
    fn a_changed_topic_belongs_to_a_name_that_is_one_level(
        good in proptest::sample::select(vec!["plant/a", "train/7/gas", "out/A/acknowledge"]),
        changes in proptest::collection::vec(change(), 1..6),
    ) {
        let mut bytes = good.as_bytes().to_vec();
        changes.iter().for_each(|change| changed(&mut bytes, change));
        let topic = String::from_utf8_lossy(&bytes).into_owned();
        match mapping().addressed(&topic) {
            Some(Addressed::Named(name)) => prop_assert_eq!((name, topic.as_str()), ("A", "plant/a")),
            Some(Addressed::ByPattern(name) | Addressed::Acknowledge(name)) => prop_assert!(is_level(name)),
            None => {}
        }
    }
}
