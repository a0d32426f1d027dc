//! Rods, push angles, references and cells as bytes: the structs of `shaders/nystrom8.wgsl` and `shaders/cells.wgsl`.

use super::Precision;
use crate::integrate::{CellDifference, Outcome, POWERS, Reference};
use crate::numerics::Real;
use crate::plan::STATE_CHANNELS;
use crate::rod::{Rest, Rod, arclength};
use crate::shooting::{REST_TERMS, Resolution, StateDerivative, StepStart, step_starts};
use bytemuck::{Pod, Zeroable};
use glam::DVec2;
use rayon::prelude::*;

/// What buffers hold, for shaders of one precision.
#[derive(Debug)]
pub struct BufferLayout {
    /// Bytes of a rod.
    pub rod: usize,
    /// Bytes of a push angle.
    pub push: usize,
    /// Bytes of a cell.
    pub cell: usize,
    /// Rods to bytes.
    pub rods: fn(&[Rod]) -> Vec<u8>,
    /// Push angles to bytes.
    pub pushes: fn(&[f64]) -> Vec<u8>,
    /// References on rods to bytes, with the steps that a resolution takes.
    pub references: fn(&[Rod], Resolution, &[Reference]) -> Packed,
    /// Cells from bytes, appended.
    pub cells: fn(&[u8], &mut Vec<CellDifference>),
}

/// References, ready for a dispatch.
#[derive(Debug)]
pub struct Packed {
    /// Cells of all of them.
    pub cells: usize,
    /// The references.
    pub references: Vec<u8>,
    /// The steps of their trajectories.
    pub starts: Vec<u8>,
}

impl BufferLayout {
    /// The layout for shaders of this precision.
    pub const fn of(precision: Precision) -> Self {
        match precision {
            Precision::F32 => Self::with::<f32>(),
            Precision::F64 => Self::with::<f64>(),
        }
    }

    const fn with<T: Scalar>() -> Self {
        Self {
            rod: size_of::<GpuRod<T>>(),
            push: size_of::<[T; 2]>(),
            cell: size_of::<GpuCell>(),
            rods: |rods| bytes(rods.iter().map(GpuRod::<T>::from)),
            pushes: |pushes| bytes(pushes.iter().map(|push| halves::<T>(*push))),
            references: packed::<T>,
            cells: |bytes, cells| {
                let each = bytes.chunks_exact(size_of::<GpuCell>());
                cells.extend(each.map(|cell| {
                    CellDifference::from(bytemuck::pod_read_unaligned::<GpuCell>(cell))
                }));
            },
        }
    }
}

/// Terms of a row's polynomials in the shaders: without a constant, which the reference has itself.
pub const ROW_POWERS: usize = POWERS - 1;

/// Terms of the Jacobian's polynomials there: Newton's last step needs four digits.
pub const JACOBIAN_TERMS: usize = 4 * 6;

/// A scalar of the shaders.
trait Scalar: Real + Pod + Into<f64> {}

impl<T: Real + Pod + Into<f64>> Scalar for T {}

fn bytes<P: Pod>(things: impl ExactSizeIterator<Item = P>) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(things.len() * size_of::<P>());
    for thing in things {
        bytes.extend_from_slice(bytemuck::bytes_of(&thing));
    }
    bytes
}

/// A number, and what the shaders' scalar leaves of it.
fn halves<T: Scalar>(number: f64) -> [T; 2] {
    let high = T::of(number);
    [high, T::of(number - high.into())]
}

fn pair<T: Scalar>(of: DVec2) -> [T; 2] {
    [T::of(of.x), T::of(of.y)]
}

/// The trajectory of a reference.
struct Trip {
    steps: u32,
    /// How far bending has turned the base.
    bent: f64,
}

/// The references of one thread at a time.
const TOGETHER: usize = 64;

