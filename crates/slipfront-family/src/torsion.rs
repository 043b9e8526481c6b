//! A drive that rotates.

use slipfront::communicator::Alone;
use slipfront::exact_solutions::{
    torsion_first_slip, torsion_of_decoupled_blocks, torsion_of_decoupled_disc,
};
use slipfront::lattice::K_DRIVE;
use slipfront::{Drive, FrictionLaw, Lattice, Model, Outline, Rotation, Slider, Surface, scales};
use slipfront_plot::Response;

use crate::chapter::Chapter;
use crate::error::FamilyError;
use crate::runs::{AnswerRun, Experiment};

/// Distances of the blocks that exist from the middle.
fn radii(model: &Model) -> Vec<f64> {
    let half = [model.lattice.nx, model.lattice.ny].map(|count| 0.5 * count as f64);
    let blocks = (0..model.lattice.n_blocks()).filter(|&b| model.slider().exists(b));
    let radius = |b: usize| {
        let (i, j) = model.lattice.column_row(b);
        libm::hypot(i as f64 + 0.5 - half[0], j as f64 + 0.5 - half[1])
    };
    blocks.map(radius).collect()
}

/// Shares of the radius within which blocks still stick.
const STUCK: [f64; 6] = [0.9, 0.8, 0.7, 0.6, 0.5, 0.4];

const V_STAR: f64 = 1e-3;
const OMEGA_STAR: f64 = 2.0;
const DT_STAR: f64 = 0.8;
/// Increase of the torque of the springs in half a step.
const HALF_A_STEP: f64 = 0.5 * (K_DRIVE * V_STAR) * DT_STAR;

/// Largest excess of the torque over that of blocks at their kinetic friction, while those within `stuck` of
/// the radius stick. It has three parts. The drag of sliding blocks is `Omega V* r/r_max` each. At a time t
/// after the slip of a block, which is detected up to a step late, its remaining part of `1 - R*` is at most
///
/// ```text
/// s_2/(s_2 - s_1) exp(-s_1 t),   s_1,2 = Omega/2 -+ sqrt(Omega^2/4 - k_s)
/// ```
///
/// The third part is the drive torque of half a step, since the torque is read at whole steps.
fn excess(radii: &[f64], stuck: f64, r_star: f64) -> f64 {
    let damping = scales::damping(OMEGA_STAR);
    let root = (0.25 * damping * damping - K_DRIVE).sqrt();
    let [slow, fast] = [0.5 * damping - root, 0.5 * damping + root];
    let largest = radii.iter().copied().fold(0.0, f64::max);
    let pull = K_DRIVE * V_STAR;
    let of_block = |r: &f64| {
        let since = (1.0 / stuck - largest / r) / pull - DT_STAR;
        let left = fast / (fast - slow) * libm::exp(-slow * since);
        r * ((1.0 - r_star) * left.min(1.0) + damping * V_STAR * r / largest)
    };
    let sliding = radii.iter().filter(|r| **r > stuck * largest);
    sliding.map(of_block).sum::<f64>() / radii.iter().sum::<f64>() + HALF_A_STEP
}

/// A disc of 40 blocks across that are driven independently: the springs between them are a million times
/// softer.
fn decoupled(r_star: f64) -> Experiment {
    let lattice = Lattice::free(40, 40);
    let outline = Outline::new(Outline::disc(&lattice, 0..40), &Alone);
    let mut slider = Slider::new(None, None, Some(outline), &Alone);
    slider.stiffness = Some(vec![1e-6; 1600]);
    let surface = Surface::uniform(&lattice, 1.0, r_star);
    let drive = Drive::along_x(V_STAR);
    let damping = scales::damping(OMEGA_STAR);
    let mut model = Model::new(lattice, surface, drive, damping, 0.0, FrictionLaw::Projection);
    let rotation = Rotation::about_centroid(&lattice, &model.rows, &slider, &Alone);
    model.drive.rotation = Some(rotation);
    Experiment::at_rest(model.with_slider(slider), DT_STAR)
}

pub(crate) fn compare(chapter: &mut Chapter) -> Result<(), FamilyError> {
    let text = "[slider]\nblocks = [20, 20]\noutline = \"disc\"\n[drive]\nmotion = \"rotation\"\n\
                [time]\nstep = 0.02\nstop = \"after_onset\"";
    let run = AnswerRun::of_equal_blocks("torsion", text)?;
    let exact = torsion_first_slip(&radii(run.simulation.snapshot().model));
    let mut sliding = run.rows.iter().filter(|row| row.point.n_sliding > 0);
    let found = sliding.next().map_or(f64::NAN, |row| row.point.mu_star);
    chapter.add_late(
        "T/T_full at the first slip of a disc with a diameter of 20 blocks",
        [exact, found],
        exact * 0.375 * 0.03 * 0.02,
        "increase of the torque in one step",
    );
    let mut curves = Vec::new();
    let shares: Vec<f64> = (30..=100).map(|k| 0.01 * f64::from(k)).collect();
    for r_star in [0.3, 0.9] {
        let experiment = decoupled(r_star);
        let radii = radii(&experiment.model);
        let first = experiment.model.first_slip_estimate(&Alone).unwrap_or(f64::NAN);
        let times = STUCK.map(|stuck| first / stuck);
        let found = experiment.values(times, |now| now.point.mu_star);
        for (stuck, found) in STUCK.into_iter().zip(found) {
            let answer = chapter.add(
                format!("T/T_full while blocks within ρ = {stuck} r_max stick, R* = {r_star}"),
                [torsion_of_decoupled_blocks(&radii, stuck, r_star), found],
                excess(&radii, stuck, r_star),
                "drag of sliding blocks, decaying force of blocks that slipped recently, and half a step",
            );
            answer.tolerance_below = HALF_A_STEP;
        }
        let exact = |stuck| torsion_of_decoupled_disc(stuck, r_star);
        curves.push(Response::of_formula(
            &format!("R* = {r_star}, exact"),
            &shares,
            exact,
        ));
        curves.push(Response::of_values(&format!("R* = {r_star}"), &STUCK, &found));
    }
    chapter.draw(
        "Torque of a disc of uncoupled blocks against the radius of the stuck part. Lines: continuous disc; points: 40 blocks across.",
        ["radius of the stuck part over disc radius", "torque over full torque"],
        curves,
    );
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The torque of uncoupled blocks is largest at the first slip if R* < 3/4, otherwise at the end.
    #[test]
    fn the_largest_torque_is_that_of_the_first_slip_or_of_the_end() {
        for r_star in [0.3, 0.9] {
            let experiment = decoupled(r_star);
            let radii = radii(&experiment.model);
            let end = 0.35;
            let time = experiment.model.first_slip_estimate(&Alone).unwrap_or(f64::NAN) / end;
            let [largest] = experiment.values([time], |now| now.peak.largest.mu_star);
            let at_the_end = torsion_of_decoupled_blocks(&radii, end, r_star);
            let above = largest - at_the_end.max(torsion_first_slip(&radii));
            // A slip is detected up to a step late.
            let most = excess(&radii, end, r_star) + 2.0 * HALF_A_STEP;
            assert!(-2.0 * HALF_A_STEP < above && above < most, "{above} of {most}");
        }
    }
}
