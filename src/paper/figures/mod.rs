//! The theory of the paper's figures, panel by panel, each with the table behind it.
//!
//! The push angle is everywhere the rotation of the base since first touch, but for the drawing of Fig. 1D; `d` is the
//! distance from the base to the contact at first touch, so that a row of Fig. 3E is the pole of Figs. 3B-D.

mod detachment;
mod drawing;
mod fig1;
mod fig2;
mod fig3;
mod fig4d;
mod fig5c;

pub use detachment::Measurements;

use crate::render::{Chart, Plot};
use crate::store::Table;
use crate::trace::NoState;
use serde::Serialize;
use std::io;

/// A figure: a chart, and the tables behind its panels.
pub struct Figure {
    /// Stem of the chart's file.
    pub name: &'static str,
    /// The chart.
    pub chart: Chart,
    /// Stem of the file and rows of each table.
    pub tables: Vec<(String, Rows)>,
}

/// Writes rows of any kind into a table.
pub type Rows = Box<dyn Fn(&mut Table) -> io::Result<()>>;

/// A panel: its letter, its plot and its table.
struct Panel {
    letter: &'static str,
    plot: Plot,
    rows: Rows,
}

impl Panel {
    fn new<R: Serialize + 'static>(letter: &'static str, plot: Plot, rows: Vec<R>) -> Self {
        Self {
            letter,
            plot,
            rows: Box::new(move |table| table.rows(&rows)),
        }
    }
}

/// Every figure of the paper that has theory in it, with measured ends of pushes where the paper shows such.
///
/// # Errors
/// When a branch cannot be followed.
pub fn figures(measured: &Measurements) -> Result<Vec<Figure>, NoState> {
    Ok(vec![
        fig1::fig1()?,
        fig2::fig2()?,
        fig3::fig3()?,
        fig4d::fig4d(&measured.fig4d),
        fig5c::fig5c([&measured.fig5c_left, &measured.fig5c_right]),
    ])
}

/// Panels in two columns, each with the stem of its table.
fn figure(
    name: &'static str,
    title: &str,
    caption: Vec<String>,
    panels: Vec<(String, Panel)>,
) -> Figure {
    let (plots, tables) = panels
        .into_iter()
        .map(|(table, Panel { letter, plot, rows })| {
            let letter = Some(letter.to_owned());
            (Plot { letter, ..plot }, (table, rows))
        })
        .unzip();
    let chart = Chart {
        title: title.to_owned(),
        caption,
        plots,
        columns: 2,
    };
    Figure {
        name,
        chart,
        tables,
    }
}

/// The same where tables are called by the figure and the letter.
fn lettered(name: &'static str, title: &str, caption: Vec<String>, panels: Vec<Panel>) -> Figure {
    let table = |panel: &Panel| format!("{name}{}", panel.letter.to_lowercase());
    let panels = panels.into_iter().map(|panel| (table(&panel), panel));
    figure(name, title, caption, panels.collect())
}

/// What the push angle is, for captions.
const PUSH: &str = "Push angle \u{3b8}_p: rotation of the base since first touch; CF left (negative), CB right (positive).";
