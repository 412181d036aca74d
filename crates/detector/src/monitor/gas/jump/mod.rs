//! A pressure that jumps: gas or transmitter?
//!
//! # Noticed
//! The observer's innovation of the pressure changes slowly, because its errors do. A change from one sample to the next is a jump if
//! it is beyond
//!
//! `L = k (6e-4 + 4 c + 1.2 q + W)`
//!
//! and the reading itself made most of it: what the expectation alone did is the model's. `c` is the mean
//! size of such changes lately, as it grows with the root of the interval, `q` the step in which the transmitter reads, and `W` what the
//! surroundings may have done: 2.2 times what the observer cannot have known of the gas temperature in the row before
//! ([`Observer::fresh_doubt_pa`](crate::estimator::observer::Observer::fresh_doubt_pa)) and the same part `c` of what its expectation moved by,
//! `W = 2.2 c (dp/dT (s + (1 - exp(-dt / tau)) e) + |E|)`. In a tunnel it takes more to be a jump; gas that flows there is told by the observer's
//! flowing member.
//!
//! Between two rows that are far apart a tunnel may begin and end, and neither shows it. So `k` is what the bracket was exceeded by lately, and a quarter more, where that was
//! no jump and three tenths of it were for the surroundings: from 1 to 4, and forgotten within days. As much more is considered of all that the surroundings do
//! ([`Observer::doubt_surroundings`](crate::estimator::observer::Observer::doubt_surroundings)).
//!
//! # Examined
//! What it was a bank of causes tells (`Examination`): nothing, an offset, gas.
mod notice;

pub use notice::{Innovated, JumpWatch, LONGEST_INTERVAL_S, USUAL_LARGEST};
