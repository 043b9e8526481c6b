//! The case that is edited: its keys, as a user would write them, and the files that they name.

use std::collections::BTreeMap;
use std::io::Write;
use std::path::Path;
use std::sync::Arc;
#[cfg(feature = "work")]
use std::sync::atomic::{AtomicBool, Ordering};

use serde::{Deserialize, Serialize};
use slipfront_base::ordered::map_of;
use slipfront_base::text::truncated;
use slipfront_case::case::{Case, Files, FilesInMemory, Ranks, Watch};
use slipfront_case::case_file::{CaseError, CaseFile, partners_of, parts_of};
use toml::{Table, Value};

use crate::base64;
use crate::names::{MAX_FILES, is_plain_name, plain_name};
use crate::protocol::Source;
use crate::sentence::sentence;

/// Largest number of blocks of a case: the run, its twin and the pictures must fit into the memory of a small
/// machine.
pub const MAX_BLOCKS: usize = 1 << 19;

/// Name of the image that holds a painted texture.
const PAINTED: &str = "texture.png";

/// A case that is edited. Copies share their files. As JSON, it is the source of an `open` request that opens
/// it.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(try_from = "Source", into = "Source")]
pub struct Document {
    /// Name of the case.
    pub name: String,
    keys: Table,
    /// Contents of the files that the case names, by their plain names.
    files: BTreeMap<String, Arc<[u8]>>,
}

/// Turns a sentence into the error of a case.
fn case_error(sentence: String) -> CaseError {
    CaseFile::default().source.error("", sentence)
}

impl From<Document> for Source {
    fn from(document: Document) -> Self {
        let files = document.files.iter();
        Self {
            toml: Some(document.toml()),
            files: map_of(files.map(|(name, contents)| (name.clone(), base64::encode(contents)))),
            name: Some(document.name),
            ..Self::default()
        }
    }
}

impl TryFrom<Source> for Document {
    type Error = String;

    /// Builds the case of a source that contains its text.
    fn try_from(source: Source) -> Result<Self, String> {
        let toml = source.toml.ok_or("the source of a case has no text")?;
        let name = source.name.filter(|name| is_plain_name(name));
        let name = name.unwrap_or_else(|| "case".to_owned());
        let mut files = BTreeMap::new();
        for (name, text) in source.files {
            files.insert(name, base64::decode(&text)?);
        }
        let read = |name: &str| {
            let missing = || "it is not one of the files that came with the case".to_owned();
            files.get(name).cloned().ok_or_else(missing)
        };
        Self::new(&name, &toml, read).map_err(sentence)
    }
}

impl Document {
    /// Builds a case from its text; `read` returns the contents of the files that it names. The files get
    /// plain names.
    ///
    /// # Errors
    /// When it is not a case, a file cannot be read, or the files are too large.
    pub fn new(
        name: &str,
        text: &str,
        read: impl Fn(&str) -> Result<Vec<u8>, String>,
    ) -> Result<Self, CaseError> {
        // The text is parsed first, because these errors refer to places in the original text.
        let mut case = CaseFile::parse(text, name, &[])?;
        let mut keys: Table = text.parse().map_err(|error| case_error(format!("{error}")))?;
        let mut contents: BTreeMap<String, Vec<u8>> = BTreeMap::new();
        let (mut bytes, mut renamed) = (0, Vec::new());
        let (named, source) = case.files_mut();
        for file in named {
            let read = read(file.name)
                .map_err(|error| source.error(&file.key, format!("{} cannot be read: {error}", file.name)))?;
            bytes += read.len() as u64;
            if bytes > MAX_FILES {
                let sentence =
                    format!("the files of the case have more than {MAX_FILES} bytes: scale them down");
                return Err(source.error(&file.key, sentence));
            }
            let mut plain = plain_name(file.name);
            while contents.get(&plain).is_some_and(|other| *other != read) {
                plain.insert_str(0, "2-");
            }
            contents.insert(plain.clone(), read);
            renamed.push((file.key, plain));
        }
        for (key, plain) in renamed {
            put(&mut keys, &key, plain.into()).map_err(case_error)?;
        }
        Ok(Self {
            name: name.to_owned(),
            keys,
            files: map_of(
                contents
                    .into_iter()
                    .map(|(name, contents)| (name, contents.into())),
            ),
        })
    }

