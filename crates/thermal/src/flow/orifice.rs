//! Mass flow through an orifice of a real gas, choked or not.
