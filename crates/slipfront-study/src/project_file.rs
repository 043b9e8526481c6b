//! The input file of a project: a base case, and a table of keys for this kind of project.

use std::path::{Path, PathBuf};

use serde::Deserialize;
use serde::de::DeserializeOwned;
use slipfront_case::case::{Files, FilesInMemory};
use slipfront_case::case_file::{
    CaseError, Key, Override, ParsedCase, Place, Source, Tables, limit_nesting, read_text, syntax_error,
    unknown_key,
};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::error::StudyError;
use crate::project_folder::{Given, ProjectKind, input_copies};

/// The case that a study varies.
#[derive(Clone, Debug)]
pub struct Base {
    /// Text of the case file.
    pub text: String,
    /// Name of the case in messages.
    pub name: String,
    /// The folder that paths of files in the case are relative to.
    pub folder: PathBuf,
    /// Files of the case that are in memory, and are not read from the folder.
    pub in_memory: FilesInMemory,
    /// Keys that are set in addition to the file, as by `--set`.
    pub(crate) overrides: Vec<Override>,
    /// The file that contains the case as its table `base`; errors give positions in it.
    pub(crate) whole: Option<Source>,
}

impl Base {
    /// The case file, parsed.
    pub fn parse(&self) -> Result<ParsedCase<'_>, CaseError> {
        let mut source = Source::new(&self.name, &self.text);
        if let Some(whole) = &self.whole {
            source = source.of_table(whole.clone(), "base");
        }
        ParsedCase::parse_from(&self.text, source)?.set(&self.overrides)
    }

    /// The files that the case names.
    pub fn files(&self) -> Files<'_> {
        Files {
            folder: &self.folder,
            in_memory: Some(&self.in_memory),
        }
    }

    /// Sets keys of the case, each by a string such as `drive.v_star=0.05`.
    ///
    /// # Errors
    /// When a string is not an override.
    pub(crate) fn set(&mut self, overrides: &[String]) -> Result<(), CaseError> {
        for text in overrides {
            self.overrides.push(Override::parse(text)?);
        }
        Ok(())
    }

    /// A base case with this text.
    fn new(text: String, name: String, folder: PathBuf) -> Self {
        Self {
            text,
            name,
            folder,
            in_memory: FilesInMemory::new(),
            overrides: Vec::new(),
            whole: None,
        }
    }
}

/// A file with a base case and a table of its own keys, such as `[design]`.
#[derive(Clone, Debug)]
pub struct ProjectFile {
    /// Name of the project and of its results.
    pub name: String,
    /// The case.
    pub base: Base,
    kind: &'static ProjectKind,
    source: Source,
    table: toml::Table,
}

impl ProjectFile {
    /// Reads a file called `file` in messages. `own` are the keys of its own table, and `further` the names
    /// of tables that [`table`](Self::table) returns. A base case that it names is relative to `folder`.
    ///
    /// # Errors
    /// When it is not TOML, or has unknown keys.
    pub fn parse<Keys: DeserializeOwned>(
        kind: &'static ProjectKind,
        own: &[Key],
        further: &[&str],
        text: &str,
        file: &str,
        name: &str,
        folder: &Path,
    ) -> Result<(Self, Keys), StudyError> {
        let mut source = Source::new(file, text);
        let root = parse_noting_places(&mut source, text)?;
        let mut tables = Tables {
            root: root.get_ref().clone(),
            source: &source,
        };
        let base = read_base(&mut tables, file, folder)?;
        let keys = tables.read_with(kind.table, own)?;
        for table in further {
            tables.root.remove(*table);
        }
        if let Some(key) = tables.root.keys().min_by_key(|key| key.span().start) {
            let known = [&["base", kind.table], further].concat();
            let sentence = unknown_key(key.get_ref(), &format!("a {} file", kind.name), &known);
            return Err(source.error_at(key.span(), sentence).into());
        }
        let table = without_places(root, &source)?;
        let name = name.to_owned();
        Ok((
            Self {
                name,
                base,
                kind,
                source,
                table,
            },
            keys,
        ))
    }

    /// Sets keys of the base case, each by a string such as `drive.v_star=0.05`.
    ///
    /// # Errors
    /// When a string is not an override.
    pub fn set(&mut self, overrides: &[String]) -> Result<(), CaseError> {
        self.base.set(overrides)
    }

    /// The project file with the base case inside, and the files that it reads, for the results folder.
    ///
    /// # Errors
    /// When the base case is not valid, or a file that it names cannot be read.
    pub fn given(&self) -> Result<Given, StudyError> {
        given(&self.base, &self.table)
    }

