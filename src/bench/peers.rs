//! Costs and errors of other programs, as `benches/peers/run.sh` writes them.

use crate::input::{TEXT_MIB, read};
use serde::Deserialize;
use std::path::{Path, PathBuf};

/// Error in radians below which the 11 digits of AUTO's push angles show none.
const LAST_DIGIT: f64 = 1e-11;

/// Other programs on one machine.
#[derive(Clone, Debug, PartialEq)]
pub struct Peers {
    /// Model name of the machine's processor.
    pub machine: String,
    /// Other programs that were measured: `[program]`.
    pub programs: Vec<Peer>,
}

/// One program on one thread, in the settings that no other setting beats.
#[derive(Clone, Debug, PartialEq)]
pub struct Peer {
    /// Name of the program.
    pub name: &'static str,
    /// Settings of the program, `[setting][microseconds, largest error in degrees]`, from the fastest one on. An error of heyoka and `solve_bvp` is
    /// relative to its number, as an angle is to a radian.
    pub points: Vec<[f64; 2]>,
}

/// Error in a file of peers: the file, the place, the value and what is allowed.
#[derive(Debug, thiserror::Error)]
#[error("--peers {}: {what}", path.display())]
pub struct PeersError {
    path: PathBuf,
    what: String,
}

#[derive(Deserialize)]
struct PeersFile {
    machine: String,
    heyoka: Option<Vec<PeerRow>>,
    auto: Option<PeerRows>,
    solve_bvp: Option<PeerRows>,
}

#[derive(Deserialize)]
struct PeerRows {
    rows: Vec<PeerRow>,
}

#[derive(Deserialize)]
struct PeerRow {
    microseconds: f64,
    error_max: f64,
    /// Threads of heyoka; the others have one.
    threads: Option<u32>,
    /// Kind of AUTO's points: `equilibrium` or `fold`.
    kind: Option<String>,
}

impl Peers {
    /// Reads the JSON file `path`; `-` is standard input.
    ///
    /// # Errors
    /// If the file cannot be read, is longer than 1 MiB, is no such JSON, has a number that is out of range, or has no program.
    pub fn read(path: &Path) -> Result<Self, PeersError> {
        let error = |what: String| PeersError { path: path.to_owned(), what };
        let bytes = read(path, TEXT_MIB);
        let bytes = bytes.map_err(|cause| error(format!("cannot read the file: {cause}")))?;
        Self::parse(&bytes).map_err(error)
    }

    fn parse(bytes: &[u8]) -> Result<Self, String> {
        let file: PeersFile = serde_json::from_slice(bytes)
            .map_err(|cause| format!("must be as benches/peers/run.sh writes it: {cause}"))?;
        let rows = |rows: Option<PeerRows>| rows.map(|peer| peer.rows);
        let programs = [
            ("heyoka", file.heyoka, 0.0),
            ("AUTO-07p", rows(file.auto), LAST_DIGIT),
            ("solve_bvp", rows(file.solve_bvp), 0.0),
        ];
        let measured = programs.into_iter();
        let programs = measured
            .filter_map(|(name, rows, least)| Some(Peer::new(name, rows?, least)))
            .collect::<Result<Vec<Peer>, String>>()?;
        if programs.iter().all(|peer| peer.points.is_empty()) {
            return Err("has no program; measure one with benches/peers/run.sh".to_owned());
        }
        Ok(Self { machine: file.machine, programs })
    }
}

impl Peer {
    /// Selects the settings among `rows` that no other one beats. Errors below `least` count as much.
    fn new(name: &'static str, rows: Vec<PeerRow>, least: f64) -> Result<Self, String> {
        let mut points = Vec::new();
        for (index, row) in rows.iter().enumerate() {
            for (key, number, is_valid) in [
                ("microseconds", row.microseconds, row.microseconds > 0.0),
                ("error_max", row.error_max, row.error_max >= 0.0),
            ] {
                if !(is_valid && number.is_finite()) {
                    return Err(format!(
                        "{name}, row {}: {key} is {number}; must be positive",
                        index + 1
                    ));
                }
            }
            let is_single = row.threads.unwrap_or(1) == 1;
            let is_state = row.kind.as_deref().is_none_or(|kind| kind == "equilibrium");
            let error = row.error_max.max(least).to_degrees();
            points.extend((is_single && is_state).then_some([row.microseconds, error]));
        }
        points.sort_by(|a: &[f64; 2], b| a[0].total_cmp(&b[0]));
        let mut best = f64::INFINITY;
        points.retain(|[_, error]| {
            let is_better = *error < best;
            best = best.min(*error);
            is_better
        });
        Ok(Self { name, points })
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test fails by panicking")]
mod tests {
    use super::*;

    #[test]
    fn the_best_settings_on_one_thread_remain() {
        let text = r#"{"machine": "M", "heyoka": [
            {"microseconds": 2.0, "error_max": 1e-4, "threads": 1},
            {"microseconds": 1.0, "error_max": 1e-3, "threads": 1},
            {"microseconds": 3.0, "error_max": 1e-4, "threads": 1},
            {"microseconds": 0.5, "error_max": 1e-9, "threads": 2}], "auto": {"rows": [
            {"microseconds": 9.0, "error_max": 0.0, "kind": "equilibrium"},
            {"microseconds": 1.0, "error_max": 0.0, "kind": "fold"}]}, "solve_bvp": null}"#;
        let peers = Peers::parse(text.as_bytes()).unwrap();
        let [heyoka, auto] = &peers.programs[..] else { panic!("{peers:?}") };
        let wanted = [[1.0, 1e-3], [2.0, 1e-4]].map(|[us, error]| [us, f64::to_degrees(error)]);
        assert_eq!(heyoka.points, wanted);
        assert_eq!(auto.points, [[9.0, LAST_DIGIT.to_degrees()]]);
    }
}
