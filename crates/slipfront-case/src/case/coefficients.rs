//! Friction coefficients of a case, drawn or read from its files, and the contact that turns them into
//! thresholds.

use slipfront::surface::{
    Adhesion, Coefficients, Contact, CorrelatedField, Distribution, Load, deviation_along, pressure_along,
};
use slipfront::{Lattice, Scales};

use super::dimensionless_groups::Groups;
use super::inputs::Inputs;
use super::textures::pitch;
use crate::case_file::{Body, CaseError, CaseFile, FrictionAlong, Near, Redistribute};
use slipfront_base::number_format::four_digits;

/// Refuses a correlation length for which coefficients could not be drawn, before any file is read.
pub(super) fn check_correlation(file: &CaseFile) -> Result<(), CaseError> {
    let (least, most) = CorrelatedField::LENGTHS.into_inner();
    let Some(blocks) = correlation_length(file) else {
        return Ok(());
    };
    let length = format!("this makes the correlation length {} blocks", four_digits(blocks));
    let sentence = if blocks < least {
        let kept = deviation_along(blocks).powi(2);
        format!(
            "{length}; at least {least} are needed: neighbouring blocks are then almost uncorrelated, and independent \
             coefficients are adequate; leave it out and multiply `sigma_static_star` and `sigma_kinetic_star` by {}, the spread \
             of means over a block, or use smaller blocks",
            four_digits(kept)
        )
    } else if blocks > most {
        format!(
            "{length}; at most {most} are possible: the coefficients are then uniform; leave it out, set the spreads to 0, and \
             `mu_static` to the coefficient"
        )
    } else {
        return Ok(());
    };
    Err(file.source.error("friction.correlation_length", sentence))
}

/// Correlation length xi in blocks.
fn correlation_length(file: &CaseFile) -> Option<f64> {
    let length = file.friction.correlation_length.as_ref()?;
    Some(length.si() / file.slider.block_size.si())
}

/// The field that gives the random coefficients as means over blocks, unless they are drawn block by block.
pub(super) fn correlated_field(file: &CaseFile, lattice: &Lattice) -> Option<CorrelatedField> {
    correlation_length(file).map(|length| CorrelatedField::new(lattice, length))
}

pub(super) fn coefficients(inputs: &mut Inputs, groups: &Groups) -> Result<Coefficients, CaseError> {
    let (file, lattice) = (inputs.file, inputs.lattice);
    let friction = &file.friction;
    let mean = friction.mu_static;
    let mu_static = inputs.read_field("friction.mu_static_field", &friction.mu_static_field)?;
    let mu_kinetic = inputs.read_field("friction.mu_kinetic_field", &friction.mu_kinetic_field)?;
    // A given field replaces the draws of its own stream; the other stream does not shift.
    let spread = |mean: f64, sigma_star: f64, given: bool| Distribution {
        mean,
        deviation: if given { 0.0 } else { sigma_star * mean },
    };
    let rows = &inputs.slab.rows;
    let of_static = spread(mean, groups.sigma_static_star, mu_static.is_some());
    let of_kinetic = spread(
        groups.r_star * mean,
        groups.sigma_kinetic_star,
        mu_kinetic.is_some(),
    );
    let mut drawn = match correlated_field(file, lattice) {
        None => Coefficients::draw_blocks(lattice.blocks_of(rows), of_static, of_kinetic, friction.seed),
        Some(field) => Coefficients::draw_correlated(&field, rows, of_static, of_kinetic, friction.seed),
    };
    drawn.mu_static = mu_static.unwrap_or(drawn.mu_static);
    drawn.mu_kinetic = mu_kinetic.unwrap_or(drawn.mu_kinetic);
    Ok(drawn)
}

impl CaseFile {
    /// Whether only nearby blocks in contact carry the load of a textured block, rather than all of them.
    pub(super) fn shares_load_nearby(&self) -> bool {
        match self.load.redistribute {
            Redistribute::Near(_) => true,
            Redistribute::All(shares) => shares && self.slider.body == Body::Bulk && !self.texture.is_empty(),
        }
    }
}

/// Distance in blocks within which blocks in contact carry the load of a textured one; none where all of them
/// share it equally, or where none carries it.
pub(super) fn sharing_distance(
    file: &CaseFile,
    scales: &Scales,
    lattice: &Lattice,
) -> Result<Option<f64>, CaseError> {
    if let Redistribute::Near(Near { within }) = &file.load.redistribute {
        return Ok(Some(scales.in_blocks(within.si())));
    }
    if !file.shares_load_nearby() {
        return Ok(None);
    }
    let mut smallest = None;
    for (number, texture) in file.texture.iter().enumerate() {
        let Some((pitch, _)) = pitch(texture, scales, lattice) else {
            let sentence = format!(
                "in a bulk body the area near a textured part carries its load, but texture {} is not an array of several \
                 features with a pitch: give `load.redistribute` = {{ within = \"...\" }}, about twice the width of a feature",
                number + 1
            );
            return Err(file.source.error(&format!("texture.{number}"), sentence));
        };
        smallest = Some(smallest.map_or(pitch, |smallest: f64| smallest.min(pitch)));
    }
    Ok(smallest)
}

/// Contact of a surface: load and adhesion.
pub(super) fn contact(inputs: &mut Inputs) -> Result<Contact, CaseError> {
    let (file, scales, lattice) = (inputs.file, inputs.scales, inputs.lattice);
    let load = match file.load.redistribute {
        Redistribute::All(false) => Load::Kept,
        Redistribute::All(true) | Redistribute::Near(_) => Load::Redistributed,
    };
    // An upright sheet touches its substrate with its lowest row.
    let is_upright = file.friction.along == FrictionAlong::X;
    let blocks = lattice.blocks_of(&inputs.slab.rows);
    let faces = is_upright.then(|| blocks.map(|b| b < lattice.nx).collect());
    let given = inputs.read_field("load.pressure_field", &file.load.pressure_field)?;
    let pressure = match &file.load.profile {
        Some(profile) => Some(pressure_along(
            lattice,
            inputs.slab.rows.clone(),
            profile.along as usize,
            profile.relative_slope,
        )),
        None => given,
    };
    let [of_static, of_kinetic] = [&file.friction.adhesion, &file.friction.adhesion_kinetic]
        .map(|strength| strength.si() / scales.stress());
    Ok(Contact {
        pressure,
        adhesion: Adhesion {
            of_static,
            of_kinetic,
        },
        faces,
        ..Contact::new(load, scales.mu_static_mean)
    })
}
