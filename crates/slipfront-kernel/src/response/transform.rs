//! The discrete Fourier transform of a plane vector at every block: `w(q) = sum_x (u_x + i u_y) exp(-i q x)`.
//!
//! Both components are the real and the imaginary part of one complex number, so that one transform serves
//! both. It is Stockham's transform, with radices 4, 2, 3 and 5, along the columns of an array, eight columns
//! at a time; what it writes is transposed, so that a second one transforms the rows and restores the order.
//! Each column is computed by the same operations on any vector width and number of threads, with twiddle
//! factors of `libm` and without fused operations, so that results have the same bits everywhere.

use std::f64::consts::TAU;
use std::ops::Range;

use super::threads::Threads;
use crate::vectorized;

/// Number of columns that are transformed at once.
pub(super) const LANES: usize = 8;

/// A complex number of each of some columns.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Lanes {
    pub(super) re: [f64; LANES],
    pub(super) im: [f64; LANES],
}

impl Lanes {
    /// Eight numbers from two functions of the place: a loop for each becomes vectors.
    #[inline(always)]
    pub(super) fn from_functions(re: impl Fn(usize) -> f64, im: impl Fn(usize) -> f64) -> Self {
        let mut lanes = Self::default();
        for k in 0..LANES {
            lanes.re[k] = re(k);
        }
        for k in 0..LANES {
            lanes.im[k] = im(k);
        }
        lanes
    }

    #[inline(always)]
    fn plus(&self, other: &Self) -> Self {
        Self::from_functions(|k| self.re[k] + other.re[k], |k| self.im[k] + other.im[k])
    }

    #[inline(always)]
    fn minus(&self, other: &Self) -> Self {
        Self::from_functions(|k| self.re[k] - other.re[k], |k| self.im[k] - other.im[k])
    }

    /// The product with a real number.
    #[inline(always)]
    fn scaled(&self, factor: f64) -> Self {
        Self::from_functions(|k| factor * self.re[k], |k| factor * self.im[k])
    }

    /// The product with a complex number.
    #[inline(always)]
    fn turned(&self, [re, im]: [f64; 2]) -> Self {
        Self::from_functions(
            |k| self.re[k] * re - self.im[k] * im,
            |k| self.re[k] * im + self.im[k] * re,
        )
    }

    /// The product with -i.
    #[inline(always)]
    fn quarter_back(&self) -> Self {
        Self::from_functions(|k| self.im[k], |k| -self.re[k])
    }
}

/// A stage of a transform: `size` numbers in each of `apart` sequences become `radix` times as many
/// sequences.
#[derive(Clone, Debug, PartialEq)]
struct Stage {
    radix: usize,
    /// Length of a sequence after the stage.
    size: usize,
    /// Number of sequences before the stage.
    apart: usize,
    /// `exp(-2 pi i p j/(radix size))` for every p below `size` and j from 1 below `radix`.
    twiddles: Vec<[f64; 2]>,
}

/// The transform of a column of `len` numbers.
#[derive(Clone, Debug, PartialEq)]
struct Plan {
    len: usize,
    stages: Vec<Stage>,
}

impl Plan {
    /// # Panics
    /// Unless `len` is a product of powers of 2, 3 and 5.
    fn new(len: usize) -> Self {
        let (mut rest, mut apart, mut stages) = (len, 1, Vec::new());
        while rest > 1 {
            let radix = [4, 2, 3, 5].into_iter().find(|radix| rest.is_multiple_of(*radix));
            let radix = radix.unwrap_or_else(|| panic!("{len} is no product of powers of 2, 3 and 5"));
            let size = rest / radix;
            let twiddle = |p: usize, j: usize| {
                let angle = -TAU * (p * j % rest) as f64 / rest as f64;
                [libm::cos(angle), libm::sin(angle)]
            };
            let twiddles = (0..size).flat_map(|p| (1..radix).map(move |j| twiddle(p, j)));
            stages.push(Stage {
                radix,
                size,
                apart,
                twiddles: twiddles.collect(),
            });
            (rest, apart) = (size, apart * radix);
        }
        Self { len, stages }
    }

