//! Identity of a run, a hash of everything that determines its numbers: runs with equal identities are made
//! once.

use serde::Serialize;
use slipfront_case::case::{Case, Input};
use slipfront_case::case_file::{CaseError, CaseFile, NamedFile, ParsedCase, Source};

use slipfront_run::program;

/// BLAKE3 hash of the sources of this crate: a part of the identity of the runs that it records.
pub const SOURCE_HASH: &str = env!("SLIPFRONT_SOURCE_HASH");

/// A base of points, with hashes of the tables that they leave unchanged.
pub(crate) struct Prepared<'a> {
    pub(crate) case: ParsedCase<'a>,
    texts: Option<[Vec<u8>; 7]>,
}

impl<'a> Prepared<'a> {
    pub(crate) fn new(case: ParsedCase<'a>) -> Result<Self, CaseError> {
        let texts = case.plain().map(|plain| texts(plain, &[], None));
        Ok(Self {
            texts: texts.transpose()?,
            case,
        })
    }

    /// The case of the base, with the hashes of its tables.
    pub(crate) fn known(&self) -> Option<(&CaseFile, &[Vec<u8>; 7])> {
        self.case.plain().zip(self.texts.as_ref())
    }
}

/// Hash of everything except the seed that determines the numbers of a run: the physics of the case, the
/// contents of its files and the program; not the names of files or the output. Tables that equal those of a
/// `known` case are not hashed again.
pub fn physics(case: &Case, known: Option<(&CaseFile, &[Vec<u8>; 7])>) -> Result<blake3::Hash, CaseError> {
    let mut hasher = blake3::Hasher::new();
    hasher.update(program::this_build().as_bytes());
    // This crate computes the recorded numbers from the output of a run, so its sources count, too.
    hasher.update(SOURCE_HASH.as_bytes());
    // The contents of files may differ even if the tables are equal.
    let known = known.filter(|_| case.inputs.is_empty());
    for text in texts(&case.file, &case.inputs, known)? {
        hasher.update(&text);
    }
    Ok(hasher.finalize())
}

/// The tables of a case that determine its numbers, with the contents of files in place of their names, and
/// without the seed.
fn texts(
    file: &CaseFile,
    inputs: &[Input],
    known: Option<(&CaseFile, &[Vec<u8>; 7])>,
) -> Result<[Vec<u8>; 7], CaseError> {
    fn text<T: Serialize + PartialEq>(
        table: &T,
        known: Option<(&T, &Vec<u8>)>,
    ) -> Result<Vec<u8>, CaseError> {
        match known {
            Some((same, text)) if same == table => Ok(text.clone()),
            _ => serde_json::to_vec(table).map_err(|error| CaseError::invalid(None, error.to_string())),
        }
    }
    let contents = |NamedFile { name, .. }: NamedFile| {
        let input = inputs.iter().find(|input| input.name == *name);
        let hash = input.map(|input| input.hash.to_hex());
        let ending = name.rsplit('.').next().unwrap_or_default();
        *name = format!("{}.{ending}", hash.unwrap_or_default());
    };
    // Without the text that the case was read from, which has no effect.
    let mut hashed = CaseFile {
        slider: file.slider.clone(),
        load: file.load.clone(),
        drive: file.drive.clone(),
        friction: file.friction.clone(),
        texture: file.texture.clone(),
        initial: file.initial.clone(),
        time: file.time.clone(),
        output: file.output.clone(),
        source: Source::default(),
    };
    hashed.friction.seed = 0;
    hashed.files_mut().0.for_each(contents);
    Ok([
        text(
            &hashed.slider,
            known.map(|(file, texts)| (&file.slider, &texts[0])),
        )?,
        text(&hashed.load, None)?,
        text(&hashed.drive, None)?,
        text(&hashed.friction, None)?,
        text(&hashed.texture, None)?,
        text(&hashed.initial, None)?,
        text(&hashed.time, known.map(|(file, texts)| (&file.time, &texts[6])))?,
    ])
}
