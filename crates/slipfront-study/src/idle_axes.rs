//! Axes that change nothing in a study: the dimensionless model and its time plan are the same at every
//! level. Pressure, stiffness or density is such an axis as long as the drive has a V*, since it then only
//! sets units.

use std::cell::LazyCell;

use slipfront::observe::KineticStart;
use slipfront_case::case::Case;

use crate::axis::Axis;
use crate::plan::Plan;

/// Strain due to the load below which it does not affect the printed digits of results; at ten times this
/// strain, it affects the third digit.
const NEGLIGIBLE_EPSILON: f64 = 1e-3;

/// The keys that set the unit of speed (Eq. 11a): V* does not change with them.
const UNITS_OF_SPEED: [&str; 4] = [
    "load.pressure",
    "slider.young_modulus",
    "slider.density",
    "friction.mu_static",
];

/// A sentence for each axis that changes nothing, with the axis and a remedy.
///
/// An axis changes nothing if all its levels give the same model, both at the first levels of the other axes
/// and at the last ones. If an axis changes something, usually its second level already differs.
pub fn idle_axes(plan: &Plan) -> Vec<String> {
    let first = vec![0; plan.axes.len()];
    let last = plan.axes.iter().map(|axis| axis.levels.len() - 1).collect();
    let corners = [first, last].map(|levels: Vec<usize>| {
        let digest = LazyCell::new({
            let levels = levels.clone();
            move || digest_at(plan, &levels)
        });
        (levels, digest)
    });
    let is_idle = |axis: usize| {
        let count = plan.axes[axis].levels.len();
        let is_same_from = |(corner, digest): &(Vec<usize>, LazyCell<Option<blake3::Hash>, _>)| {
            let others = (0..count).filter(|&level| level != corner[axis]);
            let mut digests = others.map(|level| {
                let mut levels = corner.clone();
                levels[axis] = level;
                digest_at(plan, &levels)
            });
            digest.is_some() && digests.all(|other| other == **digest)
        };
        count > 1 && corners.iter().all(is_same_from)
    };
    let idle = (0..plan.axes.len()).filter(|&axis| is_idle(axis));
    idle.map(|axis| sentence(&plan.axes[axis])).collect()
}

/// Hash of the computed model at these levels; none if they are not a valid case, since a shard need not
/// check points that it does not run.
fn digest_at(plan: &Plan, levels: &[usize]) -> Option<blake3::Hash> {
    plan.case_of(levels).ok().as_ref().map(digest)
}

/// Hash of everything in a case that the kernel and the observers use. Numbers are rounded to 24 bits,
/// because units that cancel leave rounding errors of two operations at 53 bits.
fn digest(case: &Case) -> blake3::Hash {
    let (model, time) = (&case.model, &case.time_plan);
    let mut hasher = blake3::Hasher::new();
    let words = (model.lattice, model.friction, time.last_step, time.stop);
    hasher.update(format!("{words:?}").as_bytes());
    let mut number = |value: f64| {
        hasher.update(&(value as f32).to_le_bytes());
    };
    number(if model.epsilon > NEGLIGIBLE_EPSILON {
        model.epsilon
    } else {
        0.0
    });
    let drive = &model.drive;
    let [along_x, along_y] = drive.direction;
    for value in [
        drive.v_star,
        along_x,
        along_y,
        model.damping,
        time.dt_star,
        drive.k_drive,
    ] {
        number(value);
    }
    number(f64::from(u8::from(drive.rotation.is_some())));
    if let Some(body) = model.body() {
        number(body.height);
        number(body.poisson);
        number(f64::from(u8::from(body.face.is_pressure())));
    }
    for segment in drive.program.iter().flat_map(|program| program.segments()) {
        number(segment.v_star);
        number(segment.from_star);
    }
    if let KineticStart::At(from) = time.kinetic {
        number(from);
    }
    let surface = &model.surface;
    let slider = model.slider();
    number(slider.viscosity_time);
    for block in 0..surface.n_blocks() {
        number(slider.mass(block));
        number(slider.drive_spring(block));
        number(slider.modulus(block));
        number(surface.normal_force(block));
        number(surface.static_limit(block));
        number(surface.kinetic_force(block));
    }
    hasher.finalize()
}

