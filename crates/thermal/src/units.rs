//! Units of files and of the command line: the suffix of a key is its unit.
