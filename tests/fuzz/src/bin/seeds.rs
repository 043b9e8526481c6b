//! Lists the targets, or writes their seeds, findings and dictionaries to a folder, for `run.sh`.

use std::error::Error;
use std::path::Path;

use slipfront_fuzz::TARGETS;

fn main() -> Result<(), Box<dyn Error>> {
    let out = std::env::args().nth(1);
    for target in TARGETS {
        println!("{} {}", target.name, target.max_bytes);
        let Some(out) = &out else { continue };
        std::fs::create_dir_all(out)?;
        std::fs::write(
            Path::new(out).join(format!("{}.dict", target.name)),
            target.words(),
        )?;
        let folder = Path::new(out).join(target.name);
        std::fs::create_dir_all(&folder)?;
        for (number, (_, bytes)) in target.seeds().into_iter().chain(target.findings()).enumerate() {
            std::fs::write(folder.join(format!("seed-{number}")), bytes)?;
        }
    }
    Ok(())
}
