//! Moving-horizon estimation against the Kalman filter, dense optimisation, and closed forms.
mod constrained;
mod kalman;
mod nonlinear;
mod outcomes;
mod problems;
mod reference;
mod robust;
