//! Dispatch to the vector registers of the machine, or none without the feature `simd`.
#[cfg(feature = "simd")]
pub(crate) use pulp::{Arch, Simd, WithSimd};

#[cfg(not(feature = "simd"))]
pub(crate) use plain::{Arch, Simd, WithSimd};

#[cfg(not(feature = "simd"))]
mod plain {
    /// The registers that the compiler was told of.
    #[derive(Clone, Copy, Debug, Default)]
    pub(crate) struct Arch;

    impl Arch {
        pub(crate) fn new() -> Self {
            Self
        }

        pub(crate) fn dispatch<O: WithSimd>(self, operation: O) -> O::Output {
            operation.with_simd(Self)
        }
    }

    /// Registers.
    pub(crate) trait Simd {}

    impl Simd for Arch {}

    /// An operation on them.
    pub(crate) trait WithSimd {
        type Output;

        fn with_simd<S: Simd>(self, simd: S) -> Self::Output;
    }
}
