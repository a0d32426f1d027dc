//! Energy that friction dissipates along a limit of sliding: the integral of the friction over the slid distance.

use super::limit::SlidingLimit;
use super::sliding::ContactRate;
use super::state::FrictionState;
use super::states::at_limits;
use whiskmap_mechanics::numerics::gauss::QUADRATURE;
use whiskmap_mechanics::numerics::newton_form::{Polynomial, through_nodes};

/// Dissipated energy along one limit, in `E I_base/L_w`, as a polynomial on each segment of the limit.
#[derive(Clone, Debug)]
pub struct Dissipation(Vec<DissipationSegment>);

#[derive(Clone, Debug)]
struct DissipationSegment {
    /// Energy dissipated up to the segment, with the sign of the sliding.
    before: f64,
    /// Derivative of the dissipated energy by the variable of the segment.
    power: Polynomial<4>,
}

impl DissipationSegment {
    /// Energy dissipated from the start of the segment to its variable `x`. The quadrature is exact for the polynomial.
    fn until(&self, x: f64) -> f64 {
        let sum = QUADRATURE.iter().map(|[at, weight]| weight * self.power.at(at * x).0);
        x * sum.sum::<f64>()
    }
}

impl Dissipation {
    /// Integrates along `limit` with four Gauss nodes on each segment; `None` if a state is not found.
    pub fn new(limit: &SlidingLimit) -> Option<Self> {
        let level = &limit.level;
        let nodes = limit.inner(&QUADRATURE.map(|[at, _]| at));
        let pairs: Vec<_> = nodes.iter().map(|node| (limit, node.push)).collect();
        let states: Vec<FrictionState> = at_limits(&pairs).into_iter().collect::<Option<_>>()?;
        let friction = level.rod.friction.abs() * level.rod.contact_tangent().x;
        let powers = states.iter().zip(&nodes).map(|(state, node)| {
            let FrictionState { variation, at, .. } = state;
            let rate = ContactRate::new(variation, &level.rod, at.point.x);
            let by_phi = rate.slid / variation.full.map.det();
            let slides = level.side.sign() * by_phi * node.push_by_x;
            friction * variation.full.force.abs() * slides
        });
        let powers: Vec<f64> = powers.collect();
        let mut before = 0.0;
        let segments = powers.chunks_exact(QUADRATURE.len()).map(|powers| {
            let at = QUADRATURE.iter().zip(powers);
            let [power] = through_nodes(at.map(|([x, _], power)| (*x, [*power])));
            let segment = DissipationSegment { before, power };
            before += segment.until(1.0);
            segment
        });
        Some(Self(segments.collect()))
    }

    /// Returns the energy dissipated along `limit` from first touch to `push`, a magnitude in radians; NaN beyond the limit.
    pub fn at(&self, limit: &SlidingLimit, push: f64) -> f64 {
        let place = limit.place(push);
        place.map_or(f64::NAN, |(index, x)| {
            let segment = &self.0[index];
            segment.before + segment.until(x)
        })
    }
}
