//! Bits of a run, to compare two builds.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

use slipfront::{Execution, Simulation};
use slipfront_case::case::{Case, Files, FilesInMemory, Ranks};
use slipfront_case::case_file::CaseFile;
use slipfront_session::sentence;

/// Runs a case to its end, or for `most_steps` steps at most. Returns the number of steps taken, and hashes
/// of mu*, of all displacements and of all velocities at that time: FNV-1a of the bits of the numbers, as
/// hexadecimal digits.
///
/// # Errors
/// A sentence, if the text is not a case or the run diverges.
pub fn bits_of_run(toml: &str, files: &BTreeMap<String, Vec<u8>>, most_steps: u64) -> Result<String, String> {
    let in_memory: FilesInMemory = files
        .iter()
        .map(|(name, contents)| (name.clone(), contents.as_slice().into()))
        .collect();
    let files = Files {
        folder: Path::new(""),
        in_memory: Some(&in_memory),
    };
    let file = CaseFile::parse(toml, "case", &[]).map_err(sentence)?;
    let case = Case::to_run(file, "case", files, &mut |_| true, Ranks::ALONE).map_err(sentence)?;
    let (plan, model) = (&case.time_plan, Arc::clone(&case.model));
    let mut simulation = Simulation::new(model, plan.dt_star, None, Execution::default());
    simulation
        .advance(plan.stop, most_steps, &mut [])
        .map_err(sentence)?;
    let now = simulation.snapshot();
    let (steps, mu_star) = (now.step, now.point.mu_star);
    let state = simulation.state();
    let [displacement, velocity] = [&state.displacement, &state.velocity];
    Ok(format!(
        "{steps} {:016x} {:016x} {:016x}",
        fnv([&mu_star]),
        fnv(displacement.x.iter().chain(&displacement.y)),
        fnv(velocity.x.iter().chain(&velocity.y)),
    ))
}

/// FNV-1a of the bits of numbers.
fn fnv<'a>(numbers: impl IntoIterator<Item = &'a f64>) -> u64 {
    let mut hash = 0xcbf2_9ce4_8422_2325_u64;
    for number in numbers {
        for byte in number.to_bits().to_le_bytes() {
            hash = (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3);
        }
    }
    hash
}
