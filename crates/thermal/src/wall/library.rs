//! Materials as data: values at 293.15 K, relative slopes, and where each number comes from.
//!
//! Slopes that a source gives as a polynomial are its tangent or secant over about -50 to 80 °C. A number marked
//! *practice* is what handbooks and simulation papers commonly use; no primary source was at hand.
use super::material::Material;

/// A material of the library; fields as in [`Material`].
#[derive(Clone, Copy, Debug, PartialEq)]
struct Entry {
    name: &'static str,
    density_kg_m3: f64,
    heat_capacity_j_kg_k: f64,
    heat_capacity_slope_per_k: f64,
    conductivity_w_m_k: f64,
    conductivity_slope_per_k: f64,
    source: &'static str,
}

const ENTRIES: [Entry; 8] = [
    Entry {
        name: "34CrMo4",
        density_kg_m3: 7850.0,
        heat_capacity_j_kg_k: 461.0,
        heat_capacity_slope_per_k: 6.0e-4,
        conductivity_w_m_k: 42.0,
        conductivity_slope_per_k: -4.5e-4,
        source: "EN 10083-3 data sheet (7850 kg/m3); heat capacity of 55Cr3 at -100, 20 and 100 degC (423, 461, 479 J/kg/K); \
                 conductivity: practice, near 25CrMo4 (42.7 W/m/K); its slope: 34Cr4 (46.5, 44.4, 42.3 W/m/K at 100, 200, \
                 300 degC)",
    },
    Entry {
        name: "25CrMo4",
        density_kg_m3: 7850.0,
        heat_capacity_j_kg_k: 455.0,
        heat_capacity_slope_per_k: 6.0e-4,
        conductivity_w_m_k: 42.7,
        conductivity_slope_per_k: -4.5e-4,
        source: "4130/25CrMo4 data sheets: 7850 kg/m3, 477 J/kg/K at 100 degC, 42.7 W/m/K; slope of the heat capacity as \
                 55Cr3, slope of the conductivity as 34Cr4",
    },
    Entry {
        name: "stainless-304",
        density_kg_m3: 7900.0,
        heat_capacity_j_kg_k: 500.0,
        heat_capacity_slope_per_k: 5.9e-4,
        conductivity_w_m_k: 15.0,
        conductivity_slope_per_k: 8.6e-4,
        source: "EN 10088-1 (1.4301 at 20 degC); slopes: EN 1993-1-2 annex C, c = 450 + 0.280 T, k = 14.6 + 0.0127 T",
    },
    Entry {
        name: "stainless-316",
        density_kg_m3: 8000.0,
        heat_capacity_j_kg_k: 500.0,
        heat_capacity_slope_per_k: 5.9e-4,
        conductivity_w_m_k: 15.0,
        conductivity_slope_per_k: 8.6e-4,
        source: "EN 10088-1 (1.4401 at 20 degC); slopes: EN 1993-1-2 annex C, c = 450 + 0.280 T, k = 14.6 + 0.0127 T",
    },
    Entry {
        name: "aluminium-6061",
        density_kg_m3: 2700.0,
        heat_capacity_j_kg_k: 896.0,
        heat_capacity_slope_per_k: 4.5e-4,
        conductivity_w_m_k: 167.0,
        conductivity_slope_per_k: 3.7e-4,
        source: "6061-T6 data sheets; slopes: EN 1999-1-2, c = 903 + 0.41 T, k = 190 + 0.07 T (6xxx alloys)",
    },
    Entry {
        name: "carbon-composite",
        density_kg_m3: 1550.0,
        heat_capacity_j_kg_k: 920.0,
        heat_capacity_slope_per_k: 2.5e-3,
        conductivity_w_m_k: 0.6,
        conductivity_slope_per_k: 0.0,
        source: "practice for wound carbon fibre in epoxy, 60 % fibres, across the fibres",
    },
    Entry {
        name: "HDPE",
        density_kg_m3: 950.0,
        heat_capacity_j_kg_k: 1900.0,
        heat_capacity_slope_per_k: 2.5e-3,
        conductivity_w_m_k: 0.45,
        conductivity_slope_per_k: -2.0e-3,
        source: "practice for liners of high-density polyethylene",
    },
    Entry {
        name: "brass",
        density_kg_m3: 8470.0,
        heat_capacity_j_kg_k: 380.0,
        heat_capacity_slope_per_k: 2.0e-4,
        conductivity_w_m_k: 123.0,
        conductivity_slope_per_k: 0.0,
        source: "CuZn39Pb3 (CW614N) data sheet: 8470 kg/m3, 123 W/m/K; heat capacity of neighbouring brasses, 375 to 380 \
                 J/kg/K; its slope: practice",
    },
];

/// Names of the library's materials.
pub(crate) fn names() -> impl Iterator<Item = &'static str> {
    ENTRIES.iter().map(|entry| entry.name)
}

/// A material of the library by name, whatever its case.
pub(crate) fn find(name: &str) -> Option<Material> {
    let entry = ENTRIES.iter().find(|entry| entry.name.eq_ignore_ascii_case(name))?;
    Some(Material {
        name: entry.name.to_owned(),
        density_kg_m3: entry.density_kg_m3,
        heat_capacity_j_kg_k: entry.heat_capacity_j_kg_k,
        heat_capacity_slope_per_k: entry.heat_capacity_slope_per_k,
        conductivity_w_m_k: entry.conductivity_w_m_k,
        conductivity_slope_per_k: entry.conductivity_slope_per_k,
        source: entry.source.to_owned(),
    })
}
