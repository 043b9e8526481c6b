//! Time of a change during a run: making the case with another texture, and starting the leg that continues
//! under it.
//!
//! ```console
//! $ cargo run --release -p slipfront-run --example change_cost -- 256 1
//! ```
//!
//! The example above has 256 x 256 sliding blocks on one thread. Their texture is an image that changes from
//! leg to leg, as if a person were painting it. Prints the median time of each part in ms.

use std::error::Error;
use std::fs;
use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

use slipfront::Execution;
use slipfront_case::case::Case;
use slipfront_run::running::Running;

/// Number of timed changes.
const CHANGES: usize = 21;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<usize> = std::env::args()
        .skip(1)
        .map(|word| word.parse())
        .collect::<Result<_, _>>()?;
    let [size, threads] = arguments[..] else {
        return Err("usage: change_cost SIZE THREADS".into());
    };
    let folder = tempfile::tempdir()?;
    paint(folder.path(), size, 0)?;
    let mut running = Running::start(
        &case(folder.path(), size, 0)?,
        None,
        Execution::on_threads(threads),
    );
    running.advance(1500)?;
    let mut times = [(); 3].map(|()| Vec::new());
    for change in 1..=CHANGES {
        paint(folder.path(), size, change)?;
        let began = Instant::now();
        let case = case(folder.path(), size, change)?;
        let made = Instant::now();
        running = running.change(&case, threads)?.running;
        let changed = Instant::now();
        running.advance(25)?;
        let parts = [made - began, changed - made, changed.elapsed()];
        for (times, part) in times.iter_mut().zip(parts) {
            times.push(part.as_secs_f64() * 1e3);
        }
    }
    let [case, change, steps] = times.map(|mut times| {
        times.sort_by(f64::total_cmp);
        times[CHANGES / 2]
    });
    println!("{size} x {size} blocks: case {case:.2} ms, change {change:.2} ms, 25 steps {steps:.2} ms");
    Ok(())
}

/// The picture of a disc, farther to the right with every change.
fn paint(folder: &Path, size: usize, change: usize) -> Result<(), Box<dyn Error>> {
    let centre = [0.3 * size as f64 + change as f64, 0.5 * size as f64];
    let pixel = |b: usize| {
        let [x, y] = [(b % size) as f64 - centre[0], (b / size) as f64 - centre[1]];
        if x.hypot(y) < 0.2 * size as f64 { 0 } else { 255 }
    };
    let pixels: Vec<u8> = (0..size * size).map(pixel).collect();
    let file = fs::File::create(folder.join(format!("mask{change}.png")))?;
    let mut picture = png::Encoder::new(file, size as u32, size as u32);
    picture.set_color(png::ColorType::Grayscale);
    Ok(picture.write_header()?.write_image_data(&pixels)?)
}

/// The case with this picture as its texture.
fn case(folder: &Path, size: usize, change: usize) -> Result<Arc<Case>, Box<dyn Error>> {
    let text =
        format!("slider.blocks = [{size}, {size}]\n[[texture]]\nshape = 'mask'\nfile = 'mask{change}.png'\n");
    Ok(Arc::new(Case::parse(&text, "painted", folder, &[])?))
}
