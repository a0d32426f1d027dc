//! `whiskmap reproduce` and `whiskmap verify`.

use crate::traces::good;
use crate::{Place, SCENE, names};

#[test]
fn figures_come_with_their_tables() {
    let place = Place::with(SCENE);
    let run = good(&place, &["reproduce", "new/folder"]);
    let mut files: Vec<&str> = run
        .out
        .lines()
        .map(|line| line.trim_start_matches("new/folder/"))
        .collect();
    files.sort_unstable();
    assert_eq!(files, names(&place.path("new/folder")));
    for figure in ["fig2", "fig3", "fig4d", "fig5c"] {
        for ending in ["png", "svg"] {
            assert!(files.contains(&&*format!("{figure}.{ending}")), "{files:?}");
        }
        let tables = files
            .iter()
            .filter(|file| file.starts_with(figure) && file.ends_with(".csv"));
        assert!(tables.count() >= 2, "{files:?}");
    }
    place.write("file", "");
    place
        .run(&["reproduce", "file"])
        .assert_refused(&["file: ", "give a folder that can be written"]);
}

#[test]
fn verify_says_pass_for_every_number() {
    let run = good(&Place::with(SCENE), &["verify"]);
    let passes = run
        .out
        .lines()
        .filter(|line| line.ends_with("PASS"))
        .count();
    assert!(passes > 30, "{run:?}");
    assert!(
        run.out
            .ends_with(&format!("{passes} of {passes} checks pass\n")),
        "{run:?}"
    );
}
