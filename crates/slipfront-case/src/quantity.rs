//! Physical quantities as a user writes them: a number, a unit, a dimension.
//!
//! Every accepted unit is a power of ten of its SI unit. Conversion therefore shifts the decimal exponent of
//! the number's *text* before it is parsed: `f64::from_str` rounds the SI value once, to the `f64` nearest to
//! the written number. The case file reads quantities, and passes their SI values to the scales of the model.

use std::fmt;
use std::marker::PhantomData;
use std::str::FromStr;

use serde::de::{Deserialize, Deserializer, Visitor};
use serde::ser::{Serialize, Serializer};
use thiserror::Error;

use slipfront_base::number_format::exact;
use slipfront_base::text::truncated;

/// Largest length of a text that is read as a quantity, in bytes.
const MAX_TEXT: usize = 200;

/// Units without prefix: symbol, dimension, power of ten of the SI unit.
const UNITS: [(&str, Dimension, i32); 7] = [
    ("m", Dimension::new(0, 1, 0), 0),
    ("g", Dimension::new(1, 0, 0), -3),
    ("s", Dimension::new(0, 0, 1), 0),
    ("Pa", Dimension::new(1, -1, -2), 0),
    ("N", Dimension::new(1, 1, -2), 0),
    ("bar", Dimension::new(1, -1, -2), 5),
    ("Hz", Dimension::new(0, 0, -1), 0),
];

/// Units that are not accepted, for messages that convert them: symbol, dimension, size in the SI unit.
const FOREIGN_UNITS: [(&str, Dimension, f64); 34] = [
    ("min", Dimension::new(0, 0, 1), 60.0),
    ("h", Dimension::new(0, 0, 1), 3600.0),
    ("hr", Dimension::new(0, 0, 1), 3600.0),
    ("hour", Dimension::new(0, 0, 1), 3600.0),
    ("d", Dimension::new(0, 0, 1), 86_400.0),
    ("day", Dimension::new(0, 0, 1), 86_400.0),
    ("sec", Dimension::new(0, 0, 1), 1.0),
    ("micron", Dimension::new(0, 1, 0), 1e-6),
    ("A", Dimension::new(0, 1, 0), 1e-10),
    ("\u{c5}", Dimension::new(0, 1, 0), 1e-10),
    ("\u{212b}", Dimension::new(0, 1, 0), 1e-10),
    ("angstrom", Dimension::new(0, 1, 0), 1e-10),
    ("in", Dimension::new(0, 1, 0), 0.0254),
    ("inch", Dimension::new(0, 1, 0), 0.0254),
    ("mil", Dimension::new(0, 1, 0), 25.4e-6),
    ("ft", Dimension::new(0, 1, 0), 0.3048),
    ("cc", Dimension::new(0, 3, 0), 1e-6),
    ("l", Dimension::new(0, 3, 0), 1e-3),
    ("L", Dimension::new(0, 3, 0), 1e-3),
    ("t", Dimension::new(1, 0, 0), 1e3),
    ("lb", Dimension::new(1, 0, 0), 0.453_592_37),
    ("kgf", Dimension::new(1, 1, -2), 9.806_65),
    ("lbf", Dimension::new(1, 1, -2), 4.448_221_615_260_5),
    ("dyn", Dimension::new(1, 1, -2), 1e-5),
    ("psi", Dimension::new(1, -1, -2), 6_894.757_293_168),
    ("ksi", Dimension::new(1, -1, -2), 6_894_757.293_168),
    ("atm", Dimension::new(1, -1, -2), 101_325.0),
    ("at", Dimension::new(1, -1, -2), 98_066.5),
    ("torr", Dimension::new(1, -1, -2), 101_325.0 / 760.0),
    ("Torr", Dimension::new(1, -1, -2), 101_325.0 / 760.0),
    ("mmHg", Dimension::new(1, -1, -2), 101_325.0 / 760.0),
    ("mph", Dimension::new(0, 1, -1), 0.447_04),
    ("kph", Dimension::new(0, 1, -1), 1.0 / 3.6),
    ("kmh", Dimension::new(0, 1, -1), 1.0 / 3.6),
];

