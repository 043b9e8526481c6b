//! Lengths that a case leaves to its blocks.

use std::fmt;

use super::drive::DriveStiffness;
use super::file::CaseFile;

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

impl CaseFile {
    /// Lengths of the material that are those of a block, since no key gives them: on other blocks they are others.
    pub fn lengths_of_a_block(&self) -> Vec<LengthOfABlock> {
        let thickness = self.slider.thickness.is_none().then_some(LengthOfABlock {
            length: "the thickness of the sheet",
            key: "slider.thickness",
        });
        let mount = (self.drive.stiffness == DriveStiffness::Auto).then_some(LengthOfABlock {
            length: "the screening length of the mount",
            key: "drive.stiffness_per_area",
        });
        let of_friction = self.friction.lengths_of_a_block();
        thickness.into_iter().chain(mount).chain(of_friction).collect()
    }
}
