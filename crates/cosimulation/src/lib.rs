//! A simulated cylinder and its monitor as units of a co-simulation, for any version of the Functional Mock-up Interface.
//!
//! | part | what |
//! |---|---|
//! | [`Resource`] | what a unit begins with, as the sealed bytes that its archive carries: a [`CompiledPlant`] or a compiled cylinder |
//! | [`variable`] | the table of its variables: names, units, bounds, starts |
//! | [`Instance`] | a unit that runs: values in and out, steps, saved states |
//! | [`description`] | the XML that says all this to a master |
//!
//! The plant is simulated as by [`Stepped`](cylwatch_thermal::simulate::Stepped), with inputs that hold for a step. The monitor takes one row a
//! step, stamped with the time at which the step begins.
mod access;
pub mod description;
mod error;
mod instance;
mod monitor;
mod phase;
mod plant;
mod resource;
pub mod variable;

pub use access::Access;
pub use error::CosimulationError;
pub use instance::Instance;
pub use plant::{CompiledPlant, FilmInputs};
pub use resource::Resource;
