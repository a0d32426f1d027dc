//! Bad files, and options that do not fit them.

use super::{deeplabcut, exact, measurements, options, points, refusal, with};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;
use whiskmap::tracking::{FaceAxis, ImagePole, Tracking, TrackingError};

#[test]
fn bad_files_are_named_with_line_value_and_what_is_allowed() {
    let good = deeplabcut(exact);
    for (text, why) in [
        (
            "time,angle\n1,2\n".to_owned(),
            "film.csv: has no known format: must be of DeepLabCut (the first cell is scorer)",
        ),
        (
            good.replace("bodyparts", "individuals"),
            "film.csv:2: begins with individuals: must begin with bodyparts; export the file of one individual",
        ),
        (
            good.replacen("coords", "axes", 1),
            "film.csv:3: begins with axes: must begin with coords",
        ),
        (
            good.lines().take(3).map(|line| format!("{line}\n")).collect(),
            "has no frames: must have at least one row below scorer, bodyparts and coords",
        ),
        (
            good.replacen(",x,y,likelihood", ",x,z,likelihood", 1),
            "film.csv:3: has no column y of c: must have x and y",
        ),
        (
            good.replace("\n1,", "\n0,"),
            "film.csv:5: frame 0: must be more than 0 of the line before",
        ),
        (good.replacen("\n0,", "\n0,far", 1), "film.csv:4: c x = far"),
        (
            good.replace("\n5,", "\n,"),
            "film.csv:9: frame is empty: must be a whole number of at least 0",
        ),
        (
            good.replace("\n5,", "\nimg0005.png,"),
            "film.csv:9: frame = img0005.png: must be a whole number of at least 0",
        ),
        (
            good.replace("\n5,", "\n5,1,1,2,"),
            "film.csv:9: has 31 cells: must have 28, one a column",
        ),
        (
            "fid,follicle_x\n0,1\n".to_owned(),
            "film.csv:1: found fid, follicle_x; needed fid or frame_id or frame, angle, curvature",
        ),
        (
            measurements(FaceAxis::X).replace("\n1,3", "\n-1,3"),
            "film.csv:4: fid = -1: must be a whole number of at least 0",
        ),
        (measurements(FaceAxis::X).replace(",1500,", ",1500,up"), "angle = up"),
        ("0,1\n0,far\n".to_owned(), "film.csv:2: y = far: must be a number between -1e6 and 1e6"),
        (
            "0,1\n0,2e6\n".to_owned(),
            "film.csv:2: y = 2e6: must be a number between -1e6 and 1e6, or empty where it is missing",
        ),
        ("0,1,2,3\n".to_owned(), "film.csv:1: has 4 cells: must have x,y or frame,x,y"),
        (
            "1,0,1\n0,0,1\n".to_owned(),
            "film.csv:2: frame = 0: must be at least 1 of the line before",
        ),
        ("\n".to_owned(), "film.csv: has no points: must have x,y or frame,x,y"),
        (
            "0,1,1\n9000000,1,1\n".to_owned(),
            "must have frames whose numbers differ by less than 1000000",
        ),
    ] {
        let message = refusal(&text, &options());
        assert!(message.contains(why), "{message}\n{why}");
    }
    let two = [(good.clone(), "a.csv".to_owned()), (good, "b.csv".to_owned())];
    let why = Tracking::parse(&two, &options(), &AtomicBool::new(false)).unwrap_err();
    assert_eq!(
        why.to_string(),
        "b.csv: is a second file: only the format xy may have several, one for each frame"
    );
}

/// Nine points are enough, but not for every degree, nor near the base alone.
#[test]
fn a_degree_that_needs_more_points_is_named() {
    let film = deeplabcut(exact);
    for (degree, fit_to_mm, why) in [
        (6, None, "with 10 points along a smooth curve, the base among them and all within 17."),
        (
            2,
            Some(10.0),
            "with 6 points along a smooth curve, the base among them and all within 10 mm of it; a curvature of degree 2 needs as many",
        ),
    ] {
        let options =
            with(&|options| (options.degree, options.fit_to_mm) = (Some(degree), fit_to_mm));
        let message = refusal(&film, &options);
        assert!(message.contains(why), "{message}\n{why}");
    }
}

