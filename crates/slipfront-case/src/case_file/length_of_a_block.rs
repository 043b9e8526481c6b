//! A length that follows the block because no key gives it.

use std::fmt;

/// A length of the material that equals the length of a block because no key gives it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LengthOfABlock {
    /// The length, such as "the thickness of the sheet".
    pub length: &'static str,
    /// The key that would give the length.
    pub key: &'static str,
}

impl fmt::Display for LengthOfABlock {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} (`{}`)", self.length, self.key)
    }
}
