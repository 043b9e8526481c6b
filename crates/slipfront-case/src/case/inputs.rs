//! Files that a case reads.

use std::collections::HashMap;
use std::fs::File;
use std::io::BufReader;
use std::path::{Path, PathBuf};

use blake3::Hasher;
use slipfront::Lattice;

use super::ranks::Ranks;
use crate::arrays::{self, ArrayError, Slab};
use crate::case_file::{CaseError, CaseFile, FileUse};

/// Told the share that is done of laying the texture over the blocks; `false` ends it.
pub type Watch<'a> = dyn FnMut(f64) -> bool + 'a;

/// A file that a case reads, and of which the run folder holds a copy.
#[derive(Clone, Debug, PartialEq)]
pub struct Input {
    /// Path of its copy in the run folder.
    pub name: String,
    /// Path that it is read from.
    pub original: PathBuf,
    /// Its length in bytes.
    pub length: u64,
    /// Hash of its contents, taken before the case was made of them: a copy that is made afterwards and has the same one holds
    /// what the case was made of.
    pub hash: blake3::Hash,
}

/// Names the copy of a file in the folder `inputs/` after its plain name; files of one name and different contents are
/// numbered. Gives the name, and whether there is such a copy already.
///
/// `is_same` says of a name whether the copy that has it, if there is one, has the contents of the file.
pub fn name_of_copy(plain: &str, is_same: impl Fn(&str) -> Option<bool>) -> (String, bool) {
    let mut name = format!("inputs/{plain}");
    let mut number = 1;
    while let Some(is_same) = is_same(&name) {
        if is_same {
            return (name, true);
        }
        number += 1;
        name = format!("inputs/{number}-{plain}");
    }
    (name, false)
}

/// Length and hash of a file as integers.
type Digest = [i64; 5];

/// Files that a case names, relative to a folder, with their digests; those of rank 0 alone are known.
pub(super) struct NamedFiles {
    originals: Vec<PathBuf>,
    digests: Vec<Digest>,
}

impl NamedFiles {
    /// Finds the files; rank 0 reads them as a whole.
    pub(super) fn find(
        file: &mut CaseFile,
        folder: &Path,
        lattice: &Lattice,
        ranks: &Ranks,
    ) -> Result<Self, CaseError> {
        let mut digests: HashMap<PathBuf, Digest> = HashMap::new();
        let mut found = Self {
            originals: Vec::new(),
            digests: Vec::new(),
        };
        let (files, source) = file.files_mut();
        for named in files {
            let original = folder.join(&*named.name);
            let digest = match digests.get(&original) {
                Some(known) => *known,
                None if ranks.communicator.rank() == 0 => {
                    let opened = match named.holds {
                        FileUse::Blocks => arrays::open_file(&original, lattice.nx, lattice.ny),
                        FileUse::HeightMap => arrays::open_height_map(&original),
                    };
                    let digest = opened.and_then(|file| digest(&original, file));
                    digest.map_err(|error| source.error(&named.key, error.to_string()))?
                }
                None => Digest::default(),
            };
            digests.insert(original.clone(), digest);
            found.originals.push(original);
            found.digests.push(digest);
        }
        Ok(found)
    }

    /// Tells all ranks the digests, and replaces the names in the case by those of copies. Files of equal contents and names
    /// are one.
    pub(super) fn share(mut self, file: &mut CaseFile, ranks: &Ranks) -> Vec<Input> {
        ranks.communicator.sum(self.digests.as_flattened_mut());
        let mut inputs: Vec<Input> = Vec::new();
        let names = file.files_mut().0.map(|named| named.name);
        for ((original, digest), written) in self.originals.into_iter().zip(self.digests).zip(names) {
            let [length, hash @ ..] = digest;
            let mut bytes = [0; blake3::OUT_LEN];
            for (bytes, word) in bytes.chunks_exact_mut(8).zip(hash) {
                bytes.copy_from_slice(&word.to_le_bytes());
            }
            let hash = blake3::Hash::from_bytes(bytes);
            let plain = original.file_name().map(|name| name.to_string_lossy());
            let plain = plain.unwrap_or("input".into());
            let is_same = |name: &str| Some(inputs.iter().find(|input| input.name == name)?.hash == hash);
            let (name, is_kept) = name_of_copy(&plain, is_same);
            written.clone_from(&name);
            if !is_kept {
                inputs.push(Input {
                    name,
                    original,
                    length: length.cast_unsigned(),
                    hash,
                });
            }
        }
        inputs
    }
}

