//! Quantities that follow from a case file without reading its input files.

use std::ops::Range;

use slipfront::lattice::K_DRIVE;
use slipfront::{Friction, Lattice, Scales};

use super::budget::Budget;
use super::coefficients::check_correlation;
use super::dimensionless_groups::Groups;
use super::ranks::Ranks;
use crate::case_file::{Body, CaseError, CaseFile, DriveStiffness, FrictionAlong};
use crate::quantity::Length;

/// Quantities that follow from a case file without reading its input files.
pub(super) struct Derived {
    pub(super) scales: Scales,
    pub(super) groups: Groups,
    pub(super) budget: Budget,
    pub(super) friction: Friction,
}

impl Derived {
    /// Derives the quantities. Refuses numbers outside the range of the model, and cases that do not fit into
    /// memory.
    pub(super) fn new(
        file: &CaseFile,
        lattice: &Lattice,
        rows: &Range<usize>,
        ranks: &Ranks,
        to_run: bool,
    ) -> Result<Self, CaseError> {
        let scales = scales(file);
        let groups = Groups::new(file, &scales)?;
        check_correlation(file)?;
        let n_ranks = ranks.communicator.size();
        if n_ranks > lattice.ny {
            let sentence = format!(
                "there are more ranks ({n_ranks}) than rows of blocks ({}), but each rank needs at least one row: use fewer \
                 ranks, or more blocks along y",
                lattice.ny
            );
            return Err(file.source.error("slider.blocks", sentence));
        }
        if n_ranks > 1 && file.slider.body == Body::Bulk {
            let why =
                "a bulk body is not divided over ranks, since every block acts on all others: use one rank";
            return Err(file.source.error("slider.body", why));
        }
        if let Some((key, why)) = file.friction.takes_one_rank().filter(|_| n_ranks > 1) {
            return Err(file.source.error(key, why));
        }
        let friction =
            file.friction
                .in_model(groups.v_star, &scales, file.load.foundation_of_a_block(&scales));
        let budget = Budget::of_model(lattice, rows, ranks, file, &friction);
        budget.check_case(file, to_run)?;
        Ok(Self {
            scales,
            groups,
            budget,
            friction,
        })
    }
}

/// Units of the dimensionless quantities of a case file. A bulk body has blocks as thick as they are long.
pub fn scales(file: &CaseFile) -> Scales {
    let block_size = file.slider.block_size.si();
    let thickness = file.slider.thickness.as_ref().map_or(block_size, Length::si);
    let young_modulus = match &file.drive.stiffness {
        DriveStiffness::Total(total) if file.slider.rigid => total.si() / (K_DRIVE * thickness),
        _ => file.slider.young_modulus.si(),
    };
    let contact_width = match file.friction.along {
        FrictionAlong::Plane => block_size,
        FrictionAlong::X => thickness,
    };
    Scales {
        block_size,
        thickness,
        contact_width,
        young_modulus,
        density: file.slider.density.si(),
        pressure: file.load.pressure.si(),
        mu_static_mean: file.friction.mu_static,
    }
}
