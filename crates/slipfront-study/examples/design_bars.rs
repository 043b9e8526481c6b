//! Verdicts of searches that begin with different numbers.
//!
//! ```console
//! $ cargo run --release -p slipfront-study --example design_bars -- 50 0.03 0 10000 1 2 3
//! ```
//!
//! Arguments: blocks along a side, V*, sigma_s*, runs of a search, and start numbers. Of the texture of at most 10 % with features and gaps
//! of at least 3 blocks that gives the least static friction, prints for every start number the reduction on fresh surfaces, its
//! interval, the difference to the best named pattern, and seconds.

use std::collections::HashMap;
use std::error::Error;
use std::path::Path;
use std::sync::atomic::AtomicBool;
use std::time::Instant;

use slipfront_case::case::Case;
use slipfront_study::design::{Bounds, Design, Limits, Quantity, Wish};

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [size, v_star, sigma, runs, starts @ ..] = arguments.as_slice() else {
        return Err("usage: design_bars SIZE V_STAR SIGMA RUNS START...".into());
    };
    let text = format!(
        "slider.blocks = [{size}, {size}]\ndrive.v_star = {v_star}\nfriction.sigma_static_star = {sigma}"
    );
    let case = Case::parse(&text, "bars", "", &[])?;
    let limits = Limits {
        coverage: [0.0, 10.0],
        feature: 3,
        gap: 3,
        mirror: [false; 2],
        copies: [1, 1],
        forbidden: None,
        max_features: None,
    };
    for start in starts {
        let wish = Wish::Least(Quantity::StaticFriction);
        let design = Design::new(
            &[(&case, Path::new(""))],
            wish,
            false,
            limits.clone(),
            start.parse()?,
        )?;
        let bounds = Bounds {
            runs: runs.parse()?,
            share_of_time: &|| 0.0,
            stop: &AtomicBool::new(false),
        };
        let began = Instant::now();
        let mut searched = 0.0;
        let outcome = design.run(&bounds, &mut HashMap::new(), &mut |_| Ok(()), &mut |progress| {
            searched = began.elapsed().as_secs_f64();
            if std::env::var_os("VERBOSE").is_some() {
                eprintln!("{progress:?}");
            }
        })?;
        let verdict = &outcome.verdict;
        println!(
            "start {start}: {:.2} % reduction, {:?}, named {}, {searched:.1} s of search, {:.1} s",
            100.0 * (1.0 - verdict.design.loss),
            verdict.design,
            verdict.is_named,
            began.elapsed().as_secs_f64()
        );
        for other in &verdict.others {
            println!(
                "   {}: {:.2} %, {:?}",
                other.name,
                100.0 * (1.0 - other.loss),
                other.design_is_better_by
            );
        }
        println!("   optimism {:.2}", 100.0 * verdict.optimism);
        let columns: usize = size.parse()?;
        for row in outcome.texture.chunks_exact(columns).rev() {
            println!(
                "   {}",
                row.iter()
                    .map(|&is_in| if is_in { '#' } else { '.' })
                    .collect::<String>()
            );
        }
    }
    Ok(())
}
