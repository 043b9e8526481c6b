//! The files that slipfront has written to a results folder, with their checksums in `checksums.json`. The
//! files of a batch get their names together. A file that was edited afterwards, or that somebody else has
//! put there, is neither replaced nor removed.
//!
//! All files of a batch are first written under hidden names. Then the list is written, with the checksums of
//! the new files and of the files that they replace. Only then are the files renamed. So after a kill, all
//! files are still known to be slipfront's, and the folder equals its list only when everything is there.

use std::fs::File;
use std::io::Write;
use std::path::{Path, PathBuf};

use slipfront_base::disk::{
    folder_of, found_at, is_same, make_folders, open_regular, remove_if_there, sync_folder, write_beside,
};
use slipfront_plot::{Picture, PictureError, PictureLook, PictureSize};
use slipfront_run::folder_error::FolderError;
use slipfront_run::manifest::{ManifestFile, is_one_of};
use slipfront_run::program;
use tempfile::TempPath;

use super::checksums::Checksums;
use super::input_copies::Copy;
use crate::error::StudyError;
use crate::shard::Shard;

/// Result files of a folder that only one process uses.
#[derive(Clone, Debug)]
pub struct ResultFiles {
    folder: PathBuf,
    /// Content of the folder, such as `study`.
    content: &'static str,
    /// Part of the points of a study that the folder is for.
    part: Option<String>,
    /// Whether edited files are replaced.
    force: bool,
    /// Inputs of the results, which belong to every batch.
    given: Vec<ManifestFile>,
    /// Names of the user's own input files in the folder, which are neither replaced nor removed.
    kept: Vec<String>,
    /// The look of the pictures.
    look: PictureLook,
}

impl ResultFiles {
    /// The result files of a folder. `content` names it, such as `study`; `force` allows the replacement of
    /// edited files, but not of files that slipfront has not written.
    pub fn new(folder: &Path, content: &'static str, force: bool) -> Self {
        Self {
            folder: folder.to_owned(),
            content,
            part: None,
            force,
            given: Vec::new(),
            kept: Vec::new(),
            look: PictureLook::default(),
        }
    }

    /// The files with pictures in another look.
    #[must_use]
    pub fn with_look(self, look: PictureLook) -> Self {
        Self { look, ..self }
    }

    /// Refuses a folder with files that were edited after they were written. To be called before the work
    /// that replaces them begins.
    ///
    /// # Errors
    /// When there are such files, unless they may be replaced.
    pub fn expect_unedited(&self) -> Result<(), StudyError> {
        let list = self.list()?;
        let mut edited = Vec::new();
        for ManifestFile { name, .. } in &list.files {
            if !self.is_own(name, &list, None)? {
                edited.push(name.clone());
            }
        }
        self.refuse(edited, &list)
    }

    /// A new batch of files to write.
    pub fn begin(&self) -> Batch {
        Batch {
            files: self.clone(),
            staged: Vec::new(),
            placed: self.given.clone(),
            replaceable: None,
        }
    }

    /// The list in the folder; an empty one if there is none. If edited files may be replaced, the list
    /// itself may have been edited.
    fn list(&self) -> Result<Checksums, StudyError> {
        match Checksums::read(&self.folder) {
            Err(StudyError::Checksums { .. }) if self.force => {
                Ok(Checksums::unsealed(&self.folder).unwrap_or_default())
            }
            list => Ok(list?.unwrap_or_default()),
        }
    }

    /// Whether a name is free, or its file equals one of the list or the new file.
    fn is_own(&self, name: &str, list: &Checksums, new: Option<&ManifestFile>) -> Result<bool, StudyError> {
        if self.in_place_of_folder(name)?.is_some() {
            return Ok(false);
        }
        let path = self.folder.join(name);
        let known = list.files.iter().chain(&list.replaced).chain(new);
        let is_known = is_one_of(&self.folder, name, known).map_err(FolderError::read(&path))?;
        Ok(is_known.unwrap_or(true))
    }

