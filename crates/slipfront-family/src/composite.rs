//! Surfaces of two zones.

use std::sync::Arc;

use slipfront::communicator::Alone;
use slipfront::exact_solutions::composite_peak;
use slipfront::surface::{Coefficients, Contact, Load};
use slipfront::{Drive, FrictionLaw, Lattice, Model, Outline, Slider, Surface, scales};
use slipfront_plot::{Response, Responses};

use crate::answer::{Answer, Chapter, rounding};
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
    let mu_static: Vec<f64> = (0..400)
        .map(|b| if b / 40 < weak_rows { WEAK } else { 1.0 })
        .collect();
    let mu_kinetic = mu_static.iter().map(|mu| R_STAR * mu).collect();
    let coefficients = Coefficients::given(mu_static, mu_kinetic);
    let contact = Contact::new(Load::Redistributed, 1.0);
    let surface = Surface::of_ranks(coefficients, vec![false; 400], contact, &slider, &Alone)?;
    let damping = scales::damping(OMEGA_STAR);
    let plain = Model::new(
        lattice,
        surface,
        Drive::along_x(V_STAR),
        damping,
        0.0,
        FrictionLaw::Projection,
    );
    let experiment = Experiment {
        model: Arc::new(plain.with_slider(slider)),
        dt_star: DT_STAR,
        state: None,
    };
    let run = experiment.run("composite", (6.0 / V_STAR / DT_STAR) as u64)?;
    Ok(run.largest())
}

pub(crate) fn chapter() -> Result<Chapter, FamilyError> {
    let (mut answers, mut found, mut shares) = (Vec::new(), Vec::new(), Vec::new());
    for weak_rows in 1..10 {
        let share = 0.1 * f64::from(weak_rows);
        let peak = largest(weak_rows as usize)?;
        let exact = composite_peak(share, [WEAK, 1.0], R_STAR);
        let rise = 0.375 * V_STAR * DT_STAR;
        // The weak zone slides only if the strong one slips later and at a larger friction.
        let tolerance = if exact > WEAK {
            (
                share * scales::damping(OMEGA_STAR) * V_STAR + rise,
                "drag f Ω V* of the sliding zone, and drive force of one step",
            )
        } else {
            (rise, "drive force of one step, when the weak zone slips")
        };
        let quantity = format!("largest μ*, f = 0.{weak_rows}, μ_1 = 0.5, μ_2 = 1");
        answers.push(Answer::new(quantity, [exact, peak], tolerance).at_most_below(rounding(exact)));
        shares.push(share);
        found.push(peak);
    }
    let fine: Vec<f64> = (0..=100).map(|k| 0.01 * f64::from(k)).collect();
    Ok(Chapter {
        title: "Composite surfaces",
        name: "composite",
        text: include_str!("text/composite.md"),
        answers,
        picture: Some((
            "Largest friction of a surface with two zones and uncoupled blocks, against the fraction of the weak zone.",
            Responses {
                x_title: "fraction of the weak zone".to_owned(),
                y_title: "largest friction \u{3bc}*".to_owned(),
                curves: vec![
                    Response::of_formula("exact", &fine, |share| composite_peak(share, [WEAK, 1.0], R_STAR)),
                    Response::of_formula("both thresholds at once", &fine, |share| {
                        WEAK * share + 1.0 - share
                    }),
                    Response::of_values("computed", &shares, &found),
                ],
                ..Responses::default()
            },
        )),
    })
}
