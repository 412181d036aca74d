//! Every message about a vessel file, one broken input at a time.
use cylwatch_thermal::fluid::Fluid;

use super::{CALIBRATION, vessel_message, vessel_with};

#[test]
fn each_fault_of_a_vessel_names_line_key_and_remedy() {
    let cases = [
        (
            "thickness_mm = 5.8",
            "thickness_mm = -6",
            "34: layer thickness_mm = -6 must be positive: give the thickness of this layer of the wall",
        ),
        (
            "thickness_mm = 5.8",
            "thickness_inch = 6",
            "34: layer thickness_inch is in _inch, which is no unit of thickness: use one of _mm, _m, _cm",
        ),
        (
            "thickness_mm = 5.8",
            "thickness_bar = 6",
            "34: layer thickness_bar is in _bar, which is no unit of thickness: use one of _mm, _m, _cm",
        ),
        (
            "thickness_mm = 5.8",
            "thickness = 6",
            "34: layer thickness has no unit: write thickness_mm, or another of _mm, _m, _cm",
        ),
        (
            "thickness_mm = 5.8",
            "thicknes_mm = 6",
            "34: unknown key layer thicknes_mm, did you mean thickness_mm?; known here: material, thickness_mm, cells, \
             heat_capacity_factor",
        ),
        (
            "thickness_mm = 5.8",
            "thickness_mm = 6\nthickness_cm = 0.6",
            "35: layer thickness_cm says again what thickness_mm in line 34 says: keep one of them",
        ),
        (
            "thickness_mm = 5.8",
            "thickness_mm = nan",
            "34: layer thickness_mm = nan must be a finite number: write a number or leave it out",
        ),
        (
            "thickness_mm = 5.8",
            "thickness_mm = 1e400",
            "34: layer thickness_mm = 1e400 must be a finite number: write a number or leave it out",
        ),
        ("thickness_mm = 5.8", "thickness_mm = \"6\"", "34: layer thickness_mm = \"6\" must be a number"),
        (
            "thickness_mm = 5.8",
            "thickness_mm = 6\nthickness_mm = 6",
            "35: the text cannot be read: duplicate key",
        ),
        ("thickness_mm = 5.8", "", "32: layer thickness_mm is missing: add it"),
        (
            "cylinder_cells = 6",
            "cylinder_cells = 6.5",
            "12: geometry cylinder_cells = 6.5 must be a whole number of at least 0",
        ),
        (
            "cylinder_cells = 6",
            "cylinder_cells = -6",
            "12: geometry cylinder_cells = -6 must be a whole number of at least 0",
        ),
        (
            "cylinder_cells = 6",
            "cylinder_cells = 0",
            "12: geometry cylinder_cells = 0 must be between 1 and 200: 3 to 10 cells are usual",
        ),
        ("fluid = \"nitrogen\"", "", "1: fluid is missing: add it"),
        ("fluid = \"nitrogen\"", "fluid = 7", "5: fluid = 7 must be text in quotes"),
        (
            "\"reference\"",
            "\"idealgas\"",
            "6: equation = \"idealgas\" is not known, did you mean ideal-gas?; choose one of reference, ideal-gas, peng-robinson",
        ),
        (
            "emissivity = 0.9",
            "emissivity = 1.3",
            "52: surface emissivity = 1.3 must be between 0 and 1: paint has about 0.9, bare metal 0.1 to 0.3",
        ),
        (
            "emissivity = 0.9",
            "emisivity = 0.9",
            "52: unknown key surface emisivity, did you mean emissivity?; known here: emissivity, solar_absorptivity, \
             film_factor",
        ),
        (
            "law = \"mcadams\"",
            "law = \"coefficient\"",
            "55: inside_film film_w_m2_k is missing: this law needs it",
        ),
        (
            "law = \"mcadams\"",
            "factor = 0.1",
            "56: inside_film factor cannot stand beside this law: leave it out, or choose the law that takes it",
        ),
        (
            "material = \"34CrMo4\"",
            "material = \"34CrMo\"",
            "33: layer material = \"34CrMo\" is not known, did you mean 34CrMo4?; choose one of 34CrMo4, 25CrMo4, stainless-304, stainless-316, aluminium-6061, carbon-composite, HDPE, brass",
        ),
        (
            "[[layer]]",
            "[[material]]",
            "33: unknown key material material; known here: name, density_kg_m3, heat_capacity_j_kg_k, heat_capacity_slope_per_k, conductivity_w_m_k, conductivity_slope_per_k, source",
        ),
        (
            "volume_l = 20.0",
            "volume_l = 2000",
            "38: volume volume_l = 2000 must be within 30 % of the contour's 20.0142 l: check volume, diameter and lengths",
        ),
        (
            "model = \"well-mixed\"",
            "model = \"well-mixed\"\ncells = 4",
            "60: gas cells cannot stand beside model = \"well-mixed\": leave it out, or use model = \"stratified\"",
        ),
        (
            "model = \"well-mixed\"",
            "model = \"stratified\"\ncells = 101",
            "60: gas cells = 101 must be between 2 and 100: 20 are usual; model = \"well-mixed\" is the gas of one temperature",
        ),
        ("[gas]", "[gas", "58: the text cannot be read: unclosed table, expected `]`"),
        (
            "[surface]",
            "[srface]",
            "51: unknown key srface, did you mean surface?; known here: name, fluid, equation, orientation, geometry, layer, material, volume, valve, surface, inside_film, gas, \
             calibration",
        ),
        ("depth_mm = 90", "depth_mm = 90\nshape = 3", "23: the text cannot be read: duplicate key"),
        (
            "thermal_expansion_per_k = 3.5e-5",
            "rigid = true\nthermal_expansion_per_k = 3.5e-5",
            "40: volume thermal_expansion_per_k cannot stand beside rigid = true: keep one of them",
        ),
        (
            "[geometry]\n",
            "geometry = 3\n",
            "14: the text cannot be read: cannot extend value of type integer with a dotted key",
        ),
        (
            "inner_diameter_mm = 25",
            "inner_diameter_mm = 250",
            "27: geometry.neck inner_diameter_mm = 250 must be smaller: the neck's outer diameter has to fit into the cylinder's inner diameter",
        ),
    ];
    for (from, to, expected) in cases {
        let message = vessel_message(&vessel_with(from, to));
        assert_eq!(message, format!("vessels/x.toml:{expected}"), "for {to:?}");
    }
}

