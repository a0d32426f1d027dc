//! Fig. 6 of the paper: a cone and a hair that sweep over a rough surface, from the texture model.

use super::{Figure, FigureError, FigurePanel, figure};
use crate::paper::whiskers::{FIG4_HAIR, FIG6_WHISKER};
use crate::render::{Ink, Line, Plot, STUCK, Stroke, TIP, tip_histogram, tip_lines};
use crate::scene::{Pole, Surface, Whisker};
use crate::texture::{Texture, TexturePhase, TextureSample, shape, texture};
use crate::trace::reach_mm;
use crate::whisk::AngleCourse;
use serde::Serialize;
use whiskmap_mechanics::rod::Side;

/// Frames per second, as in the paper.
const RATE: f64 = 32.0;
/// Amplitude in degrees and frequency in Hz of the base, as in the paper.
const SWEEP: [f64; 2] = [15.0, 0.2];
/// Number of whisking periods, as in the paper's panels C and F.
const PERIODS: f64 = 3.0;
/// Points along a whisker.
const POINTS: usize = 40;
/// Every how many frames a shape is drawn.
const EVERY: usize = 4;

/// Push distances of the cone and of the hair, in mm, as in the paper; `None` in free air.
const CONE_MM: [Option<f64>; 4] = [None, Some(0.33), Some(1.5), Some(4.5)];
const HAIR_MM: [Option<f64>; 4] = [None, Some(0.33), Some(2.0), Some(3.3)];

/// Surface of the figure, without its distance from the base.
const SURFACE: Surface = Surface {
    distance_mm: 0.0,
    spacing_um: 50.0,
    asperity_radius_um: 8.0,
    length_mm: 16.0,
    jitter: 0.5,
    seed: 0,
};

/// Point of a shape in a frame, a row of a table.
#[derive(Clone, Copy, Serialize)]
struct SweepPoint {
    time_s: f64,
    angle_deg: f64,
    phase: TexturePhase,
    x_mm: f64,
    y_mm: f64,
}

/// Sweep of a whisker behind the surface at one push distance.
struct Sweep<'a> {
    whisker: &'a Whisker,
    surface: Surface,
    texture: Texture,
    /// Same sweep with more samples, for the histogram.
    fine: Texture,
    /// Name of the sweep in files.
    name: String,
    /// Title of the panels of the sweep.
    title: String,
}

impl<'a> Sweep<'a> {
    fn new(
        whisker: &'a Whisker,
        push_mm: Option<f64>,
        [course, fine]: &[AngleCourse; 2],
    ) -> Result<Self, FigureError> {
        let reach_mm = reach_mm(whisker, &Pole::smooth(0.0), Side::Cb);
        // In free air the surface is beyond the whisker.
        let distance_mm = reach_mm - push_mm.unwrap_or(-1.0);
        let surface = Surface { distance_mm, ..SURFACE };
        let (of_file, title) = match push_mm {
            None => ("free".to_owned(), "free air".to_owned()),
            Some(mm) => (format!("{:.0}um", 1e3 * mm), format!("d_{{p}} = {mm} mm")),
        };
        Ok(Self {
            texture: texture(whisker, &surface, course)?,
            fine: texture(whisker, &surface, fine)?,
            whisker,
            surface,
            name: format!("_{of_file}"),
            title,
        })
    }

    /// Draws the whisker in frames of the second protraction: red where it is stuck, grey where it slips or is free.
    fn shapes(&self, letter: &'static str) -> Result<FigurePanel, FigureError> {
        let quarter = 0.25 / SWEEP[1];
        let is_shown =
            |sample: &&TextureSample| (3.0 * quarter..=5.0 * quarter).contains(&sample.time_s);
        let samples = self.texture.samples.iter().filter(is_shown);
        let (mut lines, mut rows) = (Vec::new(), Vec::new());
        for sample in samples.step_by(EVERY) {
            let points = shape(self.whisker, &self.surface, sample, POINTS)?;
            rows.extend(points.iter().map(|[x_mm, y_mm]| SweepPoint {
                time_s: sample.time_s,
                angle_deg: sample.angle_deg,
                phase: sample.phase,
                x_mm: *x_mm,
                y_mm: *y_mm,
            }));
            let (ink, name) = match sample.phase {
                TexturePhase::Stuck => (STUCK, "stuck"),
                _ => (Ink::Grey, "slipping or free"),
            };
            lines.push(Line::new(points, ink, Stroke::Solid).named(name));
        }
        let half_mm = 0.5 * self.surface.length_mm;
        let line = [-half_mm, half_mm].map(|x| [x, self.surface.distance_mm]);
        lines.push(Line::new(line.to_vec(), Ink::Black, Stroke::Dashed).named("surface"));
        let plot = Plot {
            title: self.title.clone(),
            x_label: "x (mm)".to_owned(),
            y_label: "y (mm)".to_owned(),
            lines,
            equal_axes: true,
            ..Plot::default()
        };
        Ok(FigurePanel::new(letter, plot, rows))
    }

