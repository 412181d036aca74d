//! What a sensor reads and how a filter predicts it.
