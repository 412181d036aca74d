use super::*;

/// Properties by polynomials and by the equation; the largest relative difference of each property and derivative.
fn differences(name: &str, temperatures_k: (f64, f64), pressures_pa: (f64, f64)) -> [f64; 3] {
    let fluid = Fluid::named(name).unwrap();
    let mut chart = Chart::new(fluid.clone());
    let mut worst = [0.0_f64; 3];
    let mut used = 0;
    for step in 0..300_u32 {
        // Incommensurable strides: everywhere in a cell, on either side of its edges.
        let (u, v) = ((f64::from(step) * 0.618_034).fract(), (f64::from(step) * 0.754_878).fract());
        let t = temperatures_k.0 + u * (temperatures_k.1 - temperatures_k.0);
        let p = pressures_pa.0 * (pressures_pa.1 / pressures_pa.0).powf(v);
        let rho = fluid.density_from_pressure_temperature(p, t).unwrap();
        let exact = chart.exact(rho, t);
        used += usize::from(chart.isotherm(rho, t).is_some());
        let found = chart.properties(rho, t);
        let pairs =
            [(found.p, exact.p), (found.cv, exact.cv), (found.p_t, exact.p_t), (found.p_rho, exact.p_rho)];
        for (found, exact) in pairs {
            let scale = exact.value.abs();
            worst[0] = worst[0].max((found.value - exact.value).abs() / scale);
            worst[1] = worst[1].max((found.by_t - exact.by_t).abs() * t / scale);
            worst[2] = worst[2].max((found.by_rho - exact.by_rho).abs() * rho / scale);
        }
    }
    println!("{name}: values {:.1e}, by T {:.1e}, by rho {:.1e}", worst[0], worst[1], worst[2]);
    assert!(used == 300, "{name}: polynomials in {used} of 300 states");
    worst
}

#[test]
fn polynomials_agree_with_the_equation_and_its_derivatives() {
    for name in Fluid::names() {
        // As far as it is gas there: carbon dioxide condenses at 41.6 bar and 280 K.
        let near_saturation = name == "carbon-dioxide";
        let states =
            if near_saturation { ((280.0, 360.0), (1e5, 4e6)) } else { ((220.0, 360.0), (1e5, 3e7)) };
        let worst = differences(name, states.0, states.1);
        let (values, slopes) = if near_saturation { (1e-8, 1e-5) } else { (1e-9, 1e-6) };
        assert!(worst[0] < values, "{name}: {worst:?}");
        assert!(worst[1] < slopes && worst[2] < slopes, "{name}: {worst:?}");
    }
}

#[test]
fn an_isotherm_gives_pressure_and_slope() {
    let mut chart = Chart::new(Fluid::named("nitrogen").unwrap());
    for (rho, t) in [(5.0, 280.0), (222.0, 251.3), (310.0, 340.0)] {
        let exact = chart.fluid().pressure_with_derivatives(rho, t);
        let isotherm = chart.isotherm(rho, t).unwrap();
        let (p, slope) = isotherm.pressure(rho);
        assert!(isotherm.holds(rho) && !isotherm.holds(rho + 20.0));
        approx::assert_relative_eq!(p, exact.pressure_pa, max_relative = 1e-11);
        approx::assert_relative_eq!(slope, exact.dp_drho_pa_m3_kg, max_relative = 1e-9);
    }
}

#[test]
fn states_without_a_good_polynomial_are_left_to_the_equation() {
    // Beside the critical point, too hot, too dense, without gas.
    let mut chart = Chart::new(Fluid::named("nitrogen").unwrap());
    for (rho, t) in [(313.0, 126.5), (100.0, 2500.0), (2000.0, 300.0), (-1.0, 300.0), (f64::NAN, 300.0)] {
        assert!(chart.isotherm(rho, t).is_none(), "{rho} kg/m³, {t} K");
    }
    let exact = chart.fluid().pressure_with_derivatives(313.0, 126.5);
    let found = chart.properties(313.0, 126.5).p;
    approx::assert_relative_eq!(found.value, exact.pressure_pa, max_relative = 1e-12);
    approx::assert_relative_eq!(found.by_t, exact.dp_dt_pa_k, max_relative = 1e-12);
}

#[test]
fn the_order_of_questions_does_not_matter() {
    let states = [(222.0, 280.0), (222.0, 312.0), (222.0, 248.0), (300.0, 280.0), (222.0, 280.0)];
    let mut chart = Chart::new(Fluid::named("nitrogen").unwrap());
    let found = states.map(|(rho, t)| chart.properties(rho, t).p_rho.by_t);
    assert_eq!(found[0], found[4]);
    for ((rho, t), found) in states.into_iter().zip(found) {
        let mut fresh = Chart::new(Fluid::named("nitrogen").unwrap());
        assert_eq!(fresh.properties(rho, t).p_rho.by_t, found);
    }
}
