//! A search for a texture with less static friction than the painted one.

use std::time::Duration;

use slipfront_case::case::Case;

use crate::protocol::SearchLimits;

/// Duration of a search.
pub(crate) const SEARCH_TIME: Duration = Duration::from_secs(60);

/// Smallest width of a feature and of a gap, in blocks: a laser makes round corners, which take three blocks
/// to resolve.
pub(crate) const WIDTH: usize = 3;

/// Largest coverage of a search, %, if nothing is painted.
const PLAIN_PERCENT: f64 = 10.0;

/// Largest coverage of a search, %, if the painted coverage is smaller than this.
const LEAST_PERCENT: f64 = 3.0;

/// Bounds of the textures that a search for a case may try.
pub(crate) fn limits(case: &Case) -> SearchLimits {
    let painted = case.texture.meshed_percent;
    SearchLimits {
        width_blocks: WIDTH,
        most_percent: if painted > 0.0 {
            painted.max(LEAST_PERCENT)
        } else {
            PLAIN_PERCENT
        },
    }
}

/// Reason why a search that was stopped at once has found nothing.
pub(crate) const NOTHING_TRIED: &str =
    "the search was stopped before it had tried a texture: nothing has changed";

/// The strips of blocks of a texture along x: the row, the first column, and the column after the last.
pub(crate) fn strips(texture: &[bool], columns: usize) -> Vec<[usize; 3]> {
    let mut strips: Vec<[usize; 3]> = Vec::new();
    for block in (0..texture.len()).filter(|&block| texture[block]) {
        let [row, column] = [block / columns, block % columns];
        match strips.last_mut() {
            Some([last_row, _, end]) if *last_row == row && *end == column => *end += 1,
            _ => strips.push([row, column, column + 1]),
        }
    }
    strips
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strips_hold_every_block_of_a_texture() {
        let texture: Vec<bool> = "##.# .... ...# #..#"
            .bytes()
            .filter(|byte| *byte != b' ')
            .map(|byte| byte == b'#')
            .collect();
        assert_eq!(
            strips(&texture, 4),
            [[0, 0, 2], [0, 3, 4], [2, 3, 4], [3, 0, 1], [3, 3, 4]]
        );
    }
}
