//! Check that blocks are fine enough for the outline of a texture.

use super::runnable::Case;
use crate::case_file::{MAX_BLOCKS, MAX_BLOCKS_TOTAL, Outline};
use slipfront_base::number_format::{exact, four_digits, si_prefix, with_si_prefix};

/// Share by which a length may fall below the bound: rounding of lengths and of the block size.
const ROUNDING: f64 = 1e-6;
/// Smallest edge of a block, m.
const LEAST_BLOCK: f64 = 1e-12;

impl Case {
    /// A sentence on blocks that are too coarse for the outlines of the textures, with the number of blocks
    /// that is enough; none for masks and height maps, because their outlines are not known.
    pub fn too_coarse(&self) -> Option<String> {
        let lengths = self.smallest_lengths();
        let too_small = lengths.iter().filter_map(|length| {
            let needed = length
                .enough
                .filter(|needed| length.blocks < needed * (1.0 - ROUNDING))?;
            Some((length.name.as_str(), length.blocks, needed))
        });
        let too_small: Vec<(&str, f64, f64)> = too_small.collect();
        let finer = too_small.iter().map(|(_, blocks, needed)| needed / blocks);
        let finer = finer.reduce(f64::max)?;
        let clause = |(place, (name, blocks, _)): (usize, &(&str, f64, f64))| match place {
            0 if *blocks == 1.0 => format!("the {name} is 1 block across"),
            0 => format!("the {name} is {} blocks across", four_digits(*blocks)),
            _ => format!("the {name} {}", four_digits(*blocks)),
        };
        let clauses: Vec<String> = too_small.iter().enumerate().map(clause).collect();
        let needed: Vec<String> = too_small
            .iter()
            .map(|(_, _, needed)| needed.to_string())
            .collect();
        Some(format!(
            "{}; the outline needs {}, {}",
            clauses.join(" and "),
            needed.join(" and "),
            self.blocks_for(finer)
        ))
    }

    /// Settings for blocks that are finer by the factor `finer`, on a slider of the same size and aspect
    /// ratio.
    fn blocks_for(&self, finer: f64) -> String {
        let (lattice, block_size) = (&self.model.lattice, self.scales.block_size);
        let sides = [lattice.nx, lattice.ny].map(|blocks| blocks as u64);
        let parts = greatest_common_divisor(sides);
        let more = (parts as f64 * finer * (1.0 - ROUNDING)).ceil();
        let [nx, ny] = sides.map(|blocks| (blocks / parts) as f64 * more);
        let size = block_size * parts as f64 / more;
        if nx.max(ny) > MAX_BLOCKS as f64 || nx * ny > MAX_BLOCKS_TOTAL as f64 || size < LEAST_BLOCK {
            return format!(
                "blocks of {}, of which no slider of this size can be made",
                with_si_prefix(block_size / finer, "m")
            );
        }
        // For other outlines, a coverage refers to the blocks that exist, and their number depends slightly
        // on their size.
        let least = match self.file.slider.outline {
            Outline::Rectangle => "at least",
            Outline::Disc | Outline::Mask => "about",
        };
        format!(
            "{least} {nx} x {ny} blocks (`slider.blocks = [{nx}, {ny}]`, with `slider.block_size = \"{}\"` for a slider of the same size)",
            ten_digits(size)
        )
    }
}

fn greatest_common_divisor([one, other]: [u64; 2]) -> u64 {
    match other {
        0 => one,
        _ => greatest_common_divisor([other, one % other]),
    }
}

/// A length with ten digits, so that the same number of copies fits into the slider: 1e-9 of a pitch may
/// decide this.
pub(super) fn ten_digits(length: f64) -> String {
    let (factor, prefix) = si_prefix(length);
    let rounded = format!("{:.9e}", length / factor);
    format!("{} {prefix}m", exact(rounded.parse().unwrap_or(length)))
}