    /// A link or a file in place of a parent folder of the file of this name: it may lead out of the results
    /// folder, to foreign files.
    fn in_place_of_folder(&self, name: &str) -> Result<Option<PathBuf>, StudyError> {
        let path = self.folder.join(name);
        for above in path.ancestors().skip(1).take_while(|above| *above != self.folder) {
            let found = found_at(above).map_err(FolderError::read(above))?;
            if found.is_some_and(|found| !found.is_dir()) {
                return Ok(Some(above.to_owned()));
            }
        }
        Ok(None)
    }

    /// Whether this file is there already.
    fn is_there(&self, file: &ManifestFile) -> bool {
        matches!(is_one_of(&self.folder, &file.name, [file]), Ok(Some(true)))
    }

    /// Removes files, and then gives hidden files their names: a kill in between leaves no table of another
    /// study beside the new one.
    fn rename_and_remove(
        &self,
        to_place: Vec<(TempPath, ManifestFile)>,
        gone: &[String],
    ) -> Result<(), StudyError> {
        let failed = |path: &Path| {
            let path = path.to_owned();
            |source| StudyError::Write { path, source }
        };
        let sync = |mut changed: Vec<PathBuf>| {
            changed.sort();
            changed.dedup();
            let mut folders = changed.iter();
            folders.try_for_each(|folder| sync_folder(folder).map_err(failed(folder)))
        };
        let mut changed = Vec::new();
        for name in gone {
            let path = self.folder.join(name);
            remove_if_there(&path).map_err(failed(&path))?;
            changed.push(folder_of(&path).to_owned());
        }
        sync(changed)?;
        let mut changed = vec![self.folder.clone()];
        for (file, ManifestFile { name, .. }) in to_place {
            let path = self.folder.join(name);
            file.persist(&path).map_err(|error| failed(&path)(error.error))?;
            changed.push(folder_of(&path).to_owned());
        }
        sync(changed)
    }

    /// Refuses files that are in the way, except those of the list if edited files may be replaced.
    fn refuse(&self, mut names: Vec<String>, list: &Checksums) -> Result<(), StudyError> {
        let is_listed = |name: &String| {
            list.files
                .iter()
                .chain(&list.replaced)
                .any(|file| file.name == *name)
        };
        names.retain(|name| !(self.force && is_listed(name)));
        if names.is_empty() {
            return Ok(());
        }
        Err(StudyError::Edited {
            of: self.content,
            path: self.folder.clone(),
            names,
        })
    }
}

/// Files that get their names together.
pub struct Batch {
    files: ResultFiles,
    /// Files under hidden names.
    staged: Vec<(TempPath, ManifestFile)>,
    /// Files that have their names already.
    placed: Vec<ManifestFile>,
    /// Name of a file that may be replaced although it was edited.
    replaceable: Option<String>,
}

/// Treatment of files of earlier batches that a batch does not write.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Others {
    /// Files of earlier batches stay.
    Stay,
    /// Files of earlier batches are removed, since they belong to other results.
    Go,
}

impl Batch {
    /// Writes a file, under a hidden name at first.
    ///
    /// # Errors
    /// When the system refuses to write.
    pub fn write(
        &mut self,
        name: &str,
        fill: impl FnOnce(&mut File) -> std::io::Result<()>,
    ) -> Result<(), StudyError> {
        if let Some(path) = self.files.in_place_of_folder(name)? {
            return Err(FolderError::Foreign { path }.into());
        }
        let path = self.files.folder.join(name);
        let stage = || {
            make_folders(folder_of(&path))?;
            // There may be too many files to keep them open. The caller has locked the folder against other
            // processes.
            let file = write_beside(&path, fill)?.into_temp_path();
            let listed = ManifestFile::read_copy(name, &file)?;
            Ok((file, listed))
        };
        let staged = stage();
        self.staged
            .push(staged.map_err(|source| StudyError::Write { path, source })?);
        Ok(())
    }

    /// The look of the pictures.
    pub fn look(&self) -> &PictureLook {
        &self.files.look
    }

