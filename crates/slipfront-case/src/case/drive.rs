//! The drive of a case.

use std::ops::Range;
use std::sync::Arc;

use slipfront::lattice::K_DRIVE;
use slipfront::{Body, Communicator, Drive, Lattice, Model, Program, Rotation, Slider};

use super::derived::Derived;
use super::dimensionless_groups::within;
use super::inputs::Inputs;
use crate::case_file::{
    Attached, AutoOrStiffness, CaseError, CaseFile, DEFAULT_THRESHOLD, DriveSpeed, DriveStiffness, Motion,
};

/// Largest angle, in rad, by which a drive may turn: the far ends move along tangents, not along circles.
const MAX_ANGLE: f64 = 1e-3;
/// Largest height of a body for the stiffness of its drive springs, in lengths of the longer side: it sets
/// how steeply mu* rises with the path of the drive, and not the strength.
const HEIGHT_OF_DEEP: f64 = 5.0;

/// The blocks of these rows that have a drive spring, if a file gives them.
pub(super) fn attached(inputs: &mut Inputs) -> Result<Option<Vec<bool>>, CaseError> {
    let Attached::File(name) = &inputs.file.drive.attached else {
        return Ok(None);
    };
    let slab = inputs.slab.clone();
    let attached = inputs.read_mask("drive.attach_file", name, DEFAULT_THRESHOLD, &slab);
    attached.map(Some)
}

/// Removes the drive springs of all blocks of these rows that the case does not attach. All ranks call this
/// at once.
pub(super) fn attach(
    slider: &mut Slider,
    file: &CaseFile,
    lattice: &Lattice,
    rows: &Range<usize>,
    attached: Option<Vec<bool>>,
    ranks: &dyn Communicator,
) -> Result<(), CaseError> {
    match (attached, file.drive.edge()) {
        (Some(attached), _) => slider.attach(attached.len(), |b| attached[b], ranks),
        (None, Some(edge)) => slider.attach_edge(lattice, rows, edge, ranks),
        (None, None) => {}
    }
    if slider.sum_of_drive_springs(lattice) == 0.0 {
        let sentence =
            "the file attaches no block, so the slider is not driven: 1 or a dark pixel attaches a block";
        return Err(file.source.error("drive.attach_file", sentence));
    }
    Ok(())
}

/// Stiffness of the drive springs that stand for the shear of a body between its face and its driven back, in
/// units of E times the block size.
fn mount(body: &Body, lattice: &Lattice) -> f64 {
    let longer = lattice.nx.max(lattice.ny) as f64;
    body.shear_modulus() / body.height.min(HEIGHT_OF_DEEP * longer)
}

/// The drive of a slider. A total stiffness is shared by the driven blocks in proportion to their moduli; a
/// bulk body without a given stiffness has that of its shear.
pub(super) fn drive(
    file: &CaseFile,
    derived: &Derived,
    (lattice, rows): (&Lattice, &Range<usize>),
    slider: &Slider,
    ranks: &dyn Communicator,
) -> Result<Drive, CaseError> {
    let (scales, groups) = (&derived.scales, &derived.groups);
    let shared = |total: f64| total / slider.sum_of_drive_springs(lattice);
    let k_drive = match &file.drive.stiffness {
        DriveStiffness::Each(AutoOrStiffness::Auto) => match file.slider.bulk_body() {
            Some(body) => mount(&body, lattice),
            None => K_DRIVE,
        },
        DriveStiffness::Each(AutoOrStiffness::Stiffness(each)) => each.si() / scales.stiffness(),
        DriveStiffness::EachStar(each) => *each,
        DriveStiffness::PerArea(per_area) => scales.stiffness_of_area(per_area.si()),
        DriveStiffness::Total(total) => shared(total.si() / scales.stiffness()),
        DriveStiffness::TotalStar(total) => shared(*total),
    };
    within(
        file,
        &format!("drive.{}", file.drive.stiffness.key()),
        "the stiffness of a drive spring relative to E h",
        k_drive,
        1e-12..=1e6,
    )?;
    let rotation = match file.drive.motion {
        Motion::Translation => None,
        Motion::Rotation if slider.n_blocks(lattice) == 1 => {
            let sentence = "a single block cannot rotate: use more blocks, or \"translation\"";
            return Err(file.source.error("drive.motion", sentence));
        }
        Motion::Rotation => Some(Rotation::about_centroid(lattice, rows, slider, ranks)),
    };
    Ok(Drive {
        k_drive,
        rotation,
        ..Drive::at_angle(groups.v_star, file.drive.direction)
    })
}

/// The program of the case, if it has one, with changes of speed rounded to steps.
pub(super) fn program(file: &CaseFile, dt_star: f64) -> Result<Option<Arc<Program>>, CaseError> {
    let DriveSpeed::Program(segments) = &file.drive.speed else {
        return Ok(None);
    };
    let mut before = 0.0;
    let mut parts = Vec::with_capacity(segments.len());
    for segment in segments {
        let until = segment.until_star.map(|until| (until / dt_star).round());
        if until.is_some_and(|until| until <= before) {
            let sentence = format!(
                "the speed {:?} of the program lasts less than a step of dt* = {}: speeds change at the start of a step",
                segment.v_star, dt_star
            );
            return Err(file.source.error("drive.program", sentence));
        }
        before = until.unwrap_or(before);
        let until_star = until.map_or(f64::INFINITY, |until| until * dt_star);
        parts.push((segment.v_star, until_star));
    }
    Ok(Some(Arc::new(Program::new(parts))))
}

/// Refuses a held drive if nothing stops the blocks. All ranks call this at once.
pub(super) fn refuse_endless_slip(
    file: &CaseFile,
    model: &Model,
    ranks: &dyn Communicator,
) -> Result<(), CaseError> {
    let surface = &model.surface;
    let is_endless = |b: &usize| !surface.textured[*b] && surface.kinetic_force(*b) == 0.0;
    let mut count = [0];
    if model.drive.is_held() {
        count[0] = (0..surface.n_blocks()).filter(is_endless).count() as i64;
    }
    ranks.sum(&mut count);
    let [count] = count;
    if count == 0 {
        return Ok(());
    }
    let sentence = format!(
        "{count} of the blocks in contact have no kinetic friction, so once they slide they never stop, and a held drive never \
         moves again: increase `friction.r_star`, reduce `friction.sigma_kinetic_star`, load every block, or use `loading` = \
         \"constant\""
    );
    Err(file.source.error("drive.loading", sentence))
}

/// Refuses a rotation by an angle that is not small.
pub(super) fn refuse_large_angles(
    file: &CaseFile,
    drive: &Drive,
    epsilon: f64,
    end_star: f64,
) -> Result<(), CaseError> {
    let Some(rotation) = &drive.rotation else {
        return Ok(());
    };
    let angle = epsilon * drive.farthest_path(end_star) / rotation.radius;
    if angle <= MAX_ANGLE {
        return Ok(());
    }
    let sentence = format!(
        "the drive rotates by up to {angle:.2e} rad, more than {MAX_ANGLE:e}, the limit for motion along tangents: shorten the \
         run, reduce the speed or `load.pressure`, or increase `slider.young_modulus`"
    );
    Err(file.source.error("drive.motion", sentence))
}
