//! Adaptive implicit simulation; the only file that names diffsol.
