//! Reads `types/protocol.d.ts`: interfaces, and unions of what their keys may hold.

use std::collections::{BTreeMap, BTreeSet};
use std::iter::Peekable;
use std::vec::IntoIter;

use serde_json::{Map, Value, json};

/// The type of the value of a key.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Type {
    Text,
    Number,
    Boolean,
    Null,
    /// Any value: `unknown`.
    Unknown,
    /// A text that is always the same, such as `"case"`.
    Literal(String),
    List(Box<Type>),
    /// An object with any keys.
    Map(Box<Type>),
    Union(Vec<Type>),
    /// A type that the file declares.
    Named(String),
}

impl Type {
    /// The type of the innermost elements of lists and of objects with any keys; any other type itself.
    fn within(&self) -> &Self {
        match self {
            Self::List(of) | Self::Map(of) => of.within(),
            one => one,
        }
    }
}

/// A key of an interface.
#[derive(Clone, Debug)]
pub(super) struct DeclaredKey {
    pub(super) optional: bool,
    pub(super) holds: Type,
}

/// An interface.
#[derive(Debug, Default)]
pub(super) struct Interface {
    pub(super) keys: BTreeMap<String, DeclaredKey>,
    /// Whether there may be other keys.
    open: bool,
}

/// All that the file declares.
#[derive(Debug, Default)]
pub(super) struct Declarations {
    interfaces: BTreeMap<String, Interface>,
    unions: BTreeMap<String, Type>,
}

/// Findings of `check` in examples: names of interfaces and keys, with the types of the values of these keys.
pub(super) type Seen = BTreeSet<(String, String, Option<Type>)>;

impl Declarations {
    pub(super) fn parse(text: &str) -> Self {
        let mut tokens = Tokens(tokens(text).into_iter().peekable());
        let mut all = Self::default();
        while tokens.take("export") {
            let (kind, name) = (tokens.next(), tokens.next());
            if kind == "type" {
                tokens.expect("=");
                all.unions.insert(name, tokens.union());
                tokens.expect(";");
            } else {
                assert_eq!(kind, "interface");
                all.interfaces.insert(name, tokens.interface());
            }
        }
        assert_eq!(tokens.0.next(), None);
        all
    }

    pub(super) fn interface(&self, name: &str) -> &Interface {
        &self.interfaces[name]
    }

    pub(super) fn is_interface(&self, name: &str) -> bool {
        self.interfaces.contains_key(name)
    }

    /// The types of which a value has one.
    pub(super) fn alternatives(&self, of: &Type) -> Vec<Type> {
        match of {
            Type::Union(all) => all.iter().flat_map(|one| self.alternatives(one)).collect(),
            Type::Named(name) if self.unions.contains_key(name) => self.alternatives(&self.unions[name]),
            one => vec![one.clone()],
        }
    }

    /// Whether a value is of a type: an object has exactly the keys of its interface, but for optional ones.
    pub(super) fn check(&self, value: &Value, of: &Type, seen: &mut Seen) -> bool {
        match (of, value) {
            (Type::Text, Value::String(_))
            | (Type::Number, Value::Number(_))
            | (Type::Boolean, Value::Bool(_))
            | (Type::Null, Value::Null)
            | (Type::Unknown, _) => true,
            (Type::Literal(text), Value::String(value)) => text == value,
            (Type::List(of), Value::Array(values)) => values.iter().all(|value| self.check(value, of, seen)),
            (Type::Map(of), Value::Object(values)) => {
                values.values().all(|value| self.check(value, of, seen))
            }
            (Type::Named(name), Value::Object(object)) if self.is_interface(name) => {
                self.check_object(object, name, seen)
            }
            (Type::Union(_) | Type::Named(_), value) => {
                let all = self.alternatives(of);
                all != [of.clone()] && all.iter().any(|one| self.check(value, one, seen))
            }
            _ => false,
        }
    }

    fn check_object(&self, object: &Map<String, Value>, name: &str, seen: &mut Seen) -> bool {
        let interface = self.interface(name);
        let is_declared = |key: &String| interface.open || interface.keys.contains_key(key);
        object.keys().all(is_declared)
            && interface
                .keys
                .iter()
                .all(|(key, DeclaredKey { optional, holds })| {
                    let found = object.get(key).map(|value| {
                        let mut all = self.alternatives(holds).into_iter();
                        all.find(|one| self.check(value, one, seen))
                    });
                    let is_right = match &found {
                        Some(alternative) => alternative.is_some(),
                        None => *optional,
                    };
                    seen.insert((name.to_owned(), key.clone(), found.flatten()));
                    is_right
                })
    }

    /// Adds to `all` each finding of `check` that examples can show for an interface and, except for `except`, the interfaces within it.
    pub(super) fn all_of(&self, interface: &str, except: &str, all: &mut Seen) {
        for (key, DeclaredKey { optional, holds }) in &self.interface(interface).keys {
            if *optional {
                all.insert((interface.to_owned(), key.clone(), None));
            }
            for one in self.alternatives(holds) {
                let within = one.within();
                all.insert((interface.to_owned(), key.clone(), Some(one.clone())));
                if let Type::Named(name) = within
                    && name != except
                {
                    self.all_of(name, except, all);
                }
            }
        }
    }

