//! Tables in which one of two keys sets the same thing, such as `v_star` and `speed` in `[drive]`.

/// Declares how a table with such a choice is read and written: a struct `$keys` with the keys as they stand in the file,
/// and its conversions from and to the struct `$table`, where an enum in `$choice` says which key was given. A table with
/// neither key is refused with the sentence that follows.
macro_rules! keys_with_choice {
    (
        $table:ident: $keys:ident {
            $($(#[$before_meta:meta])* $before:ident: $before_type:ty,)*
            ($choice:ident: $enum:ident {
                $first:ident: $first_type:ty => $First:ident,
                $second:ident: $second_type:ty => $Second:ident,
                _ => $missing:literal
            }),
            $($(#[$after_meta:meta])* $after:ident: $after_type:ty,)*
        }
    ) => {
        #[derive(serde::Serialize, serde::Deserialize)]
        #[serde(deny_unknown_fields)]
        pub(super) struct $keys {
            $($(#[$before_meta])* $before: $before_type,)*
            $first: Option<$first_type>,
            $second: Option<$second_type>,
            $($(#[$after_meta])* $after: $after_type,)*
        }

        impl $enum {
            /// Checks the value of the key that was given.
            pub(super) fn check(&self, check: &Check) -> Result<(), CaseError> {
                match self {
                    Self::$First(value) => check.value(stringify!($first), value),
                    Self::$Second(value) => check.value(stringify!($second), value),
                }
            }
        }

        impl TryFrom<$keys> for $table {
            type Error = &'static str;

            fn try_from(keys: $keys) -> Result<Self, Self::Error> {
                let $choice = match (keys.$first, keys.$second) {
                    (_, Some(value)) => $enum::$Second(value),
                    (Some(value), None) => $enum::$First(value),
                    (None, None) => return Err($missing),
                };
                Ok(Self {
                    $($before: keys.$before,)*
                    $choice,
                    $($after: keys.$after,)*
                })
            }
        }

        impl From<$table> for $keys {
            fn from(table: $table) -> Self {
                let ($first, $second) = match table.$choice {
                    $enum::$First(value) => (Some(value), None),
                    $enum::$Second(value) => (None, Some(value)),
                };
                Self {
                    $($before: table.$before,)*
                    $first,
                    $second,
                    $($after: table.$after,)*
                }
            }
        }
    };
}

pub(super) use keys_with_choice;