    /// The case as a text.
    pub(crate) fn toml(&self) -> String {
        self.keys.to_string()
    }

    /// The keys of the case.
    #[cfg(feature = "work")]
    pub(crate) fn keys(&self) -> &Table {
        &self.keys
    }

    /// Contents of the files that the case names, in the form that builds a case.
    pub(crate) fn files_in_memory(&self) -> FilesInMemory {
        let files = self.files.iter();
        files
            .map(|(name, contents)| (name.clone(), Arc::clone(contents)))
            .collect()
    }

    /// Contents of the files that the case names, by their plain names.
    pub(crate) fn files(&self) -> &BTreeMap<String, Arc<[u8]>> {
        &self.files
    }

    /// Approximate memory of the keys, in bytes.
    pub(crate) fn bytes_of_keys(&self) -> usize {
        bytes_of_table(&self.keys)
    }

    /// The textures, in the form in which the page edits them.
    pub(crate) fn textures(&self) -> serde_json::Value {
        let textures = self.keys.get("texture").cloned();
        textures.map_or(serde_json::Value::Array(Vec::new()), |textures| {
            serde_json::to_value(textures).unwrap_or_default()
        })
    }

    /// Whether the case has textures.
    pub(crate) fn has_texture(&self) -> bool {
        self.keys
            .get("texture")
            .and_then(Value::as_array)
            .is_some_and(|all| !all.is_empty())
    }

    /// A copy of the case without texture.
    pub(crate) fn without_texture(&self) -> Self {
        let mut twin = self.clone();
        twin.keys.remove("texture");
        twin
    }

    /// Whether both are the same case, apart from their names.
    pub(crate) fn is_same_case(&self, other: &Self) -> bool {
        self.keys == other.keys && self.files == other.files
    }

    /// The slider without texture and with the same body, to which this case is compared.
    ///
    /// # Errors
    /// A sentence, if the keys are not a case.
    pub(crate) fn twin(&self) -> Result<Self, String> {
        let mut twin = self.without_texture();
        twin.drop_unnamed_files().map_err(sentence)?;
        Ok(twin)
    }

    /// A copy of the case with other values of keys; a value of none removes its key. A key replaces all keys
    /// that set the same quantity.
    ///
    /// # Errors
    /// A sentence, if a key has no place in the case.
    pub(crate) fn with(
        &self,
        changes: impl IntoIterator<Item = (String, Option<Value>)>,
    ) -> Result<Self, String> {
        let mut changed = self.clone();
        for (key, value) in changes {
            match value {
                Some(value) => put(&mut changed.keys, &key, value)?,
                None => remove(&mut changed.keys, &key)?,
            }
            for partner in partners_of(&key) {
                remove(&mut changed.keys, &partner)?;
            }
        }
        Ok(changed)
    }

    /// A copy of the case with an image in place of its textures.
    ///
    /// # Errors
    /// When the case is invalid even without the image.
    pub(crate) fn with_image(&self, png: &[u8], threshold: f64) -> Result<Self, CaseError> {
        self.without_texture().and_image(None, png, threshold)
    }

    /// Adds an image as another texture, at `index` among the textures or at the end.
    ///
    /// # Errors
    /// When the case is invalid even without the image.
    fn and_image(self, index: Option<usize>, png: &[u8], threshold: f64) -> Result<Self, CaseError> {
        let mut painted = self;
        painted.drop_unnamed_files()?;
        let mut name = PAINTED.to_owned();
        while painted.files.contains_key(&name) {
            name.insert_str(0, "2-");
        }
        let mut texture = Table::new();
        texture.insert("shape".to_owned(), "mask".into());
        texture.insert("file".to_owned(), name.clone().into());
        if threshold != slipfront_case::case_file::DEFAULT_THRESHOLD {
            texture.insert("threshold".to_owned(), threshold.into());
        }
        painted.files.insert(name, png.into());
        let textures = painted
            .keys
            .entry("texture")
            .or_insert_with(|| Value::Array(Vec::new()));
        if let Value::Array(textures) = textures {
            textures.insert(index.unwrap_or(textures.len()), texture.into());
        }
        Ok(painted)
    }

