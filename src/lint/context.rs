//! What a rule is given.

/// One unit: its model, its tree, its text.
pub struct UnitCx<'a> {
    pub text: &'a str,
}

/// A program: the facts of all its units.
pub struct ProgramCx<'a> {
    pub text: &'a str,
}

/// A file after all rules of its units and its program ran.
pub struct FileCx<'a> {
    pub text: &'a str,
}
