//! Pictures of a study or of another project, drawn again in a requested look from the recorded runs in its
//! folder. The folder is not changed.

use std::path::Path;
use std::sync::atomic::AtomicBool;

use slipfront_base::disk::read_limited;
use slipfront_base::unfinished::TemporaryFolder;
use slipfront_plot::{PictureFormat, PictureLook};
use slipfront_run::folder_error::FolderError;
use slipfront_run::verify::VerifyError;

use crate::error::StudyError;
use crate::project_folder::{Checksums, Project};
use crate::write::STUDY_FOLDERS;

/// Largest number of bytes of a picture.
const MAX_BYTES: u64 = 1 << 30;

/// Files of pictures: their names and contents.
type PictureFiles = Vec<(String, Vec<u8>)>;

/// The folder of a finished study, or of another finished project.
pub struct PicturesOf<'f> {
    folder: &'f Path,
    /// The kind of the project.
    project: &'f Project,
    /// Names of its pictures, without their endings.
    pub names: Vec<String>,
}

/// The pictures of a folder if it is that of a study, or of a project of one of these `others`.
///
/// # Errors
/// When the results of the folder are not complete, or its list cannot be read.
pub fn pictures_of<'f>(
    folder: &'f Path,
    others: &'f [Project],
) -> Result<Option<PicturesOf<'f>>, StudyError> {
    let mut all = others.iter().chain([&STUDY_FOLDERS]);
    let Some(project) = all.find(|project| project.kind.is_in(folder)) else {
        return Ok(None);
    };
    let list = Checksums::read(folder)?.unwrap_or_default();
    if !list.is_complete {
        return Err(StudyError::Unfinished {
            what: project.kind.name,
            path: folder.to_owned(),
        });
    }
    let no_pictures = project.no_pictures;
    let names = list.files.iter().map(|file| file.name.as_str());
    Ok(Some(PicturesOf {
        folder,
        project,
        names: names
            .filter_map(|name| picture_name(name, PictureFormat::Svg, no_pictures))
            .collect(),
    }))
}

/// The name of the picture if a file is a picture in this format; none for other files.
fn picture_name(file: &str, format: PictureFormat, no_pictures: &[&str]) -> Option<String> {
    let name = file.strip_suffix(format.ending())?.strip_suffix('.')?;
    let is_one = !name.contains('/') && !no_pictures.contains(&name);
    is_one.then(|| name.to_owned())
}

impl PicturesOf<'_> {
    /// Draws the pictures from the recorded runs, and returns their files.
    ///
    /// # Errors
    /// When runs are missing, a picture cannot be drawn, or the system refuses to read or to write; after a
    /// stop.
    pub fn draw(&self, look: &PictureLook, stop: &AtomicBool) -> Result<PictureFiles, StudyError> {
        let temporary = TemporaryFolder::new(self.folder).map_err(VerifyError::Temporary)?;
        self.project.again(self.folder, temporary.path(), look, stop)?;
        let no_pictures = self.project.no_pictures;
        let is_picture = |name: &str| {
            let mut formats = look.formats.iter();
            formats.any(|format| picture_name(name, *format, no_pictures).is_some())
        };
        let listed = Checksums::read(temporary.path())?.unwrap_or_default().files;
        let pictures = listed.into_iter().filter(|file| is_picture(&file.name));
        pictures
            .map(|file| {
                let path = temporary.path().join(&file.name);
                let bytes = read_limited(&path, MAX_BYTES).map_err(FolderError::read(&path))?;
                Ok((file.name, bytes))
            })
            .collect()
    }
}
