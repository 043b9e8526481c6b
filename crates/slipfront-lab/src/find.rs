//! A search for a texture with less static friction than the painted one, in a thread of its own.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, Sender, TryRecvError, channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use slipfront_case::case::Case;
use slipfront_case::number_format::count;
use slipfront_run::pictures::texture_file::textured_blocks;
use slipfront_study::design::{Bounds, Design, Limits, Quantity, Wish};
use slipfront_study::{Sample, StudyError};

use crate::background::BackgroundTask;
use crate::protocol::{Estimate, FindingReply, SearchLimits};

/// How long a search looks for textures.
pub(crate) const SEARCH_TIME: Duration = Duration::from_secs(60);

/// Most runs of a search: as many as a design has unless its file says otherwise.
const MAX_RUNS: usize = 10_000;

/// Smallest width of a feature and of a gap, in blocks: what a laser writes has round corners, which three blocks can show.
const WIDTH: usize = 3;

/// Largest coverage, %, where nothing is painted.
const PLAIN_PERCENT: f64 = 10.0;

/// Largest coverage, %, where less than this is painted.
const LEAST_PERCENT: f64 = 3.0;

/// Most block-steps in which a texture is tried, for each thread: with some 1e8 of them in a second, there is time for several hundred
/// textures in a minute, and for a comparison of the best in less than another one.
const MAX_BLOCK_STEPS: f64 = 1e7;

/// Surfaces on which what was found is compared with what is painted; the search has seen none of them.
const FRESH_SURFACES: u64 = 8;

/// Confidence of the intervals.
const CONFIDENCE: f64 = 0.95;

/// What a search may use.
pub(crate) struct SearchBounds {
    /// How long it looks for textures.
    pub(crate) time: Duration,
    /// Runs at once.
    pub(crate) threads: usize,
}

/// A search that is under way. It ends when this is dropped.
pub(crate) struct TextureSearch {
    /// The gesture of the page that asked for it.
    pub(crate) gesture: u64,
    began: Instant,
    time: Duration,
    /// Ends the search, and has what was found by then compared.
    enough: Arc<AtomicBool>,
    state: Arc<Mutex<SearchState>>,
    outcome: Receiver<Result<Comparison, String>>,
    _work: BackgroundTask,
}

/// How far a search is.
#[derive(Default)]
struct SearchState {
    textures: usize,
    best_percent: Option<f64>,
    best_texture: Option<Arc<Vec<bool>>>,
    compares: bool,
}

/// What was found beside what is painted, on surfaces that the search has not seen.
pub(crate) struct Comparison {
    /// Textured blocks of what was found.
    pub(crate) texture: Arc<Vec<bool>>,
    /// Textures that were tried.
    pub(crate) textures: usize,
    /// Number of the surfaces.
    pub(crate) surfaces: usize,
    /// Change of static friction against the slider without texture, %.
    pub(crate) best: Option<Estimate>,
    /// What is painted changes of it, %; none where nothing is painted.
    pub(crate) painted: Option<Estimate>,
    /// Whether what was found is better than what is painted, by more than the scatter over surfaces.
    pub(crate) is_better: bool,
}

/// What a search for a case may find.
pub(crate) fn limits(case: &Case) -> SearchLimits {
    let painted = case.texture.meshed_percent;
    SearchLimits {
        width_blocks: WIDTH,
        most_percent: if painted > 0.0 {
            painted.max(LEAST_PERCENT)
        } else {
            PLAIN_PERCENT
        },
    }
}

