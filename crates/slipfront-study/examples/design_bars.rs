//! Verdicts of searches that begin with different numbers.
//!
//! ```console
//! $ cargo run --release -p slipfront-study --example design_bars -- 50 0.03 0 10000 least 1 2 3
//! ```
//!
//! Arguments: blocks along a side, V*, sigma_s*, runs of a search, the wish, and start numbers. The wish is `least` static friction, `worst` for
//! the least over V*/3, V* and 3 V* by the worst of them, or a value of mu_s* such as `0.7`. Textures cover at most 10 %, with features and gaps
//! of at least 3 blocks. Prints a line for every start number: what the design gives on fresh surfaces with the half width of its 95 % interval
//! (the reduction in %, or mu_s* and its distance from the value in %), by how many points it is better than the groove across and than the best
//! named pattern (the lower ends of the intervals), and the optimism of the search in points.

use std::collections::HashMap;
use std::error::Error;
use std::sync::atomic::AtomicBool;

use slipfront_case::case::Case;
use slipfront_study::design::{Bounds, Design, Limits, Mean, Quantity, Verdict, Wish};

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [size, v_star, sigma, runs, wish, starts @ ..] = arguments.as_slice() else {
        return Err("usage: design_bars SIZE V_STAR SIGMA RUNS least|worst|VALUE START...".into());
    };
    let case = |factor: f64| {
        let text = format!(
            "slider.blocks = [{size}, {size}]\ndrive.v_star = {}\nfriction.sigma_static_star = {sigma}",
            v_star.parse::<f64>().unwrap_or(f64::NAN) * factor
        );
        Case::parse(&text, "bars", "", &[])
    };
    let is_worst = wish == "worst";
    let factors: &[f64] = if is_worst { &[1.0 / 3.0, 1.0, 3.0] } else { &[1.0] };
    let cases: Vec<Case> = factors
        .iter()
        .map(|&factor| case(factor))
        .collect::<Result<_, _>>()?;
    let wanted = wish.parse::<f64>().ok();
    let limits = Limits {
        coverage: [0.0, 10.0],
        feature: 3,
        gap: 3,
        ..Limits::default()
    };
    for start in starts {
        let wish = match wanted {
            Some(value) => Wish::Value(Quantity::StaticFriction, value),
            None => Wish::Least(Quantity::StaticFriction),
        };
        let design = Design::new(&cases, wish, is_worst, limits.clone(), start.parse()?)?;
        let bounds = Bounds {
            runs: runs.parse()?,
            share_of_time: &|| 0.0,
            stop: &AtomicBool::new(false),
        };
        let outcome = design.run(&bounds, &mut HashMap::new(), &mut |_| Ok(()), &mut |_| {})?;
        println!("start {start}: {}", told(&outcome.verdict, wanted));
    }
    Ok(())
}

fn told(verdict: &Verdict, wanted: Option<f64>) -> String {
    let lower = |mean: Mean| 100.0 * (mean.mean - mean.half_width.unwrap_or(0.0));
    let better = verdict.others.iter().filter_map(|other| {
        let better = other.design_is_better_by?;
        Some(format!("{} by at least {:.2}", other.name, lower(better)))
    });
    let better: Vec<String> = better.collect();
    let design = &verdict.design;
    let given = match wanted {
        Some(wanted) => {
            let found = design.cases[0].static_friction_star;
            let half = found.half_width.unwrap_or(0.0);
            let distance = 100.0 * (found.mean / wanted - 1.0);
            format!(
                "mu_s* {:.5} +- {half:.5}, {distance:+.3} % from {wanted}",
                found.mean
            )
        }
        None => format!(
            "{:.2} +- {:.2} %",
            100.0 * (1.0 - design.loss),
            100.0 * design.loss_half_width.unwrap_or(0.0)
        ),
    };
    format!(
        "{given}; covers {:.2} %{}; better than {}; optimism {:.2}",
        design.coverage_percent,
        if verdict.is_named { ", a named pattern" } else { "" },
        better.join(", than "),
        100.0 * verdict.optimism
    )
}