fn sentence(axis: &Axis) -> String {
    let keys = axis.keys();
    let why = if keys.iter().any(|key| UNITS_OF_SPEED.contains(key)) {
        "but the units of results while `drive.v_star` is fixed: set `drive.speed` instead"
    } else if keys.contains("slider.block_size") {
        "but the units of results while no other length is given: vary `slider.blocks`"
    } else if keys.contains("friction.seed") || keys.contains("friction.correlation_length") {
        "because no coefficient is random: increase `friction.sigma_static_star`"
    } else if keys.iter().any(|key| key.starts_with("texture")) {
        "because all its levels cover the same blocks: use more blocks (`slider.blocks`)"
    } else {
        "with the present values of the other keys: change those"
    };
    let columns = axis.columns.join("`, `");
    format!("the axis of `{columns}` changes nothing {why}, or leave the axis out")
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::StudyFile;

    fn idle(text: &str) -> Vec<String> {
        let text = format!("base.slider.blocks = [4, 4]\n{text}");
        let file = StudyFile::parse(&text, "study.toml", "study", Path::new("")).unwrap();
        idle_axes(&Plan::new(&file, None).unwrap())
    }

    fn axis(key: &str, list: &str) -> String {
        format!("[[axes]]\nkey = '{key}'\nlist = {list}\n")
    }

    /// Axes that only set units are reported with a remedy: only the dimensionless model counts, not the name
    /// of the key.
    #[test]
    fn axes_of_units_are_named_with_their_remedy() {
        let (pressure, speed) = (
            axis("load.pressure", "['50 kPa', '100 kPa', '200 kPa']"),
            axis("drive.v_star", "[0.02, 0.03, 0.05]"),
        );
        let said = idle(&format!("{pressure}{speed}"));
        let expected = "the axis of `load.pressure` changes nothing but the units of results while `drive.v_star` is fixed: set \
                        `drive.speed` instead, or leave the axis out";
        assert_eq!(said, [expected]);
        // With the remedy, the axis has an effect.
        assert!(idle(&format!("base.drive.speed = '0.1 mm/s'\n{pressure}")).is_empty());
        for (key, list) in [
            ("slider.young_modulus", "['50 GPa', '100 GPa']"),
            ("slider.density", "['5 g/cm^3', '10 g/cm^3']"),
            ("slider.block_size", "['1 um', '3 um']"),
            // These values cancel only up to rounding.
            ("friction.mu_static", "[0.3, 0.7, 1.0]"),
        ] {
            let said = idle(&axis(key, list));
            assert!(said.len() == 1 && said[0].contains(key), "{key}: {said:?}");
        }
        let sized = "[[base.texture]]\nshape = 'cavity'\nlambda = '1 um'\n";
        assert!(
            idle(&format!(
                "{sized}{}",
                axis("slider.block_size", "['1 um', '3 um']")
            ))
            .is_empty()
        );
    }

    #[test]
    fn axes_that_change_what_is_computed_are_not_named() {
        for (key, list) in [
            ("friction.seed", "[1, 2]"),
            ("friction.correlation_length", "['1 um', '2 um']"),
            ("friction.r_star", "[0.5, 0.6]"),
            ("friction.sigma_kinetic_star", "[0, 0.05]"),
            ("drive.direction", "[0, 10]"),
            ("slider.omega_star", "[0.1, 0.2]"),
            ("slider.edges", "['free', 'periodic']"),
            ("slider.outline", "['rectangle', 'disc']"),
            ("slider.viscosity_time_star", "[0, 0.1]"),
            ("slider.density_grade.to", "[1, 0.5]"),
            ("slider.stiffness_grade.to", "[1, 0.5]"),
            ("time.duration_star", "[10, 20]"),
            ("time.kinetic_from_star", "[200, 210]"),
            ("time.stop", "['end', 'after_onset']"),
            ("friction.law", "['projection', 'literal']"),
            // Strains that affect the results.
            ("load.pressure", "['1 GPa', '2 GPa']"),
        ] {
            let grades = "{ along = 'x', from = 1, to = 1 }";
            let base =
                format!("base.slider.stiffness_grade = {grades}\nbase.slider.density_grade = {grades}\n");
            assert!(idle(&format!("{base}{}", axis(key, list))).is_empty(), "{key}");
        }
        // Four blocks per side do not resolve the difference.
        let sized = "[[base.texture]]\nshape = 'cavity'\n";
        let said = idle(&format!("{sized}{}", axis("texture.0.coverage", "[12, 13]")));
        assert!(said.len() == 1 && said[0].contains("the same blocks"), "{said:?}");
        let smooth = "base.friction.sigma_static_star = 0\nbase.friction.sigma_kinetic_star = 0\n";
        for (key, list) in [
            ("friction.seed", "[1, 2]"),
            ("friction.correlation_length", "['1 um', '2 um']"),
        ] {
            let said = idle(&format!("{smooth}{}", axis(key, list)));
            assert!(
                said.len() == 1 && said[0].contains("no coefficient is random"),
                "{said:?}"
            );
        }
    }

    /// An axis that has an effect only at the last levels of the others is not idle.
    #[test]
    fn an_axis_may_count_at_some_points_alone() {
        let variants = "[[axes]]\nname = 'held'\n[axes.variants]\nv_star = { drive.v_star = 0.03 }\n\
                        speed = { drive.speed = '0.1 mm/s' }\n";
        let pressure = axis("load.pressure", "['50 kPa', '100 kPa']");
        assert!(idle(&format!("{variants}{pressure}")).is_empty());
        assert!(idle(&format!("{pressure}{variants}")).is_empty());
    }
}
