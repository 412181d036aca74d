//! Values from tables and from CoolProp 8.0.0, with their source.
use cylwatch_thermal::fluid::Fluid;

/// The project's reference table (CoolProp 8.0.0, HEOS nitrogen); skipped where the folder is not there.
#[test]
fn nitrogen_agrees_with_the_reference_table() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/data/nitrogen_reference.csv");
    let Ok(text) = std::fs::read_to_string(path) else {
        println!("skipped: {path} is not there");
        return;
    };
    let fluid = Fluid::named("nitrogen").unwrap();
    let rows: Vec<Vec<f64>> =
        text.lines().skip(1).map(|line| line.split(',').map(|v| v.parse().unwrap()).collect()).collect();
    let origin = {
        let r = &rows[0];
        let s = fluid.state(r[2], r[0]);
        [r[4] - s.internal_energy_j_kg, r[5] - s.enthalpy_j_kg, r[6] - s.entropy_j_kg_k]
    };
    let mut worst = [0.0_f64; 14];
    for r in &rows {
        let rho = fluid.density_from_pressure_temperature(r[1], r[0]).unwrap();
        let s = fluid.checked_state(rho, r[0]).unwrap();
        let here = [
            s.temperature_k,
            s.pressure_pa,
            s.density_kg_m3,
            s.compressibility,
            s.internal_energy_j_kg + origin[0],
            s.enthalpy_j_kg + origin[1],
            s.entropy_j_kg_k + origin[2],
            s.cv_j_kg_k,
            s.cp_j_kg_k,
            s.sound_speed_m_s,
            s.dp_dt_pa_k,
            s.dp_drho_pa_m3_kg,
            fluid.viscosity_pa_s(rho, r[0]),
            fluid.conductivity_w_m_k(rho, r[0]),
        ];
        for (k, value) in here.iter().enumerate() {
            worst[k] = worst[k].max((value / r[k] - 1.0).abs());
        }
    }
    println!("{worst:?}");
    for (k, deviation) in worst.iter().enumerate() {
        let bar = if k < 12 { 3e-7 } else { 1e-6 };
        assert!(*deviation <= bar, "column {k}: {deviation:e}");
    }
}
