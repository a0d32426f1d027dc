//! Names of the variants of enums, for options and messages.

/// Gives an enum the list of its variants, in this order, and their names.
macro_rules! names {
    ($kind:ident { $($variant:ident = $name:literal),* }) => {
        impl $kind {
            /// All variants.
            pub const ALL: [Self; [$($name),*].len()] = [$(Self::$variant),*];

            /// Returns the name of the variant in options and messages.
            #[must_use]
            pub const fn name(self) -> &'static str {
                match self { $(Self::$variant => $name),* }
            }
        }
    };
}

pub(crate) use names;
