//! The outline of a textured area, along the edges of its blocks.

/// The lines between textured and other blocks, in blocks: each a chain of corners joined by straight lines,
/// as long as possible. A closed chain ends where it starts; one that meets the lattice's edge is open.
///
/// `textured` holds `nx` times `ny` blocks, row 0 at y = 0.
pub(crate) fn outline(textured: &[bool], nx: usize, ny: usize) -> Vec<Vec<(usize, usize)>> {
    let mut edges = Edges::of(textured, nx, ny);
    let mut chains = Vec::new();
    // Open chains first: they must be entered at an end. A closed one is then entered at its first corner in
    // this order, which is never in the middle of a straight line.
    for open in [true, false] {
        for y in 0..=ny {
            for x in 0..=nx {
                let starts = |edges: &Edges| (0..4).find(|&direction| edges.has((x, y), direction));
                while let Some(direction) =
                    starts(&edges).filter(|_| !open || x == 0 || y == 0 || x == nx || y == ny)
                {
                    chains.push(edges.follow((x, y), direction));
                }
            }
        }
    }
    chains
}

/// The directions from a corner: right, up, left, down.
const DIRECTIONS: [(isize, isize); 4] = [(1, 0), (0, 1), (-1, 0), (0, -1)];

/// Which directions out of every corner are edges not yet drawn, each with the textured block on its left.
struct Edges {
    corners_x: usize,
    directions: Vec<u8>,
}

impl Edges {
    fn of(textured: &[bool], nx: usize, ny: usize) -> Self {
        let mut edges = Self {
            corners_x: nx + 1,
            directions: vec![0; (nx + 1) * (ny + 1)],
        };
        let at = |x: usize, y: usize| textured[y * nx + x];
        for y in 0..ny {
            for x in 0..nx {
                if x + 1 < nx {
                    match (at(x, y), at(x + 1, y)) {
                        (true, false) => edges.add((x + 1, y), 1),
                        (false, true) => edges.add((x + 1, y + 1), 3),
                        _ => {}
                    }
                }
                if y + 1 < ny {
                    match (at(x, y), at(x, y + 1)) {
                        (true, false) => edges.add((x + 1, y + 1), 2),
                        (false, true) => edges.add((x, y + 1), 0),
                        _ => {}
                    }
                }
            }
        }
        edges
    }

    fn add(&mut self, (x, y): (usize, usize), direction: usize) {
        self.directions[y * self.corners_x + x] |= 1 << direction;
    }

    fn has(&self, (x, y): (usize, usize), direction: usize) -> bool {
        self.directions[y * self.corners_x + x] & 1 << direction != 0
    }

    fn remove(&mut self, (x, y): (usize, usize), direction: usize) {
        self.directions[y * self.corners_x + x] &= !(1 << direction);
    }

    /// The chain that starts at a corner in this direction; its edges are removed.
    fn follow(&mut self, start: (usize, usize), direction: usize) -> Vec<(usize, usize)> {
        let mut chain = vec![start];
        let (mut corner, mut direction) = (start, direction);
        loop {
            self.remove(corner, direction);
            corner = (
                corner.0.wrapping_add_signed(DIRECTIONS[direction].0),
                corner.1.wrapping_add_signed(DIRECTIONS[direction].1),
            );
            // Left before straight before right: two textured blocks that meet at a corner only stay two
            // areas.
            let next = [1, 0, 3]
                .into_iter()
                .map(|turn| (direction + turn) % 4)
                .find(|&next| self.has(corner, next));
            if next != Some(direction) || corner == start {
                chain.push(corner);
            }
            match next {
                Some(next) if corner != start => direction = next,
                _ => return chain,
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The outline of a drawing whose first line is y = 0.
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
