//! The results folder of a design: the design file, the journal of its runs, tables, the mask and a case that
//! reads it.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use serde::Deserialize;

use slipfront::device::Device;
use slipfront_plot::PictureLook;

use crate::design::{Design, Outcome};
use crate::evaluate::{MadeRun, RunCache};
use crate::file::{DESIGN, DesignFile};
use crate::report::{MASK_NAME, Report, VERDICT};
use crate::stages::{Bounds, RunCost, SearchLength, SearchProgress};
use slipfront_study::StudyError;
use slipfront_study::project_folder::{
    Batch, Journal, JournalEntry, Others, Project, ResultFiles, notes_of_use, read_numbers,
};

impl JournalEntry for MadeRun {
    const KEYS: &'static [&'static str] = &["ended"];
}

/// A results folder, with the runs that were kept in it.
#[derive(Debug)]
pub struct DesignFolder {
    path: PathBuf,
    files: ResultFiles,
    journal: Journal,
    known: RunCache,
    /// Lines of the journal that failed their checksum.
    pub damaged: usize,
    /// The design in the folder, which reads copies of its files.
    pub file: DesignFile,
    /// Device that makes the runs; none for the cores of this machine.
    device: Option<Arc<dyn Device>>,
}

impl DesignFolder {
    /// Opens a results folder: a new one, an empty one, or one of an earlier call that no other process uses.
    ///
    /// # Errors
    /// When the folder contains other files, or results that were edited afterwards, unless `force` is set;
    /// when another process uses it, or it cannot be written to.
    pub fn open(path: &Path, file: &DesignFile, force: bool) -> Result<Self, StudyError> {
        DESIGN.is_used(path)?;
        let given = file.project.given()?;
        let (journal, kept, damaged) = DESIGN.open_journal(path)?;
        let files = given.place(&DESIGN, path, force)?;
        let name = path.join(DESIGN.file).display().to_string();
        Ok(Self {
            path: path.to_owned(),
            files,
            journal,
            known: kept.into_iter().map(|run: MadeRun| (run.id, run.ended)).collect(),
            damaged,
            file: DesignFile::parse(&given.text, &name, &file.project.name, path)?,
            device: None,
        })
    }

    /// Makes the runs on a device, with the same results.
    #[must_use]
    pub fn on_device(mut self, device: Option<Arc<dyn Device>>) -> Self {
        self.device = device;
        self
    }

    /// Path of the folder.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Path of the file with the results as numbers.
    pub fn numbers(&self) -> PathBuf {
        self.path.join(VERDICT[0])
    }

    fn report<'a>(&'a self, batch: &'a mut Batch) -> Report<'a> {
        Report {
            path: &self.path,
            file: &self.file,
            batch,
        }
    }

    /// Sentences about a folder that has been used before.
    pub fn notes(&self) -> Vec<String> {
        notes_of_use(self.damaged, self.n_kept())
    }

    /// Number of runs that were kept.
    pub fn n_kept(&self) -> usize {
        self.known.len()
    }

    /// Finds the design, and the designs of a front if the file asks for one. Writes their results, and
    /// returns the verdict as text.
    ///
    /// # Errors
    /// As [`run`](Self::run), and when the system refuses to write.
    pub fn find(
        &mut self,
        bounds: &Bounds,
        watch: &mut dyn FnMut(&SearchProgress),
    ) -> Result<String, StudyError> {
        let design = self.file.design()?.on_device(self.device.clone());
        let mut of_front = FrontCost::new(self.file.keys.front.len());
        let outcome = self.run(&design, bounds, &mut |now| watch(&of_front.with(now)))?;
        let mut batch = self.files.begin();
        let mut text = self.report(&mut batch).write(&design, &outcome)?;
        let designs = self.file.designs_of_front()?;
        if !designs.is_empty() {
            // Keep the results of the design, even if its front fails.
            batch.place_so_far(Others::Go)?;
        }
        let mut front = Vec::new();
        for (percent, design) in designs {
            of_front.go_on();
            let design = design.on_device(self.device.clone());
            match self.judged(&design, bounds, &mut |now| watch(&of_front.with(now))) {
                Ok(outcome) => front.push((percent, Some((design, outcome)))),
                Err(StudyError::NoDesign { .. }) => front.push((percent, None)),
                Err(error) => return Err(error),
            }
        }
        text += &self.report(&mut batch).write_front(&front)?;
        batch.place(Others::Go, vec![self.journal.listed()?])?;
        Ok(text)
    }