    /// Transforms the numbers in `one`, and returns the array of the two in which the result is.
    #[inline(always)]
    fn transform<'a>(&self, mut one: &'a mut [Lanes], mut other: &'a mut [Lanes]) -> &'a [Lanes] {
        for stage in &self.stages {
            match stage.radix {
                2 => stage.pass(one, other, |[a, b]| [a.plus(b), a.minus(b)]),
                3 => stage.pass(one, other, of_three),
                4 => stage.pass(one, other, of_four),
                _ => stage.pass(one, other, of_five),
            }
            (one, other) = (other, one);
        }
        one
    }
}

impl Stage {
    #[inline(always)]
    fn pass<const RADIX: usize>(
        &self,
        from: &[Lanes],
        to: &mut [Lanes],
        butterfly: impl Fn([&Lanes; RADIX]) -> [Lanes; RADIX],
    ) {
        let &Self { size, apart, .. } = self;
        let results = to.chunks_exact_mut(RADIX * apart);
        let twiddles = self.twiddles.chunks_exact(RADIX - 1);
        for (p, (to, twiddles)) in results.zip(twiddles).enumerate() {
            let sequences: [&[Lanes]; RADIX] =
                std::array::from_fn(|j| &from[apart * (p + size * j)..][..apart]);
            for q in 0..apart {
                let found = butterfly(std::array::from_fn(|j| &sequences[j][q]));
                to[q] = found[0];
                for j in 1..RADIX {
                    to[q + apart * j] = found[j].turned(twiddles[j - 1]);
                }
            }
        }
    }
}

#[inline(always)]
fn of_three([a, b, c]: [&Lanes; 3]) -> [Lanes; 3] {
    /// sin 60 degrees.
    const SINE: f64 = 0.866_025_403_784_438_6;
    let (sum, difference) = (b.plus(c), b.minus(c).scaled(SINE).quarter_back());
    let middle = a.minus(&sum.scaled(0.5));
    [a.plus(&sum), middle.plus(&difference), middle.minus(&difference)]
}

#[inline(always)]
fn of_four([a, b, c, d]: [&Lanes; 4]) -> [Lanes; 4] {
    let (even, odd) = (a.plus(c), b.plus(d));
    let (apart, turned) = (a.minus(c), b.minus(d).quarter_back());
    [
        even.plus(&odd),
        apart.plus(&turned),
        even.minus(&odd),
        apart.minus(&turned),
    ]
}

#[inline(always)]
fn of_five([a, b, c, d, e]: [&Lanes; 5]) -> [Lanes; 5] {
    /// Cosines of 72 and 144 degrees.
    const COSINES: [f64; 2] = [0.309_016_994_374_947_45, -0.809_016_994_374_947_5];
    /// Sines of 72 and 144 degrees.
    const SINES: [f64; 2] = [0.951_056_516_295_153_5, 0.587_785_252_292_473_1];
    let (near, far) = (b.plus(e), c.plus(d));
    let (near_apart, far_apart) = (b.minus(e), c.minus(d));
    let middle = |[of_near, of_far]: [f64; 2]| a.plus(&near.scaled(of_near)).plus(&far.scaled(of_far));
    let turned = |[of_near, of_far]: [f64; 2]| {
        let sum = near_apart.scaled(of_near).plus(&far_apart.scaled(of_far));
        sum.quarter_back()
    };
    let (first, second) = (middle(COSINES), middle([COSINES[1], COSINES[0]]));
    let (first_turned, second_turned) = (turned(SINES), turned([SINES[1], -SINES[0]]));
    [
        a.plus(&near).plus(&far),
        first.plus(&first_turned),
        second.plus(&second_turned),
        second.minus(&second_turned),
        first.minus(&first_turned),
    ]
}

/// The numbers of a thread while it transforms some columns.
#[derive(Clone, Debug)]
struct Scratch([Vec<Lanes>; 2]);

