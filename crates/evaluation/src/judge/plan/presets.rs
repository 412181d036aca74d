//! Built-in plans: the files of `plans`, embedded.

const FILES: [(&str, &str); 12] = [
    ("railway", include_str!("../../../plans/railway.toml")),
    ("reference", include_str!("../../../plans/reference.toml")),
    ("quick", include_str!("../../../plans/quick.toml")),
    ("table", include_str!("../../../plans/table.toml")),
    ("night", include_str!("../../../plans/night.toml")),
    ("tight", include_str!("../../../plans/tight.toml")),
    ("losses", include_str!("../../../plans/losses.toml")),
    ("fault", include_str!("../../../plans/fault.toml")),
    ("years", include_str!("../../../plans/years.toml")),
    ("tails", include_str!("../../../plans/tails.toml")),
    ("likelihood", include_str!("../../../plans/likelihood.toml")),
    ("smoke", include_str!("../../../plans/smoke.toml")),
];

/// Names and texts of the built-in plans.
pub fn all() -> impl Iterator<Item = (&'static str, &'static str)> {
    FILES.into_iter()
}

/// Names of the built-in plans.
pub fn names() -> impl Iterator<Item = &'static str> {
    all().map(|(name, _)| name)
}

/// Text of a built-in plan.
pub fn text(name: &str) -> Option<&'static str> {
    all().find(|(known, _)| *known == name).map(|(_, text)| text)
}
