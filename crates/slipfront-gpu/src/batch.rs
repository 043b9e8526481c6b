//! Lattices in the layout that the kernels expect: their numbers in common arrays, one lattice after the
//! other.

use slipfront::VectorField;
use slipfront::device::{DeviceError, DeviceLattice, Equations, Motion, StepRecord};

/// The struct `Lattice` of `kernels/step.h`.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub(crate) struct Lattice {
    equations: Equations,
    motion: Motion,
    first_step: u64,
    energies_every: u64,
    energies_last: u64,
    first_block: u64,
    first_memory: u64,
    first_drive_step: u64,
    counted_every: u64,
    first_bin: u64,
    first_count: u64,
    /// The struct `CommonSum` of `kernels/fixed_point.h`.
    weakening_energy: [u64; 3],
    pub(crate) steps: u32,
    nx: u32,
    n: u32,
    is_held: u32,
    bins: u32,
    unused: u32,
}

#[cfg(feature = "cuda")]
impl Lattice {
    /// Number of tiles of some blocks along x and y that cover the lattice.
    pub(crate) fn tiles(&self, [along_x, along_y]: [usize; 2]) -> usize {
        let [nx, ny] = [self.nx, self.n / self.nx].map(|size| size as usize);
        nx.div_ceil(along_x) * ny.div_ceil(along_y)
    }

    /// Whether the weakening energy is needed at the step that follows the first `done` steps.
    pub(crate) fn needs_weakening_energy(&self, done: u32) -> bool {
        let step = self.first_step + u64::from(done);
        let has_energies = step.is_multiple_of(self.energies_every) || step == self.energies_last;
        has_energies && self.equations.fall_length >= 0.0
    }
}

/// Size of the struct `Step` of `kernels/step.h`, in numbers of 8 bytes.
#[cfg(feature = "cuda")]
pub(crate) const STEP: usize = 120 / 8;

/// Size of the struct `Totals` of `kernels/step.h`, in numbers of 8 bytes.
#[cfg(feature = "cuda")]
pub(crate) const TOTALS: usize = 216 / 8;

// The sizes of these structs in `kernels/step.h`.
const _: () = assert!(size_of::<Lattice>() == 520 && size_of::<StepRecord>() == 96);

/// Size of a record, in numbers of 8 bytes.
pub(crate) const RECORD: usize = size_of::<StepRecord>() / 8;

/// Lattices, and the number of steps that each takes.
#[derive(Debug)]
pub(crate) struct Batch {
    pub(crate) lattices: Vec<Lattice>,
    /// Displacements along x and y, then velocities along x and y, of the blocks of each lattice.
    pub(crate) state: Vec<f64>,
    /// For each lattice: squares of the static thresholds of its blocks, their kinetic impulses, which
    /// kernels change where strength falls with slip, and the positions of the driven ends at each step of
    /// the drive.
    pub(crate) given: Vec<f64>,
    /// For each lattice whose strength falls with slip, after a number that is not used: the impulses of its
    /// blocks without slip, the forces by which their strength falls, and the columns that the law remembers.
    pub(crate) memory: Vec<f64>,
    pub(crate) flags: Vec<u16>,
    /// For each lattice whose sliding blocks are counted, after a number that is not used: bins of its
    /// blocks.
    pub(crate) bins: Vec<u16>,
    /// For each such lattice, after a number that is not used: counts of each bin at each counted step.
    pub(crate) counts: Vec<u32>,
    pub(crate) first_slips: Vec<u32>,
    /// Records of the steps of each lattice, as numbers of 8 bytes.
    pub(crate) records: Vec<u64>,
}

impl Batch {
    /// Prepares lattices for `steps` steps.
    ///
    /// # Errors
    /// If the step count of a lattice would overflow.
    pub(crate) fn new(lattices: &[&mut DeviceLattice], steps: u32) -> Result<Self, DeviceError> {
        let blocks = lattices.iter().map(|lattice| lattice.flags.len()).sum();
        let mut batch = Self {
            lattices: Vec::with_capacity(lattices.len()),
            state: Vec::with_capacity(4 * blocks),
            given: Vec::with_capacity(2 * (blocks + lattices.len() * steps as usize)),
            // A GPU has no arrays without a number.
            memory: vec![0.0],
            bins: vec![0],
            counts: vec![0],
            flags: Vec::with_capacity(blocks),
            first_slips: Vec::with_capacity(blocks),
            records: vec![0; lattices.len() * steps as usize * RECORD],
        };
        for lattice in lattices {
            batch.add(lattice, steps)?;
        }
        Ok(batch)
    }

