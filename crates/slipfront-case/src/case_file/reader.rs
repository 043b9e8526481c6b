//! Reads the values of a parsed file into structs. The deserializer of toml offers every type of value to
//! every type that is read, with separate code for each pair. This one offers only the possible types, so
//! that the module of a page without a server is 120 kB smaller.

use std::fmt;
use std::ops::Range;

use serde::de::{
    DeserializeSeed, Deserializer, Error as _, Expected, IntoDeserializer, MapAccess, SeqAccess, Unexpected,
    Visitor,
};
use toml::Spanned;
use toml::de::{DeArray, DeInteger, DeTable, DeValue};

/// Reason why a value cannot be read, and its place, if it is known.
#[derive(Debug)]
pub(super) struct ReadError {
    pub(super) message: String,
    pub(super) span: Option<Range<usize>>,
}

impl ReadError {
    /// Sets the place of the error, unless a narrower one is known.
    fn at(mut self, span: &Range<usize>) -> Self {
        self.span.get_or_insert_with(|| span.clone());
        self
    }
}

impl fmt::Display for ReadError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl std::error::Error for ReadError {}

impl serde::de::Error for ReadError {
    fn custom<T: fmt::Display>(message: T) -> Self {
        let message = message.to_string();
        Self { message, span: None }
    }
}

/// A value to be read.
pub(super) struct Reader<'i> {
    value: DeValue<'i>,
    span: Range<usize>,
}

impl<'i> From<Spanned<DeValue<'i>>> for Reader<'i> {
    fn from(value: Spanned<DeValue<'i>>) -> Self {
        Self {
            span: value.span(),
            value: value.into_inner(),
        }
    }
}

/// A whole number that fits one of the integer types of keys.
enum Whole {
    Signed(i64),
    Unsigned(u64),
}

impl Whole {
    fn parse(number: &DeInteger<'_>) -> Option<Self> {
        let (digits, radix) = (number.as_str(), number.radix());
        let signed = i64::from_str_radix(digits, radix).map(Self::Signed);
        let whole = signed.or_else(|_| u64::from_str_radix(digits, radix).map(Self::Unsigned));
        whole.ok()
    }
}

/// A number with a fraction or an exponent; none if it overflows.
fn float(text: &str) -> Option<f64> {
    let number: f64 = text.parse().ok()?;
    (number.is_finite() || text.contains("inf") || text.contains("nan")).then_some(number)
}

/// Error for a value that does not have the expected type.
fn unexpected(value: &DeValue<'_>, expected: &dyn Expected) -> ReadError {
    let found = match value {
        DeValue::String(text) => Unexpected::Str(text),
        DeValue::Integer(number) => match Whole::parse(number) {
            Some(Whole::Signed(number)) => Unexpected::Signed(number),
            Some(Whole::Unsigned(number)) => Unexpected::Unsigned(number),
            None => return ReadError::custom("integer number overflowed"),
        },
        DeValue::Float(number) => match float(number.as_str()) {
            Some(number) => Unexpected::Float(number),
            None => return ReadError::custom("floating-point number overflowed"),
        },
        DeValue::Boolean(yes) => Unexpected::Bool(*yes),
        DeValue::Array(_) => Unexpected::Seq,
        DeValue::Datetime(_) | DeValue::Table(_) => Unexpected::Map,
    };
    ReadError::invalid_type(found, expected)
}

fn whole<'i, V: Visitor<'i>>(number: DeInteger<'i>, visitor: V) -> Result<V::Value, ReadError> {
    match Whole::parse(&number) {
        Some(Whole::Signed(number)) => visitor.visit_i64(number),
        Some(Whole::Unsigned(number)) => visitor.visit_u64(number),
        None => Err(unexpected(&DeValue::Integer(number), &visitor)),
    }
}

