//! Everything that can go wrong in this crate.

/// What went wrong, with the offending value, the bound and the remedy.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum EstimatorError {
    /// The thermal model refused.
    #[error(transparent)]
    Thermal(#[from] cylwatch_thermal::ThermalError),
}
