//! Identification of transfer functions against systems whose response is known in closed form.
mod exact;
mod system;
