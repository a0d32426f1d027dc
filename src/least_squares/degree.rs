//! Choice of the degree of a fit by cross-validation.

/// Returns the smallest degree whose mean squared error is not larger than the least one by more than the standard error of the difference.
///
/// `squares` has the squared errors of points that were left out of the fit, `[degree][point]`. Differences up to `exact` count as 0. This is
/// the rule of one standard error (Hastie et al., The Elements of Statistical Learning, 2009, section 7.10) with paired differences.
pub fn smallest_degree(squares: &[Vec<f64>], exact: f64) -> usize {
    let count = squares[0].len() as f64;
    let mean = |values: &[f64]| values.iter().sum::<f64>() / count;
    let means: Vec<f64> = squares.iter().map(|of_degree| mean(of_degree)).collect();
    let best = (0..means.len()).fold(
        0,
        |best, degree| {
            if means[degree] < means[best] { degree } else { best }
        },
    );
    let is_good = |degree: &usize| {
        let pairs = squares[*degree].iter().zip(&squares[best]);
        let differences: Vec<f64> = pairs.map(|(square, least)| square - least).collect();
        let excess = mean(&differences);
        let spread =
            differences.iter().map(|difference| (difference - excess) * (difference - excess));
        let error = (spread.sum::<f64>() / (count * (count - 1.0))).sqrt();
        excess <= error + exact
    };
    (0..best).find(is_good).unwrap_or(best)
}
