//! Words that people try first, and the keys of a case file to use instead.

use super::{friction, shapes};

/// Words that people try first, in lower case if they are longer than one letter, with the advice on them.
/// Keys are in backquotes.
pub(super) type Synonyms = &'static [(&'static [&'static str], &'static str)];

/// Makes a table of [`Synonyms`] from rows of words and the advice on them.
macro_rules! synonyms {
    {$($($word:literal)+ => $advice:literal;)+} => { &[$((&[$($word),+], $advice),)+] };
}
pub(super) use synonyms;

/// Words that do not belong to a law of friction or a shape of texture.
const COMMON: Synonyms = synonyms! {
    "E" "young" "youngs_modulus" "modulus" "elastic_modulus" => "Young's modulus is `slider.young_modulus`";
    "stiffness" =>
        "the springs between blocks follow from `slider.young_modulus`, and `drive.stiffness` is that of the \
        drive springs";
    "spring_constant" "k" "k1" "k2" => "the springs follow from `slider.young_modulus`";
    "nu" "poisson" "poisson_ratio" =>
        "Poisson's ratio of the springs between blocks is 1/3; that of a body with `slider.body` = \"bulk\" \
        is `slider.poisson`";
    "gradient" => "a graded stiffness or density is `slider.stiffness_grade` or `slider.density_grade`";
    "tau_v" "viscosity" "viscous" "damping_internal" "internal_damping" "kelvin_voigt" "dashpot"
        "damper" =>
        "the internal viscosity is `slider.viscosity_time_star`; damping of any motion is `slider.omega_star`";
    "springs" "bonds" =>
        "the springs between blocks follow from `slider.young_modulus`, those of the drive are \
        `drive.stiffness`, and those of contacts are `friction.contact` = \"springs\"";
    "k_s" =>
        "the stiffness of a drive spring is `drive.stiffness`, with its unit, or `drive.stiffness_star`; the \
        total stiffness is `drive.total_stiffness`";
    "shape" => "the shape of the slider is `slider.outline`, that of a texture its `shape`";
    "cutout" "domain" => "the shape of a slider is `slider.outline`";
    "rho" => "the density is `slider.density`";
    "mass" => "the mass of a block follows from `slider.density` and `slider.block_size`";
    "l" => "the edge of a block is `slider.block_size`";
    "n" "N" "nx" "ny" "length" =>
        "the slider is `slider.blocks` = [25, 25] blocks of edge `slider.block_size`";
    "material" =>
        "the material is in [slider]: `slider.young_modulus`, `slider.density`, `slider.omega_star`";
    "damping" => "the damping is `slider.omega_star`, or `slider.damping_rate` with its unit";
    "omega" =>
        "the damping is `slider.omega_star`, or `slider.damping_rate` with its unit; a rotating drive is \
        `drive.motion` = \"rotation\"";
    "boundary" => "the boundary condition at the edges is `slider.edges`";
    "longest_wave" => "a bulk body is exact for every wavelength: leave it out";
    "sheets" => "a bulk body is given by `slider.height` and `slider.poisson`, not by sheets";
    "along_to_across" => "the stiffness of a bulk body along and across a wave follows from `slider.poisson`";
    "periodic" => "periodic edges are `slider.edges` = \"periodic\"";
    "P" "normal_force" "normal_load" "weight" => "the normal load is `load.pressure`, over the whole area";
    "force" =>
        "the normal load is `load.pressure`, over the whole area; the drive has a speed, `drive.v_star`, and \
        its force is a result";
    "V" "v" => "the speed of the drive is `drive.v_star`, or `drive.speed` with its unit";
    "velocity" =>
        "the speed of the drive is `drive.v_star`, or `drive.speed` with its unit; velocity weakening is \
        `friction.velocity`";
    "angle" =>
        "the direction of the drive is `drive.direction`, and a cavity is turned by `texture.N.rotate`";
    "theta" => "the direction of the drive is `drive.direction`";
    "torque" "torsion" "spin" "angular_velocity" "angular_speed" =>
        "a rotating drive is `drive.motion` = \"rotation\", with `drive.v_star` at the largest radius; its \
        torque is a result";
    "edge" =>
        "the boundary condition at the edges is `slider.edges`; the edge that is driven is `drive.attach`";
    "push" "pull" "pusher" "attached" "driven" =>
        "the driven blocks are `drive.attach` = \"left\", \"right\", \"bottom\" or \"top\", or \
        `drive.attach_file`";
    "hold" "slide_hold_slide" "velocity_steps" "velocity_step" "steps" "schedule" "segments" =>
        "a sequence of speeds, with 0 for a hold, is `drive.program` = [{ v_star = 0.03, until_star = 200 }, \
        { v_star = 0 }]";
    "load_profile" "pressure_profile" "slope" "tilt" =>
        "a non-uniform load is `load.profile` = { along = \"x\", relative_slope = 0.5 }";
    "mu" "friction_coefficient" "coefficient" =>
        "the mean coefficients are `friction.mu_static` and `friction.r_star` (or `friction.mu_kinetic`)";
    "mu_s" "static" => "the mean static coefficient is `friction.mu_static`";
    "mu_k" "kinetic" "r" "ratio" =>
        "the mean kinetic coefficient is `friction.r_star` over the static one, or `friction.mu_kinetic` \
        itself";
    "sigma" "std" "roughness" =>
        "the spreads of the coefficients are `friction.sigma_static_star` and `friction.sigma_kinetic_star`";
    "surface" => "the surface is made of the coefficients in [friction] and of each [[texture]]";
    "dt" "timestep" "time_step" => "the time step is `time.step`";
    "end" "t_end" "n_steps" =>
        "the length of the run is `time.duration_star`, or `time.duration` with its unit";
    "every" => "snapshots at equal times are `output.snapshots` = { every = 5.0 }";
    "frames" => "times and fields of the output are `output.snapshots` and `output.fields`";
    "spacing" "period" "distance" => "the distance between the copies of a shape is `pitch`";
    "pillars" => "pillars are the shape of one with `invert` = true, arranged by `array` or `pitch`";
    "pillar" => "a pillar is the shape of it, such as \"cavity\", with `invert` = true";
    "inverse" => "`invert` = true textures the outside of a shape";
    "pattern" "arrangement" =>
        "a shape is repeated by `array` = [4, 4] or `pitch` = \"12 um\", arranged by `lattice`";
    "size" =>
        "the size of a texture is `coverage`, or `lambda` of a cavity and `width` of a groove; that of the \
        slider is `slider.blocks` times `slider.block_size`";
    "area" => "the textured fraction of the area is `coverage`, in percent";
    "depth" =>
        "a texture has no depth, and its blocks are not in contact; only a \"height_map\" has \
        `texture.N.depth`, which selects the blocks in contact";
    "position" "x" "y" => "the position of a cavity is `center`, of a groove `offset` from the middle";
    "values" => "the levels of an axis are its list, linspace or logspace";
    "simulation" => "the duration of a run and its step are in [time], its output is in [output]";
    "prestress" "shear_stress" "dead_load" "tangential_load" =>
        "an initial shear stress is `load.shear`, with its unit, or `load.shear_star`";
    "initial_displacement" "initial_velocity" "initial_state" "restart" =>
        "the initial state is `initial.displacement_x`, `initial.velocity_x` and similar keys, or \
        `initial.state_file` of another run";
    "cohesion" "adhesive" "tau_a" "shear_strength" =>
        "adhesion adds to static friction as `friction.adhesion`, and to kinetic friction as \
        `friction.adhesion_kinetic`";
    "temperature" => "the model has no temperature";
};

