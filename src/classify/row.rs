//! Boundary of one row, and classification of its cells.

use super::{Outcome, Regime, Status};
use crate::sheet::{Crossing, Edge, pieces};

/// Tie: largest distance of a push angle from a boundary, in radians, at which the angle counts as on it. Both verdicts are correct
/// there.
pub const TIE: f64 = 1e-10;

/// Push span: interval of push angles (magnitudes, in radians) on the stable sheet, at one distance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PushSpan {
    /// Crossing at the smallest push angle of the span; `None` for first touch.
    pub begin: Option<Crossing>,
    /// Crossing at the largest push angle of the span, at which the whisker detaches.
    pub end: Crossing,
}

impl PushSpan {
    /// Returns the smallest push angle of the span, in radians.
    #[must_use]
    pub fn from(&self) -> f64 {
        self.begin.map_or(0.0, |begin| begin.push)
    }

    /// Returns the largest push angle of the span, in radians.
    #[must_use]
    pub const fn to(&self) -> f64 {
        self.end.push
    }

    /// Returns true if `push`, a magnitude in radians, lies in the span or within [`TIE`] of one of its ends.
    #[must_use]
    pub fn contains(&self, push: f64) -> bool {
        self.from() - TIE <= push && push <= self.to() + TIE
    }

    /// Returns the distance from `push`, a magnitude in radians, to the detachment, in degrees; 0 beyond it.
    #[must_use]
    pub fn margin_deg(&self, push: f64) -> f32 {
        (self.to() - push).max(0.0).to_degrees() as f32
    }
}

/// Boundary of one row: the push angles that lie on the stable sheet.
#[derive(Clone, Debug, PartialEq)]
pub struct RowBoundary {
    /// Spans, first the one from first touch, if any; `None` if the crossings contradict each other.
    spans: Option<Vec<PushSpan>>,
    /// True if `spans` holds all spans of the row.
    is_complete: bool,
}

impl RowBoundary {
    /// Creates the boundary from the `crossings` of a row: first the end of a push from first touch, then the others by push angle. A
    /// last [unknown](Crossing::unknown) crossing means that there may be more.
    #[must_use]
    pub fn new(touches: bool, crossings: &[Crossing]) -> Self {
        let (crossings, is_complete) = match crossings {
            [known @ .., last] if last.is_unknown() => (known, false),
            all => (all, true),
        };
        let sound = crossings.iter().all(Crossing::is_sound);
        let even = (crossings.len() + usize::from(touches)).is_multiple_of(2);
        let spans = pieces(touches, crossings)
            .map(|(begin, end)| PushSpan { begin: begin.copied(), end: *end });
        Self { spans: (sound && even).then(|| spans.collect()), is_complete }
    }

    /// Returns the push span that contains the push angle `push`, a magnitude in radians; `None` without one.
    #[must_use]
    pub fn span(&self, push: f64) -> Option<&PushSpan> {
        self.spans().iter().find(|span| span.contains(push))
    }

    /// Returns the push spans of the row, first the one from first touch, if any, `[span]`; empty if the boundary is unknown.
    #[must_use]
    pub fn spans(&self) -> &[PushSpan] {
        self.spans.as_deref().unwrap_or_default()
    }

    /// Returns true if every push angle from `from` to `to` gets the same verdict: no span of the row begins or ends there. Push angles
    /// are magnitudes in radians.
    #[must_use]
    pub fn is_one_verdict(&self, from: f64, to: f64) -> bool {
        let is_apart = |end: f64| end + TIE < from || to < end - TIE;
        let mut spans = self.spans().iter();
        spans.all(|span| is_apart(span.from()) && is_apart(span.to()))
    }

    /// Returns true if `push` is on an end of `span` beyond which no state exists. First touch is not such an end.
    fn is_on_edge(span: &PushSpan, push: f64) -> bool {
        let is_at_begin = span.begin.is_some_and(|begin| push < begin.push + TIE);
        is_at_begin || push > span.to() - TIE
    }

    /// Returns the span of a push from first touch to detachment; `None` if the boundary is unknown or the whisker does not touch the
    /// pole.
    #[must_use]
    pub fn detachment(&self) -> Option<&PushSpan> {
        self.spans().first().filter(|span| span.begin.is_none())
    }

    /// Returns the other span that contains the end of a push from first touch, and ends beyond it: the whisker may snap to its states
    /// instead of leaving the pole. `None` if the boundary is unknown.
    #[must_use]
    pub fn snap(&self) -> Option<&PushSpan> {
        let end = self.detachment()?.to();
        let continues = |span: &&PushSpan| span.contains(end) && span.to() > end + TIE;
        self.spans().iter().find(continues)
    }

    /// Returns regime and status of the cell at `push`, a magnitude in radians, with this `outcome`. The cell is unresolved if outcome and
    /// boundary contradict each other.
    #[must_use]
    pub fn classify(&self, push: f64, outcome: Outcome) -> (Regime, Status) {
        if self.spans.is_none() {
            return (Regime::Unresolved, Status::NoBoundary);
        }
        let span = self.span(push);
        let status = match outcome {
            Outcome::Solved => Status::Solved,
            // At the tip both verdicts are correct; the verdict of the boundary is taken.
            Outcome::AtTip if span.is_some() => Status::Solved,
            Outcome::AtTip | Outcome::BeyondTip => Status::BeyondTip,
            Outcome::BeyondFold => Status::BeyondFold,
            Outcome::OffSheet => Status::Outside,
            Outcome::NotConverged
            | Outcome::NotFinite
            | Outcome::NearEdge
            | Outcome::Missed
            | Outcome::NoRow => Status::NotConverged,
        };
        match (status, span) {
            // Without a push the shape at rest decides: the whisker does not reach the pole.
            (Status::Solved | Status::NotConverged, Some(span))
                if span.begin.is_some() && push <= TIE && Self::is_on_edge(span, push) =>
            {
                (Regime::OutOfReach, Status::Outside)
            }
            (Status::Solved, Some(span)) => {
                let regime = match span.begin {
                    None => Regime::Contact,
                    Some(_) => Regime::Unreachable,
                };
                (regime, status)
            }
            (Status::Outside | Status::BeyondFold | Status::BeyondTip, span)
                if span.is_none_or(|span| Self::is_on_edge(span, push)) =>
            {
                if !self.is_complete && span.is_none() {
                    return (Regime::Unresolved, Status::NoBoundary);
                }
                let regime = match self.detachment().map(|span| span.end.edge) {
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