    /// Drops the files that no key names any more.
    ///
    /// # Errors
    /// When it is not a case.
    pub(crate) fn drop_unnamed_files(&mut self) -> Result<(), CaseError> {
        if self.files.is_empty() {
            return Ok(());
        }
        let mut case = CaseFile::parse(&self.toml(), &self.name, &[])?;
        let named: Vec<&String> = case.files_mut().0.map(|file| &*file.name).collect();
        self.files.retain(|name, _| named.contains(&name));
        Ok(())
    }

    /// A copy of the case with this mask as its only texture, one value per block from y = 0 upwards.
    ///
    /// # Errors
    /// When the image of the mask cannot be written, or the case is invalid even without it.
    pub(crate) fn with_mask(&self, textured: &[bool], nx: usize) -> Result<Self, CaseError> {
        self.without_texture().with_layer(None, textured, nx)
    }

    /// Index of the texture that a brush paints on: the last image that is stretched over the slider
    /// unchanged. None if there is no such texture.
    pub(crate) fn painted_layer(&self) -> Option<usize> {
        let textures = self.keys.get("texture")?.as_array()?;
        let is_layer = |texture: &Value| {
            texture.as_table().is_some_and(|table| {
                table.get("shape").and_then(Value::as_str) == Some("mask")
                    && table
                        .keys()
                        .all(|key| ["shape", "file", "threshold"].contains(&&**key))
            })
        };
        textures.iter().rposition(is_layer)
    }

    /// A copy of the case in which this mask replaces the texture at `index`, one value per block from y = 0
    /// upwards; without an index, the mask is added. A mask without blocks is left out.
    ///
    /// # Errors
    /// When the image of the mask cannot be written, or the case is invalid even without it.
    pub(crate) fn with_layer(
        &self,
        index: Option<usize>,
        textured: &[bool],
        nx: usize,
    ) -> Result<Self, CaseError> {
        let mut others = self.clone();
        if let Some(Value::Array(textures)) = others.keys.get_mut("texture") {
            index.map(|index| textures.remove(index));
        }
        if !others.has_texture() {
            others.keys.remove("texture");
        }
        if !textured.contains(&true) {
            return Ok(others);
        }
        let png = mask_image(textured, nx)
            .map_err(|error| case_error(format!("the mask cannot be written: {error}")))?;
        others.and_image(index, &png, slipfront_case::case_file::DEFAULT_THRESHOLD)
    }

    /// Builds the case to run, as `slipfront run` does, unless `watch` stops the work.
    ///
    /// # Errors
    /// When the keys are not a case that can be run, it has more than [`MAX_BLOCKS`] blocks, or the work was
    /// stopped.
    pub fn case(&self, watch: &mut Watch) -> Result<Case, CaseError> {
        self.build(&[], watch)
    }

    /// Builds the case to show, unless `watch` stops the work: it writes nothing, and keeps no snapshots
    /// except those at the instants A-F.
    ///
    /// # Errors
    /// When the keys are not a case that can be run, it has more than [`MAX_BLOCKS`] blocks, or the work was
    /// stopped.
    pub fn case_to_show(&self, watch: &mut Watch) -> Result<Case, CaseError> {
        let overrides = [
            "output.fields=[\"sliding\"]",
            "output.snapshots=\"auto\"",
            "output.series=\"auto\"",
            "output.movie=false",
        ];
        self.build(&overrides, watch)
    }

    /// Builds the case to show for a job, unless it is to stop.
    ///
    /// # Errors
    /// A sentence, if the keys are not a case that can be run, or the work was stopped.
    #[cfg(feature = "work")]
    pub(crate) fn case_unless(&self, stop: &AtomicBool) -> Result<Case, String> {
        self.case_to_show(&mut |_| !stop.load(Ordering::Relaxed))
            .map_err(sentence)
    }

