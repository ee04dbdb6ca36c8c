//! PL7 addresses.
