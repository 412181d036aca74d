//! The factors of a bank as plain data, to be saved; its working memory is made anew.
use serde::{Deserialize, Serialize};

use super::{UdBank, stride};
use crate::filter::lanes::Lanes;

/// Factors without working memory.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct Factors {
    states: usize,
    leading: usize,
    u: Vec<Lanes>,
    d: Vec<Lanes>,
}

impl From<UdBank> for Factors {
    fn from(bank: UdBank) -> Self {
        Self { states: bank.n, leading: bank.spans.len(), u: bank.u, d: bank.d }
    }
}

impl TryFrom<Factors> for UdBank {
    type Error = String;

    fn try_from(saved: Factors) -> Result<Self, String> {
        let Factors { states, leading, u, d } = saved;
        if leading > states || d.len() != states || states.checked_mul(stride(states)) != Some(u.len()) {
            return Err(format!(
                "factors of {states} states need as many columns, and {leading} moving ones"
            ));
        }
        Ok(Self { u, d, ..Self::new(states, leading) })
    }
}
