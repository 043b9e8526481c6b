//! How the total normal load is carried.

use crate::SurfaceError;

/// Who carries the load that textured blocks do not.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Load {
    /// The blocks in contact share the whole load equally: `F_n,i = P l^2 N/N_contact`. The paper's model.
    Redistributed,
    /// Every block in contact keeps `P l^2`; the texture's share of the load is lost. For comparison.
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