/// Complex numbers in rows: real parts, imaginary parts, and the distance between the beginnings of two rows.
#[derive(Clone, Debug)]
pub(super) struct Rows {
    pub(super) re: Vec<f64>,
    pub(super) im: Vec<f64>,
    pub(super) stride: usize,
}

impl Rows {
    /// `rows` rows of `len` numbers, or more.
    fn new(rows: usize, len: usize) -> Self {
        // Rows a power of two apart would share the same lines of a cache.
        let whole = len.next_multiple_of(LANES);
        let stride = if whole.is_multiple_of(8 * LANES) {
            whole + LANES
        } else {
            whole
        };
        let zeros = || vec![0.0; rows.next_multiple_of(LANES) * stride];
        Self {
            re: zeros(),
            im: zeros(),
            stride,
        }
    }

    /// Eight numbers of a row from `first` on.
    #[inline(always)]
    pub(super) fn lanes(&self, row: usize, first: usize) -> Lanes {
        let at = row * self.stride + first;
        let (re, im) = (&self.re[at..at + LANES], &self.im[at..at + LANES]);
        Lanes::from_functions(|k| re[k], |k| im[k])
    }
}

/// Transforms of plane vectors on a lattice of `nx` by `ny` blocks, to wave numbers and back.
#[derive(Clone, Debug)]
pub(super) struct Transform {
    pub(super) size: [usize; 2],
    plans: [Plan; 2],
    /// The columns, transformed along y.
    turned: Rows,
    scratch: Vec<Scratch>,
}

impl Transform {
    /// A transform that at most `threads` threads share.
    ///
    /// # Panics
    /// Unless both sides are products of powers of 2, 3 and 5, see [`next_side`].
    pub(super) fn new([nx, ny]: [usize; 2], threads: usize) -> Self {
        let longer = nx.max(ny);
        let scratch = || Scratch([(); 2].map(|()| vec![Lanes::default(); longer]));
        let bands = threads.min(nx.min(ny).div_ceil(LANES)).max(1);
        Self {
            size: [nx, ny],
            plans: [Plan::new(nx), Plan::new(ny)],
            turned: Rows::new(nx, ny),
            scratch: (0..bands).map(|_| scratch()).collect(),
        }
    }

    /// Room for a transform.
    pub(super) fn spectrum(&self) -> Rows {
        let [nx, ny] = self.size;
        Rows::new(ny, nx)
    }

    /// The transform of the vectors with components `x` and `y`, one row of the lattice after the other.
    pub(super) fn forward(&mut self, threads: Threads, [x, y]: [&[f64]; 2], spectrum: &mut Rows) {
        let nx = self.size[0];
        let load = |row: usize, first: usize| {
            let (from, n) = (row * nx + first, LANES.min(nx - first));
            let mut lanes = Lanes::default();
            lanes.re[..n].copy_from_slice(&x[from..from + n]);
            lanes.im[..n].copy_from_slice(&y[from..from + n]);
            lanes
        };
        let stride = spectrum.stride;
        self.transform(threads, load, [&mut spectrum.re, &mut spectrum.im], stride);
    }

    /// The vectors with the transform `spectrum(row, first column)` for eight columns, times the number of
    /// blocks.
    pub(super) fn backward(
        &mut self,
        threads: Threads,
        spectrum: impl Fn(usize, usize) -> Lanes + Sync,
        [x, y]: [&mut [f64]; 2],
    ) {
        // The inverse is the transform with real and imaginary parts exchanged, before and after.
        let load = |row: usize, first: usize| {
            let Lanes { re, im } = spectrum(row, first);
            Lanes { re: im, im: re }
        };
        self.transform(threads, load, [y, x], self.size[0]);
    }

    /// Transforms the rows of eight columns that `load` returns, along y and then along x, to rows that are
    /// `stride` apart.
    fn transform(
        &mut self,
        threads: Threads,
        load: impl Fn(usize, usize) -> Lanes + Sync,
        to: [&mut [f64]; 2],
        stride: usize,
    ) {
        let ([nx, ny], [along_x, along_y]) = (self.size, &self.plans);
        let (turned, scratch) = (&mut self.turned, &mut self.scratch);
        let columns = [&mut *turned.re, &mut *turned.im];
        Columns(along_y, nx, turned.stride).transform(threads, scratch, load, columns);
        let load = |row: usize, first: usize| turned.lanes(row, first);
        Columns(along_x, ny, stride).transform(threads, scratch, load, to);
    }
}