    /// Draws a picture in the requested size, and writes it in its formats; skips a picture that is not
    /// requested.
    ///
    /// # Errors
    /// When the picture cannot be drawn, or the system refuses to write.
    pub fn draw(
        &mut self,
        name: &str,
        draw: impl FnOnce(PictureSize) -> Result<Picture, PictureError>,
    ) -> Result<(), StudyError> {
        if !self.look().draws(name) {
            return Ok(());
        }
        let picture = draw(self.look().size).map_err(StudyError::picture(name))?;
        self.write_picture(name, &picture)
    }

    /// Writes a picture in its formats.
    ///
    /// # Errors
    /// When the system refuses to write.
    pub fn write_picture(&mut self, name: &str, picture: &Picture) -> Result<(), StudyError> {
        for format in self.look().formats.clone() {
            let file = format!("{name}.{}", format.ending());
            self.write(&file, |to| to.write_all(&picture.file(format)))?;
        }
        Ok(())
    }

    /// Marks the folder as that of a part of a study.
    pub(crate) fn is_of_part(&mut self, part: Option<Shard>) {
        self.files.part = part.map(|part| part.to_string());
    }

    /// Lets a file be replaced although it was edited.
    pub fn may_replace(&mut self, name: &str) {
        self.replaceable = Some(name.to_owned());
    }

    /// Copies files that cases read to the names that a study gives the copies. A user may have put such a
    /// file there already.
    pub fn copy_all(&mut self, copies: &[Copy]) -> Result<(), StudyError> {
        for Copy { name, original, .. } in copies {
            let to = self.files.folder.join(name);
            if is_same(original, &to) {
                self.files.kept.push(name.clone());
                continue;
            }
            let mut original = open_regular(original).map_err(FolderError::read(original))?;
            self.write(name, |to| std::io::copy(&mut original, to).map(drop))?;
        }
        Ok(())
    }

    /// Gives the input files of the results their names; they belong to all later batches.
    ///
    /// # Errors
    /// As for [`place`](Self::place).
    pub fn place_given(mut self, others: Others) -> Result<ResultFiles, StudyError> {
        self.put(others, None)?;
        Ok(ResultFiles {
            given: self.placed,
            ..self.files
        })
    }

    /// Gives the files of incomplete results their names. The batch continues.
    ///
    /// # Errors
    /// As for [`place`](Self::place).
    pub fn place_so_far(&mut self, others: Others) -> Result<(), StudyError> {
        self.put(others, None)
    }

    /// Gives all files their names, lists them with their checksums, and marks the results as complete, with
    /// the `sources` that they follow from. Existing files with the same contents are left unchanged.
    ///
    /// # Errors
    /// When an existing file with one of these names, or a file of an earlier batch, was edited or is
    /// foreign, unless such files may be replaced; then nothing is changed. When the system refuses to write.
    pub fn place(mut self, others: Others, sources: Vec<ManifestFile>) -> Result<(), StudyError> {
        self.put(others, Some(sources))
    }

