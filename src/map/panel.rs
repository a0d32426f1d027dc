//! From settled cells to the panel of a whisker, in the units of the map.

use super::{Face, cells::Cell};
use crate::classify::{Regime, RowBoundary, Status};
use crate::model::{Rest, arclength};
use crate::refine::{State, TIP_TIE};
use crate::scene::{Scene, Whisker};
use crate::sheet::{Sheet, nearest_turn};
use crate::store::{Panel, STATE_CHANNELS};
use glam::DVec2;
use rayon::prelude::*;
use std::f64::consts::FRAC_PI_4;

/// A panel without answers.
pub fn blank(scene: &Scene) -> Panel {
    let cells = scene.grid.push_angle_deg.len() * scene.grid.distance_mm.len();
    Panel {
        regime: vec![Regime::Unresolved.code(); cells],
        status: vec![Status::NotConverged.code(); cells],
        state: std::array::from_fn(|_| vec![f32::NAN; cells]),
        residual: vec![f32::NAN; cells],
        margin_deg: vec![f32::NAN; cells],
        newton_steps: vec![0; cells],
    }
}

/// Judges `cells` and writes them into `panels`; face `i` belongs to panel `i / faces_per_panel`.
pub fn fill(
    scene: &Scene,
    whiskers: &[Whisker],
    faces: &[Face],
    faces_per_panel: usize,
    cells: &[Cell],
    panels: &mut [Panel],
) {
    let width = scene.grid.push_angle_deg.len();
    let answers: Vec<Answer> = cells
        .par_chunk_by(|a, b| (a.face, a.row) == (b.face, b.row))
        .flat_map_iter(|row| {
            let face = &faces[row[0].face];
            let units = Units::new(&whiskers[row[0].face / faces_per_panel]);
            let boundary = face.sheet.as_ref().map(|sheet| {
                RowBoundary::new(sheet.touches(row[0].row), &sheet.crossings[row[0].row])
            });
            row.iter().map(move |cell| {
                let push = scene.grid.push_angle_deg[cell.column];
                answer(cell, push, face.sheet.as_ref(), boundary.as_ref(), &units)
            })
        })
        .collect();
    for (cell, answer) in cells.iter().zip(&answers) {
        let panel = &mut panels[cell.face / faces_per_panel];
        let at = cell.row * width + cell.column;
        panel.regime[at] = answer.regime.code();
        panel.status[at] = answer.status.code();
        panel.newton_steps[at] = cell.steps;
        panel.residual[at] = answer.residual;
        panel.margin_deg[at] = answer.margin_deg;
        for (channel, value) in panel.state.iter_mut().zip(answer.state) {
            channel[at] = value;
        }
    }
}

/// What a panel holds of one cell.
struct Answer {
    regime: Regime,
    status: Status,
    state: [f32; STATE_CHANNELS.len()],
    residual: f32,
    margin_deg: f32,
}

fn answer(
    cell: &Cell,
    push_deg: f64,
    sheet: Option<&Sheet>,
    boundary: Option<&RowBoundary>,
    units: &Units,
) -> Answer {
    let push = push_deg.to_radians();
    let at_tip = sheet
        .zip(cell.state)
        .is_some_and(|(sheet, state)| (state.tau / sheet.rod.tau_tip() - 1.0).abs() <= TIP_TIE);
    let (regime, status) = match boundary {
        // At the tip both verdicts are right; the boundary's is taken.
        Some(boundary)
            if at_tip && cell.status == Status::Solved && boundary.span(push.abs()).is_none() =>
        {
            boundary.judge(push.abs(), Status::BeyondTip)
        }
        Some(boundary) => boundary.judge(push.abs(), cell.status),
        None => (Regime::Unresolved, Status::NoFold),
    };
    let mut answer = Answer {
        regime,
        status,
        state: [f32::NAN; STATE_CHANNELS.len()],
        residual: f32::NAN,
        margin_deg: f32::NAN,
    };
    if let (Regime::Unresolved, Some(state)) = (regime, &cell.state) {
        answer.residual = narrow(state.residual);
    }
    let in_contact = matches!(regime, Regime::Contact | Regime::Unreachable);
    if let (true, Some(sheet), Some(state)) = (in_contact, sheet, &cell.state) {
        answer.state = units.state(sheet, cell.row, push, state).map(narrow);
        answer.residual = narrow(state.residual);
        let span = boundary.and_then(|boundary| boundary.span(push.abs()));
        answer.margin_deg = span.map_or(f32::NAN, |span| {
            narrow((span.to - push.abs()).max(0.0).to_degrees())
        });
    }
    answer
}

#[allow(clippy::cast_possible_truncation, reason = "maps are stored in f32")]
fn narrow(x: f64) -> f32 {
    x as f32
}

/// The units of one whisker.
pub struct Units {
    length_mm: f64,
    force_un: f64,
    moment_nnm: f64,
}

impl Units {
    /// With `E I_base` in N m^2: forces in `E I/L^2`, moments and energies in `E I/L`.
    #[must_use]
    pub fn new(whisker: &Whisker) -> Self {
        let stiffness =
            whisker.youngs_modulus_gpa * 1e9 * FRAC_PI_4 * (whisker.base_radius_um * 1e-6).powi(4);
        let length = whisker.length_mm * 1e-3;
        Self {
            length_mm: whisker.length_mm,
            force_un: stiffness / (length * length) * 1e6,
            moment_nnm: stiffness / length * 1e9,
        }
    }

    /// The channels of [`STATE_CHANNELS`] for a state at the signed push angle `push`, in radians.
    ///
    /// The base frame has its first axis along the base's tangent. Forces and moment are those that the pole
    /// puts on the base; the contact angle is that of the whisker's tangent at the contact.
    fn state(
        &self,
        sheet: &Sheet,
        row: usize,
        push: f64,
        state: &State,
    ) -> [f64; STATE_CHANNELS.len()] {
        let base = &state.full.base;
        let to_base = DVec2::new(base.tangent.x, -base.tangent.y);
        let contact = to_base.rotate(-base.position);
        let pole_from_contact = -(base.position + DVec2::new(0.0, sheet.rod.pole));
        let phi = sheet.rows[row].touch + push;
        let rest = Rest::new(&sheet.rod);
        let chord = contact.to_angle() - rest.direction_at_distance(contact.length());
        [
            arclength(&sheet.rod, state.tau) * self.length_mm,
            (phi - pole_from_contact.to_angle()).to_degrees(),
            base.force.abs() * self.force_un,
            base.force * base.tangent.y * self.force_un,
            base.force * base.tangent.x * self.force_un,
            -base.force * base.position.x * self.moment_nnm,
            nearest_turn(chord, push).to_degrees(),
            contact.length() * self.length_mm,
            state.full.energy * self.moment_nnm,
        ]
    }
}
