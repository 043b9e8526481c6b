//! A length that a case leaves to its blocks.

use std::fmt;

/// A length of the material that is the block's, since no key gives it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LengthOfABlock {
    /// The length, such as "the thickness of the sheet".
    pub length: &'static str,
    /// The key that gives it.
    pub key: &'static str,
}

impl fmt::Display for LengthOfABlock {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} (`{}`)", self.length, self.key)
    }
}