    /// Draws the course of the tip: time upward, as in the paper.
    fn course(&self, letter: &'static str) -> FigurePanel {
        let lines = tip_lines(&self.texture.samples, |sample| sample.time_s);
        let swap = |line: Line| Line {
            points: line.points.iter().map(|[time, tip]| [*tip, *time]).collect(),
            ..line
        };
        let plot = Plot {
            title: self.title.clone(),
            x_label: TIP.to_owned(),
            y_label: "time (s)".to_owned(),
            lines: lines.into_iter().map(swap).collect(),
            ..Plot::default()
        };
        FigurePanel::new(letter, plot, self.texture.samples.clone())
    }

    fn histogram(&self) -> FigurePanel {
        let plot = Plot { title: self.title.clone(), ..tip_histogram(&self.fine) };
        FigurePanel::new("", plot, self.fine.tip_histogram())
    }
}

/// Draws the paper's Figs. 6B, 6C, 6E and 6F.
pub fn fig6() -> Result<Figure, FigureError> {
    let [amplitude, frequency] = SWEEP;
    let course = |rate| AngleCourse::sine(amplitude, frequency, PERIODS / frequency, rate);
    let courses = [course(RATE)?, course(10.0 * RATE)?];
    let mut panels = Vec::new();
    for (whisker, pushes, letters) in [
        (&FIG6_WHISKER, CONE_MM, [("b", "B"), ("c", "C")]),
        (&FIG4_HAIR, HAIR_MM, [("e", "E"), ("f", "F")]),
    ] {
        let [(shapes, of_shapes), (tips, of_tips)] = letters;
        let sweep = |push| Sweep::new(whisker, push, &courses);
        let sweeps: Vec<Sweep> = pushes.into_iter().map(sweep).collect::<Result<_, _>>()?;
        let first = |i: usize, letter| if i == 0 { letter } else { "" };
        for (i, sweep) in sweeps.iter().enumerate() {
            let name = format!("fig6{shapes}{}", sweep.name);
            panels.push((name, sweep.shapes(first(i, of_shapes))?));
        }
        for (i, sweep) in sweeps.iter().enumerate() {
            let name = format!("fig6{tips}{}", sweep.name);
            panels.push((name, sweep.course(first(i, of_tips))));
        }
        for sweep in &sweeps {
            let name = format!("fig6{tips}_histogram{}", sweep.name);
            panels.push((name, sweep.histogram()));
        }
    }
    let Surface { spacing_um, asperity_radius_um, .. } = SURFACE;
    let caption = vec![
        "The paper has no model for this. Here the surface is a row of small poles; one at a time bends the whisker, without friction and"
            .to_owned(),
        format!("inertia. Spacing {spacing_um} \u{b5}m, jittered, and radius {asperity_radius_um} \u{b5}m are assumed, and so is the curvature of the whisker (that of Fig. 4)."),
        "B, E: every fourth frame of 32 per second in the second protraction. C, F: the tip in the first three periods; its time at each place."
            .to_owned(),
        "As in the paper, the whisker slips on at 0.33 and 1.5 mm, and the hair is caught in the first protraction or at once, and stays.".to_owned(),
        "At 4.5 mm the model differs: its whisker stays caught, but the paper's slips on.".to_owned(),
    ];
    let title = "Fig. 6: a mouse whisker (B, C) and a human hair (E, F) sweep over a rough surface";
    let mut drawn = figure("fig6", title, caption, panels);
    drawn.chart.columns = 4;
    Ok(drawn)
}
