//! A disc that is turned about its centre.

/// Torque at the first slip of a uniform slider in torsion over the torque that all blocks could bear: `mu*`
/// of the first slip:
///
/// ```text
/// T/T_full = sum_i r_i^2/(r_max sum_i r_i)
/// ```
///
/// Until then all blocks are stuck, and the spring forces grow with the radius: the block at the rim reaches
/// its threshold first, when the other blocks bear `r_i/r_max` of theirs. The result is 3/4 for a continuous
/// disc. `radii`: of all blocks, in any unit.
///
/// ```
/// use slipfront::exact_solutions::torsion_first_slip;
/// // Four blocks at radius 1 and four at 2.
/// assert_eq!(torsion_first_slip(&[1.0, 1.0, 1.0, 1.0, 2.0, 2.0, 2.0, 2.0]), 20.0 / 24.0);
/// ```
pub fn torsion_first_slip(radii: &[f64]) -> f64 {
    let largest = radii.iter().copied().fold(0.0, f64::max);
    radii.iter().map(|r| r * r).sum::<f64>() / (largest * radii.iter().sum::<f64>())
}

/// Torque, over the torque that all blocks could bear, of a uniform slider in torsion with blocks that do not
/// pull on each other. Blocks within `stuck`, a share of the largest radius, still stick, and all beyond
/// slide against kinetic friction:
///
/// ```text
/// T/T_full = [sum_stuck r_i^2/(rho r_max) + R* sum_sliding r_i]/sum_i r_i
/// ```
///
/// The spring forces grow with the radius and reach the threshold at `rho r_max`. For a continuous disc the
/// result is [`torsion_of_decoupled_disc`]. `radii`: of all blocks, in any unit.
///
/// ```
/// use slipfront::exact_solutions::torsion_of_decoupled_blocks;
/// // Two blocks at radius 1 bear 1/1.5 of their thresholds; one at radius 2 slides.
/// assert_eq!(torsion_of_decoupled_blocks(&[1.0, 1.0, 2.0], 0.75, 0.5), (2.0 / 1.5 + 1.0) / 4.0);
/// ```
pub fn torsion_of_decoupled_blocks(radii: &[f64], stuck: f64, r_star: f64) -> f64 {
    let edge = stuck * radii.iter().copied().fold(0.0, f64::max);
    let torque = |r: &f64| if *r <= edge { r * r / edge } else { r_star * r };
    radii.iter().map(torque).sum::<f64>() / radii.iter().sum::<f64>()
}

/// mu* of a uniform disc with blocks that do not pull on each other. Blocks within `stuck`, a share of its
/// radius, still stick, and all beyond slide against kinetic friction:
///
/// ```text
/// T/T_full = 3/4 rho^3 + R* (1 - rho^3)
/// ```
///
/// The stuck part bears `integral of (r/rho) r 2 pi r dr = pi rho^3/2`, the sliding part
/// `2 pi/3 R* (1 - rho^3)`, and `2 pi/3` is the torque that all blocks could bear.
///
/// ```
/// use slipfront::exact_solutions::torsion_of_decoupled_disc;
/// assert_eq!(torsion_of_decoupled_disc(1.0, 0.3), 0.75);
/// assert_eq!(torsion_of_decoupled_disc(0.0, 0.3), 0.3);
/// ```
pub fn torsion_of_decoupled_disc(stuck: f64, r_star: f64) -> f64 {
    let cube = stuck * stuck * stuck;
    0.75 * cube + r_star * (1.0 - cube)
}
