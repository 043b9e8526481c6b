//! Notes about a folder that has been used before.

use slipfront_base::number_format::count;

/// Notes on a journal with `damaged` lines and `kept` runs.
pub fn notes_of_use(damaged: usize, kept: usize) -> Vec<String> {
    let mut notes = Vec::new();
    if damaged > 0 {
        let lines = count(damaged, "damaged line");
        notes.push(format!(
            "the journal has {lines}, which are ignored: their runs count as not run"
        ));
    }
    if kept > 0 {
        let runs = count(kept, "run");
        notes.push(format!(
            "the folder contains {runs} of an earlier call, which are not repeated"
        ));
    }
    notes
}