    /// Builds the case with other values of keys, each as `key=value`.
    ///
    /// # Errors
    /// When the keys are not a case that can be run, it has more than [`MAX_BLOCKS`] blocks, or the work was
    /// stopped.
    fn build(&self, overrides: &[&str], watch: &mut Watch) -> Result<Case, CaseError> {
        let overrides: Vec<String> = overrides.iter().map(|&text| text.to_owned()).collect();
        let mut file = CaseFile::parse(&self.toml(), &self.name, &overrides)?;
        self.expect_own_files(&mut file)?;
        let [nx, ny] = file.slider.blocks.map(|count| count as usize);
        if nx.saturating_mul(ny) > MAX_BLOCKS {
            let sentence = format!(
                "{nx} x {ny} blocks are more than the {MAX_BLOCKS} that the laboratory shows: take `slipfront run` for this case"
            );
            return Err(file.source.error("slider.blocks", sentence));
        }
        let in_memory = self.files_in_memory();
        let files = Files {
            folder: Path::new(""),
            in_memory: Some(&in_memory),
        };
        Case::to_run(file, &self.name, files, watch, Ranks::ALONE)
    }

    /// Refuses a file that does not belong to the case, wherever the file is: the keys may come from a
    /// stranger's link.
    fn expect_own_files(&self, case: &mut CaseFile) -> Result<(), CaseError> {
        let (mut named, source) = case.files_mut();
        match named.find(|file| !self.files.contains_key(file.name.as_str())) {
            Some(foreign) => {
                let sentence = format!(
                    "{} cannot be read: it is not one of the files of the case",
                    foreign.name
                );
                Err(source.error(&foreign.key, sentence))
            }
            None => Ok(()),
        }
    }
}

/// An image with one pixel per block, black for texture, with the largest y first.
fn mask_image(textured: &[bool], nx: usize) -> Result<Vec<u8>, png::EncodingError> {
    let mut bytes = Vec::new();
    let rows = textured.chunks(nx).rev();
    let mut encoder = png::Encoder::new(&mut bytes, nx as u32, (textured.len() / nx) as u32);
    encoder.set_color(png::ColorType::Grayscale);
    encoder.set_depth(png::BitDepth::One);
    let mut writer = encoder.write_header()?;
    let mut stream = writer.stream_writer()?;
    let mut packed = vec![0; nx.div_ceil(8)];
    for row in rows {
        packed.fill(0);
        for (i, _) in row.iter().enumerate().filter(|(_, textured)| !**textured) {
            packed[i / 8] |= 0x80 >> (i % 8);
        }
        stream.write_all(&packed)?;
    }
    stream.finish()?;
    writer.finish()?;
    Ok(bytes)
}

/// Finds the table that holds the last part of a key such as `texture.0.center`, and returns both. If `make`,
/// missing tables on the way are made.
///
/// # Errors
/// A sentence, if it is not a key.
fn table_of<'t, 'k>(
    mut table: &'t mut Table,
    key: &'k str,
    make: bool,
) -> Result<Option<(&'t mut Table, &'k str)>, String> {
    let parts = parts_of(key).map_err(|sentence| format!("`{}`: {sentence}", truncated(key)))?;
    let (last, above) = parts.split_last().ok_or("a key has a name")?;
    let mut above = above.iter();
    while let Some(part) = above.next() {
        if make && !table.contains_key(*part) {
            table.insert((*part).to_owned(), Table::new().into());
        }
        let inner = match table.get_mut(*part) {
            Some(Value::Array(values)) => {
                let index = above.next().and_then(|index| index.parse::<usize>().ok());
                index.and_then(|index| values.get_mut(index))
            }
            inner => inner,
        };
        let Some(Value::Table(inner)) = inner else {
            return Ok(None);
        };
        table = inner;
    }
    Ok(Some((table, last)))
}

/// Sets a key.
///
/// # Errors
/// A sentence, if the case has no place for the key.
fn put(table: &mut Table, key: &str, value: Value) -> Result<(), String> {
    let found = table_of(table, key, true)?;
    let (table, last) =
        found.ok_or_else(|| format!("the case has no place for the key `{}`", truncated(key)))?;
    table.insert(last.to_owned(), value);
    Ok(())
}

/// Removes a key, if it is there.
///
/// # Errors
/// A sentence, if it is not a key.
fn remove(table: &mut Table, key: &str) -> Result<(), String> {
    if let Some((table, last)) = table_of(table, key, false)? {
        table.remove(last);
    }
    Ok(())
}

