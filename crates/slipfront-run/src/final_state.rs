//! The file of the last state of a run, from which another case can start.

use std::io::{self, BufWriter, Seek, SeekFrom, Write};

use slipfront::State;
use slipfront_case::arrays::head_of_state;
use slipfront_case::case::Case;

/// Writes the header, which comes before the numbers.
pub(crate) fn create(case: &Case, output: &mut impl Write) -> io::Result<()> {
    let lattice = &case.model.lattice;
    output.write_all(&head_of_state(lattice.nx, lattice.ny))
}

/// Writes the numbers of the rows that this process holds: displacements along x and y, velocities along
/// both.
pub(crate) fn write_rows(case: &Case, state: &State, output: impl Write + Seek) -> io::Result<()> {
    let (lattice, rows) = (&case.model.lattice, &case.model.rows);
    let head = head_of_state(lattice.nx, lattice.ny).len();
    let (u, v) = (&state.displacement, &state.velocity);
    let mut output = BufWriter::new(output);
    for (layer, values) in [&u.x, &u.y, &v.x, &v.y].into_iter().enumerate() {
        let before = (layer * lattice.ny + rows.start) * lattice.nx;
        output.seek(SeekFrom::Start((head + size_of::<f64>() * before) as u64))?;
        values
            .iter()
            .try_for_each(|value| output.write_all(&value.to_le_bytes()))?;
    }
    output.flush()
}
