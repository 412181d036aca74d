//! The factors of a bank as plain data, to be saved; its working memory is made anew.
use alloc::string::String;
use alloc::vec::Vec;
use serde::{Deserialize, Serialize};

use super::{UdBank, start};
use crate::filter::lanes::{LANES, Lanes};
use crate::numbers;

/// Factors of the filters that there are, without working memory, and of `U` what is above its diagonal, column by column.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct Factors {
    states: usize,
    leading: usize,
    filters: usize,
    /// Of each element of `U`, and of `d`, the value in every filter.
    #[serde(with = "numbers")]
    u: Vec<f64>,
    #[serde(with = "numbers")]
    d: Vec<f64>,
}

impl From<UdBank> for Factors {
    fn from(bank: UdBank) -> Self {
        let of_filters = |lanes: &Lanes| lanes.0.into_iter().take(bank.filters);
        let columns = (0..bank.n).flat_map(|j| &bank.u[start(j)..][..j]);
        let u = columns.flat_map(of_filters).collect();
        let d = bank.d.iter().flat_map(of_filters).collect();
        Self { states: bank.n, leading: bank.leading, filters: bank.filters, u, d }
    }
}

impl TryFrom<Factors> for UdBank {
    type Error = String;

    fn try_from(saved: Factors) -> Result<Self, String> {
        let Factors { states, leading, filters, u, d } = saved;
        let above = states.checked_mul(states.saturating_sub(1)).map(|twice| twice / 2);
        let times = |elements: usize| elements.checked_mul(filters);
        let fits = Some(u.len()) == above.and_then(times) && Some(d.len()) == times(states);
        if leading > states || !(1..=LANES).contains(&filters) || !fits {
            return Err(format!(
                "factors of {states} states need as many columns of one to {LANES} filters, and {leading} moving ones"
            ));
        }
        let mut bank = Self { filters, ..Self::new(states, leading) };
        // A lane without a filter does as the first one.
        let lanes = |of: &[f64]| Lanes(core::array::from_fn(|lane| of.get(lane).copied().unwrap_or(of[0])));
        let mut left = u.chunks_exact(filters).map(lanes);
        for j in 0..states {
            bank.u[start(j)..][..j].iter_mut().zip(&mut left).for_each(|(to, from)| *to = from);
        }
        bank.d = d.chunks_exact(filters).map(lanes).collect();
        Ok(bank)
    }
}
