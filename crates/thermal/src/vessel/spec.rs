//! Raw content of a vessel file.
/// Raw content of a vessel file.
pub struct VesselSpec {}
