//! Springs in contact.

use slipfront::communicator::Alone;
use slipfront::exact_solutions::{chain_slip_force, static_over_kinetic_of_springs};
use slipfront::lattice::{K_DRIVE, K_STRAIGHT};
use slipfront::observe::CurveRow;
use slipfront::surface::{Coefficients, Load};
use slipfront::{AfterBreak, ContactSprings, Drive, Lattice, Model, Slider, Surface, scales};

use crate::chapter::Chapter;
use crate::error::FamilyError;
use crate::fronts::front_speed_in_a_chain;
use crate::runs::Experiment;

/// Stiffness of the springs in contact over that of the drive.
const SOFTNESS: f64 = 1e-3;
/// V* of the rigid slider.
const V_STAR: f64 = 2.5;
/// Omega* of the rigid slider.
const OMEGA_STAR: f64 = 0.5;
/// Time step of the rigid slider, t*.
const DT_STAR: f64 = 0.8;
/// V* of the drive that pulls a chain.
const CHAIN_V_STAR: f64 = 2e-4;
/// Omega of the blocks of the chain.
const CHAIN_DAMPING: f64 = 0.5;
/// Time step of the chain, t*.
const CHAIN_DT_STAR: f64 = 0.2;

/// Ratio of the first peak to the mean during sliding, for a rigid slider with thresholds spread from 1 - w
/// to 1 + w.
fn ratio(w: f64, redraw: Option<u64>) -> Result<f64, FamilyError> {
    let lattice = Lattice::free(20, 20);
    // 2401 and 400 are coprime, so each of the 400 thresholds occurs once.
    let threshold = |b: usize| 1.0 + w * ((2 * ((2401 * b + 3) % 400) + 1) as f64 / 400.0 - 1.0);
    let given = Coefficients::given((0..400).map(threshold).collect(), vec![0.0; 400]);
    let surface = Surface::new(given, vec![false; 400], Load::Redistributed, 1.0)?;
    let stiffness = SOFTNESS * K_DRIVE;
    let damping = scales::damping(OMEGA_STAR);
    let law = ContactSprings {
        stiffness,
        after_break: AfterBreak::FormsAgain { redraw },
    };
    let model = Model::new(lattice, surface, Drive::along_x(V_STAR), damping, 0.0, law);
    let experiment = Experiment::at_rest(model, DT_STAR);
    let length = (1.0 / stiffness / V_STAR / DT_STAR) as usize;
    let run = experiment.run("springs in contact", 50 * length as u64)?;
    let force = |row: &CurveRow| row.point.mu_star - damping * V_STAR;
    // The slider begins at rest, and reaches its speed long before the first spring breaks.
    let peak = run.rows[length / 2..].iter().map(force).fold(0.0, f64::max);
    let sliding = &run.rows[10 * length..];
    Ok(peak / (sliding.iter().map(force).sum::<f64>() / sliding.len() as f64))
}

/// Largest allowed distance of the ratio from the exact one. For the peak: the drive force lags behind the
/// rise of friction by `Omega/k_s` and is read once per step, and the weakest of the 400 springs is `w/400`
/// inside their range. For the mean: after ten cycles, the phases of springs that keep their thresholds are
/// spread over `20 w` cycles. If all springs were at the same phase, an incomplete last cycle would change
/// the mean of 40 sawteeth by 1/(4 40); the spread reduces this to an eighth, divided by `20 w`. Thresholds
/// that are drawn again scatter; three standard deviations of 16000 of them are allowed.
fn tolerance(w: f64, exact: f64, redrawn: bool) -> (f64, &'static str) {
    let rise = SOFTNESS * V_STAR;
    let peak = rise * (scales::damping(OMEGA_STAR) + K_DRIVE * DT_STAR) + w / 400.0;
    let cut = 1.0 / (160.0 * 8.0 * 20.0 * w);
    let scatter = 3.0 * w / (3.0_f64 * 16000.0).sqrt();
    if redrawn {
        (
            exact * (peak / (1.0 - w) + cut + scatter),
            "the drive force lags by Ω/k_s and is sampled once per step; mean over 40 cycles, the last incomplete; scatter of thresholds",
        )
    } else {
        (
            exact * (peak / (1.0 - w) + cut),
            "the drive force lags by Ω/k_s and is sampled once per step; mean over 40 cycles, the last incomplete",
        )
    }
}

