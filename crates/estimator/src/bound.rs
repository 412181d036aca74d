//! Posterior Cramer-Rao bound.
