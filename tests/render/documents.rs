//! Pictures as files.

use super::drawn::{Pixels, rasters, svg, well_formed};
use super::map::{panel, scene, write};
use super::{SLIP_OFF, colours, flat, picture};
use std::fs;
use whiskmap::map::Panel;
use whiskmap::render::{self, MapOptions, PictureSize, RenderError};
use whiskmap::store::{self, StoredMap};

#[test]
fn an_svg_document_has_the_cells_as_pixels_and_the_rest_as_such() {
    for (tapers, panels) in [(None, 1), (Some(vec![0.2, 0.5]), 2)] {
        let scene = scene(40, 50, tapers, None);
        let panels: Vec<Panel> = (0..panels).map(|index| panel(&scene, index)).collect();
        for channel in [None, Some("force_un")] {
            let options = MapOptions { channel, ..MapOptions::default() };
            let picture = picture(&scene, &panels, &options).unwrap();
            let (document, pixels) = (svg(&picture), Pixels::of(&picture));
            assert!(well_formed(&document));
            let texts = ["A made-up whisker in front of a pole<", "push angle (deg)"];
            assert!(texts.iter().all(|text| document.contains(text)));
            let rasters = rasters(&document);
            // Inside of the frames, away from lines.
            let (mut same, mut all) = (0, 0);
            for ([left, top, width, height], raster) in &rasters {
                assert_eq!([raster.width as f64, raster.height as f64], [*width, *height]);
                for (place, pixel) in raster.pixels.iter().enumerate() {
                    let (x, y) = (place % raster.width, place / raster.width);
                    same += usize::from(*pixel == pixels.at([left + x as f64, top + y as f64]));
                }
                all += raster.pixels.len();
            }
            assert!(rasters.len() > panels.len() && same * 100 > all * 97, "{same} of {all}");
            let boundary = document.matches("stroke-width=\"3\"").count();
            assert_eq!(boundary > 1, panels.len() == 1);
        }
    }
}

#[test]
fn a_picture_has_the_requested_width() {
    let scene = scene(6, 5, None, None);
    let panels = [flat(&scene, &[2; 30], 3.0)];
    for width in [300, 1001, 3000] {
        let options = MapOptions { size: PictureSize::Width(width), ..MapOptions::default() };
        let picture = picture(&scene, &panels, &options).unwrap();
        let pixels = Pixels::of(&picture);
        assert_eq!(pixels.width, width as usize);
        let ratio = pixels.height as f64 / pixels.width as f64;
        assert!((0.7..0.8).contains(&ratio), "{ratio}");
        let part = colours(&pixels)[&SLIP_OFF] as f64 / pixels.pixels.len() as f64;
        assert!((0.6..0.75).contains(&part), "{part} of the picture");
        let document = svg(&picture);
        assert!(document.contains(&format!(" width=\"{width}\" height=\"{}\"", pixels.height)));
        assert!(document.contains(" viewBox=\"0 0 14"), "the natural size");
        assert!(rasters(&document)[1].1.width > width as usize * 8 / 10);
    }
}

#[test]
fn errors_leave_no_picture() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("map.exr");
    write(&file, &scene(2, 2, None, None));
    let map = StoredMap::open(&file).unwrap().into();
    let options = MapOptions { channel: Some("weight"), ..MapOptions::default() };
    let error = render::map(&map, &options).unwrap_err();
    assert!(
        matches!(error, RenderError::Store(store::StoreError::UnknownChannel { .. })),
        "{error}"
    );
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
}

#[test]
fn a_channel_has_its_unit_and_refused_scales_name_it() {
    let scene = scene(3, 2, None, None);
    let panels = [flat(&scene, &[1; 6], 2e3)];
    for (channel, label) in [
        ("force_un", ">contact force (mN)<"),
        ("arc_length_mm", ">arc length from base to contact (m)<"),
        ("push_chord_deg", ">chord angle (deg)<"),
        ("base_moment_nnm", ">bending moment at the base (\u{b5}N m)<"),
        ("energy_nj", ">bending energy (\u{b5}J)<"),
        ("newton_steps", ">Newton steps<"),
    ] {
        let options = MapOptions { channel: Some(channel), ..MapOptions::default() };
        let document = svg(&picture(&scene, &panels, &options).unwrap());
        assert!(document.contains(label), "{label}");
    }
    for (channel, log, range, refused) in [
        (None, true, None, "`regime`: the channel is made of codes"),
        (Some("regime"), false, Some([0.0, 1.0]), "made of codes"),
        (Some("status"), true, None, "`status`: the channel is made of codes"),
        (Some("force_un"), false, Some([2.0, 1.0]), "`force_un`: range 2,1: must be"),
        (Some("newton_steps"), true, Some([0.0, 1.0]), "begin above 0"),
    ] {
        let options = MapOptions {
            without_title: false,
            channel,
            log: log.then_some(true),
            range,
            size: PictureSize::Natural,
        };
        let error = picture(&scene, &panels, &options).unwrap_err();
        assert!(error.to_string().contains(refused), "{error}");
    }
}