/// Columns to be transformed, each of which is written as a row: their plan, their number, and the distance
/// of two rows.
#[derive(Clone, Copy)]
struct Columns<'a>(&'a Plan, usize, usize);

impl Columns<'_> {
    /// Transforms the columns; `load(row, first column)` returns the numbers of eight of them.
    fn transform(
        self,
        threads: Threads,
        scratch: &mut [Scratch],
        load: impl Fn(usize, usize) -> Lanes + Sync,
        to: [&mut [f64]; 2],
    ) {
        let Self(_, n, stride) = self;
        let work = |scratch: &mut Scratch, groups: Range<usize>, to: [&mut [f64]; 2]| {
            vectorized(
                threads.level,
                #[inline(always)]
                || self.transform_groups(scratch, groups, &load, to),
            );
        };
        share(threads, scratch, 0..n.div_ceil(LANES), to, LANES * stride, &work);
    }

    /// Transforms some groups of eight columns.
    #[inline(always)]
    fn transform_groups(
        self,
        Scratch([one, other]): &mut Scratch,
        groups: Range<usize>,
        load: &impl Fn(usize, usize) -> Lanes,
        [re, im]: [&mut [f64]; 2],
    ) {
        let Self(plan, n, stride) = self;
        let (one, other) = (&mut one[..plan.len], &mut other[..plan.len]);
        for (place, group) in groups.enumerate() {
            let first = group * LANES;
            for (row, lanes) in one.iter_mut().enumerate() {
                *lanes = load(row, first);
            }
            let found = plan.transform(one, other);
            for k in 0..LANES.min(n - first) {
                let from = (place * LANES + k) * stride;
                let (re, im) = (&mut re[from..from + plan.len], &mut im[from..from + plan.len]);
                for ((re, im), lanes) in re.iter_mut().zip(im).zip(found) {
                    (*re, *im) = (lanes.re[k], lanes.im[k]);
                }
            }
        }
    }
}

/// Shares groups of columns, which fill `group_len` numbers of `to` each, among as many threads as there are
/// `scratch` arrays.
fn share(
    threads: Threads,
    scratch: &mut [Scratch],
    groups: Range<usize>,
    [re, im]: [&mut [f64]; 2],
    group_len: usize,
    work: &(impl Fn(&mut Scratch, Range<usize>, [&mut [f64]; 2]) + Sync),
) {
    if let [scratch] = scratch {
        work(scratch, groups, [re, im]);
        return;
    }
    let half = scratch.len() / 2;
    let middle = groups.start + groups.len() * half / scratch.len();
    let (one, other) = scratch.split_at_mut(half);
    let at = (middle - groups.start) * group_len;
    let ((re, re_after), (im, im_after)) = (re.split_at_mut(at), im.split_at_mut(at));
    (threads.join)(
        &mut || share(threads, one, groups.start..middle, [re, im], group_len, work),
        &mut || {
            share(
                threads,
                other,
                middle..groups.end,
                [re_after, im_after],
                group_len,
                work,
            );
        },
    );
}

/// The least number from `n` on that a side of a lattice under a transform can have: a product of powers of
/// 2, 3 and 5.
///
/// ```
/// assert_eq!([1, 7, 16, 25, 97, 121].map(slipfront_kernel::next_side), [1, 8, 16, 25, 100, 125]);
/// ```
pub fn next_side(n: usize) -> usize {
    let is_side = |n: &usize| {
        [2, 3, 5].into_iter().fold(*n, |mut rest, prime| {
            while rest.is_multiple_of(prime) {
                rest /= prime;
            }
            rest
        }) == 1
    };
    (n.max(1)..).find(is_side).unwrap_or(n)
}
