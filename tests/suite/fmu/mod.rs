//! `cylwatch fmu`: what it writes, and that its units say what the program says.
mod monitor;
mod plant;

use crate::support::{refused, run};
use cylwatch::cosimulation::variable::Type;
use cylwatch::cosimulation::{Access, Instance};
use cylwatch::report::{Table, Values};
use std::io::{Cursor, Read};
use std::path::Path;
use tempfile::{TempDir, tempdir};
use zip::ZipArchive;

const FILL: [&str; 4] = ["--fill-pressure-bar", "200", "--fill-temperature-degc", "15"];
const STEP_S: f64 = 60.0;
/// A folder with something in place of the library: these tests load none.
fn folder() -> TempDir {
    let folder = tempdir().unwrap();
    std::fs::write(folder.path().join("library.so"), b"a library").unwrap();
    folder
}

fn fmu<'a>(more: &[&'a str]) -> Vec<&'a str> {
    [&["fmu", "nitrogen-20l", "--library", "library.so"], &FILL[..], more].concat()
}

fn file_of(archive: &[u8], name: &str) -> Vec<u8> {
    let mut bytes = Vec::new();
    ZipArchive::new(Cursor::new(archive)).unwrap().by_name(name).unwrap().read_to_end(&mut bytes).unwrap();
    bytes
}

/// Writes an archive and reads it.
fn written(folder: &Path, name: &str, more: &[&str]) -> Vec<u8> {
    let outcome = run(folder, &[&fmu(more)[..], &["-o", name]].concat());
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    std::fs::read(folder.join(name)).unwrap()
}

fn unit(folder: &Path, more: &[&str]) -> Instance {
    Instance::new(&file_of(&written(folder, "unit.fmu", more), "resources/cylinder.bin")).unwrap()
}

fn reference(unit: &Instance, name: &str) -> u32 {
    u32::try_from(unit.variables().iter().position(|of| of.name == name).unwrap_or_else(|| panic!("{name}")))
        .unwrap()
}

fn access(unit: &Instance, reference: u32) -> Access {
    match unit.variables()[reference as usize].kind {
        Type::Real(_) => Access::Real,
        _ => Access::IntegerOrEnumeration,
    }
}

fn get(unit: &mut Instance, name: &str) -> f64 {
    let reference = reference(unit, name);
    let access = access(unit, reference);
    unit.get(reference, access).unwrap()
}

fn set(unit: &mut Instance, name: &str, value: f64) {
    let reference = reference(unit, name);
    unit.set(reference, Access::Real, value).unwrap();
}

fn begun(mut unit: Instance, parameters: &[(&str, f64)]) -> Instance {
    unit.enter_initialization().unwrap();
    parameters.iter().for_each(|&(name, value)| set(&mut unit, name, value));
    unit.exit_initialization().unwrap();
    unit
}

fn numbers(table: &Table, name: &str) -> Vec<f64> {
    match &table.columns.iter().find(|column| column.name == name).unwrap_or_else(|| panic!("{name}")).values
    {
        Values::Numbers(_, numbers) => numbers.clone(),
        other => panic!("{name}: {other:?}"),
    }
}

fn worst(ours: &[f64], theirs: &[f64]) -> f64 {
    let difference = |(ours, theirs): (&f64, &f64)| match (ours.is_nan(), theirs.is_nan()) {
        (true, true) => 0.0,
        (false, false) if ours == theirs => 0.0,
        (false, false) => (ours / theirs - 1.0).abs(),
        _ => f64::INFINITY,
    };
    ours.iter().zip(theirs).map(difference).fold(0.0, f64::max)
}

#[test]
fn an_archive_has_the_same_bytes_again_and_what_each_version_asks_for() {
    let folder = folder();
    for (kind, fmi, library, words) in [
        ("plant", "2", "binaries/linux64/cylwatch.so", "fmiVersion=\"2.0\""),
        ("plant", "3", "binaries/x86_64-linux/cylwatch.so", "fmiVersion=\"3.0\""),
        ("monitor", "2", "binaries/linux64/cylwatch.so", "name=\"sensor_fault\""),
        ("monitor", "3", "binaries/x86_64-linux/cylwatch.so", "EnumerationType"),
    ] {
        let more = ["--kind", kind, "--fmi", fmi];
        let archive = written(folder.path(), "one.fmu", &more);
        assert!(archive == written(folder.path(), "one.fmu", &more), "{kind} {fmi} differs");
        let description = String::from_utf8(file_of(&archive, "modelDescription.xml")).unwrap();
        let unit = Instance::new(&file_of(&archive, "resources/cylinder.bin")).unwrap();
        for part in [words, &unit.token(), "displayUnit=\"bar\""] {
            assert!(description.contains(part), "{part} is missing in {description}");
        }
        if std::env::consts::OS == "linux" && std::env::consts::ARCH == "x86_64" {
            assert_eq!(file_of(&archive, library), b"a library");
        }
        let provenance = String::from_utf8(file_of(&archive, "resources/provenance.txt")).unwrap();
        assert!(
            provenance.contains("cylwatch fmu nitrogen-20l") && provenance.contains("sha256"),
            "{provenance}"
        );
    }
}

#[test]
fn what_makes_no_unit_is_refused() {
    let folder = folder();
    let place = folder.path();
    refused(place, &["fmu", "nitrogen-20l", "-o", "x.fmu"], &["--kind"]);
    let none = ["fmu", "nitrogen-20l", "--kind", "plant", "-o", "x.fmu", "--library", "none.so"];
    refused(place, &none, &["none.so", "cargo build --release -p cylwatch-fmi"]);
    let unfilled = ["fmu", "nitrogen-20l", "--kind", "plant", "-o", "x.fmu", "--library", "library.so"];
    refused(place, &unfilled, &["give --fill-pressure-bar and --fill-temperature-degc"]);
    refused(place, &fmu(&["--kind", "monitor", "--film", "wind", "-o", "x.fmu"]), &["leave it out"]);
    refused(place, &fmu(&["--kind", "plant", "-o", "library.so"]), &["would be overwritten"]);
    refused(place, &fmu(&["--kind", "plant", "-o", "no/folder/x.fmu"]), &["there is no folder"]);
    assert!(!place.join("x.fmu").exists());
}