    /// Searches and judges, or continues an earlier call. Every run is kept as soon as all runs of its batch
    /// have ended.
    ///
    /// # Errors
    /// As [`Design::run`]. After a stop, the folder contains the best texture so far without a verdict,
    /// unless it has the verdict of an earlier search.
    pub fn run(
        &mut self,
        design: &Design,
        bounds: &Bounds,
        watch: &mut dyn FnMut(&SearchProgress),
    ) -> Result<Outcome, StudyError> {
        let mut best = None;
        let mut watch = |now: &SearchProgress| {
            if let Some(texture) = &now.best_texture {
                best = Some((Arc::clone(texture), now.best_shares.clone()));
            }
            watch(now);
        };
        let found = self.judged(design, bounds, &mut watch);
        if let (Err(StudyError::Interrupted), Some((best, shares))) = (&found, best)
            && !self.has_verdict()
        {
            let mut batch = self.files.begin();
            self.report(&mut batch)
                .write_texture(design, &best, shares.as_deref())?;
            batch.place_so_far(Others::Stay)?;
        }
        found
    }

    /// Whether a search in the folder was finished, so that its results are there.
    pub fn has_verdict(&self) -> bool {
        self.numbers().exists()
    }

    /// Searches and judges with the runs of the journal, and appends new runs to it.
    fn judged(
        &mut self,
        design: &Design,
        bounds: &Bounds,
        watch: &mut dyn FnMut(&SearchProgress),
    ) -> Result<Outcome, StudyError> {
        let Self { journal, known, .. } = self;
        let mut keep = |runs: &[MadeRun]| journal.append(runs);
        design.run(bounds, known, &mut keep, watch)
    }
}

/// Cost of all designs of a front. Each of them costs about as much as the first.
#[derive(Default)]
struct FrontCost {
    /// Cost of the first design, once it is known.
    of_each: Option<f64>,
    /// Number of designs that follow.
    to_come: usize,
    /// Cost of the runs that were made for earlier designs.
    before: f64,
    /// Cost of the runs that were made for this design.
    here: f64,
}

impl FrontCost {
    fn new(to_come: usize) -> Self {
        Self {
            to_come,
            ..Self::default()
        }
    }

    /// Continues with the next design.
    fn go_on(&mut self) {
        self.to_come -= 1;
        self.before += std::mem::take(&mut self.here);
    }

    /// Progress of a design, with the cost of the others.
    fn with(&mut self, now: &SearchProgress) -> SearchProgress {
        let RunCost { here, left } = now.work;
        let of_each = *self.of_each.get_or_insert(here + left);
        self.here = here;
        SearchProgress {
            work: RunCost {
                here: self.before + here,
                left: left + self.to_come as f64 * of_each,
            },
            ..now.clone()
        }
    }
}

/// The part of the numbers that says whether there is a verdict.
#[derive(Deserialize)]
struct Decided {
    design: Lost,
}

#[derive(Deserialize)]
struct Lost {
    lost: Option<String>,
}

impl DesignFolder {
    /// Refuses a verdict if all textures are lost.
    ///
    /// # Errors
    /// A sentence with the name of the verdict; when the folder has none.
    pub fn expect_verdict(&self) -> Result<(), StudyError> {
        let [numbers, words] = VERDICT.map(|name| self.path().join(name));
        match read_numbers::<Decided>(&numbers)?.design.lost {
            None => Ok(()),
            Some(_) => Err(StudyError::NoVerdict { path: words }),
        }
    }
}

/// Length of the search that the results in a folder come from.
///
/// # Errors
/// When the file of the results cannot be read, or does not contain the length.
fn search_of(folder: &Path) -> Result<SearchLength, StudyError> {
    #[derive(Deserialize)]
    struct Found {
        search: SearchLength,
    }
    Ok(read_numbers::<Found>(&folder.join(VERDICT[0]))?.search)
}

/// Folders of designs.
pub const DESIGNS: Project = Project {
    kind: &DESIGN,
    no_pictures: &[MASK_NAME],
    beside: &[],
    verify_beside: None,
    find_again: Some(find_again),
};

/// Repeats a design in another folder from the runs in its journal.
fn find_again(
    folder: &Path,
    other: &Path,
    look: &PictureLook,
    stop: &AtomicBool,
) -> Result<[usize; 2], StudyError> {
    let search = search_of(folder)?;
    Journal::copy::<MadeRun>(folder, other, DESIGN.journal)?;
    let file = DesignFile::load(&folder.join(DESIGN.file))?;
    let mut again = DesignFolder::open(other, &file, false)?;
    again.files = again.files.with_look(look.clone());
    let kept = again.n_kept();
    let bounds = Bounds {
        runs: search.runs,
        share_of_time: &|| 0.0,
        stop,
        cut: search.cut,
    };
    again.find(&bounds, &mut |_| {})?;
    Ok([kept, again.n_kept()])
}
