//! Memory that a case takes while it is made and stepped, compared with the free memory of the machine before any of it is
//! taken.
//!
//! The modules that own the arrays state their sizes. The modules of slipfront-run that write the results of a run add the
//! memory and disk space of these.

use std::ops::Range;

use slipfront::{Kernel, Lattice, ModelOptions, Surface};

use super::ranks::Ranks;
use super::{drive, textures};
use crate::case_file::{CaseError, CaseFile};
use slipfront_base::machine::{available_memory, can_be_had};
use slipfront_base::number_format::{byte_size, count};

/// Largest ratio of resident to allocated memory: the allocator keeps memory that has been given back, and cannot use gaps
/// between pieces that have not. The ratio was up to 1.04.
const HEAP: f64 = 1.05;

/// Memory of the program itself.
pub const PROGRAM: f64 = 8.0 * 1024.0 * 1024.0;

/// Memory that a case takes while it is made and stepped.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Budget {
    /// Blocks of the rows that this process holds.
    pub blocks: f64,
    /// Bytes of the surface and of the slider per block.
    pub surface: f64,
    /// Bytes of the kernel per block, on one thread.
    pub kernel: f64,
    /// Bytes per block that the kernel adds on several threads.
    pub bands: f64,
    /// Bytes of masks and heights until they are laid over the lattice.
    pub laid: f64,
    /// Bytes of the files that the case reads.
    pub inputs: f64,
    /// Whether the lattice is shared by several ranks.
    pub is_shared: bool,
    /// Ranks on this machine.
    pub ranks_on_node: f64,
}

/// A cause of memory or disk use.
#[derive(Clone, Debug)]
pub struct Cause {
    /// The key of the case to which the use is due.
    pub key: &'static str,
    /// Number and kind of the things that take the memory.
    pub what: String,
    /// Remedy by which less is taken.
    pub remedy: &'static str,
}

/// Memory that is needed for a purpose.
#[derive(Debug)]
pub struct Demand<'a> {
    /// The case whose key a refusal names.
    pub file: &'a CaseFile,
    /// Purpose for which the memory is needed.
    pub whose: &'a str,
    /// Cause of the largest part of the demand, and its bytes.
    pub most: (Cause, f64),
    /// Bytes of this rank, with the program.
    pub of_rank: f64,
    /// Bytes of all ranks of this machine.
    pub on_node: f64,
    /// Bytes of the demand that each rank has taken already.
    pub had: f64,
}

impl Cause {
    /// The cause and its bytes, in words.
    pub fn in_words(&self, bytes: f64) -> String {
        format!("{} of it for {}", byte_size(bytes), self.what)
    }
}

impl Budget {
    /// Memory of cases that are too small to be compared with the machine, nor in Python their runs: asking for its free
    /// memory takes longer than making a small case. Commands compare the whole memory of a run.
    pub const SMALL: f64 = 64.0 * 1024.0 * 1024.0;

    /// The budget of a case with a model of these options, for a process that holds these rows.
    pub(super) fn new(
        lattice: &Lattice,
        rows: &Range<usize>,
        ranks: &Ranks,
        file: &CaseFile,
        options: &ModelOptions,
    ) -> Self {
        let blocks = lattice.nx * rows.len();
        let surface = Surface::bytes_per_block(options.has_pressures) + options.slider.bytes_per_block();
        let kernel = Kernel::default().for_options(options);
        let masks = textures::bytes_to_lay(file, blocks, lattice.n_blocks());
        Self {
            blocks: blocks as f64,
            surface: surface as f64,
            kernel: kernel.bytes_per_block(options),
            bands: kernel.bytes_per_block_of_bands(options),
            laid: (masks + drive::bytes_of_attached(file, blocks)) as f64,
            inputs: 0.0,
            is_shared: ranks.communicator.size() > 1,
            ranks_on_node: ranks.on_node as f64,
        }
    }

    /// Bytes that are resident where `allocated` bytes are allocated.
    pub fn resident(allocated: f64) -> f64 {
        HEAP * allocated
    }

    /// Elements for which a vector has room that grew to `length` by doubling.
    pub fn grown(length: f64) -> f64 {
        libm::exp2(libm::log2(length.max(4.0)).ceil())
    }

