//! Map of the states that two numbers at the base determine.

use super::{RenderError, labels};
use crate::locate::{SharedMap, SharedState};
use crate::scene::Grid;
use whiskmap_plot::{
    CellAxis, ColourScale, Fill, HeatMap, LegendEntry, PanelAxis, PanelCells, Picture, PictureSize,
    ScaleOptions, Shading, ValueSummary,
};

/// Ends of the colour bar. A condition is at least 1, and infinite on a singular line.
const CONDITIONS: [f64; 2] = [1.0, 1000.0];

/// Number of states that share two numbers, and its condition, in one of the pairs of a state.
type OfPair = fn(&SharedState) -> (usize, Option<f64>);

/// Pairs of numbers with their names.
const PAIRS: [(&str, OfPair); 3] = [
    ("moment and axial force", |state| (state.moment_x_states, state.moment_x_condition)),
    ("moment and transverse force", |state| (state.moment_y_states, state.moment_y_condition)),
    ("axial and transverse force", |state| (state.force_states, state.force_condition)),
];

/// Draws the condition of the states of a map on `grid` by each two numbers at the base: a panel for each two. Cells are hatched where several states
/// have the same two numbers. Lines mark where two numbers do not determine the state.
///
/// # Errors
/// No cell is in contact, or the size on paper is too small.
pub fn shared_states(
    title: &str,
    grid: &Grid,
    map: &SharedMap,
    is_straight: bool,
    size: PictureSize,
) -> Result<Picture, RenderError> {
    let columns = grid.push_angle_deg.len();
    let panel = |index: usize| {
        let (_, of_pair) = PAIRS[index];
        let count = columns * grid.distance_mm.len();
        let (mut values, mut hatched) = (vec![f64::NAN; count], vec![false; count]);
        for state in &map.states {
            let place = |values: &[f64], coordinate: f64| {
                values.partition_point(|value| *value < coordinate)
            };
            let row = place(&grid.distance_mm, state.distance_mm);
            let cell = row * columns + place(&grid.push_angle_deg, state.push_angle_deg);
            let (states, condition) = of_pair(state);
            values[cell] = condition.map_or(f64::NAN, |condition| condition.min(f64::MAX));
            hatched[cell] = states > 1;
        }
        PanelCells {
            values,
            hatched,
            curves: map.singular[index].iter().map(|ends| ends.to_vec()).collect(),
        }
    };
    let mut summary = ValueSummary::default();
    for index in 0..PAIRS.len() {
        summary.extend(panel(index).values);
    }
    let options = ScaleOptions {
        label: "condition of the contact".to_owned(),
        blank: "no contact, or one number follows from the other".to_owned(),
        log: Some(true),
        range: Some(CONDITIONS),
        whole: false,
    };
    let scale = ColourScale::new(&summary, options)
        .map_err(|cause| RenderError::Scale { channel: "condition".to_owned(), cause })?;
    let several = "several states have the same two numbers";
    let heat_map = HeatMap {
        title: title.to_owned(),
        x: CellAxis::new(labels::PUSH_ANGLE, &grid.push_angle_deg),
        y: CellAxis::new(labels::DISTANCE, &grid.distance_mm),
        panel_axes: [
            Some(PanelAxis {
                label: "measured numbers".to_owned(),
                texts: PAIRS.map(|(name, _)| name.to_owned()).to_vec(),
            }),
            None,
        ],
        shading: Shading::Quantities(scale),
        legend: vec![
            LegendEntry::swatch(Fill::BLANK.hatched(), several),
            LegendEntry::curve("singular line"),
        ],
        regions: Some(labels::regions(is_straight)),
    };
    heat_map.picture(size, |index| Ok(panel(index)))
}