/// Prefixes: symbol, power of ten. The micro sign and the Greek mu are read as `u`.
const PREFIXES: [(&str, i32); 12] = [
    ("f", -15),
    ("p", -12),
    ("n", -9),
    ("u", -6),
    ("m", -3),
    ("c", -2),
    ("d", -1),
    ("h", 2),
    ("k", 3),
    ("M", 6),
    ("G", 9),
    ("T", 12),
];

/// The exponents of kilogram, metre and second.
///
/// ```
/// use slipfront_case::quantity::Pressure;
/// assert_eq!(Pressure::DIMENSION.to_string(), "kg m^-1 s^-2");
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Dimension([i32; 3]);

impl Dimension {
    /// The dimension kg^`kilogram` m^`metre` s^`second`.
    pub const fn new(kilogram: i32, metre: i32, second: i32) -> Self {
        Self([kilogram, metre, second])
    }

    fn times(self, other: Self, power: i32) -> Self {
        Self(std::array::from_fn(|unit| self.0[unit] + power * other.0[unit]))
    }

    fn name(self) -> &'static str {
        let named = NAMED.iter().find(|(dimension, _)| *dimension == self);
        named.map_or("another quantity", |(_, name)| name)
    }
}

impl fmt::Display for Dimension {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let powers = ["kg", "m", "s"].into_iter().zip(self.0);
        let factors = powers.filter_map(|(unit, power)| match power {
            0 => None,
            1 => Some(unit.to_owned()),
            _ => Some(format!("{unit}^{power}")),
        });
        let text = factors.collect::<Vec<_>>().join(" ");
        f.write_str(if text.is_empty() { "1" } else { &text })
    }
}

