//! Every message about a vessel file, one broken input at a time.
use super::{vessel_message, vessel_with};

#[test]
fn each_fault_of_a_vessel_names_line_key_and_remedy() {
    let cases = [
        ("thickness_mm = 5.8", "thickness_mm = -6"),
        ("thickness_mm = 5.8", "thickness_inch = 6"),
        ("thickness_mm = 5.8", "thickness_bar = 6"),
        ("thickness_mm = 5.8", "thickness = 6"),
        ("thickness_mm = 5.8", "thicknes_mm = 6"),
        ("thickness_mm = 5.8", "thickness_mm = 6\nthickness_cm = 0.6"),
        ("thickness_mm = 5.8", "thickness_mm = nan"),
        ("thickness_mm = 5.8", "thickness_mm = 1e400"),
        ("thickness_mm = 5.8", "thickness_mm = \"6\""),
        ("thickness_mm = 5.8", "thickness_mm = 6\nthickness_mm = 6"),
        ("thickness_mm = 5.8", ""),
        ("cylinder_cells = 6", "cylinder_cells = 6.5"),
        ("cylinder_cells = 6", "cylinder_cells = -6"),
        ("cylinder_cells = 6", "cylinder_cells = 0"),
        ("fluid = \"nitrogen\"", ""),
        ("fluid = \"nitrogen\"", "fluid = 7"),
        ("fluid = \"nitrogen\"", "fluid = \"nitrogn\""),
        ("\"reference\"", "\"idealgas\""),
        ("emissivity = 0.9", "emissivity = 1.3"),
        ("emissivity = 0.9", "emisivity = 0.9"),
        ("law = \"mcadams\"", "law = \"coefficient\""),
        ("law = \"mcadams\"", "factor = 0.1"),
        ("material = \"34CrMo4\"", "material = \"34CrMo\""),
        ("[[layer]]", "[[material]]"),
        ("volume_l = 20.0", "volume_l = 2000"),
        ("model = \"well-mixed\"", "model = \"well-mixed\"\ncells = 4"),
        ("[gas]", "[gas"),
        ("[surface]", "[srface]"),
        ("depth_mm = 90", "depth_mm = 90\nshape = 3"),
        ("thermal_expansion_per_k = 3.5e-5", "rigid = true\nthermal_expansion_per_k = 3.5e-5"),
        ("[geometry]\n", "geometry = 3\n"),
        ("inner_diameter_mm = 25", "inner_diameter_mm = 250"),
    ];
    for (from, to) in cases {
        println!("{to:?}\n    {}", vessel_message(&vessel_with(from, to)));
    }
}
