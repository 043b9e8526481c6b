//! The case as it is edited: its keys, as a user would write them, and the files that they name.

use std::collections::BTreeMap;
use std::io::Write;
use std::path::Path;
use std::sync::Arc;

use slipfront_case::case::Case;
use slipfront_case::case_file::{CaseError, CaseFile, partners_of};
use slipfront_case::disk::read_limited;
use tempfile::TempDir;
use toml::{Table, Value};

/// Most blocks of a case: such that the run, its twin and the pictures stay within the memory of a small machine.
pub(crate) const MAX_BLOCKS: usize = 1 << 19;

/// Most bytes of all files of a case.
const MAX_FILES: u64 = 64 << 20;

/// Name of the image that holds a painted texture.
const PAINTED: &str = "texture.png";

/// A case that is edited. Copies share their files.
#[derive(Clone, Debug)]
pub(crate) struct Document {
    /// Name of the case.
    pub(crate) name: String,
    keys: Table,
    files: Arc<Files>,
}

/// The files of a case, in memory and in a folder of their own, which goes with them. They have plain names.
#[derive(Debug)]
struct Files {
    contents: BTreeMap<String, Vec<u8>>,
    folder: TempDir,
}

impl Files {
    fn new(contents: BTreeMap<String, Vec<u8>>) -> Result<Self, CaseError> {
        let written = || {
            let folder = tempfile::tempdir()?;
            for (name, bytes) in &contents {
                std::fs::write(folder.path().join(name), bytes)?;
            }
            Ok(folder)
        };
        let folder = written().map_err(|error: std::io::Error| {
            refused(format!(
                "the files of the case cannot be written to a temporary folder: {error}"
            ))
        })?;
        Ok(Self { contents, folder })
    }
}

/// A sentence as the error of a case.
fn refused(sentence: String) -> CaseError {
    CaseFile::default().source.error("", sentence)
}

/// A plain name, which stays within its folder on every system.
pub(crate) fn is_plain_name(name: &str) -> bool {
    let is_plain = |c: char| c.is_alphanumeric() || "_-. ()+".contains(c);
    !name.is_empty() && name.len() <= 100 && !name.starts_with('.') && name.chars().all(is_plain)
}

impl Document {
    /// The case of a text; `read` gives the contents of the files that it names. These get plain names.
    ///
    /// # Errors
    /// When it is no case, or a file cannot be read, or there is too much of it.
    pub(crate) fn new(
        name: &str,
        text: &str,
        read: impl Fn(&str) -> std::io::Result<Vec<u8>>,
    ) -> Result<Self, CaseError> {
        // First, since its errors name the place in the text as it was written.
        let mut case = CaseFile::parse(text, name, &[])?;
        let mut keys: Table = text.parse().map_err(|error| refused(format!("{error}")))?;
        let mut contents: BTreeMap<String, Vec<u8>> = BTreeMap::new();
        let (mut bytes, mut renamed) = (0, Vec::new());
        let named = CaseFile::files_mut(
            &mut case.slider,
            &mut case.load,
            &mut case.drive,
            &mut case.friction,
            &mut case.texture,
        );
        for file in named {
            let read = read(file.name).map_err(|error| {
                case.source
                    .error(&file.key, format!("{} cannot be read: {error}", file.name))
            })?;
            bytes += read.len() as u64;
            if bytes > MAX_FILES {
                let sentence =
                    format!("the files of the case have more than {MAX_FILES} bytes: scale them down");
                return Err(case.source.error(&file.key, sentence));
            }
            let plain = Path::new(file.name.as_str())
                .file_name()
                .unwrap_or_default()
                .to_string_lossy();
            let mut plain: String = plain
                .chars()
                .map(|c| {
                    if is_plain_name(&c.to_string()) || c == '.' {
                        c
                    } else {
                        '_'
                    }
                })
                .collect();
            while contents.get(&plain).is_some_and(|other| *other != read) {
                plain.insert_str(0, "2-");
            }
            contents.insert(plain.clone(), read);
            renamed.push((file.key, plain));
        }
        for (key, plain) in renamed {
            put(&mut keys, &key, plain.into()).map_err(refused)?;
        }
        Ok(Self {
            name: name.to_owned(),
            keys,
            files: Arc::new(Files::new(contents)?),
        })
    }

