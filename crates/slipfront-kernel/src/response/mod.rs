//! The forces of an elastic body on all blocks of its face at once: a transform of their displacements to
//! wave numbers, a product with the response of each, and a transform back.

mod threads;
mod transform;

use self::transform::{LANES, Lanes, Rows, Transform};

pub use self::threads::{Join, Threads};
pub use self::transform::next_side;

/// The response of a body to displacements of its face, for every wave number of a lattice with periodic
/// edges, and room to apply it.
///
/// With the components of a displacement as one complex number, `w = u_x + i u_y`, the force is
/// `-(a w(q) + b conj w(-q))` with `a = (K_xx + K_yy)/2` and `b = (K_xx - K_yy)/2 + i K_xy`.
#[derive(Clone, Debug)]
pub struct SurfaceResponse {
    transform: Transform,
    spectrum: Rows,
    /// a and both parts of b over the number of blocks, in the rows of the spectrum.
    tables: [Vec<f64>; 3],
}

impl SurfaceResponse {
    /// A response on `[nx, ny]` blocks for at most `threads` threads. `stiffness(i, j)` returns a and both
    /// parts of b for the wave number i of nx along x and j of ny along y.
    ///
    /// # Panics
    /// Unless [`next_side`] returns both sides themselves.
    pub fn new([nx, ny]: [usize; 2], threads: usize, stiffness: impl Fn(usize, usize) -> [f64; 3]) -> Self {
        let transform = Transform::new([nx, ny], threads);
        let spectrum = transform.spectrum();
        let mut tables = [(); 3].map(|()| vec![0.0; spectrum.re.len()]);
        let n_blocks = (nx * ny) as f64;
        for j in 0..ny {
            for i in 0..nx {
                for (table, entry) in tables.iter_mut().zip(stiffness(i, j)) {
                    table[j * spectrum.stride + i] = entry / n_blocks;
                }
            }
        }
        Self {
            transform,
            spectrum,
            tables,
        }
    }

    /// Computes the forces on all blocks from their displacements, and returns the mean displacement.
    pub fn forces(
        &mut self,
        threads: Threads,
        displacement: [&[f64]; 2],
        force: [&mut [f64]; 2],
    ) -> [f64; 2] {
        let [nx, ny] = self.transform.size;
        self.transform.forward(threads, displacement, &mut self.spectrum);
        let (spectrum, n_blocks) = (&self.spectrum, (nx * ny) as f64);
        // Column 0 is its own opposite; the others go backwards.
        let backwards = |values: &[f64], row: usize, first: usize| {
            let values = &values[(ny - row) % ny * spectrum.stride..][..nx];
            let mut back = [0.0; LANES];
            if first > 0 && first + LANES <= nx {
                back.copy_from_slice(&values[nx + 1 - first - LANES..][..LANES]);
                back.reverse();
            } else {
                for (k, back) in back.iter_mut().enumerate() {
                    *back = values[(2 * nx - (first + k) % nx) % nx];
                }
            }
            back
        };
        let product = |row: usize, first: usize| -> Lanes {
            let here = spectrum.lanes(row, first);
            let re_back = backwards(&spectrum.re, row, first);
            let im_back = backwards(&spectrum.im, row, first);
            let at = row * spectrum.stride + first;
            let [a, b_re, b_im] = self.tables.each_ref().map(|table| &table[at..at + LANES]);
            Lanes::from_functions(
                |k| -(a[k] * here.re[k] + (b_re[k] * re_back[k] + b_im[k] * im_back[k])),
                |k| -(a[k] * here.im[k] + (b_im[k] * re_back[k] - b_re[k] * im_back[k])),
            )
        };
        self.transform.backward(threads, product, force);
        [self.spectrum.re[0] / n_blocks, self.spectrum.im[0] / n_blocks]
    }
}
