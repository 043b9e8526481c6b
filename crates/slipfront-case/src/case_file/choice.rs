//! Tables in which one of two keys sets the same thing, such as `v_star` and `speed` in `[drive]`.

/// Declares how a table with such a choice is read and written: a struct `$keys` with the keys as they stand in the file, each with
/// its default, and its conversions from and to the struct `$table`, where an enum in `$choice` says which key was given. If neither
/// was, `Ok` is followed by the choice, which also makes the default of the table, or `Err` by the sentence that refuses it.
macro_rules! keys_with_choice {
    (
        $table:ident: $keys:ident {
            $($(#[$before_meta:meta])* $before:ident: $before_type:ty = $before_default:expr,)*
            ($choice:ident: $enum:ident {
                $first:ident: $first_type:ty => $First:ident,
                $second:ident: $second_type:ty => $Second:ident,
                _ => $outcome:ident($otherwise:expr)
            }),
            $($(#[$after_meta:meta])* $after:ident: $after_type:ty = $after_default:expr,)*
        }
    ) => {
        #[derive(serde::Serialize, serde::Deserialize)]
        #[serde(default, deny_unknown_fields)]
        pub(super) struct $keys {
            $($(#[$before_meta])* $before: $before_type,)*
            $first: Option<$first_type>,
            $second: Option<$second_type>,
            $($(#[$after_meta])* $after: $after_type,)*
        }

        impl Default for $keys {
            fn default() -> Self {
                Self {
                    $($before: $before_default,)*
                    $first: None,
                    $second: None,
                    $($after: $after_default,)*
                }
            }
        }

        default_table! { $outcome $table { $($before: $before_default,)* $choice: $otherwise, $($after: $after_default,)* } }

        impl TryFrom<$keys> for $table {
            type Error = &'static str;

            fn try_from(keys: $keys) -> Result<Self, Self::Error> {
                let $choice = match (keys.$first, keys.$second) {
                    (_, Some(value)) => $enum::$Second(value),
                    (Some(value), None) => $enum::$First(value),
                    (None, None) => <Result<$enum, &'static str>>::$outcome($otherwise)?,
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

/// The default of a table whose choice has one.
macro_rules! default_table {
    (Ok $table:ident { $($field:ident: $value:expr,)* }) => {
        impl Default for $table {
            fn default() -> Self {
                Self { $($field: $value,)* }
            }
        }
    };
    (Err $($table:tt)*) => {};
}

pub(super) use {default_table, keys_with_choice};
