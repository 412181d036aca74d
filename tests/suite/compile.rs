//! `cylwatch compile`: a controller with its bytes says what `cylwatch monitor` says.
use crate::support::{refused, run};
use cylwatch::detector::compiled::CompiledCylinder;
use cylwatch::detector::evidence::Tails;
use cylwatch::log::{Cells, MemoryLog};
use cylwatch::report::Values;
use cylwatch::run::{self, Call};
use tempfile::tempdir;

const FILL: [&str; 4] = ["--fill-pressure-bar", "200", "--fill-temperature-degc", "15"];

fn compile<'a>(more: &[&'a str]) -> Vec<&'a str> {
    [&["compile", "nitrogen-20l"], &FILL[..], more].concat()
}

/// Columns of a log of six hours, a row a minute, SI.
fn rows() -> [Vec<f64>; 4] {
    let wave = |minute: usize, phase: f64| (minute as f64 / 50.0 - phase).sin();
    let of = |value: &dyn Fn(usize) -> f64| (0..360).map(value).collect();
    [
        of(&|minute| 60.0 * minute as f64),
        of(&|minute| 285.0 + 5.0 * wave(minute, 0.0)),
        of(&|minute| if minute == 77 { f64::NAN } else { 285.3 + 5.0 * wave(minute, 0.2) }),
        of(&|minute| 197e5 + 3e5 * wave(minute, 0.3)),
    ]
}

#[test]
fn a_controller_says_what_the_command_says_bit_for_bit() {
    let folder = tempdir().unwrap();
    let outcome = run(folder.path(), &compile(&["-o", "cylinder.bin", "--limit-bar", "150"]));
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    assert!(outcome.stderr.contains("shoulder in K, valve in K, pressure in Pa"), "{}", outcome.stderr);
    let bytes = std::fs::read(folder.path().join("cylinder.bin")).unwrap();
    let cylinder = CompiledCylinder::from_bytes(&bytes).unwrap();
    // Without built-in vessels nothing else says that these thresholds are its own.
    assert_eq!(cylinder.settings.tails, Some(Tails::of(&cylinder.vessel, 200e5)));
    assert_ne!(cylinder.settings.tails, Some(Tails::usual(&cylinder.vessel, 200e5)));
    let mut monitor = cylinder.monitor().unwrap();
    let columns = rows();
    let mut outputs = Vec::new();
    for (row, &time_s) in columns[0].iter().enumerate() {
        outputs.extend(monitor.step(time_s, &[1, 2, 3].map(|at| columns[at][row])).unwrap());
    }
    outputs.extend(monitor.finish().unwrap());

    let names = ["time_s", "shoulder_k", "valve_k", "pressure_pa"].map(str::to_owned);
    let columns = names.into_iter().zip(rows().map(Cells::Numbers)).collect();
    let log = MemoryLog { name: "rows".to_owned(), columns };
    let options = [("fill-pressure-bar", "200"), ("fill-temperature-degc", "15"), ("limit-bar", "150")];
    let call = options
        .iter()
        .fold(Call::new("nitrogen-20l").log(log), |call, (name, value)| call.option(name, Some(value)));
    let of_command = run::monitor(call).unwrap().rows;
    let column =
        |name: &str| match &of_command.columns.iter().find(|column| column.name == name).unwrap().values {
            Values::Numbers(_, numbers) => numbers.iter().map(|number| number.to_bits()).collect::<Vec<_>>(),
            other => panic!("{name}: {other:?}"),
        };
    let ours = |of: &dyn Fn(&cylwatch::detector::monitor::Output) -> f64| {
        outputs.iter().map(|output| of(output).to_bits()).collect::<Vec<_>>()
    };
    assert_eq!(outputs.len(), 360);
    assert_eq!(ours(&|output| output.estimate.mass_kg), column("mass_kg"));
    assert_eq!(
        ours(&|output| output.decision.leak_probability.unwrap_or(f64::NAN)),
        column("leak_probability")
    );
}

#[test]
fn an_array_in_c_has_the_same_bytes_and_says_where_they_come_from() {
    let folder = tempdir().unwrap();
    run(folder.path(), &compile(&["-o", "cylinder.bin", "--quiet"]));
    let outcome = run(folder.path(), &compile(&["-o", "cylinder.c", "--quiet"]));
    assert_eq!((outcome.code, outcome.stderr.as_str()), (Some(0), ""));
    let bytes = std::fs::read(folder.path().join("cylinder.bin")).unwrap();
    let text = std::fs::read_to_string(folder.path().join("cylinder.c")).unwrap();
    let (_, array) = text.split_once("cw_cylinder[] = {").unwrap();
    let (array, rest) = array.split_once("};").unwrap();
    let numbers: Vec<u8> = array.split(',').filter_map(|number| number.trim().parse().ok()).collect();
    assert_eq!(numbers, bytes);
    assert!(rest.contains(&format!("cw_cylinder_size = {};", bytes.len())), "{rest}");
    assert!(text.contains("cylwatch compile nitrogen-20l") && text.contains("sha256"), "{text}");
}

#[test]
fn what_a_controller_could_not_begin_with_is_refused() {
    let folder = tempdir().unwrap();
    for (arguments, words) in [
        (
            vec!["compile", "nitrogen-20l", "-o", "x.bin"],
            "give --fill-pressure-bar and --fill-temperature-degc",
        ),
        (
            vec!["compile", "nitrogen-20l", "-o", "x.bin", "--fill-pressure-bar", "200"],
            "give --fill-pressure-bar and --fill-temperature-degc",
        ),
        (compile(&["-o", "x.bin", "--readings", "shoulder,nose"]), "the place of nose is unknown"),
        (compile(&["-o", "x.bin", "--announced", "0..60"]), "leave it out"),
        (compile(&["-o", "x.bin", "--sensors", "none.toml"]), "none.toml"),
        (compile(&["-o", "no/folder/x.bin"]), "there is no folder"),
    ] {
        refused(folder.path(), &arguments, &[words]);
    }
}