#[test]
fn options_that_do_not_fit_are_refused() {
    let (film, rows, points) = (deeplabcut(exact), measurements(FaceAxis::X), points(0));
    let unlikely = film.replacen(&",x,y,likelihood".repeat(9), &",x,y,other".repeat(9), 1);
    let at = ImagePole::At([0.0, 0.0]);
    let part = |name: &str| ImagePole::Part(name.to_owned());
    for (text, options, why) in [
        (
            &film,
            with(&|options| options.mm_per_pixel = 0.0),
            "mm_per_pixel = 0: must be a number between 1e-9 and 1e9",
        ),
        (&film, with(&|options| options.fps = f64::NAN), "fps = NaN: must be a number between"),
        (
            &film,
            with(&|options| options.likelihood = Some(1.5)),
            "likelihood = 1.5: must be a number between 0 and 1",
        ),
        (&film, with(&|options| options.degree = Some(7)), "degree = 7: must be between 0 and 6"),
        (
            &film,
            with(&|options| options.pole = Some(at.clone())),
            "pole = 0,0: needs contact_within_mm",
        ),
        (
            &film,
            with(&|options| options.contact_within_mm = Some(1.0)),
            "contact_within_mm = 1: must be left out without a pole",
        ),
        (
            &film,
            with(&|options| options.taper = Some(0.9)),
            "taper = 0.9: must be left out without a pole",
        ),
        (
            &film,
            with(&|options| (options.pole, options.taper) = (Some(at.clone()), Some(1.01))),
            "taper = 1.01: must be a number between 0 and 1",
        ),
        (
            &film,
            with(&|options| {
                options.pole = Some(at.clone());
                (options.taper, options.fit_to_mm) = (Some(0.9), Some(12.0));
            }),
            "taper = 0.9: must be left out with fit_to_mm, which selects polynomials",
        ),
        (
            &film,
            with(&|options| {
                (options.pole, options.contact_within_mm) = (Some(part("pole")), Some(1.0))
            }),
            "pole = pole: must be one of c, base, tip",
        ),
        (
            &film,
            with(&|options| options.points = vec!["bse".to_owned()]),
            "points = bse: must be one of c, base, tip, a, f, b, g, d, e; did you mean `base`?",
        ),
        (&film, with(&|options| options.whisker = Some(1)), "whisker = 1: must be left out"),
        (
            &film,
            with(&|options| options.face_axis = Some(FaceAxis::Y)),
            "face_axis = y: must be left out: only measurements of whisk have angles",
        ),
        (
            &film,
            with(&|options| options.curvature_at_mm = Some(20.5)),
            "curvature_at_mm = 20.5: must be between 0 and ",
        ),
        (
            &film,
            with(&|options| options.zero_s = Some(1.0)),
            "zero_s = 1: must be the time of a frame with a whisker, between 0 and 0.01 s in steps of 1/500 s",
        ),
        (
            &rows,
            with(&|options| options.whisker = Some(2)),
            "whisker = 2: must be an identity in the column label: 0 (5 rows)",
        ),
        (
            &rows,
            with(&|options| options.curvature_at_mm = Some(2.0)),
            "curvature_at_mm = 2: must be left out with measurements of whisk",
        ),
        (
            &rows,
            with(&|options| options.degree = Some(2)),
            "degree = 2: must be left out with measurements of whisk",
        ),
        (
            &rows,
            with(&|options| {
                (options.pole, options.contact_within_mm) = (Some(at.clone()), Some(1.0));
                options.taper = Some(0.9);
            }),
            "taper = 0.9: must be left out with measurements of whisk: they have no points",
        ),
        (
            &rows,
            with(&|options| options.follicle_px = Some([1.0, 2.0])),
            "follicle_px = 1,2: must be left out with measurements of whisk: they name the follicle",
        ),
        (
            &rows,
            with(&|options| options.points = vec!["a".to_owned()]),
            "points = a: must be left out",
        ),
        (
            &rows,
            with(&|options| {
                (options.pole, options.contact_within_mm) = (Some(part("pole")), Some(1.0))
            }),
            "pole = pole: must be X,Y in pixels",
        ),
        (
            &rows,
            with(&|options| options.likelihood = Some(0.9)),
            "likelihood = 0.9: must be left out with measurements of whisk: they have no likelihoods",
        ),
        (
            &points,
            with(&|options| options.likelihood = Some(0.5)),
            "likelihood = 0.5: must be left out with points x,y: they have no likelihoods",
        ),
        (
            &unlikely,
            with(&|options| options.likelihood = Some(0.5)),
            "likelihood = 0.5: must be left out: the file has no column likelihood",
        ),
        (
            &points,
            with(&|options| options.whisker = Some(1)),
            "whisker = 1: must be left out with points x,y",
        ),
        (
            &points,
            with(&|options| options.points = vec!["a".to_owned()]),
            "points = a: must be left out",
        ),
        (
            &points,
            with(&|options| {
                (options.pole, options.contact_within_mm) = (Some(part("pole")), Some(1.0))
            }),
            "pole = pole: must be left out",
        ),
    ] {
        let message = refusal(text, &options);
        assert!(message.starts_with(why), "{message}\n{why}");
    }
}

/// A flag that is set before or during the work ends it: the result is not that of the film.
#[test]
fn a_cancelled_film_has_no_result() {
    let film = deeplabcut(exact);
    let (header, rows) = film.split_at(film.find("\n0,").unwrap());
    let rows = rows.lines().skip(1).map(|row| row.split_once(',').unwrap().1);
    let rows = rows.cycle().take(40_000).enumerate();
    let long = rows.fold(header.to_owned(), |text, (i, row)| text + &format!("\n{i},{row}"));
    for (text, after_ms) in [(film.clone(), None), (long, Some(5))] {
        let cancel = AtomicBool::new(after_ms.is_none());
        let files = [(text, "film.csv".to_owned())];
        let found = std::thread::scope(|scope| {
            if let Some(after_ms) = after_ms {
                let cancel = &cancel;
                scope.spawn(move || {
                    std::thread::sleep(Duration::from_millis(after_ms));
                    cancel.store(true, Ordering::Relaxed);
                });
            }
            Tracking::parse(&files, &options(), &cancel)
        });
        assert_eq!(found, Err(TrackingError::Cancelled));
    }
}
