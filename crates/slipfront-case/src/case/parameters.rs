//! The parameters of a case that follow from the case file alone, without the files that it names.

use slipfront::{Lattice, Scales};

use super::budget::Budget;
use super::groups::Groups;
use super::output::{Output, smallest_stride};
use super::time_plan::TimePlan;
use crate::case_file::{CaseError, CaseFile};

/// The parameters of a case, computed before any array of the lattice is allocated.
pub(super) struct Parameters {
    pub(super) scales: Scales,
    pub(super) groups: Groups,
    pub(super) lattice: Lattice,
    pub(super) time_plan: TimePlan,
    pub(super) output: Output,
    pub(super) budget: Budget,
}

impl Parameters {
    pub(super) fn of(file: &CaseFile) -> Result<Self, CaseError> {
        let scales = scales(file);
        let groups = Groups::of(file, &scales)?;
        let lattice = lattice(file);
        let time_plan = TimePlan::of(file, &scales, &groups)?;
        let output = Output::of(file, &time_plan)?;
        let budget = Budget::new(&lattice, file.friction.law, &time_plan, &output);
        Ok(Self {
            scales,
            groups,
            lattice,
            time_plan,
            output,
            budget,
        })
    }
}

/// Refuses a case whose fields are too large for their file.
pub fn check_fields(file: &CaseFile, lattice: &Lattice, output: &Output) -> Result<(), CaseError> {
    let Lattice { nx, ny, .. } = lattice;
    let needed = smallest_stride(*nx, *ny, output.stride);
    if needed == output.stride {
        return Ok(());
    }
    let sentence = format!(
        "one field of {nx} x {ny} blocks takes more than the 2 GiB that the format of fields.nc holds: set \
         `output.stride` to {needed} or more"
    );
    Err(file.source.error("output.stride", sentence))
}

fn scales(file: &CaseFile) -> Scales {
    Scales {
        block_size: file.slider.block_size.si(),
        young_modulus: file.slider.young_modulus.si(),
        density: file.slider.density.si(),
        pressure: file.load.pressure.si(),
        mu_static_mean: file.friction.mu_static,
    }
}

fn lattice(file: &CaseFile) -> Lattice {
    let [nx, ny] = file.slider.blocks.map(|count| count as usize);
    Lattice::with_edges(nx, ny, file.slider.edges)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_that_no_file_holds_are_refused_before_the_run() {
        let check = |text: &str| {
            let file = CaseFile::parse(text, "case.toml", &[]).unwrap();
            let Parameters { lattice, output, .. } = Parameters::of(&file).unwrap();
            check_fields(&file, &lattice, &output)
        };
        let large = "[slider]\nblocks = [40000, 20000]\n[output]\nstride =";
        assert!(check(&format!("{large} 2")).is_ok());
        let said = check(&format!("{large} 1")).unwrap_err().to_string();
        assert!(
            said.contains("case.toml:4:10: ") && said.contains("set `output.stride` to 2 or more"),
            "{said}"
        );
    }
}
