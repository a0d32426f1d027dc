//! Balance of energy: work of the base, energy of the whisker, and losses at detachments.

use super::{SHIPPED, course, kinds, scene};
use whiskmap::texture::{Texture, texture};
use whiskmap::whisk::AngleCourse;

/// Abscissas and weights of Gauss and Legendre with eight points, on the half from 0 to 1.
const GAUSS: [[f64; 2]; 4] = [
    [0.183_434_642_495_649_8, 0.362_683_783_378_362],
    [0.525_532_409_916_329, 0.313_706_645_877_887_3],
    [0.796_666_477_413_626_7, 0.222_381_034_453_374_5],
    [0.960_289_856_497_536_3, 0.101_228_536_290_376_3],
];

/// Nodes and weights from 0 to 1 in growing order, of `panels` equal panels.
fn gauss(panels: usize) -> Vec<[f64; 2]> {
    let signed = GAUSS.map(|[x, weight]| [-x, weight]).into_iter().rev();
    let nodes: Vec<[f64; 2]> = signed.chain(GAUSS).collect();
    let width = 1.0 / panels as f64;
    let panel = |i: usize| {
        let middle = (i as f64 + 0.5) * width;
        let nodes = nodes.clone().into_iter();
        nodes.map(move |[x, weight]| [middle + 0.5 * width * x, 0.5 * width * weight])
    };
    (0..panels).flat_map(panel).collect()
}

/// Angles at which the moment of the base jumps or turns, in the order of time: events, and the ends of the strokes of `sweep`.
fn breaks(found: &Texture, sweep: &AngleCourse) -> Vec<f64> {
    let events = found.events.iter().map(|event| (event.time_s, event.angle_deg));
    let times = sweep.times_s().windows(3).zip(sweep.angles_deg().windows(3));
    let turns = times.filter(|(_, angles)| (angles[1] - angles[0]) * (angles[2] - angles[1]) < 0.0);
    let turns = turns.map(|(time, angles)| (time[1], angles[1]));
    let mut all: Vec<(f64, f64)> = events.chain(turns).collect();
    all.sort_by(|a, b| a.0.total_cmp(&b.0));
    let last = sweep.angles_deg().last().copied();
    all.into_iter().map(|(_, angle)| angle).chain(last).collect()
}

/// The work of the base is what the whisker stores at the end, and what its detachments lose.
#[test]
fn the_work_of_the_base_is_stored_or_lost() {
    for name in SHIPPED {
        let scene = scene(name);
        let surface = scene.surface.unwrap();
        let sweep = AngleCourse::sine(15.0, 0.2, 15.0, 100.0).unwrap();
        let first = texture(&scene.whisker, &surface, &sweep).unwrap();
        let (mut angles, mut weights) = (vec![0.0], vec![0.0]);
        let mut from = 0.0;
        for to in breaks(&first, &sweep) {
            // At and next to a fold the moment is a smooth function of `u`, where the angle is `from + span u^2 (3 - 2 u)`.
            let span: f64 = to - from;
            let panels = if span == 0.0 { 0 } else { 1 + (3.0 * span.abs()) as usize };
            for [u, weight] in gauss(panels) {
                angles.push(from + span * u * u * (3.0 - 2.0 * u));
                weights.push(span.to_radians() * 6.0 * u * (1.0 - u) * weight);
            }
            from = to;
        }
        angles.push(from);
        weights.push(0.0);
        let found = texture(&scene.whisker, &surface, &course(&angles)).unwrap();
        assert_eq!(kinds(&found), kinds(&first), "{name}");
        let moments = found.samples.iter().map(|sample| sample.base_moment_nnm.unwrap());
        let work: f64 = moments.zip(&weights).map(|(moment, weight)| moment * weight).sum();
        let energies = || found.samples.iter().map(|sample| sample.energy_nj.unwrap());
        let (stored, lost) = (energies().next_back().unwrap(), found.lost_nj());
        let largest = energies().fold(lost, f64::max);
        let miss = (work - stored - lost) / largest;
        // Measured: 1.2e-11.
        assert!(miss.abs() < 1e-9, "{name}: {work} {stored} {lost} {miss:e}");
        let mut losses = found.events.iter().filter_map(|event| event.lost_nj);
        assert!(losses.all(|lost| lost > 0.0), "{name}");
    }
}
