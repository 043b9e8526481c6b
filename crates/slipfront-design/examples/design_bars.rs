//! Verdicts of searches with different start numbers.
//!
//! ```console
//! $ cargo run --release -p slipfront-design --example design_bars -- 50 0.03 0 10000 least 1 2 3
//! ```
//!
//! Arguments: blocks along a side, V*, sigma_s*, runs of a search, the wish, and start numbers. The wish is
//! `least` static friction; `worst` for the least static friction in the worst of V*/3, V* and 3 V*; a value
//! of mu_s* such as `0.7`; or `curve`, the curve of an off-centre cavity on its own surface. Textures cover
//! at most 10 %, with features and gaps of at least 3 blocks.
//!
//! Prints a line for every start number:
//!
//! - the result of the design on fresh surfaces with the half width of its 95 % interval: the reduction in %;
//!   mu_s* and its distance from the value in %; or the root mean square difference of mu* from the curve,
//!   and its ratio to that of the cavity itself on 16 surfaces;
//! - by how many points the design is better than the groove across and than the best named pattern (lower
//!   ends of the intervals);
//! - for several cases, the reduction in each of them by the design and by the groove;
//! - the optimism of the search in points.

use std::collections::HashMap;
use std::error::Error;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use slipfront_case::case::Case;
use slipfront_case::texture_file::textured_blocks;
use slipfront_design::{
    Bounds, Design, FrictionUnit, Limits, Mean, OnFresh, Quantity, Target, Verdict, Wish,
};
use slipfront_run::running;

/// Keys that are added to the case that provides the curve.
const CAVITY: &str = "friction.seed = 1000\noutput.series = 5\n\
    texture = [{ shape = 'cavity', coverage = 8, center = ['17 um', '30 um'] }]";

/// Surfaces on which the cavity itself is compared with the curve.
const SURFACES: u64 = 16;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [size, v_star, sigma, runs, wish, starts @ ..] = arguments.as_slice() else {
        return Err("usage: design_bars SIZE V_STAR SIGMA RUNS least|worst|VALUE START...".into());
    };
    let v_star: f64 = v_star.parse()?;
    let case = |factor: f64, more: &str| {
        let text = format!(
            "slider.blocks = [{size}, {size}]\ndrive.v_star = {}\nfriction.sigma_static_star = {sigma}\n{more}",
            v_star * factor
        );
        Case::parse(&text, "bars", "", &[])
    };
    let is_worst = wish == "worst";
    let factors: &[f64] = if is_worst { &[1.0 / 3.0, 1.0, 3.0] } else { &[1.0] };
    let cases: Vec<Case> = factors
        .iter()
        .map(|&factor| case(factor, ""))
        .collect::<Result<_, _>>()?;
    let wanted = match wish.as_str() {
        "least" | "worst" => Wish::Least(Quantity::StaticFriction),
        "curve" => curve(case(1.0, CAVITY)?, 3.0 / v_star)?,
        value => Wish::Value(Target {
            quantity: Quantity::StaticFriction,
            star: value.parse()?,
            tolerance_star: None,
            unit: FrictionUnit::share(),
        }),
    };
    let cavity = textured_blocks(&case(1.0, CAVITY)?);
    let limits = Limits {
        coverage: [0.0, 10.0],
        feature: 3.0,
        gap: 3,
        ..Limits::default()
    };
    for start in starts {
        let wished: Vec<(&Case, Wish)> = cases.iter().map(|case| (case, wanted.clone())).collect();
        let design = Design::new(&wished, is_worst, limits.clone(), start.parse()?)?;
        let stop = AtomicBool::new(false);
        let bounds = Bounds {
            runs: runs.parse()?,
            share_of_time: &|| 0.0,
            stop: &stop,
            cut: None,
        };
        let outcome = design.run(&bounds, &mut HashMap::new(), &mut |_| Ok(()), &mut |_| {})?;
        let of_cavity = design.losses(vec![cavity.clone()], SURFACES, false, &mut HashMap::new(), &stop)?;
        let of_cavity = of_cavity.into_iter().next().ok_or("nothing was run")??;
        println!("start {start}: {}", told(&outcome.verdict, &wanted, of_cavity));
    }
    Ok(())
}

/// The wish for the curve of a case up to a time.
fn curve(case: Case, end: f64) -> Result<Wish, Box<dyn Error>> {
    let record = running::run(&Arc::new(case), 1)?;
    let points = record
        .rows
        .iter()
        .map(|row| [row.drive_time_star, row.point.mu_star]);
    Ok(Wish::Curve(points.filter(|[time, _]| *time <= end).collect()))
}

fn told(verdict: &Verdict, wanted: &Wish, of_cavity: f64) -> String {
    let lower = |mean: Mean| 100.0 * (mean.mean - mean.half_width.unwrap_or(0.0));
    let better = verdict.others.iter().filter_map(|other| {
        let better = other.design_is_better_by?;
        Some(format!("{} by at least {:.2}", other.name, lower(better)))
    });
    let better: Vec<String> = better.collect();
    let design = &verdict.design;
    let given = match wanted {
        Wish::Value(Target { star: wanted, .. }) => {
            let found = design.cases[0].static_friction_star;
            let half = found.half_width.unwrap_or(0.0);
            let distance = 100.0 * (found.mean / wanted - 1.0);
            format!(
                "mu_s* {:.5} +- {half:.5}, {distance:+.3} % from {wanted}",
                found.mean
            )
        }
        Wish::Curve(_) => format!(
            "{:.5} from the curve, {:.3} times the {of_cavity:.5} of the cavity",
            design.loss,
            design.loss / of_cavity
        ),
        _ => format!(
            "{:.2} +- {:.2} %{}",
            100.0 * (1.0 - design.loss),
            100.0 * design.loss_half_width.unwrap_or(0.0),
            in_each_case(verdict)
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

/// The reduction by the design and by the groove in each of several cases.
fn in_each_case(verdict: &Verdict) -> String {
    let bare = &verdict.others[0];
    let groove = verdict.others.iter().find(|other| other.name == "groove across");
    let reduction = |found: &OnFresh, case: usize| {
        let [found, bare] = [found, bare].map(|found| found.cases[case].static_friction_star.mean);
        100.0 * (1.0 - found / bare)
    };
    let pair = |case: usize| {
        let groove = groove.map_or(f64::NAN, |groove| reduction(groove, case));
        format!("{:.2} beside {groove:.2}", reduction(&verdict.design, case))
    };
    let n_cases = bare.cases.len();
    if n_cases == 1 {
        return String::new();
    }
    let pairs: Vec<String> = (0..n_cases).map(pair).collect();
    format!(" ({})", pairs.join(", "))
}
