//! Designs: the search for a texture.

use std::borrow::Cow;
use std::path::PathBuf;
use std::sync::Mutex;
use std::time::Instant;

use pyo3::prelude::*;
use pyo3::pybacked::PyBackedBytes;
use slipfront_design::{
    Bounds, Design as SlipfrontDesign, DesignFile, DesignFolder, OpenSearch, RunCache, SearchProgress,
};
use slipfront_study::StudyError;

use crate::process::{detached, detached_study, locked, on_pool};

/// A design: its file, and the textures that were returned and reported.
#[pyclass(frozen, module = "slipfront._slipfront")]
pub(crate) struct Design {
    file: DesignFile,
    design: SlipfrontDesign,
    search: Mutex<OpenSearch>,
    /// Runs that were made to evaluate textures.
    known: Mutex<RunCache>,
}

/// Textures as bytes of 0 and 1.
fn sets(masks: &[PyBackedBytes]) -> Vec<Vec<bool>> {
    let set = |mask: &PyBackedBytes| mask.iter().map(|&byte| byte != 0).collect();
    masks.iter().map(set).collect()
}

fn bytes(texture: &[bool]) -> Cow<'static, [u8]> {
    texture
        .iter()
        .map(|&is_in| u8::from(is_in))
        .collect::<Vec<u8>>()
        .into()
}

#[pymethods]
impl Design {
    /// The design of a text called `name`; the files it names are relative to a folder.
    #[staticmethod]
    fn parse(py: Python<'_>, text: &str, name: &str, folder: PathBuf) -> PyResult<Self> {
        Self::from_file(py, || DesignFile::parse(text, name, name, &folder))
    }

    /// The design of a file, with overrides of its base of the form KEY=VALUE.
    #[staticmethod]
    fn load(py: Python<'_>, path: PathBuf, overrides: Vec<String>) -> PyResult<Self> {
        Self::from_file(py, || {
            let mut file = DesignFile::load(&path)?;
            file.project.set(&overrides)?;
            Ok(file)
        })
    }

    #[getter]
    fn name(&self) -> &str {
        &self.file.project.name
    }

    /// Blocks along x and along y.
    #[getter]
    fn size(&self) -> [usize; 2] {
        self.design.size()
    }

    /// Reason why a texture is not legal; none if it is.
    fn illegal(&self, mask: PyBackedBytes) -> Option<String> {
        let [mask] = sets(&[mask]).try_into().ok()?;
        self.design.check(&mask).err().map(|error| error.to_string())
    }

    fn ask(&self, py: Python<'_>, n: usize) -> PyResult<Vec<Cow<'static, [u8]>>> {
        let asked = detached(py, || locked(&self.search).ask(n))?;
        Ok(asked.iter().map(|texture| bytes(texture)).collect())
    }

    fn tell(&self, py: Python<'_>, masks: Vec<PyBackedBytes>, losses: Vec<f64>) -> PyResult<()> {
        let rated = sets(&masks).into_iter().zip(losses).collect();
        detached(py, || locked(&self.search).tell(rated))
    }

    /// The best texture with a known loss, and its loss.
    fn best(&self) -> Option<(Cow<'static, [u8]>, f64)> {
        locked(&self.search)
            .best()
            .map(|(texture, loss)| (bytes(&texture), loss))
    }

    /// Losses of textures, distances from the target, on some surfaces; infinite, with the reason, for a
    /// texture without a loss.
    fn losses(
        &self,
        py: Python<'_>,
        masks: Vec<PyBackedBytes>,
        surfaces: u64,
        is_coarse: bool,
        threads: usize,
    ) -> PyResult<Vec<(f64, Option<String>)>> {
        let textures = sets(&masks);
        on_pool(
            py,
            "work",
            threads,
            None,
            |()| (),
            |stop, _| {
                let known = &mut *locked(&self.known);
                let losses = self.design.losses(textures, surfaces, is_coarse, known, stop)?;
                let with_reasons = losses.into_iter().map(|loss| match loss {
                    Ok(loss) => (loss, None),
                    Err(why) => (f64::INFINITY, Some(why)),
                });
                Ok(with_reasons.collect())
            },
        )
    }

    /// Searches in a folder, or continues there, and writes the results of the design; returns the verdict as
    /// a text. `folder` also says whether edited files there are replaced.
    fn execute(
        &self,
        py: Python<'_>,
        folder: (PathBuf, bool),
        runs: Option<usize>,
        seconds: Option<f64>,
        threads: usize,
        watch: Option<Py<PyAny>>,
    ) -> PyResult<String> {
        let (folder, force) = folder;
        let runs = runs.unwrap_or(self.file.keys.runs as usize);
        let mut opened = detached_study(py, || {
            self.file.check(runs, threads, seconds.is_some())?;
            DesignFolder::open(&folder, &self.file, force)
        })?;
        let numbers = |now: &SearchProgress| (now.runs, now.total, now.best);
        let began = Instant::now();
        on_pool(py, "work", threads, watch.as_ref(), numbers, |stop, show| {
            let share_of_time = || Bounds::share_of(began.elapsed().as_secs_f64(), seconds);
            let bounds = Bounds {
                runs,
                share_of_time: &share_of_time,
                stop,
                cut: None,
            };
            opened.find(&bounds, show)
        })
    }
}

impl Design {
    fn from_file(
        py: Python<'_>,
        read: impl FnOnce() -> Result<DesignFile, StudyError> + Send,
    ) -> PyResult<Self> {
        detached_study(py, || {
            let file = read()?;
            let design = file.design()?;
            let search = Mutex::new(design.open_search());
            Ok(Self {
                file,
                design,
                search,
                known: Mutex::default(),
            })
        })
    }
}
