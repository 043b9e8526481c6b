//! Words that people try first, and the keys of a case file to use instead.

use super::{friction, shapes};

/// Each word, in lower case if it is longer than one letter, and the advice on it. Keys are in backquotes.
const COMMON: &[(&str, &str)] = &[
    ("E", YOUNG),
    ("young", YOUNG),
    ("youngs_modulus", YOUNG),
    ("modulus", YOUNG),
    ("elastic_modulus", YOUNG),
    ("stiffness", STIFFNESS),
    ("spring_constant", SPRINGS),
    ("k", SPRINGS),
    ("k1", SPRINGS),
    ("k2", SPRINGS),
    ("nu", POISSON),
    ("poisson", POISSON),
    ("poisson_ratio", POISSON),
    (
        "gradient",
        "a graded stiffness or density is `slider.stiffness_grade` or `slider.density_grade`",
    ),
    ("tau_v", VISCOSITY),
    ("viscosity", VISCOSITY),
    ("viscous", VISCOSITY),
    ("damping_internal", VISCOSITY),
    ("internal_damping", VISCOSITY),
    ("kelvin_voigt", VISCOSITY),
    ("dashpot", VISCOSITY),
    ("damper", VISCOSITY),
    ("springs", SPRINGS_OF_EACH),
    ("bonds", SPRINGS_OF_EACH),
    (
        "k_s",
        "the stiffness of a drive spring is `drive.stiffness`, with its unit, or `drive.stiffness_star`; the total stiffness is `drive.total_stiffness`",
    ),
    (
        "shape",
        "the shape of the slider is `slider.outline`, that of a texture its `shape`",
    ),
    ("cutout", OUTLINE),
    ("domain", OUTLINE),
    ("rho", "the density is `slider.density`"),
    (
        "mass",
        "the mass of a block follows from `slider.density` and `slider.block_size`",
    ),
    ("l", "the edge of a block is `slider.block_size`"),
    ("n", BLOCKS),
    ("N", BLOCKS),
    ("nx", BLOCKS),
    ("ny", BLOCKS),
    ("length", BLOCKS),
    (
        "material",
        "the material is in [slider]: `slider.young_modulus`, `slider.density`, `slider.omega_star`",
    ),
    (
        "damping",
        "the damping is `slider.omega_star`, or `slider.damping_rate` with its unit",
    ),
    (
        "omega",
        "the damping is `slider.omega_star`, or `slider.damping_rate` with its unit; a rotating drive is `drive.motion` = \"rotation\"",
    ),
    (
        "boundary",
        "the boundary condition at the edges is `slider.edges`",
    ),
    (
        "longest_wave",
        "a bulk body is exact for every wavelength: leave it out",
    ),
    (
        "sheets",
        "a bulk body is given by `slider.height` and `slider.poisson`, not by sheets",
    ),
    (
        "along_to_across",
        "the stiffness of a bulk body along and across a wave follows from `slider.poisson`",
    ),
    ("periodic", "periodic edges are `slider.edges` = \"periodic\""),
    ("P", PRESSURE),
    (
        "force",
        "the normal load is `load.pressure`, over the whole area; the drive has a speed, `drive.v_star`, and its force is a result",
    ),
    ("normal_force", PRESSURE),
    ("normal_load", PRESSURE),
    ("weight", PRESSURE),
    ("V", SPEED),
    ("v", SPEED),
    (
        "velocity",
        "the speed of the drive is `drive.v_star`, or `drive.speed` with its unit; velocity weakening is `friction.velocity`",
    ),
    (
        "angle",
        "the direction of the drive is `drive.direction`, and a cavity is turned by `texture.N.rotate`",
    ),
    ("theta", "the direction of the drive is `drive.direction`"),
    ("torque", ROTATION),
    ("torsion", ROTATION),
    ("spin", ROTATION),
    ("angular_velocity", ROTATION),
    ("angular_speed", ROTATION),
    (
        "edge",
        "the boundary condition at the edges is `slider.edges`; the edge that is driven is `drive.attach`",
    ),
    ("push", ATTACH),
    ("pull", ATTACH),
    ("pusher", ATTACH),
    ("attached", ATTACH),
    ("driven", ATTACH),
    ("hold", PROGRAM),
    ("slide_hold_slide", PROGRAM),
    ("velocity_steps", PROGRAM),
    ("velocity_step", PROGRAM),
    ("steps", PROGRAM),
    ("schedule", PROGRAM),
    ("segments", PROGRAM),
    ("load_profile", PROFILE),
    ("pressure_profile", PROFILE),
    ("slope", PROFILE),
    ("tilt", PROFILE),
    ("mu", FRICTION),
    ("friction_coefficient", FRICTION),
    ("coefficient", FRICTION),
    ("mu_s", "the mean static coefficient is `friction.mu_static`"),
    ("static", "the mean static coefficient is `friction.mu_static`"),
    ("mu_k", KINETIC),
    ("kinetic", KINETIC),
    ("r", KINETIC),
    ("ratio", KINETIC),
    ("sigma", SPREAD),
    ("std", SPREAD),
    ("roughness", SPREAD),
    (
        "surface",
        "the surface is made of the coefficients in [friction] and of each [[texture]]",
    ),
    ("dt", "the time step is `time.step`"),
    ("timestep", "the time step is `time.step`"),
    ("time_step", "the time step is `time.step`"),
    ("end", DURATION),
    ("t_end", DURATION),
    ("n_steps", DURATION),
    (
        "every",
        "snapshots at equal times are `output.snapshots` = { every = 5.0 }",
    ),
    (
        "frames",
        "times and fields of the output are `output.snapshots` and `output.fields`",
    ),
    ("spacing", PITCH),
    ("period", PITCH),
    ("distance", PITCH),
    (
        "pillars",
        "pillars are the shape of one with `invert` = true, arranged by `array` or `pitch`",
    ),
    (
        "pillar",
        "a pillar is the shape of it, such as \"cavity\", with `invert` = true",
    ),
    ("inverse", "`invert` = true textures the outside of a shape"),
    ("pattern", PATTERN),
    ("arrangement", PATTERN),
    (
        "size",
        "the size of a texture is `coverage`, or `lambda` of a cavity and `width` of a groove; that of the slider is \
        `slider.blocks` times `slider.block_size`",
    ),
    (
        "area",
        "the textured fraction of the area is `coverage`, in percent",
    ),
    (
        "depth",
        "a texture has no depth, and its blocks are not in contact; only a \"height_map\" has `texture.N.depth`, which selects the blocks in contact",
    ),
    (
        "position",
        "the position of a cavity is `center`, of a groove `offset` from the middle",
    ),
    (
        "x",
        "the position of a cavity is `center`, of a groove `offset` from the middle",
    ),
    (
        "y",
        "the position of a cavity is `center`, of a groove `offset` from the middle",
    ),
    (
        "values",
        "the levels of an axis are its list, linspace or logspace",
    ),
    (
        "simulation",
        "the duration of a run and its step are in [time], its output is in [output]",
    ),
    ("prestress", SHEAR),
    ("shear_stress", SHEAR),
    ("dead_load", SHEAR),
    ("tangential_load", SHEAR),
    ("initial_displacement", INITIAL),
    ("initial_velocity", INITIAL),
    ("initial_state", INITIAL),
    ("restart", INITIAL),
    ("cohesion", ADHESION),
    ("adhesive", ADHESION),
    ("tau_a", ADHESION),
    ("shear_strength", ADHESION),
    ("temperature", "the model has no temperature"),
];

