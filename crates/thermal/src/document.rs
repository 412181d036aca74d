//! Reading of TOML documents whose keys carry units.
