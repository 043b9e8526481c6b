//! The number of threads of this process.

use crate::failure::Failure;

/// Sets the number of threads of this process, by default one per core, and returns it.
pub(crate) fn set_threads(threads: Option<u16>) -> Result<usize, Failure> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads.map_or(0, usize::from));
    pool.build_global().map_err(Failure::running)?;
    Ok(rayon::current_num_threads())
}
