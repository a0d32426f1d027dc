//! Table rows whose columns are defined once, for the documentation and `--help`.

use whiskmap_mechanics::shooting::Reading;

/// Expands to the description of a column: its own, that which all tables have, or that of the field of [`Reading`] with its name.
macro_rules! column {
    ($column:ident $($text:literal)+) => { concat!($($text),+) };
    (side) => { " Side of the whisker that the pole is on: cb (convex) or cf (concave)." };
    (distance_mm) => { " Distance from the base to the contact at first touch, in mm." };
    (push_angle_deg) => { " Rotation of the base since first touch, in degrees: positive CB, negative CF." };
    (snaps_deg) => { " Push up to which the whisker may snap to other stable states, in degrees." };
    (peak_strain) => { " Largest bending strain at the surface: radius times change of curvature." };
    (peak_strain_mm) => { " Arclength from the base to the largest bending strain, in mm." };
    ($field:ident) => { whiskmap_mechanics::state_column!($field) };
}

/// Defines a struct whose fields are the columns of a table. Their doc comments are the descriptions in
/// [`COLUMNS`](crate::trace::Detachment::COLUMNS); without one, the description is that of all tables.
///
/// A row `of a state` is a [`StateRow`]: fields marked `= place` and `= load` have the values of a [`Reading`].
macro_rules! row {
    ($(#[$outer:meta])* pub struct $name:ident {
        $($(#[doc = $text:literal])* pub $column:ident: $kind:ty,)*
    }) => {
        $(#[$outer])* pub struct $name {
            $(#[doc = $crate::trace::column!($column $($text)*)] pub $column: $kind,)*
        }

        impl $name {
            /// Names and descriptions of the columns of the table, `[column]`, in order.
            pub const COLUMNS: &[(&str, &str)] =
                &[$((stringify!($column), $crate::trace::column!($column $($text)*))),*];
        }
    };
    ($(#[$outer:meta])* pub struct $name:ident of a state {
        $($(#[doc = $text:literal])* pub $column:ident: $kind:ty $(= $part:ident)?,)*
    }) => {
        $crate::trace::row! {
            $(#[$outer])* pub struct $name {
                $($(#[doc = $text])* pub $column: $kind,)*
            }
        }

        impl $crate::trace::StateRow for $name {
            fn with_state(mut self, state: Option<&whiskmap_mechanics::shooting::Reading>) -> Self {
                if let Some(state) = state {
                    $($($crate::trace::row!(@value $part self.$column = state.$column);)?)*
                }
                self
            }

            fn unloaded(mut self) -> Self {
                $($($crate::trace::row!(@zero $part self.$column);)?)*
                self
            }
        }
    };
    (@value $part:ident $row:ident.$column:ident = $state:ident.$field:ident) => { $row.$column = $state.$field.into() };
    (@zero place $row:ident.$column:ident) => {};
    (@zero load $row:ident.$column:ident) => { $row.$column = 0.0.into() };
}

pub(crate) use {column, row};

/// Row with columns of a state, by the names of the fields of [`Reading`].
pub(crate) trait StateRow {
    /// Returns the row with the values of `state`; unchanged without one.
    fn with_state(self, state: Option<&Reading>) -> Self;

    /// Returns the row with all loads 0, as those of a free whisker.
    fn unloaded(self) -> Self;
}