    fn put(&mut self, others: Others, sources_of_all: Option<Vec<ManifestFile>>) -> Result<(), StudyError> {
        let Self {
            files,
            staged,
            placed,
            replaceable,
        } = self;
        let folder = &files.folder;
        let before = files.list()?;
        let mut foreign = Vec::new();
        let mut listed: Vec<ManifestFile> = placed.clone();
        for (_, file) in &*staged {
            let may_go = replaceable.as_ref() == Some(&file.name);
            if !may_go && !files.is_own(&file.name, &before, Some(file))? {
                foreign.push(file.name.clone());
            }
            listed.retain(|placed| placed.name != file.name);
            listed.push(file.clone());
        }
        let mut gone = Vec::new();
        let is_listed = |name: &str| before.files.iter().any(|file| file.name == name);
        // Files that a killed process still had to remove.
        let left = before.replaced.iter().filter(|file| !is_listed(&file.name));
        for file in before.files.iter().chain(left) {
            let ManifestFile { name, .. } = file;
            if listed.iter().any(|new| new.name == *name) {
                continue;
            }
            let is_own = files.is_own(name, &before, None)?;
            if files.kept.contains(name) {
                // A file that the user has changed belongs to the user from now on.
                listed.extend((is_own && is_listed(name)).then(|| file.clone()));
                continue;
            }
            if !is_own {
                foreign.push(name.clone());
            } else if others == Others::Go || !is_listed(name) {
                gone.push(name.clone());
            }
            if others == Others::Stay && is_listed(name) {
                listed.push(file.clone());
            }
        }
        files.refuse(foreign, &before)?;
        listed.sort_by(|a, b| a.name.cmp(&b.name));
        let staged = std::mem::take(staged);
        placed.retain(|placed| staged.iter().all(|(_, file)| file.name != placed.name));
        placed.extend(staged.iter().map(|(_, file)| file.clone()));
        let to_place: Vec<_> = staged
            .into_iter()
            .filter(|(_, file)| !files.is_there(file))
            .collect();
        let changes = !to_place.is_empty() || !gone.is_empty();
        // Includes files that a killed process still had to replace.
        let mut replaced: Vec<ManifestFile> = Vec::new();
        for file in before.files.iter().chain(&before.replaced) {
            let stays = listed.iter().any(|new| new.name == file.name);
            if (stays || gone.contains(&file.name)) && !listed.contains(file) && !replaced.contains(file) {
                replaced.push(file.clone());
            }
        }
        let (is_complete, sources) = match sources_of_all {
            Some(sources) => (true, sources),
            None if before.is_complete && !changes => (true, before.sources.clone()),
            None => (false, Vec::new()),
        };
        let mut list = Checksums {
            of: files.content.to_owned(),
            part: files.part.clone(),
            version: program::VERSION.to_owned(),
            revision: program::REVISION.map(str::to_owned),
            build: program::this_build().to_owned(),
            files: listed,
            is_complete,
            sources,
            replaced,
            seal: String::new(),
        };
        if !changes && !before.build.is_empty() {
            // Another program may have written these files.
            (list.version, list.revision) = (before.version.clone(), before.revision.clone());
            list.build.clone_from(&before.build);
        }
        let before = Checksums {
            seal: String::new(),
            ..before
        };
        if !changes && list == before {
            return Ok(());
        }
        list.clone().write(folder)?;
        files.rename_and_remove(to_place, &gone)?;
        let is_to_come = |old: &ManifestFile| {
            list.files
                .iter()
                .any(|new| new.name == old.name && !files.is_there(new))
        };
        let to_come: Vec<ManifestFile> = list
            .replaced
            .iter()
            .filter(|old| is_to_come(old))
            .cloned()
            .collect();
        if to_come == list.replaced {
            return Ok(());
        }
        let list = Checksums {
            replaced: to_come,
            ..list
        };
        list.write(folder)
    }
}

#[cfg(test)]
mod tests {
    use super::super::checksums::CHECKSUMS;
    use super::*;

    fn batch_of(files: &ResultFiles, contents: &[(&str, &str)]) -> Batch {
        let mut batch = files.begin();
        for (name, text) in contents {
            batch.write(name, |to| to.write_all(text.as_bytes())).unwrap();
        }
        batch
    }

    fn place(files: &ResultFiles, contents: &[(&str, &str)]) -> Result<(), StudyError> {
        batch_of(files, contents).place(Others::Go, Vec::new())
    }

    fn read(folder: &Path, name: &str) -> Option<String> {
        std::fs::read_to_string(folder.join(name)).ok()
    }

    fn listed(folder: &Path) -> Vec<String> {
        let list = Checksums::read(folder).unwrap().unwrap();
        list.files.into_iter().map(|file| file.name).collect()
    }