impl TextureSearch {
    /// Begins a search for a case, in a thread that holds `working`.
    ///
    /// # Errors
    /// A sentence, if the slider is too narrow or too large for a search, or its files cannot be read any more.
    pub(crate) fn begin(
        case: &Case,
        gesture: u64,
        bounds: &SearchBounds,
        working: &Sender<()>,
    ) -> Result<Self, String> {
        let (design, painted) = design(case).map_err(|error| error.to_string())?;
        refuse_narrow(&design)?;
        refuse_large(&design, bounds)?;
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(bounds.threads)
            .build();
        let pool = pool.map_err(|error| format!("the system refuses threads for the search: {error}"))?;
        let (began, time) = (Instant::now(), bounds.time);
        let state = Arc::new(Mutex::new(SearchState::default()));
        let enough = Arc::new(AtomicBool::new(false));
        let (ends, outcome) = channel();
        let (shared, is_enough) = (Arc::clone(&state), Arc::clone(&enough));
        // A pool of its own: steps of the run that is shown would wait in that of all others until whole runs have ended.
        let work = BackgroundTask::spawn(working, move |stop| {
            let search = || find(&design, painted, [began, began + time], &is_enough, &shared, stop);
            // Nobody listens any more after the end of the session.
            let _ = ends.send(pool.install(search));
        });
        Ok(Self {
            gesture,
            began,
            time,
            enough,
            state,
            outcome,
            _work: work.map_err(|error| format!("the system refuses a thread for the search: {error}"))?,
        })
    }

    /// Ends the search; what it has found by then is compared with what is painted.
    pub(crate) fn stop(&self) {
        self.enough.store(true, Ordering::Relaxed);
    }

    /// Ends the search once its time is over, whatever it is doing then.
    pub(crate) fn stop_in_time(&self) {
        if self.began.elapsed() >= self.time {
            self.stop();
        }
    }

    /// What came of the search, once it has ended.
    pub(crate) fn outcome(&self) -> Option<Result<Comparison, String>> {
        match self.outcome.try_recv() {
            Ok(outcome) => Some(outcome),
            Err(TryRecvError::Empty) => None,
            Err(TryRecvError::Disconnected) => Some(Err(
                "the search failed by a defect of its own, which the terminal tells".to_owned(),
            )),
        }
    }

    /// How far the search is; `columns` is the number of blocks along x.
    pub(crate) fn progress(&self, columns: usize) -> FindingReply {
        let state = lock(&self.state);
        let texture = state.best_texture.as_deref();
        FindingReply {
            seconds: self.began.elapsed().min(self.time).as_secs_f64(),
            of_seconds: self.time.as_secs_f64(),
            textures: state.textures,
            compares: state.compares,
            best_percent: state.best_percent,
            best_texture: texture.map_or(Vec::new(), |texture| strips(texture, columns)),
        }
    }
}

impl Drop for TextureSearch {
    fn drop(&mut self) {
        self.stop();
    }
}

fn lock(state: &Mutex<SearchState>) -> MutexGuard<'_, SearchState> {
    // Nothing panics while it is locked.
    state.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The design that a search is for, and the painted blocks, if there are any.
fn design(case: &Case) -> Result<(Design, Option<Vec<bool>>), StudyError> {
    let allowed = limits(case);
    let limits = Limits {
        coverage: [0.0, allowed.most_percent],
        feature: allowed.width_blocks,
        gap: allowed.width_blocks,
        ..Limits::default()
    };
    let wish = Wish::Least(Quantity::StaticFriction);
    let mut design = Design::new(std::slice::from_ref(case), wish, false, limits, 1)?;
    let painted = Some(textured_blocks(case)).filter(|painted| painted.contains(&true));
    if let Some(painted) = &painted {
        design.begin_with("painted".to_owned(), painted.clone());
    }
    Ok((design, painted))
}

/// Refuses a slider that has no room for a feature.
fn refuse_narrow(design: &Design) -> Result<(), String> {
    let [nx, ny] = design.size();
    if nx.min(ny) < WIDTH {
        return Err(format!(
            "the slider has {nx} x {ny} blocks, where the narrowest feature that is searched for has {WIDTH}: take more blocks"
        ));
    }
    Ok(())
}

/// Refuses a slider of which too few textures can be tried in the time.
fn refuse_large(design: &Design, bounds: &SearchBounds) -> Result<(), String> {
    let needed = design
        .block_steps_per_texture()
        .map_err(|error| error.to_string())?;
    let most = MAX_BLOCK_STEPS * bounds.threads as f64;
    if needed > most {
        return Err(format!(
            "the slider is too large for a search of a minute: to try a texture takes {needed:.2e} block-steps, where at most {most:.0e} \
             leave time for some hundred textures on {}; take fewer blocks or a faster drive, or `slipfront design`, which takes as \
             long as it needs",
            count(bounds.threads, "thread")
        ));
    }
    Ok(())
}

