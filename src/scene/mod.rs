//! A scene: what to simulate, read from TOML and checked. An accepted scene is valid everywhere after.
//!
//! Text (`read`) becomes tables (`file`, `axis`), tables become a [`Scene`] (`check`, `limits`), and whatever is
//! refused becomes one message that points into the text (`error`).

mod axis;
mod check;
mod error;
mod file;
mod limits;
mod mechanics;
mod profile;
mod read;
mod rows;
mod shape;

pub use error::SceneError;

use serde::Serialize;

/// A whisker at rest.
#[derive(Clone, Debug, PartialEq)]
pub struct Whisker {
    /// Arclength from base to tip.
    pub length_mm: f64,
    /// Radius at the base.
    pub base_radius_um: f64,
    /// Radius at the tip; 0 is a perfect cone.
    pub tip_radius_um: f64,
    /// Young's modulus at the base; it scales forces, moments and energies, never an angle.
    pub youngs_modulus_gpa: f64,
    /// Intrinsic curvature as a parabola, `None` for a straight whisker.
    pub curvature: Option<Curvature>,
    /// Intrinsic curvature as an Euler spiral, in place of the parabola.
    pub euler_spiral: Option<EulerSpiral>,
    /// Measured radii in place of those that fall linearly: rows of arclength and radius over the whisker's length and
    /// base radius, from (0, 1) to (1, tip radius).
    pub profile: Option<Vec<[f64; 2]>>,
    /// Young's modulus at the tip over that at the base; linear in between.
    pub modulus_tip_to_base: f64,
    /// Real arclength over the arclength in the plane of contact: more than 1 where the whisker droops out of the
    /// plane. The radius is read at the real arclength.
    pub arc_stretch: f64,
}

impl Whisker {
    /// The largest curvature at rest, in radians per millimetre.
    #[must_use]
    pub fn sharpest_bend_per_mm(&self) -> f64 {
        let parabola = self.curvature.map_or(0.0, |own| 2.0 * own.parabola_per_mm);
        let spiral = self.euler_spiral.map_or(0.0, |own| {
            let at_tip = own.per_mm + own.per_mm2 * self.length_mm;
            own.per_mm.abs().max(at_tip.abs())
        });
        parabola.max(spiral)
    }
}

/// What the whisker is pushed against.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pole {
    /// Radius; 0 is a point contact.
    pub radius_mm: f64,
    /// Coulomb's coefficient; the whisker slides toward its tip at this limit.
    pub friction: f64,
}

impl Pole {
    /// A pole without friction.
    #[must_use]
    pub const fn smooth(radius_mm: f64) -> Self {
        Self {
            radius_mm,
            friction: 0.0,
        }
    }
}

/// The undeflected shape `y = A (x - vertex)^2` with the base at `x = 0` (paper, Eq. 7).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Curvature {
    /// `A`.
    pub parabola_per_mm: f64,
    /// Where the vertex lies.
    pub vertex_mm: f64,
}

/// The undeflected shape whose curvature is linear in the arclength (Starostin et al. 2020).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EulerSpiral {
    /// Curvature at the base; positive bends toward the CF side, as a parabola does.
    pub per_mm: f64,
    /// Its growth along the whisker.
    pub per_mm2: f64,
}

/// The axes of the sweep; every list is strictly increasing and not empty.
#[derive(Clone, Debug, PartialEq)]
pub struct Grid {
    /// Rotation of the base since first touch: negative CF, positive CB.
    pub push_angle_deg: Vec<f64>,
    /// Distance from the base to the contact at first touch.
    pub distance_mm: Vec<f64>,
    /// `1 - tip/base radius`, in place of the whisker's own.
    pub taper: Option<Vec<f64>>,
    /// Parabola coefficient `A`, in place of the whisker's own.
    pub curvature_per_mm: Option<Vec<f64>>,
}

/// A checked scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    /// One line for people.
    pub title: String,
    /// The whisker as the file describes it; [`Scene::whiskers`] yields those to simulate.
    pub whisker: Whisker,
    /// The pole.
    pub pole: Pole,
    /// The sweep.
    pub grid: Grid,
    /// Stem of the output files.
    pub name: String,
    /// The file as it was read.
    pub text: String,
}

impl Scene {
    /// The scene's whisker with a taper (`1 - tip/base radius`) and a parabola coefficient in place of its
    /// own. The vertex stays: the whisker's own, or 0 where its file gives no curvature.
    #[must_use]
    pub fn whisker_at(&self, taper: Option<f64>, curvature_per_mm: Option<f64>) -> Whisker {
        let mut whisker = self.whisker.clone();
        if let Some(taper) = taper {
            whisker.tip_radius_um = whisker.base_radius_um * (1.0 - taper);
        }
        if let Some(parabola_per_mm) = curvature_per_mm {
            let vertex_mm = whisker.curvature.map_or(0.0, |own| own.vertex_mm);
            whisker.curvature = Some(Curvature {
                parabola_per_mm,
                vertex_mm,
            });
        }
        whisker.curvature = whisker.curvature.filter(|c| c.parabola_per_mm != 0.0);
        whisker
    }

    /// Every whisker of the sweep, in the order of the atlas: taper varies fastest (its columns), curvature
    /// slowest (its rows). Without such axes, the one whisker of the file.
    pub fn whiskers(&self) -> impl Iterator<Item = (Morphology, Whisker)> {
        let tapers = choices(self.grid.taper.as_deref());
        choices(self.grid.curvature_per_mm.as_deref())
            .into_iter()
            .flat_map(move |curvature| {
                tapers
                    .clone()
                    .into_iter()
                    .map(move |taper| (taper, curvature))
            })
            .map(|(taper, curvature)| {
                let whisker = self.whisker_at(taper, curvature);
                let own = whisker.curvature.map_or(0.0, |own| own.parabola_per_mm);
                let morphology = Morphology {
                    taper: taper.unwrap_or(1.0 - whisker.tip_radius_um / whisker.base_radius_um),
                    curvature_per_mm: curvature.unwrap_or(own),
                };
                (morphology, whisker)
            })
    }

    /// Whether whiskers are swept: whether there is an axis of taper or curvature.
    #[must_use]
    pub fn is_sweep(&self) -> bool {
        self.grid.taper.is_some() || self.grid.curvature_per_mm.is_some()
    }

    /// The smallest and the largest distance of first touch; it must be more than the pole's radius, too.
    #[must_use]
    pub fn distances_mm(&self) -> (f64, f64) {
        let length = self.whisker.length_mm;
        (length / NEAREST, FARTHEST * length)
    }
}

/// The nearest first touch is the whisker's length over this.
const NEAREST: f64 = 1000.0;

/// The farthest is the whisker's length times this.
const FARTHEST: f64 = 10.0;

/// Where a whisker stands in a sweep.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Morphology {
    /// `1 - tip/base radius`.
    pub taper: f64,
    /// Parabola coefficient `A`.
    pub curvature_per_mm: f64,
}

/// What an axis puts in place of the whisker's own value: its values one by one, or nothing, once.
fn choices(axis: Option<&[f64]>) -> Vec<Option<f64>> {
    axis.map_or_else(
        || vec![None],
        |values| values.iter().copied().map(Some).collect(),
    )
}
