//! Random whiskers with friction up to 1: states along the whole push, changes of the phase, and ends of the push.

use crate::random_rods::{Random, USUAL, rod};
use whiskmap::friction::{
    ContactHistory, ContactPhase, ContactQuery, FrictionState, Sliding, states,
    surely_slides_to_end,
};
use whiskmap::mechanics::rod::{Effects, Rod, Side};
use whiskmap::mechanics::shooting::FirstVariation;
use whiskmap::mechanics::shooting::batch::{Batch, Method};
use whiskmap::sheet::{LevelCurve, Sheet};

/// Row of a random whisker with the end of its push.
struct RandomRow {
    level: LevelCurve,
    end: f64,
}

/// Random whisker with friction up to 1, on a random side.
fn rough(random: &mut Random) -> (Rod, Side) {
    let effects = Effects { gradient: random.unit() < 0.3, spiral: random.unit() < 0.2, ..USUAL };
    let rod = rod(effects, random);
    let side = if rod.pole >= 0.0 { Side::Cb } else { Side::Cf };
    let rod = Rod {
        friction: side.sign() * random.between(0.01, 1.0),
        pole: if random.unit() < 0.2 { 0.0 } else { rod.pole },
        ..rod
    };
    (rod, side)
}

/// Rows of random whiskers on both sides, with pushes below half a turn.
fn rows(count: usize, seed: u64) -> Vec<RandomRow> {
    let mut random = Random::new(seed);
    let mut rows = Vec::new();
    while rows.len() < count {
        let (rod, side) = rough(&mut random);
        let sheet = Sheet::new(Method::fine(), &rod, side, &[random.between(0.15, 0.95)]);
        let Some(end) = sheet.crossings[0].first() else {
            continue;
        };
        if sheet.touches(0) && end.is_sound() && (1e-3..3.0).contains(&end.push) {
            rows.push(RandomRow { level: sheet.level(0), end: end.push });
        }
    }
    rows
}

fn at(history: &ContactHistory, push: f64) -> Option<FrictionState> {
    let phase = history.phase(push);
    states(&[ContactQuery { history, push, phase }]).pop()?
}

/// Every state is found, with a force ratio that its phase allows. Forces are continuous where the phase changes. Every push detaches with a
/// contact that slides toward the tip.
#[test]
fn every_state_of_a_random_push_is_found() {
    const ROWS: usize = 300;
    let rows = rows(ROWS, 7);
    let levels: Vec<LevelCurve> = rows.iter().map(|row| row.level.clone()).collect();
    let histories = ContactHistory::of(&levels);
    let mut counts = [0; 3];
    let mut changes = 0;
    let mut endless = 0;
    let mut worst = 0.0_f64;
    for (row, history) in rows.iter().zip(&histories) {
        let rod = &row.level.rod;
        let case = format!("{rod:?} {:?}", row.level.row);
        let history = history.as_ref().unwrap();
        endless += usize::from(history.sliding_at_end(row.end) != Some(Sliding::Tip));
        let pushes = (1..100).map(|i| row.end * f64::from(i) / 100.0);
        let pushes: Vec<f64> = pushes.collect();
        let queries = pushes.iter().map(|push| ContactQuery {
            history,
            push: *push,
            phase: history.phase(*push),
        });
        let found = states(&queries.collect::<Vec<_>>());
        let friction = rod.friction.abs();
        let mut before: Option<(f64, ContactPhase)> = None;
        for (push, state) in pushes.iter().zip(found) {
            let state = state.unwrap_or_else(|| panic!("{case}: no state at {push}"));
            let ratio = state.at.ratio * row.level.side.sign();
            assert!(state.residual <= 1e-11, "{case}: {push} {state:?}");
            match state.sliding {
                Sliding::Tip => assert!(ratio == friction),
                Sliding::Base => assert!(ratio == -friction),
                Sliding::Sticks => assert!(ratio.abs() <= friction, "{case}: {push} {ratio}"),
            }
            counts[state.sliding as usize] += 1;
            let phase = history.phase(*push);
            if let Some((from, last)) = before
                && last.sliding() != phase.sliding()
            {
                let (mut low, mut high) = (from, *push);
                while high - low > 1e-12 {
                    let middle = 0.5 * (low + high);
                    let is_last = history.phase(middle).sliding() == last.sliding();
                    *(if is_last { &mut low } else { &mut high }) = middle;
                }
                let [one, other] = [low, high].map(|push| at(history, push).unwrap());
                let jump =
                    (one.variation.full.force.abs() / other.variation.full.force.abs() - 1.0).abs();
                worst = worst.max(jump);
                changes += 1;
            }
            before = Some((*push, phase));
        }
    }
    assert!(counts.iter().all(|count| *count > 50), "{counts:?}");
    assert!(changes > 100, "{changes}");
    // Measured: 3.2e-6, of 600 whiskers. A rounding of the slid distance changes the force ratio of some sticking contacts by as much.
    assert!(worst < 1e-5, "{worst:e}");
    assert_eq!(endless, 0);
}

