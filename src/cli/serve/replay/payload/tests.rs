use super::*;
use crate::cli::serve::mapping::Reading;
use crate::thermal::units::{Dimension, units_of};

fn mapping(form: TimeForm, time: &str, at: &[&str]) -> Mapping {
    let reading = |at: &&str| Reading { name: String::new(), at: (*at).to_owned() };
    Mapping {
        format: PayloadFormat::Json,
        topics: [].into(),
        pattern: None,
        time: time.to_owned(),
        form,
        readings: at.iter().map(reading).collect(),
        message_bytes: 1000,
        prefix: String::new(),
    }
}

#[test]
fn a_message_is_read_as_the_row_that_it_was_made_of() {
    let at = ["/data/p", "/data/temps/1", "/data/temps/0", "/x~1y/~0", "/1/a"];
    let cells = [200.125, 15.03, f64::NAN, -0.1, 1e-300];
    for form in [TimeForm::Rfc3339, TimeForm::Seconds, TimeForm::Milliseconds] {
        let mapping = mapping(form, "/head/t", &at);
        let time_us = 1_767_225_600_250_001;
        let text = Payload::of(&mapping).unwrap().text(time_us, &cells);
        let row = mapping.row(text.as_bytes(), 0).unwrap();
        assert_eq!(row.time_ns, time_us * 1000, "{text}");
        let bits = |cells: &[f64]| cells.iter().map(|cell| cell.to_bits()).collect::<Vec<_>>();
        assert_eq!(bits(&row.cells), bits(&cells), "{text}");
    }
}

#[test]
fn numbers_below_a_key_are_a_list_and_others_keys() {
    let mapping = mapping(TimeForm::Seconds, "/t", &["/l/2", "/o/0", "/o/b", "/z/01"]);
    let text = Payload::of(&mapping).unwrap().text(0, &[1.0, 2.0, 3.0, 4.0]);
    assert_eq!(text, r#"{"t":0.0,"l":[null,null,1.0],"o":{"0":2.0,"b":3.0},"z":{"01":4.0}}"#);
}

#[test]
fn values_that_share_a_place_and_messages_without_a_time_cannot_be_played() {
    for at in [&["/p", "/p"][..], &["/t"], &["/t/p"], &["/a/b", "/a"]] {
        let error = Payload::of(&mapping(TimeForm::Seconds, "/t", at)).unwrap_err().to_string();
        assert!(error.contains("two values"), "{error}");
    }
    assert!(Payload::of(&mapping(TimeForm::Arrival, "", &["/p"])).is_err());
}

proptest::proptest! {
    #[test]
    fn what_a_log_has_in_a_unit_comes_back_in_si_with_all_its_bits(value in -1e4..1e4) {
        for unit in units_of(Dimension::Temperature).chain(units_of(Dimension::Pressure)) {
            let si = unit.to_si(value);
            proptest::prop_assert_eq!(unit.to_si(written(unit, si)), si, "{}", unit.suffix);
        }
    }

    #[test]
    fn a_reading_of_a_few_digits_stays_as_the_logger_wrote_it(digits in -99_999i32..99_999) {
        let value = f64::from(digits) / 1000.0;
        for suffix in ["bar", "kpa", "psi", "degc", "k"] {
            let unit = units_of(Dimension::Temperature).chain(units_of(Dimension::Pressure));
            let unit = unit.into_iter().find(|unit| unit.suffix == suffix).unwrap();
            proptest::prop_assert_eq!(written(unit, unit.to_si(value)), value, "{}", suffix);
        }
    }
}