    /// Values of a type, one at least of each of its alternatives.
    pub(super) fn samples(&self, of: &Type) -> Vec<Value> {
        match of {
            Type::Text => vec![json!("text")],
            Type::Number => vec![json!(1)],
            Type::Boolean => vec![json!(true)],
            Type::Null | Type::Unknown => vec![Value::Null],
            Type::Literal(text) => vec![json!(text)],
            // Points and blocks have two coordinates.
            Type::List(of) => self
                .first_sample(of)
                .map(|one| json!([one, one]))
                .into_iter()
                .collect(),
            Type::Map(of) => self
                .first_sample(of)
                .map(|one| json!({ "key": one }))
                .into_iter()
                .collect(),
            Type::Named(name) if self.is_interface(name) => self.samples_of_interface(name),
            Type::Union(_) | Type::Named(_) => {
                let all = self.alternatives(of);
                all.iter().flat_map(|one| self.samples(one)).collect()
            }
        }
    }

    fn first_sample(&self, of: &Type) -> Option<Value> {
        let first = self.alternatives(of).into_iter().next()?;
        self.samples(&first).into_iter().next()
    }

    /// The object without its optional keys, and one for each sample of each key.
    fn samples_of_interface(&self, name: &str) -> Vec<Value> {
        let keys = &self.interface(name).keys;
        let required = keys.iter().filter(|(_, key)| !key.optional);
        let least = required.map(|(name, key)| (name.clone(), self.first_sample(&key.holds).unwrap()));
        let least: Map<String, Value> = least.collect();
        let with = |(name, key): (&String, &DeclaredKey)| {
            let object = |value| {
                let mut object = least.clone();
                object.insert(name.clone(), value);
                Value::Object(object)
            };
            self.samples(&key.holds)
                .into_iter()
                .map(object)
                .collect::<Vec<_>>()
        };
        let all: Vec<Value> = keys.iter().flat_map(with).collect();
        [Value::Object(least.clone())].into_iter().chain(all).collect()
    }
}

/// Names, texts in their marks, and single signs; without comments.
fn tokens(text: &str) -> Vec<String> {
    let mut all = Vec::new();
    let mut rest = text.trim_start();
    while let Some(first) = rest.chars().next() {
        let length = if rest.starts_with("//") {
            rest.find('\n').unwrap()
        } else if rest.starts_with("/*") {
            rest.find("*/").unwrap() + 2
        } else if first == '\'' {
            rest[1..].find('\'').unwrap() + 2
        } else {
            let is_letter = |c: char| c.is_ascii_alphanumeric() || c == '_';
            rest.find(|c| !is_letter(c)).unwrap_or(rest.len()).max(1)
        };
        if !rest.starts_with('/') {
            all.push(rest[..length].to_owned());
        }
        rest = rest[length..].trim_start();
    }
    all
}

struct Tokens(Peekable<IntoIter<String>>);

impl Tokens {
    fn next(&mut self) -> String {
        self.0.next().unwrap()
    }

    /// Whether this comes next; then it is passed.
    fn take(&mut self, token: &str) -> bool {
        self.0.next_if(|next| next == token).is_some()
    }

    fn expect(&mut self, token: &str) {
        assert_eq!(self.next(), token);
    }

    fn interface(&mut self) -> Interface {
        let mut interface = Interface::default();
        self.expect("{");
        while !self.take("}") {
            if self.take("[") {
                interface.open = true;
                self.map();
                self.take(";");
                continue;
            }
            let name = self.next();
            let optional = self.take("?");
            self.expect(":");
            let holds = self.union();
            self.expect(";");
            assert!(
                interface
                    .keys
                    .insert(name, DeclaredKey { optional, holds })
                    .is_none()
            );
        }
        interface
    }

    /// The rest of `[key: string]: Type`, after its first sign.
    fn map(&mut self) -> Type {
        for token in ["key", ":", "string", "]", ":"] {
            self.expect(token);
        }
        self.union()
    }

    fn union(&mut self) -> Type {
        let mut all = vec![self.one()];
        while self.take("|") {
            all.push(self.one());
        }
        if all.len() == 1 {
            all.remove(0)
        } else {
            Type::Union(all)
        }
    }

    fn one(&mut self) -> Type {
        let token = self.next();
        let mut one = match token.as_str() {
            "string" => Type::Text,
            "number" => Type::Number,
            "boolean" => Type::Boolean,
            "null" => Type::Null,
            "unknown" => Type::Unknown,
            "Record" => {
                for token in ["<", "string", ","] {
                    self.expect(token);
                }
                let of = self.union();
                self.expect(">");
                Type::Map(Box::new(of))
            }
            "{" => {
                self.expect("[");
                let of = self.map();
                self.expect("}");
                Type::Map(Box::new(of))
            }
            text if text.starts_with('\'') => Type::Literal(text.trim_matches('\'').to_owned()),
            name => Type::Named(name.to_owned()),
        };
        while self.take("[") {
            self.expect("]");
            one = Type::List(Box::new(one));
        }
        one
    }
}