/// Reason why a text is not a quantity of the wanted dimension.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the sentence of each variant tells what it is")]
pub enum QuantityError {
    #[error("{value} has no unit; write {wanted} as a string with its unit, such as {example:?}")]
    NoUnit {
        value: String,
        wanted: &'static str,
        example: &'static str,
    },
    #[error("{text:?} does not begin with a number; give {wanted}, such as {example:?}")]
    NoNumber {
        text: String,
        wanted: &'static str,
        example: &'static str,
    },
    #[error("unknown unit `{unit}` in {text:?}: {advice}")]
    UnknownUnit {
        text: String,
        unit: String,
        advice: String,
    },
    #[error("the unit of {text:?} cannot be read: {why}")]
    Unit { text: String, why: &'static str },
    #[error("{text:?} is {given} ({dimension}); give {wanted}, such as {example:?}")]
    Dimension {
        text: String,
        given: &'static str,
        dimension: Dimension,
        wanted: &'static str,
        example: &'static str,
    },
    #[error("{text:?} is too {what} for a computation")]
    Range { text: String, what: &'static str },
    #[error("a string of {bytes} bytes is too long for a quantity such as {example:?}")]
    TooLong { bytes: usize, example: &'static str },
}

/// The kind of a [`Quantity`], implemented only by the markers in [`kind`].
pub trait Kind: Clone + fmt::Debug + PartialEq {
    /// The description of the kind.
    const DESCRIPTION: Description;
}

/// Description of a [`Kind`], as a value, so that one function reads all kinds.
#[derive(Clone, Copy, Debug)]
pub struct Description {
    dimension: Dimension,
    /// Name of the quantity with its article, for messages.
    name: &'static str,
    /// Example of the quantity, for messages.
    example: &'static str,
    /// SI unit of the quantity, in a form that can be read back.
    si_unit: &'static str,
}
macro_rules! quantities {
    ($($(#[$doc:meta])* $name:ident: $dimension:expr, $label:literal, $example:literal, $unit:literal;)*) => {
        /// Markers that distinguish the kinds of quantity.
        pub mod kind {
            use super::{Description, Dimension, Kind};
            $(
                $(#[$doc])*
                #[derive(Clone, Debug, PartialEq, Eq)]
                pub enum $name {}
                impl Kind for $name {
                    const DESCRIPTION: Description = Description {
                        dimension: $dimension,
                        name: $label,
                        example: $example,
                        si_unit: $unit,
                    };
                }
            )*
        }
        $($(#[$doc])* pub type $name = Quantity<kind::$name>;)*
        /// Dimensions with a name, for messages.
        const NAMED: &[(Dimension, &str)] = &[
            $(($dimension, $label),)*
        ];
    };
}

quantities! {
    /// A length, read into m.
    Length: Dimension::new(0, 1, 0), "a length", "1 um", "m";
    /// A pressure or an elastic modulus, read into Pa.
    Pressure: Dimension::new(1, -1, -2), "a pressure", "100 kPa", "Pa";
    /// A mass, read into kg.
    Mass: Dimension::new(1, 0, 0), "a mass", "20 g", "kg";
    /// A density, read into kg/m^3.
    Density: Dimension::new(1, -3, 0), "a density", "10 g/cm^3", "kg/m^3";
    /// A speed, read into m/s.
    Speed: Dimension::new(0, 1, -1), "a speed", "0.0949 mm/s", "m/s";
    /// A duration, read into s.
    Duration: Dimension::new(0, 0, 1), "a time", "84 ns", "s";
    /// A stiffness, read into N/m.
    Stiffness: Dimension::new(1, 0, -2), "a stiffness", "2 N/m", "N/m";
    /// A stiffness per area, read into N/m^3.
    StiffnessPerArea: Dimension::new(1, -2, -2), "a stiffness per area", "10 N/um/mm^2", "N/m^3";
    /// A force, read into N.
    Force: Dimension::new(1, 1, -2), "a force", "0.3 N", "N";
    /// A rate, read into 1/s.
    Rate: Dimension::new(0, 0, -1), "a rate", "3e8 1/s", "1/s";
}

/// A quantity, with its original text.
///
/// Two quantities are equal when their texts and values are. Bounds belong to the key of the quantity, and
/// are checked there.
///
/// ```
/// use slipfront_case::quantity::{Density, Length};
/// let block_size: Length = "25 um".parse()?;
/// assert_eq!(block_size.si(), 25e-6);
/// assert_eq!(block_size.to_string(), "25 um");
/// assert_eq!("10 g/cm^3".parse::<Density>()?.si(), 1e4);
/// assert_eq!(Length::from_si(25e-6).to_string(), "2.5e-5 m");
/// # Ok::<(), slipfront_case::quantity::QuantityError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Quantity<K: Kind> {
    text: String,
    si: f64,
    kind: PhantomData<K>,
}

impl<K: Kind> Quantity<K> {
    /// The dimension of every quantity of this type.
    pub const DIMENSION: Dimension = K::DESCRIPTION.dimension;
    /// The value in SI units: the `f64` nearest to the written number.
    pub fn si(&self) -> f64 {
        self.si
    }

    /// The quantity with an SI value, written with the fewest digits that read back to the same `f64`.
    ///
    /// Checking or reading a case file refuses a quantity with a value that is not finite.
    pub fn from_si(si: f64) -> Self {
        Self {
            text: format!("{si:?} {}", K::DESCRIPTION.si_unit),
            si,
            kind: PhantomData,
        }
    }
}

impl<K: Kind> From<f64> for Quantity<K> {
    fn from(si: f64) -> Self {
        Self::from_si(si)
    }
}

impl<K: Kind> fmt::Display for Quantity<K> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

impl<K: Kind> FromStr for Quantity<K> {
    type Err = QuantityError;

    fn from_str(text: &str) -> Result<Self, QuantityError> {
        Ok(Self {
            si: K::DESCRIPTION.read(text)?,
            text: text.to_owned(),
            kind: PhantomData,
        })
    }
}

impl Description {
    fn no_unit(self, value: String) -> QuantityError {
        QuantityError::NoUnit {
            value,
            wanted: self.name,
            example: self.example,
        }
    }

    /// Reads a text, and returns the value in SI units.
    fn read(self, text: &str) -> Result<f64, QuantityError> {
        if text.len() > MAX_TEXT {
            return Err(QuantityError::TooLong {
                bytes: text.len(),
                example: self.example,
            });
        }
        let number = DecimalText::split(text.trim()).ok_or_else(|| QuantityError::NoNumber {
            text: text.to_owned(),
            wanted: self.name,
            example: self.example,
        })?;
        if number.rest.trim().is_empty() {
            return Err(self.no_unit(text.trim().to_owned()));
        }
        let unit = Unit::read(text, number.rest, self.dimension, self.example)?;
        let dimension = unit.dimension;
        if dimension != self.dimension {
            return Err(QuantityError::Dimension {
                text: text.to_owned(),
                given: dimension.name(),
                dimension,
                wanted: self.name,
                example: self.example,
            });
        }
        let si = number.shifted(unit.power_of_ten).map(|si| si * unit.factor);
        let si = si
            .filter(|si| si.is_finite())
            .ok_or_else(|| QuantityError::Range {
                text: text.to_owned(),
                what: if number.exponent > 0 { "large" } else { "small" },
            })?;
        if let Some(foreign) = unit.foreign {
            return Err(QuantityError::UnknownUnit {
                text: text.to_owned(),
                unit: foreign,
                advice: format!("write \"{} {}\"", six_digits(si), self.si_unit),
            });
        }
        Ok(si)
    }
}

impl<K: Kind> Serialize for Quantity<K> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(&self.text)
    }
}

impl<'de, K: Kind> Deserialize<'de> for Quantity<K> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let (text, si) = deserializer.deserialize_any(QuantityVisitor(K::DESCRIPTION))?;
        Ok(Self {
            text,
            si,
            kind: PhantomData,
        })
    }
}

struct QuantityVisitor(Description);

impl Visitor<'_> for QuantityVisitor {
    /// Text of the quantity, and its value in SI units.
    type Value = (String, f64);

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Description { name, example, .. } = self.0;
        write!(f, "{name} as a string with its unit, such as {example:?}")
    }

    fn visit_str<E: serde::de::Error>(self, text: &str) -> Result<Self::Value, E> {
        let si = self.0.read(text).map_err(E::custom)?;
        Ok((text.to_owned(), si))
    }

    fn visit_i64<E: serde::de::Error>(self, value: i64) -> Result<Self::Value, E> {
        Err(E::custom(self.0.no_unit(value.to_string())))
    }

    fn visit_u64<E: serde::de::Error>(self, value: u64) -> Result<Self::Value, E> {
        Err(E::custom(self.0.no_unit(value.to_string())))
    }

    fn visit_f64<E: serde::de::Error>(self, value: f64) -> Result<Self::Value, E> {
        Err(E::custom(self.0.no_unit(format!("{value:?}"))))
    }
}

/// A number with its unit as written, of any dimension, for comparing quantities of unknown kind.
///
/// ```
/// use slipfront_case::quantity::WrittenQuantity;
/// let [one, other] = ["50 kPa", "1 MPa"].map(|text| WrittenQuantity::read(text).expect("a pressure"));
/// assert_eq!(one.unit(), "kPa");
/// assert_eq!(other.in_unit_of(&one), Some(1000.0));
/// assert!(WrittenQuantity::read("free").is_none());
/// ```
pub struct WrittenQuantity<'a> {
    number: DecimalText<'a>,
    unit: Unit,
}