    /// The case of a file, with the files that stand beside it.
    ///
    /// # Errors
    /// As for [`new`](Self::new).
    pub(crate) fn load(path: &Path, name: &str) -> Result<Self, CaseError> {
        let text = slipfront_case::case_file::read_text(path)?;
        let folder = path.parent().unwrap_or(Path::new(""));
        Self::new(name, &text, |file| read_limited(&folder.join(file), MAX_FILES))
    }

    /// The case as a text.
    pub(crate) fn toml(&self) -> String {
        self.keys.to_string()
    }

    /// The files that it names.
    pub(crate) fn files(&self) -> &BTreeMap<String, Vec<u8>> {
        &self.files.contents
    }

    /// The textures, as the page changes them.
    pub(crate) fn textures(&self) -> serde_json::Value {
        let textures = self.keys.get("texture").cloned();
        textures.map_or(serde_json::Value::Array(Vec::new()), |textures| {
            serde_json::to_value(textures).unwrap_or_default()
        })
    }

    /// The same case without texture.
    pub(crate) fn without_texture(&self) -> Self {
        let mut twin = self.clone();
        twin.keys.remove("texture");
        twin
    }

    /// The same case with other values of keys, none to remove one. A key that sets the same thing as another replaces it.
    ///
    /// # Errors
    /// A sentence, if a key has no place in the case.
    pub(crate) fn with(
        &self,
        changes: impl IntoIterator<Item = (String, Option<Value>)>,
    ) -> Result<Self, String> {
        let mut changed = self.clone();
        for (key, value) in changes {
            for partner in partners_of(&key) {
                remove(&mut changed.keys, &partner);
            }
            match value {
                Some(value) => put(&mut changed.keys, &key, value)?,
                None => remove(&mut changed.keys, &key),
            }
        }
        Ok(changed)
    }

    /// The same case with an image in place of its textures.
    ///
    /// # Errors
    /// When it cannot be written.
    pub(crate) fn with_image(&self, png: Vec<u8>, threshold: f64) -> Result<Self, CaseError> {
        let mut contents = self.files.contents.clone();
        let mut painted = self.without_texture();
        let still_named: Vec<String> = painted.named_files();
        contents.retain(|name, _| still_named.contains(name));
        let mut name = PAINTED.to_owned();
        while contents.contains_key(&name) {
            name.insert_str(0, "2-");
        }
        let mut texture = Table::new();
        texture.insert("shape".to_owned(), "mask".into());
        texture.insert("file".to_owned(), name.clone().into());
        if threshold != slipfront_case::case_file::DEFAULT_THRESHOLD {
            texture.insert("threshold".to_owned(), threshold.into());
        }
        contents.insert(name, png);
        painted
            .keys
            .insert("texture".to_owned(), Value::Array(vec![texture.into()]));
        painted.files = Arc::new(Files::new(contents)?);
        Ok(painted)
    }

    /// The files that its keys name.
    fn named_files(&self) -> Vec<String> {
        fn strings(value: &Value, found: &mut Vec<String>) {
            match value {
                Value::String(text) => found.push(text.clone()),
                Value::Array(values) => values.iter().for_each(|value| strings(value, found)),
                Value::Table(table) => table.values().for_each(|value| strings(value, found)),
                _ => {}
            }
        }
        let mut found = Vec::new();
        self.keys.values().for_each(|value| strings(value, &mut found));
        found
    }

