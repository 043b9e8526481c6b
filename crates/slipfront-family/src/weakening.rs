//! Kinetic friction that falls with speed.

use slipfront::exact_solutions::weakening_growth;
use slipfront::lattice::K_DRIVE;
use slipfront::{Coulomb, Drive, Friction, FrictionLaw, Weakening};
use slipfront_plot::Response;

use crate::chapter::Chapter;
use crate::error::FamilyError;
use crate::runs::growth_of_perturbation;

const LAW: Weakening = Weakening {
    critical_speed: 0.1,
    ratio: 0.4,
};
const V_STAR: f64 = 0.2;
const DT_STAR: f64 = 0.01;
const DAMPINGS: [f64; 5] = [0.0, 0.2, 0.3, 0.4, 0.6];

/// Growth rate of a small perturbation of steady sliding, for blocks that move together.
fn computed(damping: f64) -> f64 {
    let friction = Friction::Coulomb(Coulomb {
        weakening: Some(LAW),
        ..FrictionLaw::Projection.into()
    });
    growth_of_perturbation(Drive::along_x(V_STAR), damping, friction, DT_STAR, [0.0, 2.4])
}

pub(crate) fn compare(chapter: &mut Chapter) -> Result<(), FamilyError> {
    let exact = |damping: f64| weakening_growth(&LAW, 0.5, V_STAR, K_DRIVE, damping);
    let found = DAMPINGS.map(computed);
    for (damping, found) in DAMPINGS.into_iter().zip(found) {
        chapter.add(
            format!("growth rate at V* = 0.2, Ω = {damping}"),
            [exact(damping), found],
            // Without damping the rate is -(dF/dv)/2.
            0.6 * 2.0 * exact(0.0) * DT_STAR * exact(damping).abs(),
            "first-order error, relative ½ |dF/dv| Δt, plus a fifth for higher orders",
        );
    }
    let fine: Vec<f64> = (0..=60).map(|k| 0.01 * f64::from(k)).collect();
    chapter.draw(
        "Growth rate of a small perturbation of steady sliding against damping. A positive rate leads to stick-slip.",
        ["damping \u{3a9}", "growth rate"],
        vec![
            Response::of_formula("exact", &fine, exact),
            Response::of_values("computed", &DAMPINGS, &found),
        ],
    );
    Ok(())
}