/// Drive force at which the first spring of a chain breaks; NaN if another one breaks. The chain is driven at
/// its first block.
fn pull(n: usize, stiffness: f64) -> f64 {
    let lattice = Lattice::free(n, 1);
    let law = ContactSprings {
        stiffness,
        after_break: AfterBreak::FormsAgain { redraw: None },
    };
    let surface = Surface::uniform(&lattice, 1.0, 0.0);
    let mut slider = Slider::default();
    slider.attach(n, |b| b == 0, &Alone);
    let drive = Drive::along_x(CHAIN_V_STAR);
    let model = Model::new(lattice, surface, drive, CHAIN_DAMPING, 0.0, law).with_slider(slider);
    let mut simulation = Experiment::at_rest(model, CHAIN_DT_STAR).begin();
    while simulation.snapshot().totals.n_slipping == 0 {
        simulation.step();
    }
    let now = simulation.snapshot();
    let times = now.first_slip_time_star();
    if (0..n).all(|b| times[b].is_nan() == (b > 0)) {
        now.block(0).force_drive[0]
    } else {
        f64::NAN
    }
}

/// Time step of the chain in which a front runs, t*.
const FRONT_DT_STAR: f64 = 5e-3;

/// Fronts in a chain with contacts that yield and slide: stiffness of the contacts over that of the chain,
/// prestress, and speed of the front over that of sound. Another program has computed the speeds by
/// integrating the equations of motion with a quarter of this time step.
const FRONTS: [[f64; 3]; 7] = [
    [16.0, 0.7, 1.28479],
    [4.0, 0.4, 1.04359],
    [4.0, 0.7, 1.1671],
    [4.0, 0.9, 1.42046],
    [1.0, 0.7, 1.09072],
    [1.0, 0.9, 1.23405],
    [0.25, 0.9, 1.12465],
];

pub(crate) fn compare(chapter: &mut Chapter) -> Result<(), FamilyError> {
    for [softness, prestress, expected] in FRONTS {
        let law = ContactSprings {
            stiffness: softness * K_STRAIGHT,
            after_break: AfterBreak::Slides,
        };
        let found = front_speed_in_a_chain(0.0, prestress, law.into(), FRONT_DT_STAR)?;
        chapter.add(
            format!("front speed v/c, k_t = {softness} K, prestress {prestress}"),
            [expected, found],
            0.5 * K_STRAIGHT.sqrt() * FRONT_DT_STAR * expected * expected,
            "springs break at whole steps, up to half a step from the interval l/v",
        );
    }
    for (redraw, which) in [(None, "kept"), (Some(5), "redrawn")] {
        for w in [0.05, 0.1, 0.2] {
            let exact = static_over_kinetic_of_springs(w, redraw.is_some());
            let (tolerance, reason) = tolerance(w, exact, redraw.is_some());
            chapter.add(
                format!("ratio of static to kinetic friction of a rigid slider, w = {w}, thresholds {which}"),
                [exact, ratio(w, redraw)?],
                tolerance,
                reason,
            );
        }
    }
    for n in [1, 2, 5, 20] {
        let exact = chain_slip_force(n, K_STRAIGHT, 0.1);
        chapter.add(
            format!("F_T at the first break in a chain of {n} contact springs, k_t = 0.1"),
            [exact, pull(n, 0.1)],
            CHAIN_V_STAR * (CHAIN_DAMPING * exact + K_DRIVE * CHAIN_DT_STAR),
            "drag Ω V* Σu_i/u_1, and drive force of one step",
        );
    }
    Ok(())
}