    fn add(&mut self, lattice: &DeviceLattice, steps: u32) -> Result<(), DeviceError> {
        let last = lattice.steps_done + u64::from(steps);
        if last >= u64::from(u32::MAX) {
            let message = format!("a run ends before step {}, and not at step {last}", u32::MAX);
            return Err(DeviceError(message));
        }
        let [nx, ny] = lattice.blocks;
        let n = nx * ny;
        self.lattices.push(Lattice {
            equations: lattice.equations,
            motion: lattice.motion,
            first_step: lattice.steps_done,
            energies_every: lattice.energies.every,
            energies_last: lattice.energies.last,
            first_block: self.flags.len() as u64,
            first_memory: self.memory.len() as u64,
            first_drive_step: lattice.motion.drive_steps,
            counted_every: lattice.counts.as_ref().map_or(0, |counts| counts.every),
            first_bin: self.bins.len() as u64,
            first_count: self.counts.len() as u64,
            weakening_energy: [0; 3],
            steps,
            nx: nx as u32,
            n: n as u32,
            is_held: lattice.is_held().into(),
            bins: lattice
                .counts
                .as_ref()
                .map_or(0, |counts| counts.bins.count as u32),
            unused: 0,
        });
        let (u, v) = (&lattice.state.displacement, &lattice.state.velocity);
        for field in [&u.x, &u.y, &v.x, &v.y] {
            self.state.extend(field);
        }
        self.given.extend(&*lattice.static_limit_squares);
        self.given.extend(&*lattice.kinetic_impulses);
        self.given.extend(lattice.drive_positions(steps).flatten());
        if let Some(strength) = &lattice.strength {
            self.memory.extend(&*lattice.kinetic_impulses);
            self.memory.extend(&*strength.drops);
            self.memory.extend(strength.columns.iter().flatten());
        }
        if let Some(counts) = &lattice.counts {
            self.bins.extend(&*counts.bin_of);
            self.counts
                .resize(self.counts.len() + count_len(lattice, steps), 0);
        }
        self.flags.extend(&*lattice.flags);
        self.first_slips.extend(&lattice.first_slips);
        // The kernels rely on these lengths.
        let (blocks, latest) = (self.flags.len(), &self.lattices[self.lattices.len() - 1]);
        let expected = 2 * (blocks + self.lattices.len() * steps as usize);
        assert!(
            self.state.len() == 4 * blocks
                && self.first_slips.len() == blocks
                && blocks as u64 == latest.first_block + n as u64
                && self.given.len() == expected
                && self.memory.len() == latest.first_memory as usize + memory_len(lattice)
                && is_complete(lattice),
            "the arrays of a lattice of {nx} x {ny} blocks have other lengths"
        );
        Ok(())
    }

    /// Copies the results of the steps back to the lattices.
    pub(crate) fn return_to(&self, lattices: &mut [&mut DeviceLattice]) {
        let mut first = 0;
        for (k, (lattice, after)) in lattices.iter_mut().zip(&self.lattices).enumerate() {
            let (n, steps) = (after.n as usize, after.steps as usize);
            let field = |which: usize| self.state[4 * first + which * n..][..n].to_vec();
            lattice.state.displacement = VectorField::from([field(0), field(1)]);
            lattice.state.velocity = VectorField::from([field(2), field(3)]);
            lattice
                .first_slips
                .copy_from_slice(&self.first_slips[first..first + n]);
            if let Some(strength) = &mut lattice.strength {
                let memory = self.memory[after.first_memory as usize..].chunks(n);
                // After the impulses, and the forces by which strength falls.
                for (column, values) in strength.columns.iter_mut().zip(memory.skip(2)) {
                    column.copy_from_slice(values);
                }
            }
            let counted = lattice.counted_steps(after.steps);
            if let Some(counts) = &mut lattice.counts {
                let rows = self.counts[after.first_count as usize..].chunks(counts.bins.count);
                counts.recorded.extend(counted.zip(rows.map(<[u32]>::to_vec)));
            }
            lattice.motion = after.motion;
            lattice.steps_done += steps as u64;
            let records = &self.records[k * steps * RECORD..][..steps * RECORD];
            lattice.records.extend(records.as_chunks().0.iter().map(record));
            first += n;
        }
    }
}

/// Bytes of the arrays that not every lattice has.
#[cfg(feature = "cuda")]
pub(crate) fn more_bytes(lattice: &DeviceLattice, steps: u32) -> usize {
    let bins = lattice.counts.as_ref().map_or(0, |counts| counts.bin_of.len());
    let counts = count_len(lattice, steps);
    memory_len(lattice) * size_of::<f64>() + bins * size_of::<u16>() + counts * size_of::<u32>()
}

/// Number of counts of sliding blocks in some steps.
fn count_len(lattice: &DeviceLattice, steps: u32) -> usize {
    let bins = lattice.counts.as_ref().map_or(0, |counts| counts.bins.count);
    bins * lattice.counted_steps(steps).count()
}

/// Number of doubles that the kernels expect as memory of the law of friction of a lattice.
fn memory_len(lattice: &DeviceLattice) -> usize {
    let columns = lattice
        .strength
        .as_ref()
        .map_or(0, |strength| 2 + strength.columns.len());
    columns * lattice.flags.len()
}

/// Whether the kernels find bins and columns that exist.
fn is_complete(lattice: &DeviceLattice) -> bool {
    let equations = &lattice.equations;
    let has_bins = lattice.counts.as_ref().is_none_or(|counts| {
        let most = counts.bin_of.iter().max().map_or(0, |bin| usize::from(*bin));
        counts.bin_of.len() == lattice.flags.len() && most < counts.bins.count
    });
    let columns = match (equations.fall_length >= 0.0, equations.healing_time.is_finite()) {
        (false, _) => 0,
        (true, false) => 1,
        (true, true) => 3,
    };
    has_bins
        && lattice
            .strength
            .as_ref()
            .map_or(0, |strength| strength.columns.len())
            >= columns
}

/// Converts the words of a record to a [`StepRecord`].
fn record(words: &[u64; RECORD]) -> StepRecord {
    let number = |k: usize| f64::from_bits(words[k]);
    StepRecord {
        displacement: [number(0), number(1)],
        velocity_after: [number(2), number(3)],
        velocity_square: number(4),
        friction_power: number(5),
        stress_square_max: number(6),
        // GPUs and their host CPUs are little-endian.
        n_sliding: [words[7] as u32, (words[7] >> 32) as u32],
        stored: [number(8), number(9), number(10)],
        weakening_energy: number(11),
    }
}