fn digest(path: &Path, file: File) -> Result<Digest, ArrayError> {
    let mut hasher = Hasher::new();
    hasher.update_reader(file).map_err(|source| ArrayError::Read {
        path: path.to_owned(),
        source,
    })?;
    let mut digest = Digest::default();
    digest[0] = hasher.count().cast_signed();
    let hash = hasher.finalize();
    for (word, bytes) in digest[1..].iter_mut().zip(hash.as_bytes().as_chunks::<8>().0) {
        *word = i64::from_le_bytes(*bytes);
    }
    Ok(digest)
}

/// The files that a case reads, and the rows that are wanted of them.
pub(super) struct Inputs {
    pub(super) files: Vec<Input>,
    pub(super) slab: Slab,
}

impl Inputs {
    /// Reads the file that has this name in the case, which `key` gives it.
    pub(super) fn read<T>(
        &self,
        file: &CaseFile,
        key: &str,
        name: &str,
        read: impl FnOnce(&Path, &mut BufReader<File>) -> Result<T, ArrayError>,
    ) -> Result<T, CaseError> {
        let Slab { nx, ny, .. } = self.slab;
        let original = self.original(name);
        let opened = arrays::open_file(original, nx, ny);
        let read = opened.and_then(|opened| read(original, &mut BufReader::new(opened)));
        read.map_err(|error| placed(file, key, error))
    }

    /// Reads the image or array that has this name in the case, which `key` gives it: whether each block of the slab is dark, or 1.
    pub(super) fn read_mask(
        &self,
        file: &CaseFile,
        key: &str,
        name: &str,
        threshold: f64,
        slab: &Slab,
        watch: &mut Watch,
    ) -> Result<Vec<bool>, CaseError> {
        self.read(file, key, name, |path, source| match is_array(path) {
            true => arrays::mask_npy(path, source, slab),
            false => arrays::mask_png(path, source, threshold, slab, &mut |share| {
                watch(share).then_some(()).ok_or(ArrayError::Stopped)
            }),
        })
    }

    /// Reads the height map that has this name in the case, which `key` gives it.
    pub(super) fn read_height_map<T>(
        &self,
        file: &CaseFile,
        key: &str,
        name: &str,
        read: impl FnOnce(&Path, &mut BufReader<File>) -> Result<T, ArrayError>,
    ) -> Result<T, CaseError> {
        let original = self.original(name);
        let opened = arrays::open_height_map(original);
        let read = opened.and_then(|opened| read(original, &mut BufReader::new(opened)));
        read.map_err(|error| placed(file, key, error))
    }

    /// The path of the file that has this name in the case.
    fn original<'a>(&'a self, name: &'a str) -> &'a Path {
        let input = self.files.iter().find(|input| input.name == name);
        input.map_or(Path::new(name), |input| &input.original)
    }

    /// Reads a number of every block from the file of this name, if the case names one.
    pub(super) fn read_field(
        &self,
        file: &CaseFile,
        key: &str,
        name: &Option<String>,
    ) -> Result<Option<Vec<f64>>, CaseError> {
        let read = |name: &String| {
            self.read(file, key, name, |path, source| {
                arrays::field(path, source, &self.slab)
            })
        };
        name.as_ref().map(read).transpose()
    }
}

/// Whether the file of a mask is an array, and not an image.
pub(super) fn is_array(path: &Path) -> bool {
    arrays::extension(path) == "npy"
}

/// An error about the file that a key names.
fn placed(file: &CaseFile, key: &str, error: ArrayError) -> CaseError {
    match error {
        ArrayError::Stopped => CaseError::Stopped,
        error => file.source.error(key, error.to_string()),
    }
}
