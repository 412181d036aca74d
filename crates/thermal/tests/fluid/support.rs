//! Tables and the fluids that the tests go through.
use cylwatch_thermal::fluid::{Equation, Fluid};

/// Every equation.
pub(crate) const EQUATIONS: [Equation; 3] = [Equation::Reference, Equation::IdealGas, Equation::PengRobinson];

/// Every fluid with every equation.
pub(crate) fn all() -> Vec<Fluid> {
    let named = Fluid::names().map(|name| Fluid::named(name).unwrap());
    named.flat_map(|fluid| EQUATIONS.map(|equation| fluid.clone().with_equation(equation))).collect()
}

/// Whether it condenses anywhere in its domain: neither the ideal gas nor mixtures do.
pub(crate) fn condenses(fluid: &Fluid) -> bool {
    let domain = fluid.domain();
    fluid.equation() != Equation::IdealGas
        && domain.lowest_temperature_k < 0.9 * domain.critical_temperature_k
}

/// Whether it condenses in a cylinder at 15 °C, so that its liquid is refused.
pub(crate) fn liquefies(fluid: &Fluid) -> bool {
    fluid.equation() != Equation::IdealGas && fluid.domain().critical_temperature_k > 290.0
}

/// Rows of a table of numbers below its header; lines with `#` are comments. What is missing is not a number.
pub(crate) fn rows(text: &str) -> Vec<Vec<f64>> {
    let lines = text.lines().filter(|line| !line.starts_with('#')).skip(1);
    let number = |value: &str| if value.is_empty() { f64::NAN } else { value.parse().unwrap() };
    lines.map(|line| line.split(',').map(number).collect()).collect()
}
