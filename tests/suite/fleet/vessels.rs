//! The file of vessels: what is wrong with it, by line, value and remedy.
use super::{TIGHT, column, fleet, log, table, with_logs};
use crate::support::refused;

/// What is wrong with a file of vessels: text, and words of the message.
const BAD: &[(&str, &[&str])] = &[
    ("", &["fleet.csv is empty", "cylinder,vessel"]),
    ("\n\n# nothing\n", &["fleet.csv is empty"]),
    ("cylinder,vessel\n", &["no cylinder below the header", "a row for each"]),
    ("cylinder\nA\n", &["fleet.csv:1", "no column vessel"]),
    ("vessel\nnitrogen-20l\n", &["fleet.csv:1", "no column cylinder"]),
    ("# made by hand\ncylinder,vesel\nA,nitrogen-20l\n", &["fleet.csv:2", "\"vesel\"", "nearest is vessel"]),
    ("cylinder,vessel,limit\nA,nitrogen-20l,160\n", &["fleet.csv:1", "\"limit\"", "limit_bar"]),
    ("cylinder,vessel,fill_pressure_degc\nA,nitrogen-20l,160\n", &["fleet.csv:1", "fill_pressure_degc"]),
    ("cylinder,vessel,output\nA,nitrogen-20l,x\n", &["fleet.csv:1", "\"output\"", "unknown"]),
    ("cylinder,vessel,save_every_s\nA,nitrogen-20l,9\n", &["fleet.csv:1", "save_every_s"]),
    ("cylinder,vessel,\nA,nitrogen-20l,\n", &["fleet.csv:1", "\"\" is unknown"]),
    ("cylinder,vessel,vessel\nA,nitrogen-20l,x\n", &["fleet.csv:1", "vessel stands there twice"]),
    ("cylinder,vessel\n,nitrogen-20l\n", &["fleet.csv:2", "cylinder is empty"]),
    ("cylinder,vessel\nA,\n", &["fleet.csv:2", "vessel of A", "write a TOML file"]),
    ("cylinder,vessel\nA,-\n", &["fleet.csv:2", "vessel of A"]),
    ("cylinder,vessel\nA,nitrogen-20l\nA,nitrogen-20l\n", &["fleet.csv:3", "A stands in line 2 already"]),
    ("cylinder,vessel\nA,nitrogen-20\n", &["fleet.csv:2", "nitrogen-20", "nearest is nitrogen-20l"]),
    ("cylinder,vessel\nA,fleet.csv\n", &["fleet.csv:2", "fleet.csv"]),
    ("cylinder,vessel\nA,nitrogen-20l,7\n", &["fleet.csv:2", "3 cells", "2"]),
    ("cylinder,vessel,limit_bar\nA,nitrogen-20l\n", &["fleet.csv:2", "2 cells", "complete it"]),
    ("cylinder,vessel,settled\nA,nitrogen-20l,maybe\n", &["fleet.csv:2", "settled = maybe", "yes or no"]),
    ("cylinder,vessel,sensors\nA,nitrogen-20l,none.toml\n", &["fleet.csv:2", "none.toml is no file"]),
    ("cylinder,vessel,commissioned\nA,nitrogen-20l,none.json\n", &["fleet.csv:2", "none.json is no file"]),
    ("cylinder,vessel,learned_in\nA,nitrogen-20l,none.json\n", &["fleet.csv:2", "none.json is no file"]),
    ("cylinder,vessel,announced\nA,nitrogen-20l,9\n", &["fleet.csv:2", "announced 9", "FROM..UNTIL"]),
    ("cylinder,vessel,announced\nA,nitrogen-20l,9..3\n", &["fleet.csv:2", "before the beginning"]),
    ("cylinder,vessel,fill_sd_percent\nA,nitrogen-20l,0\n", &["fleet.csv:2", "fill_sd_percent 0", "above 0"]),
    ("cylinder,vessel,fill_temperature_degc\nA,nitrogen-20l,15\n", &["fleet.csv:2", "fill_temperature"]),
    ("cylinder,vessel,fill_mass_kg,fill_pressure_bar\nA,nitrogen-20l,4,200\n", &["fleet.csv:2", "fill_mass"]),
    (
        "cylinder,vessel,limit_bar,limit_psi\nA,nitrogen-20l,160,2300\n",
        &["fleet.csv:2", "limit_psi", "keep one"],
    ),
];

#[test]
fn a_file_of_vessels_that_is_wrong_is_refused_with_line_value_and_remedy() {
    let folder = with_logs(&[("A.csv", log(0..10, TIGHT))], &["A"]);
    let check = |text: &str, words: &[&str]| {
        std::fs::write(folder.path().join("fleet.csv"), text).unwrap();
        refused(folder.path(), &["fleet", "logs", "--vessels", "fleet.csv", "-o", "out", "-q"], words);
    };
    for (text, words) in BAD {
        check(text, words);
    }
    // Every quantity refuses what is no number, and what cannot be, by its own name.
    let quantities = [
        "fill_pressure_bar",
        "fill_pressure_psi",
        "fill_mass_kg",
        "fill_mass_g",
        "limit_bar",
        "limit_kpa",
        "next_service_d",
        "next_service_h",
    ];
    for column in quantities {
        for value in
            ["-1", "0", "many", "nan", "inf", "1e400", "1 2", "0x10", "200bar", "--", "1;2", "\u{221e}"]
        {
            check(&format!("cylinder,vessel,{column}\nA,nitrogen-20l,{value}\n"), &["fleet.csv:2", column]);
        }
    }
    for value in ["-300", "999", "cold", "-101"] {
        check(
            &format!("cylinder,vessel,coldest_degc\nA,nitrogen-20l,{value}\n"),
            &["fleet.csv:2", "coldest"],
        );
    }
    assert!(!folder.path().join("out").exists());
}

#[test]
fn a_file_of_vessels_may_have_semicolons_decimal_commas_and_a_byte_order_mark() {
    let folder = with_logs(&[("A.csv", log(0..90, TIGHT))], &["A"]);
    let text = "\u{feff}Cylinder;Vessel;Limit_bar;Fill_pressure_bar;Fill_temperature_degc\nA;nitrogen-20l;155,5;200;15,0\n";
    std::fs::write(folder.path().join("fleet.csv"), text).unwrap();
    let outcome = fleet(folder.path(), &[]);
    assert_eq!(outcome.code, Some(3), "{}", outcome.stderr);
    assert_eq!(column(&table(folder.path(), "summary.csv"), "limit_bar"), ["155.5"]);
}