/// Each word with the advice on it.
fn all_words() -> impl Iterator<Item = (&'static str, &'static str)> {
    let tables = [COMMON]
        .into_iter()
        .chain(friction::SYNONYMS)
        .chain(shapes::SYNONYMS);
    tables.flat_map(|table| {
        table
            .iter()
            .flat_map(|(words, advice)| words.iter().map(|word| (*word, *advice)))
    })
}

/// The advice on a word.
pub(super) fn advice_on(word: &str) -> Option<&'static str> {
    // For single letters, case matters: E and e, V and v.
    let small = word.to_lowercase();
    let known = all_words().find(|(known, _)| *known == word || (word.len() > 1 && *known == small));
    known.map(|(_, advice)| advice)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case_file::key_table::SECTIONS;

    /// Every key that advice names exists. No word is a key itself, which would be misdirected from the wrong
    /// table, unless its advice names it.
    #[test]
    fn advice_names_keys_that_exist() {
        for (word, advice) in all_words() {
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
            assert!(word.len() == 1 || word == word.to_lowercase(), "{word}");
            assert_eq!(
                all_words().filter(|(other, _)| *other == word).count(),
                1,
                "{word}"
            );
            assert_eq!(advice_on(word), Some(advice));
        }
        assert_eq!(advice_on("E"), Some("Young's modulus is `slider.young_modulus`"));
        assert_eq!(advice_on("V"), advice_on("v"));
        assert_eq!(advice_on("e"), None);
    }
}
