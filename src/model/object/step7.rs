//! STEP 7 addresses.
