//! How the total normal load is distributed over the blocks.

use crate::error::SurfaceError;

/// What happens to the load of textured blocks, which carry none.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Load {
    /// The blocks in contact carry equal parts of the whole load: `F_n,i = P l^2 N/N_contact`. The paper's model.
    Redistributed,
    /// Every block in contact carries `P l^2`; the load of the textured blocks is lost. For comparison.
    Kept,
}

impl Load {
    /// Normal force on a block in contact in units of `P l^2`.
    pub(crate) fn normal_force_per_block(self, textured: &[bool]) -> Result<f64, SurfaceError> {
        let n_blocks = textured.len();
        let n_contact = textured.iter().filter(|&&t| !t).count();
        if n_contact == 0 {
            return Err(SurfaceError::NoContact { n_blocks });
        }
        Ok(match self {
            Load::Redistributed => n_blocks as f64 / n_contact as f64,
            Load::Kept => 1.0,
        })
    }
}
