//! Table rows whose columns are defined once, for the documentation and `--help`.

use whiskmap_mechanics::rod::Side;
use whiskmap_mechanics::shooting::Reading;

/// Expands to the description of a column: its own description, the shared one of all tables, or the description of the field of
/// [`Reading`] with its name.
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
/// [`COLUMNS`](crate::trace::Detachment::COLUMNS); a field without one has the shared description of all tables.
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

            fn contact(&self) -> $crate::trace::ContactColumns {
                let mut contact = $crate::trace::ContactColumns::default();
                $($crate::trace::row!(@contact contact.$column = self);)*
                contact
            }
        }
    };
    (@contact $contact:ident.side = $row:ident) => { $contact.side = $row.side.into() };
    (@contact $contact:ident.arc_length_mm = $row:ident) => { $contact.arc_length_mm = $row.arc_length_mm.into() };
    (@contact $contact:ident.contact_angle_deg = $row:ident) => { $contact.contact_angle_deg = $row.contact_angle_deg.into() };
    (@contact $contact:ident.force_un = $row:ident) => { $contact.force_un = $row.force_un.into() };
    (@contact $contact:ident.base_force_x_un = $row:ident) => { $contact.base_force_un[0] = $row.base_force_x_un.into() };
    (@contact $contact:ident.base_force_y_un = $row:ident) => { $contact.base_force_un[1] = $row.base_force_y_un.into() };
    (@contact $contact:ident.$other:ident = $row:ident) => {};
    (@value $part:ident $row:ident.$column:ident = $state:ident.$field:ident) => { $row.$column = $state.$field.into() };
    (@zero place $row:ident.$column:ident) => {};
    (@zero load $row:ident.$column:ident) => { $row.$column = 0.0.into() };
}

pub(crate) use {column, row};

/// Row with columns of a state, by the names of the fields of [`Reading`].
pub trait StateRow {
    /// Returns the row with the values of `state`; unchanged without one.
    #[must_use]
    fn with_state(self, state: Option<&Reading>) -> Self;

    /// Returns the row with all loads 0, as a free whisker has them.
    #[must_use]
    fn unloaded(self) -> Self;

    /// Returns the columns of the contact.
    fn contact(&self) -> ContactColumns;
}

/// Columns of a row that give the contact of its state, and the force there. Columns that the table does not have are `None`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ContactColumns {
    /// Side of the whisker that the pole is on; `None` for a free whisker.
    pub side: Option<Side>,
    /// Arclength from the base to the contact, in mm.
    pub arc_length_mm: Option<f64>,
    /// Angle of the tangent at the contact, from the base's tangent, in degrees.
    pub contact_angle_deg: Option<f64>,
    /// Normal part of the force between pole and whisker, in uN.
    pub force_un: Option<f64>,
    /// Force that the pole puts on the base, along its tangent and to the left of it, `[x, y]` in uN.
    pub base_force_un: [Option<f64>; 2],
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::trace::{BranchPoint, Detachment};

    /// The force on the base is (3, 4) uN, so that the whole force is 5 uN.
    #[test]
    fn rows_have_the_values_of_their_state() {
        let reading = Reading::of([7.0, 8.0, 2.0, 3.0, 4.0, 9.0, 10.0, 11.0, 12.0]);
        let point = BranchPoint::default().with_state(Some(&reading));
        let places = [point.arc_length_mm, point.contact_angle_deg, point.push_chord_deg];
        assert_eq!(places, [7.0, 8.0, 10.0]);
        let loads =
            [point.force_un, point.base_moment_nnm, point.energy_nj, point.contact_force_un];
        assert_eq!(loads, [2.0, 9.0, 12.0, 5.0]);
        let end = Detachment::default().with_state(Some(&reading));
        assert_eq!([end.base_force_x_un, end.base_force_y_un], [Some(3.0), Some(4.0)]);
        let free = end.unloaded();
        assert_eq!([free.force_un, free.contact_force_un, free.energy_nj], [Some(0.0); 3]);
        assert_eq!(free.contact_distance_mm, Some(11.0));
        assert_eq!(Detachment::default().with_state(None), Detachment::default());
    }

    /// Rows share the description of a field of [`Reading`], but for rows with a description of their own.
    #[test]
    fn columns_have_their_descriptions() {
        let about = |columns: &[(&str, &str)], name: &str| {
            let found = columns.iter().find(|(column, _)| *column == name);
            found.map(|(_, about)| (*about).to_owned())
        };
        let energy = about(Detachment::COLUMNS, "energy_nj");
        assert_eq!(energy.as_deref(), Some(" Bending energy of the whisker, in nJ."));
        assert_eq!(energy, about(BranchPoint::COLUMNS, "energy_nj"));
        let stable = about(BranchPoint::COLUMNS, "stable");
        assert!(
            stable
                .is_some_and(|description| description.starts_with(" True if the state is stable"))
        );
    }
}
