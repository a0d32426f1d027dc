//! Charts and heat maps as PNG, SVG and PDF, drawn from plain data.
//!
//! A [`Chart`] holds plots of lines, bands, dots, discs and notes; a [`HeatMap`] holds panels of cells. Both become a [`Picture`],
//! which [`Picture::encode`] turns into the bytes of a file. Equal data give equal bytes.
//!
//! ```
//! use whiskmap_plot::{Chart, Dot, Ink, Line, PictureFormat, PictureSize, Plot, PrintSize, Stroke};
//!
//! let parabola = (-20..=20).map(|i| 0.1 * f64::from(i)).map(|x| [x, x * x]);
//! let plot = Plot {
//!     x_label: "deflection (mm)".to_owned(),
//!     y_label: "energy (nJ)".to_owned(),
//!     lines: vec![Line::new(parabola.collect(), Ink::Blue, Stroke::Solid).named("spring")],
//!     dots: vec![Dot { at: [0.0, 0.0], open: true, name: Some("rest".to_owned()), ..Dot::default() }],
//!     ..Plot::default()
//! };
//! let chart = Chart::single("A spring", plot);
//! let picture = chart.picture(PictureSize::Natural)?;
//! let svg = String::from_utf8(picture.encode(PictureFormat::Svg)?)?;
//! assert!(svg.starts_with("<?xml") && svg.contains(">deflection (mm)</text>"));
//! let png = picture.encode(PictureFormat::Png)?;
//! assert!(png.starts_with(b"\x89PNG"));
//! let column = PrintSize { width_mm: 85.0, height_mm: None, dpi: 300.0 };
//! let printed = chart.picture(PictureSize::Print(column))?;
//! assert_eq!(printed.pixels()[0], 1004);
//! assert!(printed.encode(PictureFormat::Pdf)?.starts_with(b"%PDF"));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Text has at least 7 pt in a picture with a size on paper. In a text, `_{...}` is a subscript, as in `θ_{p}`.
//!
//! Axes choose their ranges, ticks and units. A label that ends in a unit of length, force, moment or energy, such as `(mm)`, changes to
//! the unit in which numbers read best. The font is DejaVu Sans; the crate contains it, and its licence in `fonts/`.

mod chart;
mod frame;
mod heat_map;
mod picture;

pub use chart::{Band, Chart, Disc, Dot, Ink, Inset, Line, Note, Plot, Shade, Stroke};
pub use frame::heading::LegendEntry;
pub use frame::regions::Region;
pub use frame::units::readable_value;
pub use heat_map::cell_axis::CellAxis;
pub use heat_map::colour_scale::{ColourScale, ScaleError, ScaleOptions};
pub use heat_map::summary::ValueSummary;
pub use heat_map::{HeatMap, PanelAxis, PanelCells, Shading};
pub use picture::font::missing_glyphs;
pub use picture::palette::{Fill, Rgb};
pub use picture::size::{PictureSize, PrintSize, SizeError};
pub use picture::{EncodeError, Picture, PictureFormat};