impl<'a> WrittenQuantity<'a> {
    /// The quantity in a text; none if it is not a number with a known unit.
    pub fn read(text: &'a str) -> Option<Self> {
        let number = DecimalText::split(text.trim()).filter(|_| text.len() <= MAX_TEXT)?;
        let unit = number.rest.trim();
        if unit.is_empty() {
            return None;
        }
        let unit = Unit::read(text, unit, Dimension::new(0, 0, 0), "").ok()?;
        unit.foreign.is_none().then_some(Self { number, unit })
    }

    /// Unit of the quantity as written; `1/s` for `/s`.
    pub fn unit(&self) -> String {
        let unit = self.number.rest.trim();
        let one = if unit.starts_with('/') { "1" } else { "" };
        format!("{one}{unit}")
    }

    /// Value in the unit of another quantity, rounded once; none if the dimensions differ.
    pub fn in_unit_of(&self, other: &Self) -> Option<f64> {
        let is_alike = self.unit.dimension == other.unit.dimension;
        let power = self.unit.power_of_ten - other.unit.power_of_ten;
        self.number.shifted(power).filter(|_| is_alike)
    }

    /// The quantity in kilograms, metres and seconds, as a text that is equal for equal quantities.
    pub fn in_base_units(&self) -> String {
        // Neither too large a number nor one that vanishes has a value.
        let value = self.number.shifted(self.unit.power_of_ten).unwrap_or(f64::NAN);
        format!("{} {}", value + 0.0, self.unit.dimension)
    }
}

