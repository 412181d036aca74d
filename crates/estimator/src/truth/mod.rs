//! Truth for judging: mismatched cylinders and weather, seeded.
