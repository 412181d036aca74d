//! The factors of a bank as plain data, to be saved; its working memory is made anew.
use serde::{Deserialize, Serialize};

use super::{UdBank, stride};
use crate::filter::lanes::Lanes;

/// Factors without working memory, and of `U` what is above its diagonal, column by column.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct Factors {
    states: usize,
    leading: usize,
    u: Vec<Lanes>,
    d: Vec<Lanes>,
}

impl From<UdBank> for Factors {
    fn from(bank: UdBank) -> Self {
        let columns = bank.u.chunks_exact(stride(bank.n)).enumerate();
        let u = columns.flat_map(|(j, column)| &column[..j]).copied().collect();
        Self { states: bank.n, leading: bank.spans.len(), u, d: bank.d }
    }
}

impl TryFrom<Factors> for UdBank {
    type Error = String;

    fn try_from(saved: Factors) -> Result<Self, String> {
        let Factors { states, leading, u, d } = saved;
        let above = states.checked_mul(states.saturating_sub(1)).map(|twice| twice / 2);
        if leading > states || d.len() != states || above != Some(u.len()) {
            return Err(format!(
                "factors of {states} states need as many columns, and {leading} moving ones"
            ));
        }
        let mut bank = Self { d, ..Self::new(states, leading) };
        let mut left = u.as_slice();
        for (j, column) in bank.u.chunks_exact_mut(stride(states)).enumerate() {
            let (own, others) = left.split_at(j);
            column[..j].copy_from_slice(own);
            left = others;
        }
        Ok(bank)
    }
}