/// A decimal number at the beginning of a text, not yet rounded.
struct DecimalText<'a> {
    /// Sign, digits and decimal point.
    mantissa: &'a str,
    exponent: i32,
    rest: &'a str,
}

impl<'a> DecimalText<'a> {
    fn split(text: &'a str) -> Option<Self> {
        let unsigned = text.strip_prefix(['+', '-']).unwrap_or(text);
        let after_digits = unsigned.trim_start_matches(|c: char| c.is_ascii_digit() || c == '.');
        let mantissa = &text[..text.len() - after_digits.len()];
        // Digits and at most one point: the standard library parses none of "1.2.3", "." and "".
        mantissa.parse::<f64>().ok()?;
        let (exponent, rest) = split_exponent(after_digits)?;
        Some(Self {
            mantissa,
            exponent,
            rest,
        })
    }

    /// The number times 10^`power`, rounded once; `None` when it overflows, or underflows to zero.
    fn shifted(&self, power: i32) -> Option<f64> {
        let exponent = self.exponent.saturating_add(power);
        let value: f64 = format!("{}e{exponent}", self.mantissa).parse().ok()?;
        let is_zero = !self.mantissa.contains(|c: char| c.is_ascii_digit() && c != '0');
        (value.is_finite() && (value != 0.0 || is_zero)).then_some(value)
    }
}

/// Splits "e-3 mm" into -3 and " mm". An `e` without a digit after it belongs to the unit.
fn split_exponent(text: &str) -> Option<(i32, &str)> {
    let Some(after_e) = text.strip_prefix(['e', 'E']) else {
        return Some((0, text));
    };
    let unsigned = after_e.strip_prefix(['+', '-']).unwrap_or(after_e);
    let rest = unsigned.trim_start_matches(|c: char| c.is_ascii_digit());
    if rest.len() == unsigned.len() {
        return Some((0, text));
    }
    let digits = &after_e[..after_e.len() - rest.len()];
    // The only possible error is too many digits: such a number overflows or underflows in any case.
    let limit = if digits.starts_with('-') {
        i32::MIN
    } else {
        i32::MAX
    };
    Some((digits.parse().unwrap_or(limit), rest))
}

/// A product of powers of units.
struct Unit {
    dimension: Dimension,
    /// The unit is 10^`power_of_ten` times `factor` SI units; `factor` is 1 if every unit in it is accepted.
    power_of_ten: i32,
    factor: f64,
    /// The first symbol in the unit that is not accepted.
    foreign: Option<String>,
}

