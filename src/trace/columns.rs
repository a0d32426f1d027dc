//! Table rows whose columns are defined once, for the documentation and `--help`.

/// Defines a struct whose fields are the columns of a table. Their doc comments are the descriptions in
/// [`COLUMNS`](crate::trace::Detachment::COLUMNS).
macro_rules! row {
    ($(#[$outer:meta])* pub struct $name:ident {
        $($(#[doc = $text:literal])+ pub $column:ident: $kind:ty,)*
    }) => {
        $(#[$outer])* pub struct $name {
            $($(#[doc = $text])+ pub $column: $kind,)*
        }

        impl $name {
            /// Names and descriptions of the columns of the table, `[column]`, in order.
            pub const COLUMNS: &[(&str, &str)] = &[$((stringify!($column), concat!($($text),+))),*];
        }
    };
}

pub(crate) use row;
