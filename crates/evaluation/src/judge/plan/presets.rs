//! Built-in plans: the files of `plans`, embedded.
use cylwatch_thermal::document::Presets;

/// The built-in plans.
pub const FILES: Presets = Presets {
    kind: "plan",
    files: &[
        ("railway", include_str!("../../../plans/railway.toml")),
        ("reference", include_str!("../../../plans/reference.toml")),
        ("quick", include_str!("../../../plans/quick.toml")),
        ("table", include_str!("../../../plans/table.toml")),
        ("night", include_str!("../../../plans/night.toml")),
        ("tight", include_str!("../../../plans/tight.toml")),
        ("losses", include_str!("../../../plans/losses.toml")),
        ("fault", include_str!("../../../plans/fault.toml")),
        ("years", include_str!("../../../plans/years.toml")),
        ("metros", include_str!("../../../plans/metros.toml")),
        ("tails", include_str!("../../../plans/tails.toml")),
        ("likelihood", include_str!("../../../plans/likelihood.toml")),
        ("smoke", include_str!("../../../plans/smoke.toml")),
    ],
};