#[test]
fn a_gas_that_the_fluids_do_not_know_is_refused_at_its_line() {
    let Err(refusal) = Fluid::named("nitrogn") else { return };
    let message = vessel_message(&vessel_with("fluid = \"nitrogen\"", "fluid = \"nitrogn\""));
    assert_eq!(message, format!("vessels/x.toml:5: fluid = \"nitrogn\" must be a known gas: {refusal}"));
}

#[test]
fn a_record_that_claims_what_cannot_be_is_refused() {
    let plain = cylwatch_thermal::vessel::presets::FILES.text("nitrogen-20l").unwrap();
    let cases = [
        (
            "date = \"2026-03-01T12:00:00Z\"",
            "date = \"yesterday\"",
            "calibration date = \"yesterday\" must be a date",
        ),
        ("confidence = 0.95", "confidence = 95", "calibration confidence = 95 must be below 1"),
        ("sha256 = \"BA7816", "sha256 = \"", "calibration.log sha256 = \"bf8f01"),
        (
            "value = 1.2",
            "value = 1.3",
            "calibration.fitted value = 1.3 must be between low = 1.18 and high = 1.22",
        ),
        ("sd = 1.0", "sd = 0.0", "prior sd = 0.0 must be positive"),
    ];
    for (from, to, expected) in cases {
        assert_eq!(CALIBRATION.matches(from).count(), 1, "{from}");
        let message = vessel_message(&format!("{plain}{}", CALIBRATION.replace(from, to)));
        assert!(message.contains(expected), "`{expected}` is not in {message}");
    }
    for (from, to) in [
        ("thickness_mm = 5.8", "thickness_mm = 5.8\nheat_capacity_factor = 0"),
        ("emissivity = 0.9", "emissivity = 0.9\nfilm_factor = -1"),
    ] {
        assert!(vessel_message(&vessel_with(from, to)).contains("_factor = "), "{to}");
    }
}