    #[test]
    fn results_take_the_places_of_earlier_ones() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path();
        let files = ResultFiles::new(path, "study", false);
        let given = batch_of(&files, &[("study.toml", "base"), ("inputs/mask.png", "mask")]);
        let files = given.place_given(Others::Stay).unwrap();
        place(&files, &[("runs.csv", "1"), ("old.svg", "<svg/>")]).unwrap();
        let before = std::fs::read(path.join(CHECKSUMS)).unwrap();
        place(&files, &[("runs.csv", "1"), ("old.svg", "<svg/>")]).unwrap();
        assert_eq!(std::fs::read(path.join(CHECKSUMS)).unwrap(), before);
        place(&files, &[("runs.csv", "2"), ("new.svg", "<svg></svg>")]).unwrap();
        assert_eq!(read(path, "runs.csv").unwrap(), "2");
        assert_eq!(read(path, "old.svg"), None);
        assert_eq!(
            listed(path),
            ["inputs/mask.png", "new.svg", "runs.csv", "study.toml"]
        );
        assert!(Checksums::read(path).unwrap().unwrap().replaced.is_empty());
        // Hidden files are gone.
        assert_eq!(std::fs::read_dir(path).unwrap().count(), 5);
    }

    #[test]
    fn edited_files_and_files_of_others_are_refused_by_name_and_edited_ones_replaced_on_demand() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path();
        let files = ResultFiles::new(path, "design", false);
        place(&files, &[("mask.dxf", "1"), ("case.toml", "1"), ("old.csv", "1")]).unwrap();
        std::fs::write(path.join("mask.dxf"), "mine").unwrap();
        std::fs::write(path.join("old.csv"), "mine").unwrap();
        std::fs::write(path.join("design.txt"), "notes of mine").unwrap();
        let results = [("mask.dxf", "2"), ("case.toml", "2"), ("design.txt", "2")];
        let said = files.expect_unedited().unwrap_err().to_string();
        assert!(
            said.contains("mask.dxf, old.csv") && said.contains("--force"),
            "{said}"
        );
        let said = place(&files, &results).unwrap_err().to_string();
        assert!(said.contains("mask.dxf, design.txt, old.csv"), "{said}");
        assert_eq!(read(path, "case.toml").unwrap(), "1");
        let forced = ResultFiles::new(path, "design", true);
        forced.expect_unedited().unwrap();
        let said = place(&forced, &results).unwrap_err().to_string();
        assert!(said.contains(": design.txt; move them away"), "{said}");
        assert_eq!(read(path, "design.txt").unwrap(), "notes of mine");
        std::fs::remove_file(path.join("design.txt")).unwrap();
        place(&forced, &results).unwrap();
        for (name, text) in results {
            assert_eq!(read(path, name).unwrap(), text);
        }
        // The file no longer belongs to the results, and is not removed.
        assert_eq!(read(path, "old.csv").unwrap(), "mine");
        place(&files, &results).unwrap();
    }

    /// At whatever point a process was killed, the next call knows which files are slipfront's.
    #[test]
    fn a_kill_between_list_and_files_is_made_good() {
        let before = [("a.csv", "1"), ("gone.csv", "1"), ("b.csv", "1")];
        let after = [("a.csv", "2"), ("b.csv", "1"), ("c.csv", "2")];
        for done in 0..=3 {
            let folder = tempfile::tempdir().unwrap();
            let path = folder.path();
            let files = ResultFiles::new(path, "study", false);
            place(&files, &before).unwrap();
            let old = Checksums::read(path).unwrap().unwrap();
            let names = |name: &str| old.files.iter().find(|file| file.name == name).unwrap().clone();
            Checksums {
                files: after
                    .iter()
                    .map(|(name, text)| ManifestFile::of_bytes(name, text.as_bytes()))
                    .collect(),
                replaced: vec![names("a.csv"), names("gone.csv")],
                ..old.clone()
            }
            .write(path)
            .unwrap();
            if done > 0 {
                std::fs::write(path.join("a.csv"), "2").unwrap();
            }
            if done > 1 {
                std::fs::write(path.join("c.csv"), "2").unwrap();
            }
            if done > 2 {
                std::fs::remove_file(path.join("gone.csv")).unwrap();
            }
            files.expect_unedited().unwrap();
            // The folder may be opened several times before its results are written.
            for _ in 0..2 {
                batch_of(&files, &[("study.toml", "base")])
                    .place_given(Others::Stay)
                    .unwrap();
            }
            place(&files, &after).unwrap();
            for (name, text) in after {
                assert_eq!(read(path, name).unwrap(), text, "{done}");
            }
            assert_eq!(read(path, "gone.csv"), None, "{done}");
            assert!(
                Checksums::read(path).unwrap().unwrap().replaced.is_empty(),
                "{done}"
            );
        }
    }

    /// A list from elsewhere cannot remove files outside of its folder.
    #[test]
    fn a_list_leads_to_no_file_elsewhere() {
        let above = tempfile::tempdir().unwrap();
        let path = above.path().join("out");
        std::fs::create_dir(&path).unwrap();
        let mine = above.path().join("mine");
        std::fs::write(&mine, "mine").unwrap();
        for name in ["../mine", mine.to_str().unwrap()] {
            let list = Checksums {
                files: vec![ManifestFile::of_bytes(name, b"mine")],
                ..Checksums::default()
            };
            list.write(&path).unwrap();
            let files = ResultFiles::new(&path, "study", false);
            let said = place(&files, &[("a.csv", "1")]).unwrap_err().to_string();
            assert!(said.contains("is outside the folder"), "{said}");
            place(&ResultFiles::new(&path, "study", true), &[("a.csv", "1")]).unwrap();
            assert!(mine.exists());
        }
    }

    /// A file that a user has put among the copies, and that a study reads there, belongs to the user.
    #[test]
    fn inputs_of_the_user_stay_in_the_folder() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path();
        std::fs::create_dir(path.join("inputs")).unwrap();
        std::fs::write(path.join("inputs/mine.png"), "mine").unwrap();
        let mut study: toml::Table = "base.texture = [{ shape = 'mask', file = 'inputs/mine.png' }]"
            .parse()
            .unwrap();
        let copies = super::super::input_copies::copy(&mut study, path).unwrap();
        let mut given = ResultFiles::new(path, "study", false).begin();
        given.copy_all(&copies).unwrap();
        let files = given.place_given(Others::Go).unwrap();
        place(&files, &[("runs.csv", "1")]).unwrap();
        assert_eq!(listed(path), ["runs.csv"]);
        place(&ResultFiles::new(path, "study", false), &[("runs.csv", "2")]).unwrap();
        assert_eq!(read(path, "inputs/mine.png").unwrap(), "mine");
    }

    #[test]
    fn a_changed_list_says_nothing_of_files() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path();
        let files = ResultFiles::new(path, "study", false);
        place(&files, &[("a.csv", "1")]).unwrap();
        let text = read(path, CHECKSUMS).unwrap();
        std::fs::write(
            path.join(CHECKSUMS),
            text.replace("is_complete\": true", "is_complete\": false"),
        )
        .unwrap();
        let said = place(&files, &[("a.csv", "2")]).unwrap_err().to_string();
        assert!(said.contains("checksums.json is damaged"), "{said}");
        assert_eq!(read(path, "a.csv").unwrap(), "1");
        place(&ResultFiles::new(path, "study", true), &[("a.csv", "2")]).unwrap();
        assert_eq!(read(path, "a.csv").unwrap(), "2");
    }

    #[cfg(unix)]
    #[test]
    fn links_and_folders_in_the_place_of_results_are_refused() {
        let (folder, other) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
        let path = folder.path();
        let files = ResultFiles::new(path, "study", false);
        std::os::unix::fs::symlink(other.path(), path.join("inputs")).unwrap();
        let mut batch = files.begin();
        assert!(
            batch
                .write("inputs/mask.png", |to| to.write_all(b"mask"))
                .is_err()
        );
        assert_eq!(std::fs::read_dir(other.path()).unwrap().count(), 0);
        let mine = other.path().join("mine");
        std::fs::write(&mine, "1").unwrap();
        std::os::unix::fs::symlink(&mine, path.join("a.csv")).unwrap();
        std::fs::create_dir(path.join("b.csv")).unwrap();
        for name in ["a.csv", "b.csv"] {
            let said = place(&files, &[(name, "1")]).unwrap_err().to_string();
            assert!(said.contains(name), "{said}");
        }
        assert_eq!(read(other.path(), "mine").unwrap(), "1");
    }
}
