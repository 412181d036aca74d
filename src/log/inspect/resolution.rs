//! The step of a column's digits: the largest number that all its values are multiples of, but for a constant.

/// Decimals beyond which digits are those of a computer, not of a sensor.
const DECIMALS: u32 = 9;

/// Values as whole numbers of their last decimal, and what divides all their differences.
#[derive(Clone, Debug, Default)]
pub(super) struct Resolution {
    decimals: u32,
    first: Option<i64>,
    divisor: u64,
    /// Whether a cell had no plain digits.
    is_unknown: bool,
}

impl Resolution {
    /// Takes in a cell with a number.
    pub(super) fn push(&mut self, cell: &[u8]) {
        let Some((value, decimals)) = digits(cell).filter(|_| !self.is_unknown) else {
            self.is_unknown = true;
            return;
        };
        if decimals > self.decimals {
            let factor = 10_i64.pow(decimals - self.decimals);
            self.decimals = decimals;
            self.first = self.first.and_then(|first| first.checked_mul(factor));
            self.divisor = self.divisor.saturating_mul(factor.unsigned_abs());
        }
        let Some(value) = value.checked_mul(10_i64.pow(self.decimals - decimals)) else {
            self.is_unknown = true;
            return;
        };
        let first = *self.first.get_or_insert(value);
        self.divisor = common_divisor(self.divisor, value.abs_diff(first));
    }

    /// The step in the unit of the file; `None`: the digits do not say, or nothing has changed.
    pub(super) fn step(&self) -> Option<f64> {
        let is_known = !self.is_unknown && self.divisor > 0;
        is_known.then(|| self.divisor as f64 / 10_f64.powi(self.decimals as i32))
    }
}

/// A number without exponent as whole units of its last decimal, and its decimals.
fn digits(cell: &[u8]) -> Option<(i64, u32)> {
    let text = std::str::from_utf8(cell.trim_ascii()).ok()?;
    let (whole, fraction) = text.split_once(['.', ',']).unwrap_or((text, ""));
    let decimals = u32::try_from(fraction.len()).ok().filter(|&decimals| decimals <= DECIMALS)?;
    let is_plain = fraction.bytes().all(|byte| byte.is_ascii_digit());
    let value = format!("{whole}{fraction}").parse().ok().filter(|_| is_plain)?;
    Some((value, decimals))
}

fn common_divisor(mut a: u64, mut b: u64) -> u64 {
    while b > 0 {
        (a, b) = (b, a % b);
    }
    a
}

#[cfg(test)]
mod tests {
    use super::*;

    fn step(cells: &[&str]) -> Option<f64> {
        let mut resolution = Resolution::default();
        cells.iter().for_each(|cell| resolution.push(cell.as_bytes()));
        resolution.step()
    }

    #[test]
    fn the_step_is_that_of_the_digits() {
        assert_eq!(step(&["20.1", "20.4", "19.9"]), Some(0.1));
        assert_eq!(step(&["+0020,25", "20,5", "21"]), Some(0.25));
        assert_eq!(step(&["-0.0625", "1.125", "3"]), Some(0.0625));
        assert_eq!(step(&["15.00", "15.00"]), None);
        assert_eq!(step(&["1e3", "2"]), None);
        assert_eq!(step(&["12.300000190734863", "12"]), None);
        assert_eq!(step(&["9223372036854775807", "0.000000001"]), None);
    }
}