    /// The same case with a texture that is this mask, one value per block from y = 0 upwards.
    ///
    /// # Errors
    /// When it cannot be written.
    pub(crate) fn with_mask(&self, textured: &[bool], nx: usize) -> Result<Self, CaseError> {
        if !textured.contains(&true) {
            return Ok(self.without_texture());
        }
        let png = mask_image(textured, nx)
            .map_err(|error| refused(format!("the mask cannot be written: {error}")))?;
        self.with_image(png, slipfront_case::case_file::DEFAULT_THRESHOLD)
    }

    /// The case that can be run, as `slipfront run` makes it.
    ///
    /// # Errors
    /// Those of a case, and one with more than [`MAX_BLOCKS`] blocks.
    pub(crate) fn case(&self) -> Result<Case, CaseError> {
        self.made(&[])
    }

    /// The same case as it is shown: it writes nothing, and keeps no more than the instants A-F for it.
    pub(crate) fn case_to_show(&self) -> Result<Case, CaseError> {
        self.made(&[
            "output.fields=[\"sliding\"]",
            "output.snapshots=\"auto\"",
            "output.series=\"auto\"",
            "output.movie=false",
        ])
    }

    fn made(&self, overrides: &[&str]) -> Result<Case, CaseError> {
        let overrides: Vec<String> = overrides.iter().map(|&text| text.to_owned()).collect();
        let mut file = CaseFile::parse(&self.toml(), &self.name, &overrides)?;
        self.refuse_other_files(&mut file)?;
        let [nx, ny] = file.slider.blocks.map(|count| count as usize);
        if nx.saturating_mul(ny) > MAX_BLOCKS {
            let sentence = format!(
                "{nx} x {ny} blocks are more than the {MAX_BLOCKS} that the laboratory shows: take `slipfront run` for this case"
            );
            return Err(file.source.error("slider.blocks", sentence));
        }
        Case::to_run(file, &self.name, self.files.folder.path(), &mut |_| true)
    }
}

impl Document {
    /// Refuses a case that names a file which does not belong to it, wherever that may be: keys may come from anybody's link.
    fn refuse_other_files(&self, case: &mut CaseFile) -> Result<(), CaseError> {
        let source = &case.source;
        let named = CaseFile::files_mut(
            &mut case.slider,
            &mut case.load,
            &mut case.drive,
            &mut case.friction,
            &mut case.texture,
        );
        for file in named {
            if !self.files.contents.contains_key(file.name.as_str()) {
                let sentence = format!(
                    "{} cannot be read: it is not one of the files of the case",
                    file.name
                );
                return Err(source.error(&file.key, sentence));
            }
        }
        Ok(())
    }
}

/// An image of one pixel per block, black where it is texture, the largest y first.
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

/// Sets a key such as `drive.v_star` or `texture.0.center`.
fn put(table: &mut Table, key: &str, value: Value) -> Result<(), String> {
    let (first, rest) = key.split_once('.').unwrap_or((key, ""));
    if rest.is_empty() {
        table.insert(first.to_owned(), value);
        return Ok(());
    }
    let nowhere = || format!("the case has no place for the key `{key}`");
    match table
        .entry(first.to_owned())
        .or_insert_with(|| Table::new().into())
    {
        Value::Table(inner) => put(inner, rest, value),
        Value::Array(values) => {
            let (index, rest) = rest.split_once('.').ok_or_else(nowhere)?;
            let element = index
                .parse::<usize>()
                .ok()
                .and_then(|index| values.get_mut(index));
            match element {
                Some(Value::Table(inner)) => put(inner, rest, value),
                _ => Err(nowhere()),
            }
        }
        _ => Err(nowhere()),
    }
}

/// Removes a key, if it is there.
fn remove(table: &mut Table, key: &str) {
    match key.split_once('.') {
        None => {
            table.remove(key);
        }
        Some((first, rest)) => {
            if let Some(Value::Table(inner)) = table.get_mut(first) {
                remove(inner, rest);
            }
        }
    }
}
