//! Raw content of a scenario file.
/// Raw content of a scenario file.
pub struct ScenarioSpec {}