/// Approximate memory of a table, in bytes.
fn bytes_of_table(table: &Table) -> usize {
    let entry = |(key, value): (&String, &Value)| size_of::<String>() + key.len() + bytes_of(value);
    table.iter().map(entry).sum()
}

fn bytes_of(value: &Value) -> usize {
    let inner = match value {
        Value::String(text) => text.len(),
        Value::Array(values) => values.iter().map(bytes_of).sum(),
        Value::Table(table) => bytes_of_table(table),
        _ => 0,
    };
    size_of::<Value>() + inner
}

#[cfg(test)]
mod tests {
    use super::*;

    fn document(text: &str) -> Document {
        Document::new("case", text, |_| Err("there is none".to_owned())).unwrap()
    }

    #[test]
    fn a_key_replaces_those_that_set_the_same_thing() {
        let set = |document: &Document, key: &str, value: Option<Value>| {
            document.with([(key.to_owned(), value)]).unwrap()
        };
        let slow = set(
            &document("drive.v_star = 0.03"),
            "drive.speed",
            Some("1 um/s".into()),
        );
        assert_eq!(slow.toml().trim(), "[drive]\nspeed = \"1 um/s\"");
        let fast = set(&slow, "drive.v_star", Some(0.1.into()));
        assert_eq!(fast.case(&mut |_| true).unwrap().groups.v_star, 0.1);
        assert_eq!(
            set(&fast, "drive.v_star", None)
                .case(&mut |_| true)
                .unwrap()
                .groups
                .v_star,
            0.03
        );
        let error = fast
            .with([("drive.v_star.more".to_owned(), Some(1.into()))])
            .unwrap_err();
        assert_eq!(error, "the case has no place for the key `drive.v_star.more`");
    }

    /// Masks are read back from their images unchanged, even if the width is not a multiple of the eight
    /// blocks in a byte.
    #[test]
    fn a_mask_is_the_texture_it_was_painted_as() {
        for (nx, ny) in [(1, 2), (7, 3), (8, 8), (13, 5), (100, 9)] {
            let mask: Vec<bool> = (0..nx * ny).map(|b| (b * b + b / 3) % 3 == 1).collect();
            let painted = document(&format!("slider.blocks = [{nx}, {ny}]"))
                .with_mask(&mask, nx)
                .unwrap();
            assert_eq!(
                painted.case(&mut |_| true).unwrap().model.surface.textured,
                mask,
                "{nx} x {ny}"
            );
            assert!(
                painted
                    .with_mask(&vec![false; nx * ny], nx)
                    .unwrap()
                    .textures()
                    .as_array()
                    .unwrap()
                    .is_empty()
            );
        }
    }

    #[test]
    fn an_image_replaces_those_of_the_textures_alone() {
        let text = "friction.mu_static_field = 'mu.csv'\ntexture = [{ shape = 'mask', file = 'texture.png' }, { shape = 'mask', file = 'b.png' }]\n";
        let document = Document::new("case", text, |name| Ok(name.into())).unwrap();
        let painted = document.with_image(b"image", 0.25).unwrap();
        let files = [("mu.csv", b"mu.csv".to_vec()), ("texture.png", b"image".to_vec())];
        assert!(
            painted
                .files()
                .iter()
                .map(|(name, contents)| (name.as_str(), contents.to_vec()))
                .eq(files)
        );
        assert_eq!(
            painted.textures(),
            serde_json::json!([{ "shape": "mask", "file": "texture.png", "threshold": 0.25 }])
        );
    }

    #[test]
    fn files_of_one_name_are_kept_apart() {
        let text = "slider.blocks = [2, 2]\nfriction.mu_static_field = 'a/mu.csv'\nfriction.mu_kinetic_field = 'b/mu.csv'\n";
        let read = |path: &str| {
            Ok(if path.starts_with('a') {
                b"1,1\n1,1\n"
            } else {
                b"2,2\n2,2\n"
            }
            .to_vec())
        };
        let document = Document::new("case", text, read).unwrap();
        assert_eq!(
            document.files().keys().collect::<Vec<_>>(),
            ["2-mu.csv", "mu.csv"]
        );
        let surface = &document.case(&mut |_| true).unwrap().model.surface;
        assert_eq!((surface.mu_static[0], surface.mu_kinetic[0]), (1.0, 2.0));
    }
}