fn packed<T: Scalar>(rods: &[Rod], resolution: Resolution, references: &[Reference]) -> Packed {
    let parts = references.par_chunks(TOGETHER).map(|references| {
        let mut starts = Vec::new();
        let trips = references.iter().map(|reference| {
            let rod = &rods[reference.rod as usize];
            let Reference { tau, load, .. } = *reference;
            let steps = resolution.steps(rod, tau, load);
            let bent = step_starts(rod, tau, load, steps, &mut starts);
            Trip { steps, bent }
        });
        let trips: Vec<Trip> = trips.collect();
        (trips, bytes(starts.iter().map(GpuStart::<T>::from)))
    });
    let parts: Vec<(Vec<Trip>, Vec<u8>)> = parts.collect();
    let mut packed = Packed {
        cells: 0,
        references: Vec::with_capacity(references.len() * size_of::<GpuReference<T>>()),
        starts: Vec::with_capacity(parts.iter().map(|(_, starts)| starts.len()).sum()),
    };
    let mut first_step = 0;
    let trips = parts.iter().flat_map(|(trips, _)| trips);
    for (reference, trip) in references.iter().zip(trips) {
        let rod = &rods[reference.rod as usize];
        let packed_one = GpuReference::<T>::new(rod, reference, packed.cells, first_step, trip);
        let bytes = bytemuck::bytes_of(&packed_one);
        packed.references.extend_from_slice(bytes);
        packed.cells += reference.cells.len();
        first_step += trip.steps;
    }
    for (_, starts) in &parts {
        packed.starts.extend_from_slice(starts);
    }
    packed
}

/// The codes that the shaders write, from 0. A kernel that writes nothing leaves zeros, which are no solution.
pub const OUTCOMES: [(&str, Outcome); 6] = [
    ("NOT_FINITE", Outcome::NotFinite),
    ("SOLVED", Outcome::Solved),
    ("BEYOND_TIP", Outcome::BeyondTip),
    ("NEAR_EDGE", Outcome::NearEdge),
    ("FAR", Outcome::Far),
    ("MISSED", Outcome::Missed),
];

#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C, packed)]
struct GpuRod<T> {
    taper: T,
    bend: T,
    spiral: [T; 2],
}

impl<T: Scalar> From<&Rod> for GpuRod<T> {
    fn from(rod: &Rod) -> Self {
        Self {
            taper: T::of(rod.taper),
            bend: T::of(rod.bend),
            spiral: rod.spiral.unwrap_or_default().map(T::of),
        }
    }
}

#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C, packed)]
struct GpuStart<T> {
    radius: T,
    arclength: T,
    tangent: [T; 2],
    position: [T; 2],
    bent: T,
    rest: [T; 2],
    rest_turn: [T; REST_TERMS],
}

impl<T: Scalar> From<&StepStart> for GpuStart<T> {
    fn from(start: &StepStart) -> Self {
        Self {
            radius: T::of(start.radius),
            arclength: T::of(start.arclength),
            tangent: pair(start.tangent),
            position: pair(start.position),
            bent: T::of(start.bent),
            rest: pair(start.rest),
            rest_turn: start.rest_turn.map(T::of),
        }
    }
}

#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C, packed)]
struct GpuReference<T> {
    tau: T,
    load: T,
    radius: T,
    arclength: T,
    force: T,
    rest: [T; 2],
    to_tip: T,
    to_pole: [T; 2],
    position: [T; 2],
    tangent: [T; 2],
    by_tau: [T; 4],
    by_load: [T; 4],
    bent: T,
    energy: T,
    push: [T; 2],
    per_way: T,
    push_by_way: [T; ROW_POWERS],
    tau_by_way: [T; ROW_POWERS],
    resting_by_way: [T; ROW_POWERS],
    jacobian: [T; JACOBIAN_TERMS],
    rod: u32,
    first_cell: u32,
    first_push: u32,
    steps: u32,
    first_step: u32,
    unused: u32,
}

