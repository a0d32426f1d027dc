//! Rows of tables whose columns are defined once: in the docs and in `--help`.

/// A struct whose fields are the columns of a table; their docs are what [`COLUMNS`](crate::trace::Detachment::COLUMNS)
/// says of them.
macro_rules! row {
    ($(#[$outer:meta])* pub struct $name:ident {
        $($(#[doc = $text:literal])+ pub $column:ident: $kind:ty,)*
    }) => {
        $(#[$outer])* pub struct $name {
            $($(#[doc = $text])+ pub $column: $kind,)*
        }

        impl $name {
            /// The columns of its table, in their order, and what they mean.
            pub const COLUMNS: &[(&str, &str)] = &[$((stringify!($column), concat!($($text),+))),*];
        }
    };
}

pub(crate) use row;