impl Unit {
    /// Reads the unit of `text`, a quantity of dimension `wanted`.
    fn read(
        text: &str,
        unit_text: &str,
        wanted: Dimension,
        example: &'static str,
    ) -> Result<Self, QuantityError> {
        let unit_text = with_ascii_signs(unit_text);
        let factors = split_factors(text, &unit_text)?;
        let mut unit = Self {
            dimension: Dimension::new(0, 0, 0),
            power_of_ten: 0,
            factor: 1.0,
            foreign: None,
        };
        for &(symbol, power) in &factors {
            if let Some((dimension, power_of_ten)) = find_symbol(symbol) {
                unit.dimension = unit.dimension.times(dimension, power);
                unit.power_of_ten += power * power_of_ten;
            } else if let Some((_, dimension, factor)) =
                FOREIGN_UNITS.iter().find(|(foreign, ..)| *foreign == symbol)
            {
                unit.dimension = unit.dimension.times(*dimension, power);
                unit.factor *= factor.powi(power);
                unit.foreign.get_or_insert_with(|| symbol.to_owned());
            } else {
                return Err(QuantityError::UnknownUnit {
                    text: text.to_owned(),
                    unit: truncated(symbol),
                    advice: advice_on(&unit_text, symbol, &factors, wanted, example),
                });
            }
        }
        Ok(unit)
    }
}

/// Splits "kg/m^3" into the symbols and powers ("kg", 1) and ("m", -3).
fn split_factors<'u>(text: &str, unit_text: &'u str) -> Result<Vec<(&'u str, i32)>, QuantityError> {
    let wrong = |why| QuantityError::Unit {
        text: text.to_owned(),
        why,
    };
    let mut all = Vec::new();
    for (place, part) in unit_text.split('/').enumerate() {
        let factors = part.split(['*', ' ']).filter(|factor| !factor.is_empty());
        let factors: Vec<&str> = factors.collect();
        let sign = if place == 0 { 1 } else { -1 };
        match factors.as_slice() {
            // "1/s" after the number, or "5/s" without the 1.
            [] | ["1"] if place == 0 && unit_text.contains('/') => continue,
            [] => return Err(wrong("a unit is missing beside `/` or `*`")),
            [_, _, ..] if place > 0 => {
                return Err(wrong(
                    "a product after `/` is ambiguous: write `/` or `^-1` for every factor below the line",
                ));
            }
            _ => {}
        }
        for factor in factors {
            let (symbol, power) = split_power(factor)
                .ok_or_else(|| wrong("a power is a whole number from -9 to 9, as in `m^-3`"))?;
            all.push((symbol, sign * power));
        }
    }
    Ok(all)
}

/// Replaces signs with their ASCII spelling: micro, middle dot, superscripts.
fn with_ascii_signs(text: &str) -> String {
    const SUPERSCRIPTS: [char; 10] = [
        '\u{2070}', '\u{b9}', '\u{b2}', '\u{b3}', '\u{2074}', '\u{2075}', '\u{2076}', '\u{2077}', '\u{2078}',
        '\u{2079}',
    ];
    let mut ascii = String::new();
    let mut in_superscript = false;
    for c in text.chars() {
        let raised = match c {
            '\u{207b}' => Some('-'),
            _ => (('0'..='9').zip(SUPERSCRIPTS)).find_map(|(digit, sign)| (sign == c).then_some(digit)),
        };
        match (raised, c) {
            (Some(raised), _) if in_superscript => ascii.push(raised),
            (Some(raised), _) => ascii.extend(['^', raised]),
            (None, '\u{b5}' | '\u{3bc}') => ascii.push('u'),
            (None, '\u{b7}' | '\u{22c5}') => ascii.push('*'),
            (None, c) if c.is_whitespace() => ascii.push(' '),
            (None, c) => ascii.push(c),
        }
        in_superscript = raised.is_some();
    }
    ascii
}

fn split_power(factor: &str) -> Option<(&str, i32)> {
    let Some((symbol, power)) = factor.split_once('^') else {
        return Some((factor, 1));
    };
    let power = power.parse().ok().filter(|power| (-9..=9).contains(power))?;
    Some((symbol, power))
}

/// The dimension and power of ten of a symbol: a bare unit, or otherwise a prefix and a unit.
fn find_symbol(symbol: &str) -> Option<(Dimension, i32)> {
    let bare = |name: &str| {
        let unit = UNITS.iter().find(|(unit, ..)| *unit == name);
        unit.map(|&(_, dimension, power)| (dimension, power))
    };
    bare(symbol).or_else(|| {
        PREFIXES.iter().find_map(|(prefix, power_of_prefix)| {
            let (dimension, power) = bare(symbol.strip_prefix(prefix)?)?;
            Some((dimension, power + power_of_prefix))
        })
    })
}

