//! The boundary of one row, and the verdict on its cells.

use super::{Regime, Status};
use crate::sheet::{Crossing, Edge};

/// Push angles, in radians, closer to a boundary than this count as on it; both verdicts are right there.
pub const TIE: f64 = 1e-10;

/// A stretch of push angles (magnitudes, in radians) on the stable sheet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Span {
    /// Where it begins.
    pub from: f64,
    /// Where the whisker detaches.
    pub to: f64,
    /// How it detaches there.
    pub edge: Edge,
}

impl Span {
    /// Whether the push angle is on it, or on one of its ends.
    #[must_use]
    pub fn contains(&self, push: f64) -> bool {
        self.from - TIE <= push && push <= self.to + TIE
    }

    /// How far it is from `push` to where the whisker detaches, in degrees.
    #[must_use]
    pub fn margin_deg(&self, push: f64) -> f32 {
        (self.to - push).max(0.0).to_degrees() as f32
    }
}

/// Which push angles of a row are on the stable sheet.
#[derive(Clone, Debug, PartialEq)]
pub struct RowBoundary {
    /// Whether the whisker at rest reaches the pole: the first span then begins at first touch.
    touches: bool,
    /// Spans in the order of growing push angle; `None` when the crossings do not make sense.
    spans: Option<Vec<Span>>,
    /// Whether there are no others.
    is_complete: bool,
}

impl RowBoundary {
    /// The boundary made of a row's `crossings`: the end of a push from first touch, then the others by push angle; at last the
    /// [unknown](Crossing::unknown) one, if there may be more.
    #[must_use]
    pub fn new(touches: bool, crossings: &[Crossing]) -> Self {
        let (crossings, is_complete) = match crossings {
            [known @ .., last] if last.is_unknown() => (known, false),
            all => (all, true),
        };
        let sound = crossings.iter().all(Crossing::is_sound);
        let even = (crossings.len() + usize::from(touches)).is_multiple_of(2);
        let mut ends = crossings.iter();
        let mut spans = Vec::new();
        let mut from = touches.then_some(0.0);
        while let Some(begin) = from.take().or_else(|| ends.next().map(|c| c.push)) {
            let Some(end) = ends.next() else { break };
            spans.push(Span {
                from: begin,
                to: end.push,
                edge: end.edge,
            });
        }
        Self {
            touches,
            spans: (sound && even).then_some(spans),
            is_complete,
        }
    }

    /// The span that the push angle is on, if any.
    #[must_use]
    pub fn span(&self, push: f64) -> Option<&Span> {
        self.spans().iter().find(|span| span.contains(push))
    }

    /// The spans: the one from first touch, if there is one, before the others; none where the boundary is not known.
    #[must_use]
    pub fn spans(&self) -> &[Span] {
        self.spans.as_deref().unwrap_or_default()
    }

    /// Whether all pushes between these are judged alike: none is on an end of a span.
    #[must_use]
    pub fn is_one_verdict(&self, from: f64, to: f64) -> bool {
        let is_apart = |end: f64| end + TIE < from || to < end - TIE;
        let mut spans = self.spans().iter();
        spans.all(|span| is_apart(span.from) && is_apart(span.to))
    }

    /// Whether `push` is on an end of `span` beyond which there is no state; first touch is no such end.
    fn is_on_edge(&self, span: &Span, push: f64) -> bool {
        let from_touch = self.detachment() == Some(span);
        (push < span.from + TIE && !from_touch) || push > span.to - TIE
    }

    /// Where a push from first touch ends, if the boundary is known and there is a first touch.
    #[must_use]
    pub fn detachment(&self) -> Option<&Span> {
        self.spans.as_ref().filter(|_| self.touches)?.first()
    }

    /// The regime at `push` for a cell that was settled with `status`, and the status, which turns into one of
    /// the unresolved kinds where cell and boundary contradict each other.
    #[must_use]
    pub fn judge(&self, push: f64, status: Status) -> (Regime, Status) {
        if self.spans.is_none() {
            return (Regime::Unresolved, Status::NoBoundary);
        }
        match (status, self.span(push)) {
            // Without a push the shape at rest decides: a pole that it does not reach is out of reach.
            (Status::Solved | Status::NotConverged, Some(span))
                if !self.touches && push <= TIE && self.is_on_edge(span, push) =>
            {
                (Regime::OutOfReach, Status::Outside)
            }
            (Status::Solved, Some(span)) => {
                let regime = if self.detachment() == Some(span) {
                    Regime::Contact
                } else {
                    Regime::Unreachable
                };
                (regime, status)
            }
            (Status::Outside | Status::BeyondFold | Status::BeyondTip, span)
                if span.is_none_or(|span| self.is_on_edge(span, push)) =>
            {
                if !self.is_complete && span.is_none() {
                    return (Regime::Unresolved, Status::NoBoundary);
                }
                let regime = match self.detachment().map(|span| span.edge) {
                    None => Regime::OutOfReach,
                    Some(Edge::Fold) => Regime::SlipOff,
                    Some(Edge::Tip) => Regime::PullOff,
                };
                (regime, status)
            }
            (Status::NotConverged, _) => (Regime::Unresolved, status),
            (Status::Solved, None) if !self.is_complete => (Regime::Unresolved, Status::NoBoundary),
            _ => (Regime::Unresolved, Status::Disagreement),
        }
    }
}
