//! Benchmarks of repeated slip: the stick-slip cycle of one block with rate-and-state friction and inertia,
//! and the catalogue of events of a train of blocks.

use slipfront_plot::Response;

use crate::chapter::Chapter;
use crate::error::FamilyError;
use crate::runs::Experiment;

/// Period, largest speed, and largest and least force of a stick-slip cycle.
type Cycle = [f64; 4];

/// The last cycle of a block with steps of `dt_star`, when the cycles repeat.
fn cycle(dt_star: f64) -> Result<Cycle, FamilyError> {
    const STIFFNESS: f64 = 0.1;
    const V_STAR: f64 = 1e-3;
    const END: f64 = 26_000.0;
    let text = format!(
        "[slider]\nblocks = [1, 1]\nomega_star = 0\n[drive]\nv_star = {V_STAR}\nstiffness_star = {STIFFNESS}\n\
         [friction]\nlaw = \"rate_and_state\"\nmu_static = 1\na = 0.01\nb = 0.02\nd_c_star = 0.02\nv_0_star = 1e-3\nmu_0 = 0.6\n\
         theta_0_star = 19.8\n[time]\nstep = {dt_star}\nduration_star = {END}"
    );
    let (experiment, last_step) = Experiment::of_case("recurrence", &text)?;
    let mut simulation = experiment.begin();
    /// Speed that defines the time of a slip: fast compared with the drive, slow compared with the slip.
    const TIMED: f64 = 0.01;
    let (mut times, mut before) = (Vec::new(), 0.0);
    const NONE: [f64; 3] = [0.0, 0.0, f64::INFINITY];
    let (mut whole, mut so_far) = ([f64::NAN; 3], NONE);
    for step in 0..last_step {
        let now = simulation.snapshot();
        let speed = now.block(0).velocity[0];
        if before < TIMED && speed >= TIMED {
            (whole, so_far) = (so_far, NONE);
            times.push((step as f64 + (TIMED - before) / (speed - before)) * dt_star);
        }
        before = speed;
        let [fastest, largest, least] = so_far;
        let force = now.point.mu_star;
        so_far = [fastest.max(speed), largest.max(force), least.min(force)];
        simulation.step();
    }
    let period = match times[..] {
        [.., one, next] => next - one,
        _ => f64::NAN,
    };
    let [fastest, largest, least] = whole;
    Ok([period, fastest, largest, least])
}

/// Reference cycle: integration in displacement and the logarithms of speed and state by the Radau method
/// with a relative error of 1e-9.
const RADAU: Cycle = [2481.2248, 0.368_505, 0.670_089_9, 0.427_003_4];

pub(crate) fn compare_cycle(chapter: &mut Chapter) -> Result<(), FamilyError> {
    let (coarse, fine) = rayon::join(|| cycle(0.1), || cycle(0.05));
    let (coarse, fine) = (coarse?, fine?);
    let names = ["period", "largest speed", "largest force", "smallest force"];
    for (k, name) in names.into_iter().enumerate() {
        chapter.add(
            format!("{name}, extrapolated from Δt* = 0.1 and 0.05"),
            [RADAU[k], 2.0 * fine[k] - coarse[k]],
            5e-4 * RADAU[k],
            "the scheme is first-order accurate, so the extrapolation has a second-order error",
        );
    }
    Ok(())
}

/// Range of the logarithm of the moment over F/k_p with the bins for the exponent.
const WINDOW: [f64; 2] = [-7.0, -2.0];
const BINS: usize = 10;

/// Exponent of the decrease of the number of events with the moment, by least squares over bins of the
/// logarithm of the moment; and the logarithms of moment and number.
fn exponent(moments: &[f64]) -> (f64, [Vec<f64>; 2]) {
    let [low, high] = WINDOW;
    let width = (high - low) / BINS as f64;
    let mut counts = [0.0; BINS];
    for ln in moments.iter().map(|moment| libm::log(*moment)) {
        if (low..high).contains(&ln) {
            counts[((ln - low) / width) as usize] += 1.0;
        }
    }
    let x: Vec<f64> = (0..BINS).map(|k| low + (k as f64 + 0.5) * width).collect();
    let y: Vec<f64> = counts.iter().map(|&count| libm::log(count)).collect();
    let mean = |values: &[f64]| values.iter().sum::<f64>() / BINS as f64;
    let (mx, my) = (mean(&x), mean(&y));
    let covariance: f64 = x.iter().zip(&y).map(|(x, y)| (x - mx) * (y - my)).sum();
    let variance: f64 = x.iter().map(|x| (x - mx) * (x - mx)).sum();
    (-covariance / variance, [x, counts.to_vec()])
}

pub(crate) fn compare_catalogue(chapter: &mut Chapter) -> Result<(), FamilyError> {
    let text = include_str!("../cases/burridge_knopoff.toml");
    let text = text.replace("duration_star = 10000", "duration_star = 20000");
    let (experiment, last_step) = Experiment::of_case("catalogue", &text)?;
    let events = experiment.events("catalogue", last_step)?;
    // The first fifth of the events is left out, because the train starts from rest. F/k_p is F/(k_s*).
    let later = &events[events.len() / 5..];
    let ended = later
        .iter()
        .filter(|event| event.after.is_some() && event.moment > 0.0);
    let moments: Vec<f64> = ended.map(|event| event.moment * 0.0075).collect();
    let (found, [x, counts]) = exponent(&moments);
    chapter.add(
        format!("exponent of {} events, -7 < ln M < -2", moments.len()),
        [1.0, found],
        0.15,
        "scatter between windows of a catalogue of 26 668 events",
    );
    let moment: Vec<f64> = x.iter().map(|&x| libm::exp(x)).collect();
    let line = |m: f64| counts[BINS / 2] * moment[BINS / 2] / m;
    let picture = chapter.draw(
        "Number of events in bins of ln M of width 0.5, and a line proportional to 1/M.",
        ["moment M", "events"],
        vec![
            Response::of_values("events", &moment, &counts),
            Response::of_formula("1/M", &moment, line),
        ],
    );
    (picture.log_x, picture.log_y) = (true, true);
    Ok(())
}
