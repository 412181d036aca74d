//! Judging an estimator: normalised innovations and errors against their chi-square bounds.
