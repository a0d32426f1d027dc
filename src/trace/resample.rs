//! Resampling of a branch at uniform distances along it.

/// Returns positions of `count` points along a curve, `[point]`, and the index of the fold among them, `None` without one. `lengths` and the
/// positions are lengths along the curve, as in [`LevelCurve::length`](crate::sheet::LevelCurve::length). The parts before and after the fold each
/// get intervals in proportion to their length.
pub fn targets(lengths: &[f64], fold: Option<usize>, count: usize) -> (Vec<f64>, Option<usize>) {
    let intervals = count - 1;
    let total = lengths[lengths.len() - 1];
    let uniform = |from: f64, to: f64, n: usize| {
        (0..n).map(move |i| (to - from).mul_add(i as f64 / n as f64, from))
    };
    let Some(fold) = fold.map(|fold| lengths[fold]) else {
        let targets = uniform(0.0, total, intervals).chain([total]);
        return (targets.collect(), None);
    };
    let before = (fold / total * intervals as f64).round() as usize;
    let before = before.clamp(1, intervals - 1);
    let targets =
        uniform(0.0, fold, before).chain(uniform(fold, total, intervals - before)).chain([total]);
    (targets.collect(), Some(before))
}
