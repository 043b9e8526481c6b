//! Columns of a checkpoint, read from and written to the arrays of a band.

use std::ops::Range;

use slipfront_kernel::{Band, LANES, Layout, NEVER, TILE};

use crate::checkpoint::BlockColumn;

/// Sets the values of a column of a checkpoint from block `first` on, for the blocks of the band.
pub(super) fn set_column(
    band: &mut Band,
    layout: &Layout,
    dt_star: f64,
    column: BlockColumn,
    first: usize,
    values: &[f64],
) {
    for [of_values, own] in common(band, layout, first, values.len()) {
        let values = &values[of_values];
        let with_halo = band.halo + own.start..band.halo + own.end;
        match column {
            BlockColumn::DisplacementX => band.displacement.x[with_halo].copy_from_slice(values),
            BlockColumn::DisplacementY => band.displacement.y[with_halo].copy_from_slice(values),
            BlockColumn::VelocityX => band.velocity.x[own].copy_from_slice(values),
            BlockColumn::VelocityY => band.velocity.y[own].copy_from_slice(values),
            BlockColumn::FirstSlip => {
                for (step, time_star) in band.first_slip[own].iter_mut().zip(values) {
                    // An integer, except for the rounding of the product in the checkpoint and of this
                    // quotient.
                    let number = (time_star / dt_star).round();
                    *step = if number.is_nan() { NEVER } else { number as u32 };
                }
            }
            BlockColumn::Memory(number) => {
                let thresholds = band.thresholds.as_mut();
                if let Some(memory) = thresholds.and_then(|thresholds| thresholds.column_mut(number)) {
                    memory[own].copy_from_slice(values);
                }
            }
        }
    }
}

/// Writes to `values` a column of a checkpoint at t*, from block `first` on, for the blocks of the band.
pub(super) fn read_column(
    band: &Band,
    layout: &Layout,
    [dt_star, time_star]: [f64; 2],
    column: BlockColumn,
    first: usize,
    values: &mut [f64],
) {
    for [of_values, own] in common(band, layout, first, values.len()) {
        let values = &mut values[of_values];
        let with_halo = band.halo + own.start..band.halo + own.end;
        match column {
            BlockColumn::DisplacementX => values.copy_from_slice(&band.displacement.x[with_halo]),
            BlockColumn::DisplacementY => values.copy_from_slice(&band.displacement.y[with_halo]),
            BlockColumn::VelocityX => values.copy_from_slice(&band.velocity.x[own]),
            BlockColumn::VelocityY => values.copy_from_slice(&band.velocity.y[own]),
            BlockColumn::FirstSlip => {
                for (time_star, &step) in values.iter_mut().zip(&band.first_slip[own]) {
                    *time_star = if step == NEVER {
                        f64::NAN
                    } else {
                        f64::from(step) * dt_star
                    };
                }
            }
            BlockColumn::Memory(number) => {
                let Some(thresholds) = &band.thresholds else {
                    return;
                };
                for (value, k) in values.iter_mut().zip(own) {
                    let is_moving = band.velocity.at(k) != [0.0, 0.0];
                    *value = thresholds.memory(number, k, is_moving, time_star);
                }
            }
        }
    }
}

/// Blocks of the band among the `count` from `first` on, and the elements that hold them, row after row.
fn common(
    band: &Band,
    layout: &Layout,
    first: usize,
    count: usize,
) -> impl Iterator<Item = [Range<usize>; 2]> + use<> {
    let (layout, begin) = (*layout, band.first);
    let from = layout.element_of(first).max(begin);
    let to = (layout.element_of(first + count - 1) + 1).min(begin + band.len);
    layout.rows_among(from..to).filter_map(move |(_, _, part)| {
        let element = from + part.start;
        let b = layout.block(element)? - first;
        let own = element - begin;
        Some([b..b + part.len(), own..own + part.len()])
    })
}

/// Continues from a checkpoint after all columns are set, as if every tile had just been swept: the
/// largest contact stress of a checkpoint includes the skipped tiles.
pub(super) fn resume(band: &mut Band) {
    for task in &mut band.tasks {
        task.active = u32::MAX;
    }
    for k in 0..band.len {
        let v = band.velocity.at(k);
        band.set_moving(k, v != [0.0, 0.0]);
        let speed_square = &mut band.tiles[k / TILE].sums.speed_square;
        *speed_square = speed_square.max(v[0] * v[0] + v[1] * v[1]);
        band.slipped[k / LANES] |= u8::from(band.first_slip[k] != NEVER) << (k % LANES);
    }
    band.begin_thresholds();
}
