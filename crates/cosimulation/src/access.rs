//! How a master asks for values.
use crate::variable::Type;

/// How a value is asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Access {
    /// A real number.
    Real,
    /// A whole number.
    Integer,
    /// A word.
    Enumeration,
    /// Either of the last two.
    IntegerOrEnumeration,
}

impl Access {
    /// Whether a type is asked for so.
    pub(crate) fn fits(self, kind: Type) -> bool {
        match kind {
            Type::Real(_) => self == Self::Real,
            Type::Integer => matches!(self, Self::Integer | Self::IntegerOrEnumeration),
            Type::Enumeration(_) => matches!(self, Self::Enumeration | Self::IntegerOrEnumeration),
        }
    }

    /// Name of what is asked for.
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::Real => "real",
            Self::Integer | Self::IntegerOrEnumeration => "integer",
            Self::Enumeration => "enumeration",
        }
    }
}
