//! Share of the 95 % intervals of mu_k* that contain the mean of an infinite run of the same surface.
//!
//! ```console
//! $ cargo run --release -p slipfront-run --example uncertainty_coverage -- 1001 1334
//! ```
//!
//! Runs 25 x 25 blocks, once for each seed, in three regimes: the speed and damping of the paper, ten times
//! the damping, and a third of the speed. The mean over a window five times as long as the longest tested
//! one, which has a smaller error, represents the mean of an infinite run. Prints, for each length of the
//! windows, the number of windows that give a standard error, the root mean square of z (the deviation over
//! the standard error), and the number of intervals of +-1.96 standard errors that contain the mean.

use std::error::Error;

use rayon::prelude::*;
use slipfront::observe::{KineticHistory, KineticStart, Scheduled};
use slipfront::{Execution, Simulation, Stop};
use slipfront_case::case::Case;

/// Speed V* and damping Omega* of each regime.
const REGIMES: [[f64; 2]; 3] = [[0.03, 0.1], [0.03, 1.0], [0.01, 0.1]];

/// Lengths of windows times V*.
const WINDOWS: [f64; 3] = [40.0, 80.0, 400.0];

/// Deviation over standard error in each window but the last; none for windows that give no standard error.
fn deviations([v_star, omega_star]: [f64; 2], seed: u64) -> Result<Vec<Option<f64>>, String> {
    let text = format!(
        "slider.blocks = [25, 25]\nslider.omega_star = {omega_star}\ndrive.v_star = {v_star}\nfriction.seed = {seed}\n"
    );
    let case = Case::parse(&text, "case", "", &[]).map_err(|error| error.to_string())?;
    let dt = case.time_plan.dt_star;
    let mut simulation = Simulation::new(case.model, dt, None, Execution::default());
    // The window begins 2.5/V* after the peak, which comes before 2.7/V*.
    let ends = WINDOWS.map(|window| ((5.3 + window) / v_star / dt) as u64);
    let mut histories = ends.map(KineticHistory::new);
    let mut windows = Vec::new();
    for (k, end) in ends.into_iter().enumerate() {
        let mut observers: Vec<_> = histories[k..]
            .iter_mut()
            .map(|history| Scheduled::always(history))
            .collect();
        simulation
            .run(Stop::at_step(end), &mut observers)
            .map_err(|error| error.to_string())?;
        let from = KineticStart::Auto.time_star(&simulation.peak(), v_star);
        windows.extend(histories[k].kinetic(from, dt, v_star));
    }
    let mean = windows.pop().ok_or("no window")?.mu_star;
    let deviation =
        |window: slipfront::observe::Kinetic| Some((window.mu_star - mean) / window.uncertainty.ok()?);
    Ok(windows.into_iter().map(deviation).collect())
}

fn main() -> Result<(), Box<dyn Error>> {
    let seeds: Vec<u64> = std::env::args()
        .skip(1)
        .map(|word| word.parse())
        .collect::<Result<_, _>>()?;
    let [first, last] = seeds[..] else {
        return Err("usage: uncertainty_coverage FIRST_SEED LAST_SEED".into());
    };
    println!("   V*  Omega*  window V*   given %   rms z   held %");
    for regime in REGIMES {
        let all: Vec<Vec<Option<f64>>> = (first..=last)
            .into_par_iter()
            .map(|seed| deviations(regime, seed))
            .collect::<Result<_, _>>()?;
        for (k, window) in WINDOWS[..WINDOWS.len() - 1].iter().enumerate() {
            let z: Vec<f64> = all.iter().filter_map(|windows| windows[k]).collect();
            let share = |part: usize, whole: usize| 100.0 * part as f64 / whole as f64;
            let rms = (z.iter().map(|z| z * z).sum::<f64>() / z.len() as f64).sqrt();
            let held = z.iter().filter(|z| z.abs() < 1.96).count();
            let [v_star, omega_star] = regime;
            println!(
                "{v_star:5}  {omega_star:6}  {window:9}  {:8.1}  {rms:6.2}  {:7.1}",
                share(z.len(), all.len()),
                share(held, z.len())
            );
        }
    }
    Ok(())
}