    /// A further table of the file, in addition to the case and the project's own table.
    ///
    /// # Errors
    /// When the file has something else with that name.
    pub fn table(&self, name: &str) -> Result<Option<&toml::Table>, CaseError> {
        let given = self.table.get(name);
        if given.is_some_and(|given| !given.is_table()) {
            let sentence = format!("`{name}` must be a table: write its keys below a line [{name}]");
            return Err(self.source.error(name, sentence));
        }
        Ok(given.and_then(toml::Value::as_table))
    }

    /// An error about a further table of the file.
    pub fn error_in_table(&self, name: &str, sentence: String) -> CaseError {
        self.source.error(name, sentence)
    }

    /// An error about a key of the project's own table.
    pub fn error(&self, key: &str, sentence: String) -> CaseError {
        self.source.error(&format!("{}.{key}", self.kind.table), sentence)
    }

    /// An error about a case that a key of the project's own table defines, at the position of the key.
    pub fn found_in(&self, key: &str, error: CaseError) -> CaseError {
        match error {
            CaseError::Invalid(invalid) => match invalid.place {
                Some(Place::Override(given)) => self.error(key, format!("`{given}`: {}", invalid.sentence)),
                _ => CaseError::Invalid(invalid),
            },
            error => error,
        }
    }
}

/// The text of a file with its base case inside, and the copies of the files that it names.
pub(crate) fn given(base: &Base, table: &toml::Table) -> Result<Given, StudyError> {
    let mut portable = toml::Table::from_iter([("base".to_owned(), base_table(base)?.into())]);
    portable.extend(table.clone().into_iter().filter(|(key, _)| key != "base"));
    let copies = input_copies::copy(&mut portable, &base.folder)?;
    Ok(Given {
        text: portable_text(portable)?,
        copies,
        others: Vec::new(),
    })
}

/// Parses a text, and records the positions of its keys in the source.
pub(crate) fn parse_noting_places<'t>(
    source: &mut Source,
    text: &'t str,
) -> Result<Spanned<DeTable<'t>>, CaseError> {
    let root = DeTable::parse(limit_nesting(source, 0, text)?);
    let root = root.map_err(|error| syntax_error(source, 0, &error))?;
    source.note_places(root.get_ref());
    Ok(root)
}

/// The values of a parsed text without their positions.
pub(crate) fn without_places(root: Spanned<DeTable>, source: &Source) -> Result<toml::Table, CaseError> {
    let table = toml::Table::deserialize(toml::Deserializer::from(root));
    table.map_err(|error| syntax_error(source, 0, &error))
}

/// The keys of a base case.
fn base_table(base: &Base) -> Result<toml::Table, CaseError> {
    base.parse()?.to_table()
}

/// The text of a study. Keys in an axis or under `[study]` keep their order, which determines that of columns
/// and points: serialising the table as a whole would move its lists of tables to the end.
pub(crate) fn portable_text(mut study: toml::Table) -> Result<String, CaseError> {
    let mut text = String::new();
    if let Some(base) = study.remove("base") {
        text += &toml::to_string(&toml::Table::from_iter([("base".to_owned(), base)]))?;
    }
    for (name, value) in study {
        let (header, tables) = match value {
            toml::Value::Array(tables) => (format!("[[{name}]]"), tables),
            table => (format!("[{name}]"), vec![table]),
        };
        for table in tables {
            text += &format!("\n{header}\n");
            for (key, value) in table.as_table().into_iter().flatten() {
                text += &format!("{key} = {value}\n");
            }
        }
    }
    Ok(text)
}

/// The base case of a file called `file`: its table `base`, a case file that it names relative to `folder`,
/// or the baseline.
pub(crate) fn read_base(tables: &mut Tables, file: &str, folder: &Path) -> Result<Base, StudyError> {
    let folder = folder.to_owned();
    let Some(value) = tables.root.remove("base") else {
        // Without a base, the study varies the baseline.
        let (text, name) = (String::new(), format!("{file} [base]"));
        return Ok(Base::new(text, name, folder));
    };
    let span = value.span();
    match value.into_inner() {
        DeValue::String(path) => {
            let path = folder.join(path.as_ref());
            let text = read_text(&path).map_err(|error| tables.source.error_at(span, error.to_string()))?;
            let folder = path.parent().unwrap_or(Path::new("")).to_owned();
            let name = path.display().to_string();
            Ok(Base::new(text, name, folder))
        }
        table @ DeValue::Table(_) => {
            let table: toml::Table = tables.read_table(Spanned::new(span, table), "[base]")?;
            let text = toml::to_string(&table).map_err(CaseError::from)?;
            let name = format!("[base] of {file}");
            Ok(Base {
                whole: Some(tables.source.clone()),
                ..Base::new(text, name, folder)
            })
        }
        _ => {
            let sentence = "`base` must be the path of a case file, or a table [base] with its keys";
            Err(tables.source.error_at(span, sentence))?
        }
    }
}