impl<T: Scalar> GpuReference<T> {
    fn new(
        rod: &Rod,
        reference: &Reference,
        first_cell: usize,
        first_step: u32,
        trip: &Trip,
    ) -> Self {
        let Reference {
            tau,
            load,
            push,
            state,
            ..
        } = reference;
        let s = arclength(rod, *tau);
        let full = &state.full;
        let numbers =
            |by: &StateDerivative| [by.angle, by.position.x, by.position.y, by.energy].map(T::of);
        let along = |i: usize| std::array::from_fn(|power| T::of(reference.row[power + 1][i]));
        Self {
            tau: T::of(*tau),
            load: T::of(*load),
            radius: T::of(rod.radius(*tau)),
            arclength: T::of(s),
            force: T::of(full.force),
            rest: pair(Rest::parabola_tangent(rod, s)),
            to_tip: T::of(rod.tau_tip() - tau),
            to_pole: pair(rod.to_pole() - full.position),
            position: pair(full.position),
            tangent: pair(full.tangent),
            by_tau: numbers(&state.by_tau),
            by_load: numbers(&state.by_load),
            bent: T::of(trip.bent),
            energy: T::of(if full.force == 0.0 {
                0.0
            } else {
                2.0 * full.energy / full.force
            }),
            push: halves(*push),
            per_way: T::of(reference.per_way),
            push_by_way: along(0),
            tau_by_way: along(1),
            resting_by_way: along(2),
            jacobian: std::array::from_fn(|i| T::of(reference.row[i / 4][3 + i % 4])),
            rod: reference.rod,
            // A call has fewer cells than `u32` can count.
            first_cell: first_cell as u32,
            first_push: reference.cells.start,
            steps: trip.steps,
            first_step,
            unused: 0,
        }
    }
}

#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct GpuCell {
    numbers: [f32; STATE_CHANNELS.len()],
    residual: f32,
    outcome: u32,
}

impl From<GpuCell> for CellDifference {
    // Whatever the shader says, a number that is not finite is not a solution.
    fn from(cell: GpuCell) -> Self {
        let is_finite = cell.numbers.iter().all(|x| x.is_finite()) && cell.residual.is_finite();
        let outcome = OUTCOMES
            .get(cell.outcome as usize)
            .filter(|_| is_finite)
            .map_or(Outcome::NotFinite, |&(_, outcome)| outcome);
        Self {
            numbers: cell.numbers,
            residual: cell.residual,
            outcome,
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test fails by panicking")]
mod tests {
    use super::*;
    use crate::integrate::gpu::shaders;
    use naga::TypeInner;
    use std::mem::offset_of;

    /// Name, size and members, in the eyes of the shader and of Rust.
    type Struct = (String, usize, Vec<(String, usize)>);

    fn in_shader(precision: Precision) -> Vec<Struct> {
        let module = naga::front::wgsl::parse_str(&shaders::cells(precision)).unwrap();
        let structs = module.types.iter().filter_map(|(_, found)| {
            let TypeInner::Struct { members, span } = &found.inner else {
                return None;
            };
            let members = members.iter();
            let members = members.map(|m| (m.name.clone().unwrap(), m.offset as usize));
            Some((found.name.clone()?, *span as usize, members.collect()))
        });
        structs.collect()
    }

    macro_rules! in_rust {
        ($type:ty, $name:literal, $($member:ident)+) => {
            (
                $name.to_owned(),
                size_of::<$type>(),
                vec![$((stringify!($member).to_owned(), offset_of!($type, $member))),+],
            )
        };
    }

    fn agrees<T: Scalar>(precision: Precision) {
        let shader = in_shader(precision);
        for rust in [
            in_rust!(GpuRod<T>, "Rod", taper bend spiral),
            in_rust!(GpuStart<T>, "StepStart", radius arclength tangent position bent rest rest_turn),
            in_rust!(GpuReference<T>, "Reference", tau load radius arclength force rest to_tip to_pole position tangent
                by_tau by_load bent energy push per_way push_by_way tau_by_way resting_by_way jacobian rod first_cell first_push steps first_step unused),
            in_rust!(GpuCell, "Cell", numbers residual outcome),
        ] {
            assert_eq!(shader.iter().find(|s| s.0 == rust.0), Some(&rust));
        }
    }

    #[test]
    fn shaders_and_rust_agree_on_every_offset() {
        agrees::<f32>(Precision::F32);
        agrees::<f64>(Precision::F64);
    }

    #[test]
    fn a_cell_that_is_not_finite_or_not_written_is_no_solution() {
        for (first, code, outcome) in [
            (1.0, 1, Outcome::Solved),
            (f32::NAN, 1, Outcome::NotFinite),
            (1.0, 9, Outcome::NotFinite),
            (0.0, 0, Outcome::NotFinite),
        ] {
            let cell = GpuCell {
                numbers: [first; STATE_CHANNELS.len()],
                residual: 0.0,
                outcome: code,
            };
            let mut cells = Vec::new();
            (BufferLayout::of(Precision::F32).cells)(bytemuck::bytes_of(&cell), &mut cells);
            assert_eq!(cells[0].outcome, outcome);
        }
    }
}
