//! Numbers of frames in the names of their files.

use std::path::Path;

/// Returns the numbers of frames whose files or images have these names, `[frame]`: the only number in which the names differ. `None` if they differ
/// elsewhere, or nowhere.
pub(super) fn numbers_in(names: &[&str]) -> Option<Vec<u64>> {
    let parts = |name: &&str| -> Option<Vec<Result<u64, String>>> {
        let stem = Path::new(name).file_stem()?.to_str()?.to_owned();
        let parts = stem.as_bytes().chunk_by(|a, b| a.is_ascii_digit() == b.is_ascii_digit());
        let part = |part: &[u8]| {
            let text = String::from_utf8_lossy(part);
            text.parse().map_err(|_| text.into_owned())
        };
        Some(parts.map(part).collect())
    };
    let all: Vec<Vec<_>> = names.iter().map(parts).collect::<Option<_>>()?;
    let (first, rest) = all.split_first()?;
    let have_places = rest.iter().all(|parts| parts.len() == first.len());
    let differs = |place: &usize| rest.iter().any(|parts| parts[*place] != first[*place]);
    let places = (0..first.len()).filter(|place| have_places && differs(place));
    let [place] = places.collect::<Vec<_>>()[..] else {
        return None;
    };
    all.into_iter().map(|mut parts| parts.swap_remove(place).ok()).collect()
}

#[cfg(test)]
mod tests {
    use super::numbers_in;

    #[test]
    fn the_number_that_differs_is_the_number_of_the_frame() {
        let numbers = |names: &[&str]| numbers_in(names);
        assert_eq!(numbers(&["f_1.csv", "f_10.csv", "f_2.csv"]), Some(vec![1, 10, 2]));
        assert_eq!(numbers(&["a/w1_f08.csv", "b/w1_f12.csv"]), Some(vec![8, 12]));
        assert_eq!(numbers(&["007.csv", "7.csv", "8.csv"]), Some(vec![7, 7, 8]));
        for names in [
            &["a.csv", "b.csv"][..],
            &["1.csv"],
            &["1.csv", "1.csv"],
            &["w1_f1.csv", "w2_f2.csv"],
            &["f1.csv", "f2x.csv"],
            &["1.csv", "99999999999999999999.csv"],
            &[],
        ] {
            assert_eq!(numbers(names), None, "{names:?}");
        }
    }
}
