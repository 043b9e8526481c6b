//! The outline of a textured area, along the edges of its blocks.
//!
//! The crate slipfront-plot, which imports no other crate of the project, links to this file.

use std::collections::BTreeSet;

/// An edge between a textured block on its left and another block: y and x of the corner where it starts, and
/// the index of its direction.
type PixelEdge = (usize, usize, usize);

/// The directions from a corner: right, up, left, down.
const DIRECTIONS: [(isize, isize); 4] = [(1, 0), (0, 1), (-1, 0), (0, -1)];

/// The lines between textured and other blocks, in blocks: each is a chain of corners joined by straight
/// lines that are as long as possible. A closed chain ends where it starts; a chain that meets the lattice's
/// edge is open.
///
/// `textured` holds `nx` times `ny` blocks, row 0 at y = 0.
pub fn outline(textured: &[bool], nx: usize, ny: usize) -> Vec<Vec<(usize, usize)>> {
    let mut edges = edges(textured, nx, ny);
    // Open chains first: they must be entered at an end. A closed chain is then entered at its first corner
    // in this order, which is never in the middle of a straight line.
    let is_at_border = |&(y, x, _): &PixelEdge| x == 0 || y == 0 || x == nx || y == ny;
    let (border, inside): (Vec<PixelEdge>, Vec<PixelEdge>) =
        edges.iter().partition(|edge| is_at_border(edge));
    let mut chains = Vec::new();
    for edge in border.into_iter().chain(inside) {
        if edges.contains(&edge) {
            chains.push(follow(&mut edges, edge));
        }
    }
    chains
}

fn edges(textured: &[bool], nx: usize, ny: usize) -> BTreeSet<PixelEdge> {
    let mut edges = BTreeSet::new();
    for block in (0..textured.len()).filter(|&block| textured[block]) {
        let (x, y) = (block % nx, block / nx);
        let neighbours = [
            ((x + 1 < nx).then(|| block + 1), (y, x + 1, 1)),
            ((y + 1 < ny).then(|| block + nx), (y + 1, x + 1, 2)),
            ((x > 0).then(|| block - 1), (y + 1, x, 3)),
            ((y > 0).then(|| block - nx), (y, x, 0)),
        ];
        for (neighbour, edge) in neighbours {
            if neighbour.is_some_and(|neighbour| !textured[neighbour]) {
                edges.insert(edge);
            }
        }
    }
    edges
}

/// The corners of the chain that starts with this edge; its edges are removed.
fn follow(edges: &mut BTreeSet<PixelEdge>, (mut y, mut x, mut direction): PixelEdge) -> Vec<(usize, usize)> {
    let mut chain = vec![(x, y)];
    loop {
        edges.remove(&(y, x, direction));
        x = x.wrapping_add_signed(DIRECTIONS[direction].0);
        y = y.wrapping_add_signed(DIRECTIONS[direction].1);
        // Left before straight before right: two textured blocks that meet only at a corner stay separate
        // areas.
        let mut turns = [1, 0, 3].into_iter().map(|turn| (direction + turn) % 4);
        let next = turns.find(|&next| edges.contains(&(y, x, next)));
        let is_closed = chain[0] == (x, y);
        if next != Some(direction) || is_closed {
            chain.push((x, y));
        }
        match next {
            Some(next) if !is_closed => direction = next,
            _ => return chain,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The outline of a drawing; its first line is y = 0.
    fn traced(rows: &[&str]) -> Vec<Vec<(usize, usize)>> {
        let textured: Vec<bool> = rows
            .iter()
            .flat_map(|row| row.bytes().map(|b| b == b'#'))
            .collect();
        outline(&textured, rows[0].len(), rows.len())
    }

    fn length(chain: &[(usize, usize)]) -> usize {
        chain
            .windows(2)
            .map(|pair| pair[0].0.abs_diff(pair[1].0) + pair[0].1.abs_diff(pair[1].1))
            .sum()
    }

    #[test]
    fn an_l_is_one_closed_chain_of_six_corners() {
        let chains = traced(&["......", ".####.", ".####.", ".##...", "......"]);
        assert_eq!(chains.len(), 1);
        let chain = &chains[0];
        assert_eq!((chain.len(), chain[0], length(chain)), (7, chain[6], 14));
        for corner in [(1, 1), (5, 1), (5, 3), (3, 3), (3, 4), (1, 4)] {
            assert!(chain.contains(&corner), "{corner:?} in {chain:?}");
        }
    }

    #[test]
    fn a_ring_has_an_outer_and_an_inner_chain() {
        let mut lengths: Vec<_> = traced(&[".....", ".###.", ".#.#.", ".###.", "....."])
            .iter()
            .map(|c| (c.len(), length(c)))
            .collect();
        lengths.sort_unstable();
        assert_eq!(lengths, [(5, 4), (5, 12)]);
    }

    #[test]
    fn a_groove_through_the_lattice_is_two_straight_lines() {
        let mut chains = traced(&["....", "####", "####", "...."]);
        chains.sort_unstable();
        assert_eq!(chains, [[(0, 1), (4, 1)], [(4, 3), (0, 3)]]);
    }

    #[test]
    fn a_texture_at_a_corner_is_one_open_chain() {
        assert_eq!(traced(&["##..", "##..", "...."]), [[(2, 0), (2, 2), (0, 2)]]);
    }

    #[test]
    fn blocks_that_touch_at_a_corner_stay_apart() {
        let chains = traced(&["....", ".#..", "..#.", "...."]);
        assert_eq!(chains.len(), 2);
        assert!(chains.iter().all(|chain| length(chain) == 4 && chain.len() == 5));
    }

    #[test]
    fn nothing_textured_or_everything_has_no_outline() {
        assert!(
            traced(&["..", ".."]).is_empty() && traced(&["##", "##"]).is_empty() && traced(&["#"]).is_empty()
        );
    }
}
