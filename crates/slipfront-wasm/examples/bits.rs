//! Prints the bits of runs on this machine: for each case file its name, the number of steps taken, and
//! hashes of mu*, displacements and velocities.
//!
//! ```console
//! $ cargo run -p slipfront-wasm --example bits -- 3000 cases/*.toml
//! ```

use std::collections::BTreeMap;
use std::path::Path;

use slipfront_case::case_file::CaseFile;
use slipfront_wasm::bits::bits_of_run;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let most_steps: u64 = arguments.next().ok_or("how many steps at most?")?.parse()?;
    for path in arguments {
        let path = Path::new(&path);
        let toml = std::fs::read_to_string(path)?;
        let folder = path.parent().unwrap_or(Path::new(""));
        let mut file = CaseFile::parse(&toml, "case", &[])?;
        let mut files = BTreeMap::new();
        for named in file.files_mut().0 {
            files.insert(named.name.clone(), std::fs::read(folder.join(&*named.name))?);
        }
        let name = path.file_stem().unwrap_or_default().to_string_lossy();
        println!("{name} {}", bits_of_run(&toml, &files, most_steps)?);
    }
    Ok(())
}
