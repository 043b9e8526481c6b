//! A search for a texture with less static friction than the painted one, and its comparison with the painted
//! one.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use slipfront_base::number_format::count;
use slipfront_case::texture_file::textured_blocks;
use slipfront_design::{Bounds, Design, Limits, Quantity, Wish};
use slipfront_study::StudyError;

use crate::document::Document;
use crate::event::{Event, EventKind, Mask, SearchUpdate, Worker};
use crate::protocol::{Estimate, FoundOutcome, FoundReply};
use crate::search::{NOTHING_TRIED, SEARCH_TIME, WIDTH, limits};
use crate::sentence::sentence;

/// Largest number of runs of a search: the default of a design.
const MAX_RUNS: usize = 10_000;

/// Number of surfaces, unseen by the search, on which the best texture is compared with the painted one.
const FRESH_SURFACES: u64 = 8;

/// Largest number of block-steps per texture and thread. With some 1e8 block-steps per second, there is time
/// for several hundred textures in a minute, and for the comparison of the best one in less than another
/// minute.
const MAX_BLOCK_STEPS: f64 = 1e7;

/// The design problem of a search for a document, and the painted blocks, if there are any.
fn design_for(document: &Document, stop: &AtomicBool) -> Result<(Design, Option<Vec<bool>>), String> {
    let case = document.case_unless(stop)?;
    let allowed = limits(&case);
    let limits = Limits {
        coverage: [0.0, allowed.most_percent],
        feature: allowed.width_blocks as f64,
        gap: allowed.width_blocks,
        ..Limits::default()
    };
    let wish = Wish::Least(Quantity::StaticFriction);
    let mut design = Design::new(&[(&case, wish)], false, limits, 1).map_err(sentence)?;
    let painted = Some(textured_blocks(&case)).filter(|painted| painted.contains(&true));
    if let Some(painted) = &painted {
        design.begin_with("painted".to_owned(), painted.clone(), None);
    }
    Ok((design, painted))
}

/// Refuses a slider without room for a feature.
fn refuse_narrow(design: &Design) -> Result<(), String> {
    let [nx, ny] = design.size();
    if nx.min(ny) < WIDTH {
        return Err(format!(
            "the slider has {nx} x {ny} blocks, where the narrowest feature that is searched for has {WIDTH}: take more blocks"
        ));
    }
    Ok(())
}

/// Refuses a slider that is too large for `threads` threads to try enough textures in the time.
fn refuse_large(design: &Design, threads: usize) -> Result<(), String> {
    let needed = design.block_steps_per_texture().map_err(sentence)?;
    let most = MAX_BLOCK_STEPS * threads as f64;
    if needed > most {
        return Err(format!(
            "the slider is too large for a search of a minute: to try a texture takes {needed:.2e} block-steps, where at most {most:.0e} \
             leave time for some hundred textures on {}; take fewer blocks or a faster drive, or `slipfront design`, which takes as \
             long as it needs",
            count(threads, "thread")
        ));
    }
    Ok(())
}

/// Searches for a texture for [`SEARCH_TIME`], and returns the best one.
///
/// # Errors
/// A sentence, if there is none, or the search was stopped.
pub(super) fn search(document: &Document, worker: &dyn Worker) -> Result<Mask, String> {
    let began = worker.now();
    let (design, _) = design_for(document, worker.stop())?;
    refuse_narrow(&design)?;
    refuse_large(&design, rayon::current_num_threads())?;
    let bounds = Bounds {
        runs: MAX_RUNS,
        share_of_time: &|| (worker.now() - began).as_secs_f64() / SEARCH_TIME.as_secs_f64(),
        stop: worker.stop(),
        cut: None,
    };
    let searched = design.search(&bounds, &mut |now| {
        worker.send(Event(EventKind::Tried(SearchUpdate {
            textures: now.textures,
            best_percent: now.best_texture.is_some().then_some(-now.best),
            best_texture: now.best_texture.clone().map(Mask),
        })));
    });
    let best = searched.map_err(|error| match error {
        StudyError::NoDesign { .. } => format!(
            "no texture whose features and gaps are {WIDTH} blocks wide covers as little of this slider as a search may: paint more, or \
             take more blocks"
        ),
        error => error.to_string(),
    })?;
    best.into_iter()
        .next()
        .map(Mask)
        .ok_or_else(|| NOTHING_TRIED.to_owned())
}

/// Compares the best texture of a search with the painted one, on surfaces that the search has not seen. It
/// is to replace the painted one if it is better by more than the scatter over surfaces.
///
/// # Errors
/// A sentence, if runs cannot be made, or the comparison was stopped.
pub(super) fn compare(document: &Document, best: &Mask, stop: &AtomicBool) -> Result<FoundReply, String> {
    let (design, painted) = design_for(document, stop)?;
    let both: Vec<Arc<Vec<bool>>> = [Arc::clone(&best.0)]
        .into_iter()
        .chain(painted.map(Arc::new))
        .collect();
    let losses = design
        .losses_on_fresh(&both, FRESH_SURFACES, stop)
        .map_err(sentence)?;
    let changes = |losses: &Vec<f64>| {
        let changes: Vec<f64> = losses.iter().map(|loss| 100.0 * (loss - 1.0)).collect();
        Estimate::from_values(&changes)
    };
    // Without texture nothing changes.
    let gain = |(surface, loss): (usize, &f64)| losses.get(1).map_or(1.0, |painted| painted[surface]) - loss;
    let gain: Vec<f64> = losses[0].iter().enumerate().map(gain).collect();
    let is_better =
        Estimate::from_values(&gain).is_some_and(|gain| gain.mean - gain.half_width.unwrap_or(0.0) > 0.0);
    Ok(FoundReply {
        outcome: match is_better {
            true => FoundOutcome::Replaced,
            false => FoundOutcome::Kept,
        },
        textures: 0,
        surfaces: losses[0].len(),
        best: changes(&losses[0]),
        painted: losses.get(1).and_then(changes),
    })
}
