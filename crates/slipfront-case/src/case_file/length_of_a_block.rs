//! A length that equals the block length because no key gives it.

use std::fmt;

/// A length of the material that equals the block length because no key gives it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LengthOfABlock {
    /// The length, such as "the thickness of the sheet".
    pub length: &'static str,
    /// The key to give the length.
    pub key: &'static str,
}

impl fmt::Display for LengthOfABlock {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} (`{}`)", self.length, self.key)
    }
}
