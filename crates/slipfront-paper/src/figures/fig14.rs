//! Fig. 14: slip fronts around a circular cavity.

use crate::drawing::stress_maps;
use crate::error::PaperError;
use crate::figure_data::FigureData;
use crate::figures::fig11::{minima, neighbours};
use crate::run::FigureRun;
use crate::runner::FigureRunner;
use crate::statistics::{mean, range};

/// Shares of the blocks in contact that have slipped, from the left to the right of a panel.
const SHARES: [f64; 5] = [0.02, 0.1, 0.3, 0.5, 0.8];

pub(super) fn measure(runner: &mut FigureRunner, data: &mut FigureData) -> Result<(), PaperError> {
    let sweep = runner.plan("fig14")?;
    let names = sweep.names(0);
    let mut maps = Vec::new();
    for (k, name) in names.iter().enumerate() {
        let run = runner.run_one(sweep.case(&[k], 0)?)?;
        let again = runner.run_seen_at_shares(sweep.case(&[k], 0)?, &run, &SHARES)?;
        for ((_, frame), share) in again.record.frames.iter().zip(SHARES) {
            let slipped = 100.0 * share;
            maps.push(again.stress_map(frame, &format!("{name}: {slipped:.0} % slipped"))?);
        }
        match name.as_str() {
            "a" => {
                data.value("nearness_of_first_slips", nearness(&run, 0.05));
                data.value("early_minima_percent", early_minima(&run));
            }
            "b" => {
                data.value("first_slips_at_the_rim_percent", first_at_rim(&run));
                data.value("asymmetry_percent", asymmetry(&run));
                data.value("elongation", elongation(&run, 0.3)?);
            }
            _ => data.value("elongation_at_45_degrees", elongation(&run, 0.3)?),
        }
    }
    data.panel(
        "fig14",
        "Contact stress around a circular cavity with 5 % coverage while slip spreads. a: rough surface; b: \
         smooth surface, driven to the right; c: smooth surface, driven to the upper right.",
        stress_maps(maps, SHARES.len()),
    );
    Ok(())
}

/// Distance of a block from the middle of the slider, along the drive and across it.
fn place(run: &FigureRun, block: usize) -> [f64; 2] {
    let (lattice, [dx, dy]) = (&run.case.model.lattice, run.case.model.drive.direction);
    let (i, j) = lattice.column_row(block);
    let x = i as f64 + 0.5 - 0.5 * lattice.nx as f64;
    let y = j as f64 + 0.5 - 0.5 * lattice.ny as f64;
    [x * dx + y * dy, y * dx - x * dy]
}

/// Blocks in contact that slip before this share has slipped.
fn slipped(run: &FigureRun, share: f64) -> Result<Vec<usize>, PaperError> {
    let until = run.time_of_share(share)?;
    let times = &run.record.first_slip_time_star;
    Ok((0..times.len()).filter(|&block| times[block] <= until).collect())
}

/// Mean distance from the rim of the cavity of the first blocks to slip, over that of all blocks in contact.
fn nearness(run: &FigureRun, share: f64) -> f64 {
    let textured = &run.case.model.surface.textured;
    let cavity = textured.iter().filter(|&&textured| textured).count();
    let radius = (cavity as f64 / std::f64::consts::PI).sqrt();
    let distance = |block: usize| {
        let [x, y] = place(run, block);
        (libm::hypot(x, y) - radius).max(0.0)
    };
    let mean_distance = |blocks: Vec<usize>| mean(&blocks.into_iter().map(distance).collect::<Vec<f64>>());
    let all = (0..textured.len()).filter(|&block| !textured[block]).collect();
    mean_distance(slipped(run, share).unwrap_or_default()) / mean_distance(all)
}

/// Share of the local minima of mu_si that slip earlier than the mean of their neighbours, %. It is one half
/// if minima have no effect on the fronts.
fn early_minima(run: &FigureRun) -> f64 {
    let model = &run.case.model;
    let times = &run.record.first_slip_time_star;
    let minima = minima(&model.lattice, &model.surface.mu_static);
    let is_early = |&&block: &&usize| {
        let around: Vec<f64> = neighbours(&model.lattice, block)
            .map(|other| times[other])
            .collect();
        times[block] < mean(&around)
    };
    100.0 * minima.iter().filter(is_early).count() as f64 / minima.len() as f64
}

/// Share of the first slipping blocks that touch the cavity, %.
fn first_at_rim(run: &FigureRun) -> f64 {
    let (lattice, textured) = (&run.case.model.lattice, &run.case.model.surface.textured);
    let times = &run.record.first_slip_time_star;
    let earliest = run.record.summary.first_slip_time_star;
    let first = (0..times.len()).filter(|&block| Some(times[block]) == earliest);
    let first: Vec<usize> = first.collect();
    let touches = |&&block: &&usize| neighbours(lattice, block).any(|other| textured[other]);
    100.0 * first.iter().filter(touches).count() as f64 / first.len() as f64
}

/// Difference of the times of first slip from those of the mirror image across the drive, over their range,
/// %.
fn asymmetry(run: &FigureRun) -> f64 {
    let lattice = &run.case.model.lattice;
    let times = &run.record.first_slip_time_star;
    let mirrored = |block: usize| {
        let (i, j) = lattice.column_row(block);
        times[lattice.block(i, lattice.ny - 1 - j)]
    };
    let differences: Vec<f64> = (0..times.len())
        .map(|block| (times[block] - mirrored(block)).abs())
        .filter(|difference| !difference.is_nan())
        .collect();
    100.0 * mean(&differences) / range(&run.slip_times())
}

/// Extent of the slipped area along the drive over that across it, as root mean square distances from the
/// cavity.
fn elongation(run: &FigureRun, share: f64) -> Result<f64, PaperError> {
    let (mut along, mut across) = (0.0, 0.0);
    for block in slipped(run, share)? {
        let [x, y] = place(run, block);
        along += x * x;
        across += y * y;
    }
    Ok((along / across).sqrt())
}