/// Advice on an unknown `symbol` among the `factors` of a unit: the nearest unit that gives the
/// product the `wanted` dimension, or otherwise the known units.
fn advice_on(
    unit_text: &str,
    symbol: &str,
    factors: &[(&str, i32)],
    wanted: Dimension,
    example: &str,
) -> String {
    if symbol.starts_with(',') {
        return "the decimal sign is a point".to_owned();
    }
    // The dimension that remains for the unknown factor; none if several are unknown.
    let is_unknown = |&&(other, _): &&(&str, i32)| find_symbol(other).is_none();
    let unknown: Vec<&(&str, i32)> = factors.iter().filter(is_unknown).collect();
    if let [(_, power)] = unknown.as_slice() {
        let known = factors
            .iter()
            .filter_map(|&(other, power)| Some((find_symbol(other)?.0, power)));
        let rest = known.fold(Dimension::new(0, 0, 0), |all, (unit, power)| {
            all.times(unit, power)
        });
        let fits = |unit: Dimension, power: i32| rest.times(unit, power) == wanted;
        // "mm2" for "mm^2".
        let bare = symbol.trim_end_matches(|c: char| c.is_ascii_digit());
        if let (Some((unit, _)), Ok(raised @ 1..=9)) =
            (find_symbol(bare), symbol[bare.len()..].parse::<i32>())
            && fits(unit, power * raised)
        {
            return format!("did you mean `{bare}^{raised}`?");
        }
        // 1 MPa is nearer to the example "100 kPa" than 1 mPa, for "2 mpa" as for "210000 mpa".
        let decades = |near: &str| {
            let read = |text: &str| {
                let written = WrittenQuantity::read(text)?;
                written.number.shifted(written.unit.power_of_ten)
            };
            let one = format!("1 {}", unit_text.replacen(symbol, near, 1));
            let ratio = read(&one).zip(read(example));
            ratio.map_or(0.0, |(value, usual)| libm::log10(value / usual).abs())
        };
        if let Some(near) = nearest_unit(symbol, |unit| fits(unit, *power), decades) {
            return format!("did you mean `{near}`?");
        }
    }
    format!(
        "write it as in {example:?}; the units are m, g, s, Pa, N, bar and Hz, with the prefixes f p n u m c d h k M G T"
    )
}

/// The accepted unit, with its prefix, that is spelt most like `symbol`, among those with a suitable
/// dimension; of those that differ from it by capitals alone, the one with the fewest `decades` from a usual
/// value.
fn nearest_unit(
    symbol: &str,
    fits: impl Fn(Dimension) -> bool,
    decades: impl Fn(&str) -> f64,
) -> Option<String> {
    let units = UNITS.iter().filter(|(_, dimension, _)| fits(*dimension));
    let candidates = units.flat_map(|(unit, ..)| {
        let prefixes = PREFIXES.iter().map(|(prefix, _)| *prefix).chain([""]);
        prefixes.map(move |prefix| format!("{prefix}{unit}"))
    });
    let distance = |unit: &str| {
        // "KPA" is nearer to "kPa" than to any unit with other letters.
        let folded = strsim::damerau_levenshtein(&unit.to_lowercase(), &symbol.to_lowercase());
        let unusual = if folded == 0 {
            decades(unit).round() as u64
        } else {
            0
        };
        (folded, unusual, strsim::damerau_levenshtein(unit, symbol))
    };
    let nearest = candidates.map(|unit| (distance(&unit), unit)).min();
    let ((distance, ..), unit) = nearest?;
    (distance == 0 || distance == 1 && symbol.len() > 1).then_some(unit)
}

/// A number to six digits, for a conversion.
fn six_digits(value: f64) -> String {
    exact(format!("{value:.5e}").parse().unwrap_or(value))
}

#[cfg(test)]
mod tests;
