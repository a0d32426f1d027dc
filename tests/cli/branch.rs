//! `whiskmap branch`.

use crate::traces::{BRANCH, CB, SHAPE, cells, good};
use crate::{Place, SCENE};

#[test]
fn a_branch_has_as_many_points_as_asked_for() {
    let place = Place::with(SCENE);
    let run = good(&place, &[&CB[..], &["--points", "17"]].concat());
    let rows = cells(&run.out, BRANCH);
    assert_eq!(rows.len(), 17);
    let marks: Vec<&str> = rows
        .iter()
        .map(|row| row[9])
        .filter(|mark| !mark.is_empty())
        .collect();
    assert_eq!(marks, ["touch", "fold", "second-fold"]);
    let both = good(&place, &["branch", "scene.toml", "--distance", "15.66"]);
    assert_eq!(cells(&both.out, BRANCH).len(), 400);
}

/// The push angle of the fold, as printed, is a state, whichever way degrees are rounded.
#[test]
fn the_fold_can_be_asked_for() {
    let place = Place::with(SCENE);
    for distance in ["5.5", "8", "11.3", "14.1", "15.66", "17.9"] {
        for side in ["cb", "cf"] {
            let run = good(
                &place,
                &[
                    "branch",
                    "scene.toml",
                    "--distance",
                    distance,
                    "--side",
                    side,
                ],
            );
            let rows = cells(&run.out, BRANCH);
            let fold = rows.iter().find(|row| row[9] == "fold").unwrap();
            for branch in ["stable", "unstable"] {
                let at = [
                    "shape",
                    "scene.toml",
                    "--distance",
                    distance,
                    "--push-angle",
                    fold[2],
                ];
                good(
                    &place,
                    &[&at[..], &["--branch", branch, "--points=2"]].concat(),
                );
            }
        }
    }
    // Unstable states reach across first touch.
    let at = [
        "shape",
        "scene.toml",
        "--distance=15.66",
        "--push-angle",
        "-20",
        "--branch=unstable",
    ];
    let run = good(&place, &[&at[..], &["--side", "cb"]].concat());
    assert!(run.out.starts_with(SHAPE));
    good(
        &place,
        &[
            "shape",
            "scene.toml",
            "--distance=9",
            "--push-angle",
            "-1e-5",
        ],
    );
}
