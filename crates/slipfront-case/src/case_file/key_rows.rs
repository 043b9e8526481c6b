//! Tables of a file, declared with one row per key.

/// Declares the struct of a table and the keys of the table, `KEYS`, with one row per key: its meaning as a
/// doc comment, its name, the type of its value, and its [`key`](super::key).
///
/// Rows of alternative keys for one quantity, such as `v_star` and `speed` in `[drive]`, are in brackets. The
/// struct then has an enum in their place for the key that was given. A table with none of them is refused
/// with the sentence after `or`. A second struct has the keys as in the file, with conversions from and to
/// the first.
///
/// A table of a case, `checked` or with alternative keys, also gets the check of its values against the kinds
/// of their keys, `check_values`.
#[macro_export]
macro_rules! key_rows {
    (
        $(#[$attribute:meta])*
        pub struct $table:ident checked {
            $($(#[doc = $doc:literal])+ $(#[serde($($serde:tt)*)])* pub $name:ident: $type:ty = $key:expr,)+
        }
    ) => {
        $crate::key_rows! {
            $(#[$attribute])*
            pub struct $table {
                $($(#[doc = $doc])+ $(#[serde($($serde)*)])* pub $name: $type = $key,)+
            }
        }

        impl $table {
            /// Refuses values that their keys do not accept.
            pub(in $crate::case_file) fn check_values(&self, check: &Check) -> Result<(), CaseError> {
                $(check.value(stringify!($name), &self.$name)?;)+
                Ok(())
            }
        }

        impl Checked for $table {
            fn check(&self, check: &Check, key: &str, _: &KeyKind) -> Result<(), CaseError> {
                self.check_values(&check.within(&check.path_of(key), Self::KEYS))
            }
        }
    };
    (
        $(#[$attribute:meta])*
        $of_table:vis struct $table:ident {
            $($(#[doc = $doc:literal])+ $(#[serde($($serde:tt)*)])* $vis:vis $name:ident: $type:ty = $key:expr,)+
        }
    ) => {
        $(#[$attribute])*
        $of_table struct $table {
            $($(#[doc = $doc])+ $(#[serde($($serde)*)])* $vis $name: $type,)+
        }

        impl $table {
            /// The keys of the table, in the order of the documentation.
            pub const KEYS: &'static [$crate::case_file::Key] =
                &[$($key.named(stringify!($name), concat!($($doc),+)),)+];
        }
    };
    (
        $(#[$attribute:meta])*
        pub struct $table:ident from $file:ident {
            $($(#[doc = $doc:literal])+ $(#[serde($($serde:tt)*)])* pub $name:ident: $type:ty = $key:expr,)*
            $(
                [$(#[$of_choice:meta])+ pub $choice:ident: $enum:ident or $missing:literal {
                    $($(#[doc = $doc_one:literal])+ $(#[serde($($serde_one:tt)*)])*
                        $one:ident: $type_one:ty => $Variant:ident = $key_one:expr,)+
                }]
                $($(#[doc = $doc_after:literal])+ $(#[serde($($serde_after:tt)*)])*
                    pub $after:ident: $type_after:ty = $key_after:expr,)*
            )+
        }
    ) => {
        $(#[$attribute])*
        pub struct $table {
            $($(#[doc = $doc])+ pub $name: $type,)*
            $($(#[$of_choice])+ pub $choice: $enum, $($(#[doc = $doc_after])+ pub $after: $type_after,)*)+
        }

        impl $table {
            /// The keys of the table, in the order of the documentation.
            pub const KEYS: &'static [Key] = &[
                $($key.named(stringify!($name), concat!($($doc),+)),)*
                $(
                    $($key_one.or($enum::KEYS).named(stringify!($one), concat!($($doc_one),+)),)+
                    $($key_after.named(stringify!($after), concat!($($doc_after),+)),)*
                )+
            ];

            /// Refuses values that their keys do not accept.
            pub(in $crate::case_file) fn check_values(&self, check: &Check) -> Result<(), CaseError> {
                $(check.value(stringify!($name), &self.$name)?;)*
                $(
                    match &self.$choice {
                        $($enum::$Variant(value) => check.value(stringify!($one), value)?,)+
                    }
                    $(check.value(stringify!($after), &self.$after)?;)*
                )+
                Ok(())
            }
        }
        $(
            $(#[$of_choice])+
            #[derive(Clone, Debug, PartialEq)]
            pub enum $enum {
                $($(#[doc = $doc_one])+ $Variant($type_one),)+
            }

            impl $enum {
                /// Names of all keys for the quantity, of which a table has one.
                const KEYS: &'static [&'static str] = &[$(stringify!($one)),+];

                /// Name of the given key.
                pub const fn key(&self) -> &'static str {
                    match self {
                        $(Self::$Variant(_) => stringify!($one),)+
                    }
                }

            }
        )+

        #[derive(serde::Serialize, serde::Deserialize)]
        #[serde(deny_unknown_fields)]
        pub(super) struct $file {
            $($(#[serde($($serde)*)])* $name: $type,)*
            $(
                $($(#[serde($($serde_one)*)])* $one: Option<$type_one>,)+
                $($(#[serde($($serde_after)*)])* $after: $type_after,)*
            )+
        }

        impl TryFrom<$file> for $table {
            type Error = &'static str;

            fn try_from(keys: $file) -> Result<Self, Self::Error> {
                Ok(Self {
                    $($name: keys.$name,)*
                    $(
                        $choice: {
                            let given = None;
                            $(let given = keys.$one.map($enum::$Variant).or(given);)+
                            given.ok_or($missing)?
                        },
                        $($after: keys.$after,)*
                    )+
                })
            }
        }

        impl From<$table> for $file {
            fn from(table: $table) -> Self {
                let mut keys = Self {
                    $($name: table.$name,)*
                    $($($one: None,)+ $($after: table.$after,)*)+
                };
                $(match table.$choice {
                    $($enum::$Variant(value) => keys.$one = Some(value),)+
                })+
                keys
            }
        }
    };
}
