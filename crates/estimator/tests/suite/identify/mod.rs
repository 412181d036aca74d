//! Identification of transfer functions against systems whose response is known in closed form.
mod bad_input;
mod errors_in_variables;
mod exact;
mod invariance;
mod noisy;
mod peer;
mod structure;
mod system;
