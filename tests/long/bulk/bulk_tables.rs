//! Reductions of static friction by dimples on a bulk body: on a half-space, from a quasi-static solver, and
//! and as the product finds them on sheets and on the body.
//!
//! ```console
//! $ cargo run --release -p slipfront-long-tests --example bulk_tables
//! ```
//!
//! Dimples are half a pitch wide, R* = 0.5. Prints reductions in % over `w p (1 - nu)/G`, with the weakening
//! `w = (mu_s - mu_k) p_c/D_c` and the pressure p_c of the blocks in contact: by a square array with 16
//! blocks per pitch, where a body is 5 pitches high; then by a band of two columns across the drive, a patch
//! of 2 x 2 and 16 dimples at random places on 4 x 4 pitches.

#![allow(clippy::unwrap_used)] // A run that fails ends the program.

#[allow(dead_code)] // Each program uses its own part of it.
mod dimples;
mod fourier;
mod half_space;

use std::f64::consts::PI;

use crate::dimples::{Dimples, Sharing, patterns};

const PITCH: usize = 16;
const THIRD: f64 = 1.0 / 3.0;

fn main() {
    let weakening = [1.0, 2.0, 5.0, 10.0, 20.0];
    let array = Dimples::array(PITCH);
    let finer = Dimples::array(2 * PITCH);
    let row = |name: &str, reduction: &dyn Fn(f64) -> f64| {
        let figures = weakening.map(|w| format!("{:8.2}", reduction(w)));
        println!("{name:44}{}", figures.concat());
    };
    println!(
        "{:44}{}",
        "w p (1 - nu)/G",
        weakening.map(|w| format!("{w:8}")).concat()
    );
    let equal = Sharing::Equal;
    row("half-space, nu = 1/3", &|w| array.on_half_space(THIRD, w, equal));
    row("half-space, nu = 1/3, 32 blocks a pitch", &|w| {
        finer.on_half_space(THIRD, w, equal)
    });
    // The mount G/H, and the mount that fits best, in G over the pitch.
    for (name, thickness, mount) in [
        ("sheet, h = 5 p", 5.0, 0.2),
        ("sheet, h = 0.5 p", 0.5, 0.2),
        ("sheet, h = 0.1 p", 0.1, 0.2),
        ("sheet that fits, h = 0.04 p, K = 4.7 G/p", 0.125 / PI, 1.5 * PI),
    ] {
        row(name, &|w| array.on_sheet(w, thickness, mount));
    }
    row("bulk body, nu = 1/3", &|w| array.on_body(THIRD, w, equal, &[]));
    row("half-space, nu = 1/4", &|w| array.on_half_space(0.25, w, equal));
    row("bulk body, nu = 1/4", &|w| array.on_body(0.25, w, equal, &[]));

    println!(
        "\n{:36}{:>24}{:>12}{:>8}",
        "4 x 4 pitches, nu = 1/3", "w p (1 - nu)/G", "half-space", "found"
    );
    for (name, dimples) in ["band", "patch", "random"].into_iter().zip(patterns(PITCH)) {
        for (sharing, how) in [
            (Sharing::Equal, "load shared by all"),
            (Sharing::Near, "load shared within a pitch"),
        ] {
            for w in [2.0, 10.0] {
                let body = dimples.on_half_space(THIRD, w, sharing);
                let found = dimples.on_body(THIRD, w, sharing, &[]);
                println!("{name:8}{how:28}{w:24}{body:12.2}{found:8.2}");
            }
        }
    }
}