    /// Bytes while the case is made.
    pub fn making(&self) -> f64 {
        self.blocks * self.surface + self.laid
    }

    /// Bytes while the model is stepped.
    pub fn stepping(&self) -> f64 {
        self.blocks * (self.surface + self.kernel + self.bands)
    }

    /// The blocks that this process holds, as a cause of memory use.
    pub fn cause_of_blocks(&self) -> Cause {
        Cause {
            key: "slider.blocks",
            what: count(self.blocks as usize, "block"),
            remedy: "lower `slider.blocks`",
        }
    }

    /// The files that the case reads, as a cause of memory use.
    pub fn cause_of_inputs() -> Cause {
        Cause {
            key: "texture",
            what: "the files that it reads".to_owned(),
            remedy: "scale them down, or name fewer",
        }
    }

    /// Refuses a case that has no memory to be made.
    pub(super) fn check_making(&self, file: &CaseFile) -> Result<(), CaseError> {
        if self.making() < Self::SMALL {
            return Ok(());
        }
        let of_blocks = self.blocks * self.surface;
        let most = if self.laid >= of_blocks {
            (Self::cause_of_inputs(), self.laid)
        } else {
            (self.cause_of_blocks(), of_blocks)
        };
        self.compare(
            self.demand(file, "this case", most, self.making()),
            available_memory(),
        )
    }

    /// Refuses a case that has no memory to be made or stepped.
    pub(super) fn check_running(&self, file: &CaseFile) -> Result<(), CaseError> {
        let stepping = self.stepping();
        if self.ranks_on_node * stepping >= Self::SMALL {
            let demand = self.demand(
                file,
                "a run of this case",
                (self.cause_of_blocks(), stepping),
                stepping,
            );
            self.compare(demand, available_memory())?;
        }
        self.check_making(file)
    }

    fn demand<'a>(
        &self,
        file: &'a CaseFile,
        whose: &'a str,
        most: (Cause, f64),
        allocated: f64,
    ) -> Demand<'a> {
        let of_rank = PROGRAM + Self::resident(allocated);
        Demand {
            file,
            whose,
            most,
            of_rank,
            on_node: self.ranks_on_node * of_rank,
            had: 0.0,
        }
    }

    /// Refuses a demand for more memory than there is, with `available` bytes beside those that each rank has taken.
    ///
    /// # Errors
    /// A sentence with both figures, and the key to change.
    pub fn compare(&self, demand: Demand, available: Option<f64>) -> Result<(), CaseError> {
        let Demand {
            of_rank,
            on_node,
            had,
            ..
        } = demand;
        let available = available.map(|available| available + self.ranks_on_node * had);
        let bound = match available {
            Some(available) if on_node > available => {
                format!("{} are available", byte_size(available))
            }
            _ if !can_be_had(of_rank - had) => "the system gives less at once (see `ulimit -v`)".to_owned(),
            _ => return Ok(()),
        };
        let (each, or) = if self.is_shared {
            (" per rank", ", or share it among more machines")
        } else {
            ("", "")
        };
        let together = match self.ranks_on_node {
            1.0 => String::new(),
            ranks => format!(", {} for the {ranks} ranks of this machine,", byte_size(on_node)),
        };
        let (whose, needed) = (demand.whose, byte_size(of_rank));
        let (cause, bytes) = demand.most;
        let (most, remedy) = (cause.in_words(bytes), cause.remedy);
        let sentence = format!(
            "{whose} takes about {needed} of memory{each} ({most}){together} where {bound}: {remedy}{or}"
        );
        Err(demand.file.source.error(cause.key, sentence))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use slipfront_base::machine::free_disk;

    #[test]
    fn the_machine_says_what_it_has() {
        let folder = tempfile::tempdir().unwrap();
        let there = free_disk(folder.path()).unwrap();
        assert!(there > 0.0);
        // Where a folder will be made counts the nearest that is there.
        assert!(free_disk(&folder.path().join("not/yet/there")).is_some());
        // This test runs in some memory.
        assert!(available_memory().is_none_or(|bytes| bytes > PROGRAM));
    }
}
