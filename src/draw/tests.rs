//! Tests of drawings.
