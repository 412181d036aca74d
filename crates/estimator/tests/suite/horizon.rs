//! Moving-horizon estimation against the Kalman filter, dense optimisation, and closed forms.
mod constrained;
mod kalman;
mod problems;
mod reference;
