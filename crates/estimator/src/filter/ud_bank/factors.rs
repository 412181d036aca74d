//! The factors of a bank as plain data, to be saved; its working memory is made anew.
use alloc::string::String;
use alloc::vec::Vec;
use serde::ser::SerializeStruct;
use serde::{Deserialize, Serialize, Serializer};

use super::{UdBank, start};
use crate::filter::lanes::{LANES, Lanes};
use crate::numbers;

/// Factors of the filters that there are, without working memory, and of `U` what is above its diagonal, column by column.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct Factors {
    states: usize,
    leading: usize,
    filters: usize,
    /// Of each element of `U`, and of `d`, the value in every filter.
    #[serde(with = "numbers")]
    u: Vec<f64>,
    #[serde(with = "numbers")]
    d: Vec<f64>,
}

impl UdBank {
    /// Write the covariance of the first filter, its factors rounded.
    pub(crate) fn write_outline(&self, outline: &mut Factors, rounded: impl Fn(f64) -> f64 + Copy) {
        let of_first = |lanes: &Lanes| rounded(lanes.0[0]);
        (outline.states, outline.leading, outline.filters) = (self.n, self.leading, 1);
        outline.u.clear();
        outline.u.extend((0..self.n).flat_map(|j| &self.u[start(j)..][..j]).map(of_first));
        outline.d.clear();
        outline.d.extend(self.d.iter().map(of_first));
    }

    /// Let every filter have the covariance of an outline of as many states.
    pub(crate) fn return_to(&mut self, outline: &Factors) {
        let mut left = outline.u.iter();
        for j in 0..self.n {
            let column = &mut self.u[start(j)..][..j];
            column.iter_mut().zip(&mut left).for_each(|(to, from)| *to = Lanes::splat(*from));
        }
        self.d.iter_mut().zip(&outline.d).for_each(|(to, from)| *to = Lanes::splat(*from));
    }
}

impl Factors {
    /// Memory for the outline of a filter of `n` states.
    /// Whether it is of one filter with so many states.
    pub(crate) fn is_like(&self, n: usize) -> bool {
        [self.u.len(), self.d.len()] == [n * n.saturating_sub(1) / 2, n]
    }

    pub(crate) fn with_room(n: usize) -> Self {
        let (u, d) = (Vec::with_capacity(n * n.saturating_sub(1) / 2), Vec::with_capacity(n));
        Self { states: 0, leading: 0, filters: 1, u, d }
    }
}

/// As its [`Factors`], without their memory.
impl Serialize for UdBank {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let of_filters = |lanes: &Lanes| lanes.0.into_iter().take(self.filters);
        let columns = (0..self.n).flat_map(|j| &self.u[start(j)..][..j]);
        let mut to = serializer.serialize_struct("Factors", 5)?;
        to.serialize_field("states", &self.n)?;
        to.serialize_field("leading", &self.leading)?;
        to.serialize_field("filters", &self.filters)?;
        to.serialize_field("u", &numbers::All(columns.flat_map(of_filters)))?;
        to.serialize_field("d", &numbers::All(self.d.iter().flat_map(of_filters)))?;
        to.end()
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
