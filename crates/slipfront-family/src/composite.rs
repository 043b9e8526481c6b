//! Surfaces of two zones.

use slipfront::communicator::Alone;
use slipfront::exact_solutions::composite_peak;
use slipfront::surface::{Coefficients, Contact, Load};
use slipfront::{Drive, FrictionLaw, Lattice, Model, Outline, Slider, Surface, scales};
use slipfront_plot::Response;

use crate::chapter::{Chapter, rounding};
use crate::error::FamilyError;
use crate::runs::Experiment;

const V_STAR: f64 = 0.005;
const OMEGA_STAR: f64 = 1.5;
const DT_STAR: f64 = 0.1;
const WEAK: f64 = 0.5;
const R_STAR: f64 = 0.5;

/// Largest mu* of 10 x 10 uncoupled blocks with some weak rows.
fn largest(weak_rows: usize) -> Result<f64, FamilyError> {
    let lattice = Lattice::free(20, 20);
    let exists = (0..400).map(|b| (b % 20) % 2 == 0 && (b / 20) % 2 == 0);
    let slider = Slider::new(None, None, Some(Outline::new(exists.collect(), &Alone)), &Alone);
    let static_of = |b: usize| if b / 40 < weak_rows { WEAK } else { 1.0 };
    let mu_static: Vec<f64> = (0..400).map(static_of).collect();
    let mu_kinetic = mu_static.iter().map(|mu| R_STAR * mu).collect();
    let coefficients = Coefficients::given(mu_static, mu_kinetic);
    let contact = Contact::new(Load::Redistributed, 1.0);
    let surface = Surface::of_ranks(coefficients, vec![false; 400], contact, &slider, &Alone)?;
    let (drive, damping) = (Drive::along_x(V_STAR), scales::damping(OMEGA_STAR));
    let model = Model::new(lattice, surface, drive, damping, 0.0, FrictionLaw::Projection);
    let experiment = Experiment::at_rest(model.with_slider(slider), DT_STAR);
    let run = experiment.run("composite", (6.0 / V_STAR / DT_STAR) as u64)?;
    Ok(run.largest())
}

pub(crate) fn compare(chapter: &mut Chapter) -> Result<(), FamilyError> {
    let (mut found, mut shares) = (Vec::new(), Vec::new());
    for weak_rows in 1..10 {
        let share = 0.1 * f64::from(weak_rows);
        let peak = largest(weak_rows as usize)?;
        let exact = composite_peak(share, [WEAK, 1.0], R_STAR);
        let rise = 0.375 * V_STAR * DT_STAR;
        // The weak zone slides only if the strong one slips later and at a larger friction.
        let (tolerance, reason) = if exact > WEAK {
            (
                share * scales::damping(OMEGA_STAR) * V_STAR + rise,
                "drag f Ω V* of the sliding zone, and drive force of one step",
            )
        } else {
            (rise, "drive force of one step, when the weak zone slips")
        };
        let quantity = format!("largest μ*, f = 0.{weak_rows}, μ_1 = 0.5, μ_2 = 1");
        let answer = chapter.add(quantity, [exact, peak], tolerance, reason);
        answer.tolerance_below = rounding(exact);
        shares.push(share);
        found.push(peak);
    }
    let fine: Vec<f64> = (0..=100).map(|k| 0.01 * f64::from(k)).collect();
    let at_once = |share: f64| WEAK * share + 1.0 - share;
    chapter.draw(
        "Largest friction of a surface with two zones and uncoupled blocks, against the fraction of the weak zone.",
        ["fraction of the weak zone", "largest friction \u{3bc}*"],
        vec![
            Response::of_formula("exact", &fine, |share| composite_peak(share, [WEAK, 1.0], R_STAR)),
            Response::of_formula("both thresholds at once", &fine, at_once),
            Response::of_values("computed", &shares, &found),
        ],
    );
    Ok(())
}
