//! Least value of a function of one variable by golden section (Kiefer, Proc. AMS 4 (1953) 502).

/// Point of the least value of a function with one valley in `[low, high]`, to `width`.
///
/// # Errors
/// The first error of `f`.
pub fn golden_section<E>(
    (mut low, mut high): (f64, f64),
    width: f64,
    mut f: impl FnMut(f64) -> Result<f64, E>,
) -> Result<f64, E> {
    let ratio = 0.5 * (5f64.sqrt() - 1.0);
    let (mut a, mut b) = (high - ratio * (high - low), low + ratio * (high - low));
    let (mut at_a, mut at_b) = (f(a)?, f(b)?);
    while high - low > width {
        if at_a < at_b {
            high = b;
            (b, at_b) = (a, at_a);
            a = high - ratio * (high - low);
            at_a = f(a)?;
        } else {
            low = a;
            (a, at_a) = (b, at_b);
            b = low + ratio * (high - low);
            at_b = f(b)?;
        }
    }
    Ok(0.5 * (low + high))
}

/// Number of evaluations that [`golden_section`] takes.
pub fn evaluations((low, high): (f64, f64), width: f64) -> usize {
    let ratio = 0.5 * (5f64.sqrt() - 1.0);
    2 + ((width / (high - low)).ln() / ratio.ln()).ceil().max(0.0) as usize
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_finds_the_valley_with_the_announced_number_of_evaluations() {
        let mut count = 0;
        let found = golden_section((0.5, 1.0), 1e-4, |x: f64| -> Result<f64, ()> {
            count += 1;
            Ok((x - 0.7).powi(2))
        });
        assert!((found.unwrap() - 0.7).abs() < 1e-4);
        assert_eq!(count, evaluations((0.5, 1.0), 1e-4));
    }
}
