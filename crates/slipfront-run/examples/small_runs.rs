//! Time of a small run compared with that of its steps: from a case in memory to its numbers in one call,
//! without files.
//!
//! ```console
//! $ cargo run --release -p slipfront-run --example small_runs -- 50
//! ```
//!
//! 50 x 50 blocks with a texture on one thread, to the end of the first peak and along a path. Prints the
//! least time in ms of making the case, of its steps alone, of a run that keeps only its numbers, and of a
//! run that records everything for its files; the last two also over the time of the steps.

use std::error::Error;
use std::hint::black_box;
use std::sync::Arc;
use std::time::Instant;

use slipfront::{Execution, Simulation};
use slipfront_case::case::Case;
use slipfront_run::run_summary::run_summary;
use slipfront_run::running;

/// Number of repetitions of each part; the parts alternate.
const ROUNDS: usize = 15;

fn main() -> Result<(), Box<dyn Error>> {
    let size: usize = std::env::args().nth(1).ok_or("usage: small_runs SIZE")?.parse()?;
    for (name, time) in [
        ("to the end of the peak", "stop = 'after_onset'"),
        ("along a path", "duration_star = 150"),
    ] {
        let text = format!(
            "slider.blocks = [{size}, {size}]\ntexture = [{{ shape = 'cavity', coverage = 10 }}]\ntime = {{ {time} }}\n"
        );
        measure(name, &text)?;
    }
    Ok(())
}

fn measure(name: &str, text: &str) -> Result<(), Box<dyn Error>> {
    let make = || Case::parse(text, "case", "", &[]);
    let case = Arc::new(make()?);
    let steps = run_summary(&case)?.steps;
    let mut least = [f64::INFINITY; 4];
    for _ in 0..ROUNDS {
        let mut simulation = Simulation::new(
            Arc::clone(&case.model),
            case.time_plan.dt_star,
            None,
            Execution::default(),
        );
        let times = [
            timed(make),
            timed(|| (0..steps).for_each(|_| simulation.step())),
            timed(|| run_summary(&case)),
            timed(|| running::run(&case, 1)),
        ];
        for (least, time) in least.iter_mut().zip(times) {
            *least = least.min(time);
        }
    }
    let [made, stepped, numbers, whole] = least;
    println!(
        "{name}: case {made:.3} ms, {steps} steps {stepped:.3} ms, numbers {numbers:.3} ms ({:.3}), whole run {whole:.3} ms ({:.3})",
        numbers / stepped,
        whole / stepped
    );
    Ok(())
}

/// The time of this work in ms.
fn timed<T>(work: impl FnOnce() -> T) -> f64 {
    let began = Instant::now();
    black_box(work());
    began.elapsed().as_secs_f64() * 1e3
}