const YOUNG: &str = "Young's modulus is `slider.young_modulus`";
const SPRINGS: &str = "the springs follow from `slider.young_modulus`";
const STIFFNESS: &str = "the springs between blocks follow from `slider.young_modulus`, and `drive.stiffness` is that of the drive springs";
const POISSON: &str = "Poisson's ratio of the springs between blocks is 1/3; that of a body with `slider.body` = \"bulk\" is `slider.poisson`";
const BLOCKS: &str = "the slider is `slider.blocks` = [25, 25] blocks of edge `slider.block_size`";
const PRESSURE: &str = "the normal load is `load.pressure`, over the whole area";
const SPEED: &str = "the speed of the drive is `drive.v_star`, or `drive.speed` with its unit";
const FRICTION: &str =
    "the mean coefficients are `friction.mu_static` and `friction.r_star` (or `friction.mu_kinetic`)";
const KINETIC: &str =
    "the mean kinetic coefficient is `friction.r_star` over the static one, or `friction.mu_kinetic` itself";
const SPREAD: &str =
    "the spreads of the coefficients are `friction.sigma_static_star` and `friction.sigma_kinetic_star`";
const DURATION: &str = "the length of the run is `time.duration_star`, or `time.duration` with its unit";
const VISCOSITY: &str =
    "the internal viscosity is `slider.viscosity_time_star`; damping of any motion is `slider.omega_star`";