/// Searches until `until`, and compares the best with what is painted.
fn find(
    design: &Design,
    painted: Option<Vec<bool>>,
    [began, until]: [Instant; 2],
    enough: &AtomicBool,
    state: &Mutex<SearchState>,
    stop: &AtomicBool,
) -> Result<Comparison, String> {
    let time = (until - began).as_secs_f64();
    let bounds = Bounds {
        runs: MAX_RUNS,
        share_of_time: &|| began.elapsed().as_secs_f64() / time,
        stop: enough,
    };
    let searched = design.search(&bounds, &mut |now| {
        let mut state = lock(state);
        state.textures = now.textures;
        if let Some(texture) = &now.best_texture {
            state.best_percent = Some(-now.best);
            state.best_texture = Some(Arc::clone(texture));
        }
    });
    let (best, textures) = {
        let mut state = lock(state);
        state.compares = true;
        (state.best_texture.clone(), state.textures)
    };
    let best = match searched {
        Ok(searched) => searched.into_iter().next(),
        // What was found before.
        Err(StudyError::Interrupted) => best,
        Err(StudyError::NoDesign) => {
            return Err(format!(
                "no texture whose features and gaps are {WIDTH} blocks wide covers as little of this slider as a search may: paint \
                 more, or take more blocks"
            ));
        }
        Err(error) => return Err(error.to_string()),
    };
    let best = best.ok_or("the search was stopped before it had tried a texture: nothing has changed")?;
    compare(design, best, painted, textures, stop).map_err(|error| error.to_string())
}

/// Compares what was found with what is painted, on surfaces that the search has not seen.
fn compare(
    design: &Design,
    best: Arc<Vec<bool>>,
    painted: Option<Vec<bool>>,
    textures: usize,
    stop: &AtomicBool,
) -> Result<Comparison, StudyError> {
    let both: Vec<Arc<Vec<bool>>> = [Arc::clone(&best)]
        .into_iter()
        .chain(painted.map(Arc::new))
        .collect();
    let losses = design.losses_on_fresh(&both, FRESH_SURFACES, stop)?;
    let changes = |losses: &Vec<f64>| {
        let changes: Vec<f64> = losses.iter().map(|loss| 100.0 * (loss - 1.0)).collect();
        estimate(&changes)
    };
    // Without texture nothing changes.
    let gain = |(surface, loss): (usize, &f64)| losses.get(1).map_or(1.0, |painted| painted[surface]) - loss;
    let gain: Vec<f64> = losses[0].iter().enumerate().map(gain).collect();
    Ok(Comparison {
        texture: best,
        textures,
        surfaces: losses[0].len(),
        best: changes(&losses[0]),
        painted: losses.get(1).and_then(changes),
        is_better: estimate(&gain).is_some_and(|gain| gain.mean - gain.half_width.unwrap_or(0.0) > 0.0),
    })
}

fn estimate(values: &[f64]) -> Option<Estimate> {
    let sample = Sample::of(values, CONFIDENCE)?;
    Some(Estimate {
        mean: sample.mean,
        half_width: sample.half_width,
    })
}

/// The strips of blocks of a texture along x: the row, the first column, and the one after the last.
fn strips(texture: &[bool], columns: usize) -> Vec<[usize; 3]> {
    let mut strips: Vec<[usize; 3]> = Vec::new();
    for block in (0..texture.len()).filter(|&block| texture[block]) {
        let [row, column] = [block / columns, block % columns];
        match strips.last_mut() {
            Some([last_row, _, end]) if *last_row == row && *end == column => *end += 1,
            _ => strips.push([row, column, column + 1]),
        }
    }
    strips
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strips_hold_every_block_of_a_texture() {
        let texture: Vec<bool> = "##.# .... ...# #..#"
            .bytes()
            .filter(|byte| *byte != b' ')
            .map(|byte| byte == b'#')
            .collect();
        assert_eq!(
            strips(&texture, 4),
            [[0, 0, 2], [0, 3, 4], [2, 3, 4], [3, 0, 1], [3, 3, 4]]
        );
    }
}
