//! Variables of a unit, as a table: place 0 is the time, and a place is the value reference.

/// Unit of a variable.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unit {
    /// s.
    Second,
    /// K.
    Kelvin,
    /// A difference of temperatures, K.
    KelvinDifference,
    /// Pa.
    Pascal,
    /// Pa/s.
    PascalPerSecond,
    /// kg.
    Kilogram,
    /// kg/s.
    KilogramPerSecond,
    /// m.
    Metre,
    /// m/s.
    MetrePerSecond,
    /// W.
    Watt,
    /// W/m².
    WattPerSquareMetre,
    /// W/(m² K).
    WattPerSquareMetreKelvin,
    /// A pure number.
    One,
}

/// A unit as people read it: `value * factor + offset`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DisplayUnit {
    /// Name.
    pub name: &'static str,
    /// Factor.
    pub factor: f64,
    /// Offset.
    pub offset: f64,
}

impl Unit {
    /// All units, in the order of a description.
    pub const ALL: [Self; 13] = [
        Self::Second,
        Self::Kelvin,
        Self::KelvinDifference,
        Self::Pascal,
        Self::PascalPerSecond,
        Self::Kilogram,
        Self::KilogramPerSecond,
        Self::Metre,
        Self::MetrePerSecond,
        Self::Watt,
        Self::WattPerSquareMetre,
        Self::WattPerSquareMetreKelvin,
        Self::One,
    ];

    /// Symbol.
    pub const fn symbol(self) -> &'static str {
        match self {
            Self::Second => "s",
            Self::Kelvin | Self::KelvinDifference => "K",
            Self::Pascal => "Pa",
            Self::PascalPerSecond => "Pa/s",
            Self::Kilogram => "kg",
            Self::KilogramPerSecond => "kg/s",
            Self::Metre => "m",
            Self::MetrePerSecond => "m/s",
            Self::Watt => "W",
            Self::WattPerSquareMetre => "W/m2",
            Self::WattPerSquareMetreKelvin => "W/(m2.K)",
            Self::One => "1",
        }
    }

    /// Exponents of kg, m, s and K.
    pub const fn exponents(self) -> [i32; 4] {
        match self {
            Self::Second => [0, 0, 1, 0],
            Self::Kelvin | Self::KelvinDifference => [0, 0, 0, 1],
            Self::Pascal => [1, -1, -2, 0],
            Self::PascalPerSecond => [1, -1, -3, 0],
            Self::Kilogram => [1, 0, 0, 0],
            Self::KilogramPerSecond => [1, 0, -1, 0],
            Self::Metre => [0, 1, 0, 0],
            Self::MetrePerSecond => [0, 1, -1, 0],
            Self::Watt => [1, 2, -3, 0],
            Self::WattPerSquareMetre => [1, 0, -3, 0],
            Self::WattPerSquareMetreKelvin => [1, 0, -3, -1],
            Self::One => [0, 0, 0, 0],
        }
    }

    /// What people read it in, where that is another unit.
    pub const fn display(self) -> Option<DisplayUnit> {
        match self {
            Self::Kelvin => Some(DisplayUnit { name: "degC", factor: 1.0, offset: -273.15 }),
            Self::Pascal => Some(DisplayUnit { name: "bar", factor: 1e-5, offset: 0.0 }),
            Self::PascalPerSecond => Some(DisplayUnit { name: "bar/h", factor: 0.036, offset: 0.0 }),
            Self::KilogramPerSecond => Some(DisplayUnit { name: "g/h", factor: 3.6e6, offset: 0.0 }),
            Self::Metre => Some(DisplayUnit { name: "mm", factor: 1e3, offset: 0.0 }),
            _ => None,
        }
    }
}

/// A choice of words.
#[derive(Debug, PartialEq, Eq)]
pub struct Enumeration {
    /// Name of the type.
    pub name: &'static str,
    /// What it says.
    pub description: &'static str,
    /// Words and what they mean; the first has the value 1.
    pub items: &'static [(&'static str, &'static str)],
}

/// Type of a variable.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Type {
    /// A number with a unit.
    Real(Unit),
    /// A whole number.
    Integer,
    /// One of several words.
    Enumeration(&'static Enumeration),
}

/// What a variable is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Causality {
    /// The time.
    Independent,
    /// Set before the first step.
    Parameter,
    /// Set before any step.
    Input,
    /// Said by the unit.
    Output,
}

/// A variable.
#[derive(Clone, Debug, PartialEq)]
pub struct Variable {
    /// Name.
    pub name: String,
    /// What it is.
    pub description: String,
    /// What it is for.
    pub causality: Causality,
    /// Type.
    pub kind: Type,
    /// Value that it begins with, if it can be set.
    pub start: Option<f64>,
    /// Lowest and highest value that it can be set to.
    pub range: Option<(f64, f64)>,
    /// Whether NaN says that there is no value.
    pub can_be_missing: bool,
}

impl Variable {
    /// The time, which is the first variable of every unit.
    pub(crate) fn time() -> Self {
        let time = Self::output("time", "Time", Type::Real(Unit::Second));
        Self { causality: Causality::Independent, ..time }
    }

    /// An output.
    pub(crate) fn output(name: impl Into<String>, description: impl Into<String>, kind: Type) -> Self {
        Self {
            name: name.into(),
            description: description.into(),
            causality: Causality::Output,
            kind,
            start: None,
            range: None,
            can_be_missing: false,
        }
    }

    /// A number that is set.
    pub(crate) fn settable(
        causality: Causality,
        (name, description): (&str, &str),
        unit: Unit,
        start: f64,
        range: (f64, f64),
    ) -> Self {
        let variable = Self::output(name, description, Type::Real(unit));
        Self { causality, start: Some(start), range: Some(range), ..variable }
    }

    /// A reading that may be missing, and is at the start.
    pub(crate) fn reading(name: String, description: String, unit: Unit) -> Self {
        let variable = Self::output(name, description, Type::Real(unit));
        Self { causality: Causality::Input, start: Some(f64::NAN), can_be_missing: true, ..variable }
    }

    /// Whether it can be set to a value.
    pub(crate) fn admits(&self, value: f64) -> bool {
        match self.range {
            Some((low, high)) => (low..=high).contains(&value),
            None => value.is_finite() || (self.can_be_missing && value.is_nan()),
        }
    }
}