const SPRINGS_OF_EACH: &str = "the springs between blocks follow from `slider.young_modulus`, those of the drive are `drive.stiffness`, and those \
                               of contacts are `friction.contact` = \"springs\"";
const OUTLINE: &str = "the shape of a slider is `slider.outline`";
const ROTATION: &str = "a rotating drive is `drive.motion` = \"rotation\", with `drive.v_star` at the largest radius; its torque is a result";
const ATTACH: &str = "the driven blocks are `drive.attach` = \"left\", \"right\", \"bottom\" or \"top\", or `drive.attach_file`";
const PROGRAM: &str = "a sequence of speeds, with 0 for a hold, is `drive.program` = [{ v_star = 0.03, until_star = 200 }, { v_star = 0 }]";
const PROFILE: &str = "a non-uniform load is `load.profile` = { along = \"x\", relative_slope = 0.5 }";
const ADHESION: &str = "adhesion adds to static friction as `friction.adhesion`, and to kinetic friction as `friction.adhesion_kinetic`";
const SHEAR: &str = "an initial shear stress is `load.shear`, with its unit, or `load.shear_star`";
const INITIAL: &str = "the initial state is `initial.displacement_x`, `initial.velocity_x` and similar keys, or `initial.state_file` of another run";
const PITCH: &str = "the distance between the copies of a shape is `pitch`";
const PATTERN: &str = "a shape is repeated by `array` = [4, 4] or `pitch` = \"12 um\", arranged by `lattice`";

/// Each word with the advice on it.
fn synonyms() -> impl Iterator<Item = &'static (&'static str, &'static str)> {
    let own = friction::SYNONYMS.iter().chain(shapes::SYNONYMS);
    COMMON.iter().chain(own.copied().flatten())
}

/// The advice on a word.
pub(super) fn advice_on(word: &str) -> Option<&'static str> {
    // For single letters, case matters: E and e, V and v.
    let small = word.to_lowercase();
    synonyms()
        .find(|(known, _)| *known == word || (word.len() > 1 && *known == small))
        .map(|(_, advice)| *advice)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case_file::key_table::SECTIONS;

    /// Every key that advice names exists. No word is a key itself, which would be misdirected from the wrong
    /// table, unless its advice names it.
    #[test]
    fn advice_names_keys_that_exist() {
        for (word, advice) in synonyms() {
            let has = |table: &str, name: &str| {
                let mut sections = SECTIONS.iter().filter(|section| section.table() == table);
                sections.any(|section| section.key(name).is_some())
            };
            for named in advice.split('`').skip(1).step_by(2) {
                let (table, name) = match named.split_once('.') {
                    Some((table, name)) => (table, name.trim_start_matches("N.")),
                    None => ("texture", named),
                };
                assert!(has(table, name) || name == "shape", "{word}: {named}");
            }
            assert!(
                SECTIONS.iter().all(|section| section.key(word).is_none())
                    || advice.contains(&format!(".{word}`")),
                "{word}"
            );
            assert!(word.len() == 1 || *word == word.to_lowercase(), "{word}");
            assert_eq!(synonyms().filter(|(other, _)| other == word).count(), 1, "{word}");
            assert_eq!(advice_on(word), Some(*advice));
        }
        assert_eq!(advice_on("E"), Some(YOUNG));
        assert_eq!(advice_on("V"), Some(SPEED));
        assert_eq!(advice_on("e"), None);
    }
}
