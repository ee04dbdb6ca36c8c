//! Bytes to text, text to units.
