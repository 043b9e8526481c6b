//! Fig. 11: places where slip begins, and the spread of slip fronts over a rough surface.

use slipfront::Lattice;

use crate::drawing::{coefficient_maps, stress_maps};
use crate::error::PaperError;
use crate::figure_data::FigureData;
use crate::run::{FigureRun, blank_map, on_each};
use crate::runner::FigureRunner;
use crate::statistics::{largest, rises};
use slipfront_plot::FieldMap;

/// Minima of mu_si that are marked.
const MARKED: usize = 6;
/// Shares of the slider that have slipped in panels b-d.
const SHARES: [f64; 3] = [0.03, 0.2, 0.6];

pub(super) fn measure(runner: &mut FigureRunner, data: &mut FigureData) -> Result<(), PaperError> {
    let runs = runner.run(runner.case_on_surfaces("fig11")?)?;
    let [main, ..] = &runs[..] else { return Ok(()) };
    draw(runner, main, data)?;
    let shares: Vec<f64> = runs.iter().map(nucleations_at_minima).collect();
    data.values("nucleations_at_minima_percent", &shares);
    let places = on_each(&runs, FigureRun::first_block)?;
    let repeated = (0..places.len()).filter(|&k| places[..k].contains(&places[k]));
    data.value("repeated_first_places", repeated.count() as f64);
    // With the same random numbers and another spread, the first slip is expected at the same block, but at
    // another time.
    let mut times = Vec::new();
    let mut moved = 0;
    for sigma in ["0.025", "0.05", "0.1"] {
        let run = runner.run_one(runner.case("fig11", &[&format!("friction.sigma_static_star={sigma}")])?)?;
        moved += usize::from(run.first_block()? != places[0]);
        times.push(run.first_slip()?);
    }
    data.value("first_places_moved_by_sigma", moved as f64);
    data.value("largest_rise_of_first_slip", largest(rises(&times)));
    Ok(())
}

fn draw(runner: &FigureRunner, main: &FigureRun, data: &mut FigureData) -> Result<(), PaperError> {
    let (lattice, surface) = (&main.case.model.lattice, &main.case.model.surface);
    let mut minima = minima(lattice, &surface.mu_static);
    minima.truncate(MARKED);
    let marks = minima.iter().map(|&block| lattice.column_row(block).into());
    let marks: Vec<[usize; 2]> = marks.collect();
    let mean = main.case.scales.mu_static_mean;
    data.panel(
        "fig11a",
        "Local static friction coefficients. Circles mark the six lowest local minima.",
        coefficient_maps(
            "\u{3bc}_s/\u{27e8}\u{3bc}_s\u{27e9}",
            main.case.groups.sigma_static_star,
            vec![FieldMap {
                values: surface.mu_static.iter().map(|mu| (mu / mean) as f32).collect(),
                marks: marks.clone(),
                ..blank_map(&main.case, "a")
            }],
        ),
    );
    let run = runner.run_seen_at_shares(runner.case("fig11", &[])?, main, &SHARES)?;
    let mut maps = Vec::new();
    for ((_, frame), label) in run.record.frames.iter().zip(["b", "c", "d"]) {
        maps.push(FieldMap {
            marks: marks.clone(),
            ..run.stress_map(frame, label)?
        });
    }
    data.panel(
        "fig11bcd",
        "Contact stress after 3, 20 and 60 % of the blocks have slipped. Fronts start at the circles and merge.",
        stress_maps(maps, 3),
    );
    Ok(())
}

/// Blocks with a coefficient below those of all their neighbours, the lowest first.
pub(super) fn minima(lattice: &Lattice, mu_static: &[f64]) -> Vec<usize> {
    let mut minima: Vec<usize> = (0..mu_static.len())
        .filter(|&block| neighbours(lattice, block).all(|neighbour| mu_static[neighbour] > mu_static[block]))
        .collect();
    minima.sort_by(|&a, &b| mu_static[a].total_cmp(&mu_static[b]));
    minima
}

/// The blocks around a block, including those at its corners.
pub(super) fn neighbours(lattice: &Lattice, block: usize) -> impl Iterator<Item = usize> {
    let (i, j) = lattice.column_row(block);
    let around = (-1..=1).flat_map(|dx| (-1..=1).map(move |dy| [dx, dy]));
    around
        .filter(|&offset| offset != [0, 0])
        .filter_map(move |offset| lattice.neighbour(i, j, offset))
}

/// The blocks where slip begins: blocks that slip before the peak, ahead of all blocks around them.
pub(super) fn starts(run: &FigureRun) -> Vec<usize> {
    let lattice = &run.case.model.lattice;
    let times = &run.record.first_slip_time_star;
    let before_all = |block: usize| {
        neighbours(lattice, block).all(|other| times[other].is_nan() || times[other] > times[block])
    };
    (0..times.len())
        .filter(|&block| times[block] <= run.record.summary.onset_time_star && before_all(block))
        .collect()
}

/// Share of the places where slip begins that are local minima of mu_si, %.
fn nucleations_at_minima(run: &FigureRun) -> f64 {
    let minima = minima(&run.case.model.lattice, &run.case.model.surface.mu_static);
    let starts = starts(run);
    let at_minima = starts.iter().filter(|block| minima.contains(block)).count();
    100.0 * at_minima as f64 / starts.len() as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn minima_are_below_all_their_neighbours() {
        let lattice = Lattice::free(4, 3);
        let mu = [
            0.5, 1.0, 1.0, 0.9, //
            1.0, 1.0, 1.0, 1.0, //
            0.7, 1.0, 0.6, 0.8,
        ];
        assert_eq!(minima(&lattice, &mu), [0, 10, 8, 3]);
    }
}