/// Sliding directions at the ends of pushes by the history of the contact, and whether a few states of the row show it to slide toward the
/// tip, `[row]`.
fn at_ends(rod: &Rod, side: Side, distances: &[f64]) -> Vec<(Option<Sliding>, bool)> {
    let sheet = Sheet::new(Method::fine(), rod, side, distances);
    let rows = (0..distances.len()).filter(|row| sheet.touches(*row));
    let rows = rows.filter_map(|row| Some((row, *sheet.crossings[row].first()?)));
    let rows: Vec<_> = rows.filter(|(_, end)| end.push > 1e-3).collect();
    let points = rows.iter().map(|(_, end)| (end.tau, end.load));
    let states: Vec<FirstVariation> = Batch::new(Method::fine()).shoot_at(rod, points);
    let rows = rows.into_iter().zip(states);
    let rows: Vec<_> = rows.map(|((row, end), state)| (row, end, state)).collect();
    let levels: Vec<LevelCurve> = rows.iter().map(|(row, ..)| sheet.level(*row)).collect();
    let histories = ContactHistory::of(&levels);
    let ends = rows.iter().zip(&histories);
    let by_history = ends.map(|((_, end, _), history)| {
        let history = history.as_ref()?;
        history.sliding_at_end(end.push)
    });
    by_history.zip(surely_slides_to_end(&sheet, &rows)).collect()
}

/// A few states of a row show that most contacts slide toward the tip at the end of the push. They never show it of one that does not. In a
/// search over 550,000 random rows they showed it of 99.4 %, and of none of the 105 that do not.
#[test]
fn contacts_that_surely_slide_to_the_end_do() {
    let mut random = Random::new(5);
    let (mut ends, mut sure) = (0, 0);
    for _ in 0..40 {
        let (rod, side) = rough(&mut random);
        let distances: Vec<f64> = (1..10).map(|i| 0.1 * f64::from(i)).collect();
        for (by_history, is_sure) in at_ends(&rod, side, &distances) {
            assert!(!is_sure || by_history == Some(Sliding::Tip), "{rod:?}");
            ends += 1;
            sure += usize::from(is_sure);
        }
    }
    assert!(ends > 250 && 20 * sure > 19 * ends, "{sure} of {ends}");
    // A nearly perfect cone, first touched near its tip, whose contact sticks at the fold.
    let cone = Rod {
        taper: 0.9787911939620971,
        bend: 0.7534539699554443,
        slope: -0.2978797180567483,
        friction: -0.9278615593910218,
        ..Rod::default()
    };
    let distances: Vec<f64> = (880..995).map(|i| 1e-3 * f64::from(i)).collect();
    let found = at_ends(&cone, Side::Cf, &distances);
    let sticking = found.iter().filter(|(way, _)| *way == Some(Sliding::Sticks));
    assert!(sticking.clone().count() > 2, "{found:?}");
    assert!(sticking.clone().all(|(_, is_sure)| !is_sure));
}