impl<'de> Reader<'de> {
    /// Visits the value. An error gets its place.
    fn visit<T>(self, visit: impl FnOnce(DeValue<'de>) -> Result<T, ReadError>) -> Result<T, ReadError> {
        let Self { value, span } = self;
        visit(value).map_err(|error| error.at(&span))
    }

    fn number<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, ReadError> {
        self.visit(|value| match value {
            DeValue::Integer(number) => whole(number, visitor),
            DeValue::Float(ref number) => match float(number.as_str()) {
                Some(number) => visitor.visit_f64(number),
                None => Err(unexpected(&value, &visitor)),
            },
            other => Err(unexpected(&other, &visitor)),
        })
    }

    fn text<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, ReadError> {
        self.visit(|value| match value {
            // Not borrowed text, which would need separate code for every type: cases keep no borrowed text.
            DeValue::String(text) => visitor.visit_str(&text),
            other => Err(unexpected(&other, &visitor)),
        })
    }

    fn list<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, ReadError> {
        self.visit(|value| match value {
            DeValue::Array(values) => visitor.visit_seq(Elements(values.into_iter())),
            other => Err(unexpected(&other, &visitor)),
        })
    }

    fn table<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, ReadError> {
        self.visit(|value| match value {
            DeValue::Table(table) => visitor.visit_map(Entries {
                left: table.into_iter(),
                value: None,
            }),
            other => Err(unexpected(&other, &visitor)),
        })
    }
}

/// Functions of a deserializer that all call one function of [`Reader`].
macro_rules! read_as {
    ($($how:ident: $($function:ident)+;)*) => {$($(
        fn $function<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, ReadError> {
            self.$how(visitor)
        }
    )+)*};
}

impl<'de> Deserializer<'de> for Reader<'de> {
    type Error = ReadError;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, ReadError> {
        match self.value {
            DeValue::String(_) => self.text(visitor),
            DeValue::Integer(_) | DeValue::Float(_) => self.number(visitor),
            DeValue::Boolean(yes) => self.visit(|_| visitor.visit_bool(yes)),
            DeValue::Array(_) => self.list(visitor),
            DeValue::Datetime(_) | DeValue::Table(_) => self.table(visitor),
        }
    }

    fn deserialize_bool<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, ReadError> {
        self.visit(|value| match value {
            DeValue::Boolean(yes) => visitor.visit_bool(yes),
            other => Err(unexpected(&other, &visitor)),
        })
    }

    read_as! {
        number: deserialize_i8 deserialize_i16 deserialize_i32 deserialize_i64
            deserialize_u8 deserialize_u16 deserialize_u32 deserialize_u64 deserialize_f32 deserialize_f64;
        text: deserialize_str deserialize_string deserialize_char deserialize_identifier;
        list: deserialize_seq;
        table: deserialize_map;
    }

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        _name: &'static str,
        _fields: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, ReadError> {
        self.table(visitor)
    }

    /// A key that is present has a value.
    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, ReadError> {
        let span = self.span.clone();
        visitor.visit_some(self).map_err(|error| error.at(&span))
    }

    fn deserialize_newtype_struct<V: Visitor<'de>>(
        self,
        _name: &'static str,
        visitor: V,
    ) -> Result<V::Value, ReadError> {
        let span = self.span.clone();
        visitor
            .visit_newtype_struct(self)
            .map_err(|error| error.at(&span))
    }

    /// Enums of a case are words.
    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _name: &'static str,
        _variants: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, ReadError> {
        self.visit(|value| match value {
            DeValue::String(word) => visitor.visit_enum(word.into_deserializer()),
            other => Err(unexpected(&other, &visitor)),
        })
    }

    serde::forward_to_deserialize_any! {
        i128 u128 bytes byte_buf unit unit_struct tuple tuple_struct ignored_any
    }
}

/// The values of an array, in order.
struct Elements<'i>(<DeArray<'i> as IntoIterator>::IntoIter);

impl<'de> SeqAccess<'de> for Elements<'de> {
    type Error = ReadError;

    fn next_element_seed<T: DeserializeSeed<'de>>(&mut self, seed: T) -> Result<Option<T::Value>, ReadError> {
        let next = self.0.next();
        next.map(|value| seed.deserialize(Reader::from(value)))
            .transpose()
    }
}

/// The keys of a table with their values, in order.
struct Entries<'i> {
    left: <DeTable<'i> as IntoIterator>::IntoIter,
    /// Value of the last key that was read.
    value: Option<Spanned<DeValue<'i>>>,
}

impl<'de> MapAccess<'de> for Entries<'de> {
    type Error = ReadError;

    fn next_key_seed<K: DeserializeSeed<'de>>(&mut self, seed: K) -> Result<Option<K::Value>, ReadError> {
        let Some((key, value)) = self.left.next() else {
            return Ok(None);
        };
        self.value = Some(value);
        let span = key.span();
        let read: Result<_, ReadError> = seed.deserialize(key.into_inner().into_deserializer());
        read.map(Some).map_err(|error| error.at(&span))
    }

    fn next_value_seed<V: DeserializeSeed<'de>>(&mut self, seed: V) -> Result<V::Value, ReadError> {
        let value = self.value.take();
        let value = value.ok_or_else(|| ReadError::custom("a value is read once, after its key"))?;
        let span = value.span();
        seed.deserialize(Reader::from(value))
            .map_err(|error| error.at(&span))
    }
}
