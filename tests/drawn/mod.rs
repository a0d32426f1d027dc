//! Small charts, and reading them again: pixels of a PNG, polylines and tags of an SVG document.

use std::fs::{self, File};
use whiskmap::render::{Chart, ChartFormat, Ink, Line, Plot, Stroke};

/// A line without a name.
pub fn line(points: &[[f64; 2]], ink: Ink, stroke: Stroke) -> Line {
    Line {
        points: points.to_vec(),
        ink,
        stroke,
        name: None,
    }
}

/// A chart of one plot, without a title.
pub fn single(plot: Plot) -> Chart {
    Chart {
        title: String::new(),
        plots: vec![plot],
        columns: 1,
    }
}

/// A decoded PNG.
pub struct Picture {
    pub width: usize,
    pub height: usize,
    pixels: Vec<[u8; 3]>,
}

impl Picture {
    pub fn of(chart: &Chart) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("chart.png");
        chart.save(&path, ChartFormat::Png).unwrap();
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
        let mut reader = png::Decoder::new(File::open(path).unwrap())
            .read_info()
            .unwrap();
        let mut bytes = vec![0; reader.output_buffer_size()];
        let info = reader.next_frame(&mut bytes).unwrap();
        Self {
            width: info.width as usize,
            height: info.height as usize,
            pixels: bytes.as_chunks().0.to_vec(),
        }
    }

    pub fn at(&self, [x, y]: [f64; 2]) -> [u8; 3] {
        self.pixels[y as usize * self.width + x as usize]
    }
}

/// The polylines of a document: points, and whether they are dashed.
pub fn polylines(svg: &str) -> Vec<(Vec<[f64; 2]>, bool)> {
    let points = |tag: &str| {
        let list = tag.split('"').nth(1).unwrap();
        let pairs = list.split(' ').map(|pair| pair.split_once(',').unwrap());
        pairs
            .map(|(x, y)| [x.parse().unwrap(), y.parse().unwrap()])
            .collect()
    };
    let tags = svg.lines().filter(|line| line.starts_with("<polyline"));
    tags.map(|tag| (points(tag), tag.contains("stroke-dasharray")))
        .collect()
}

/// Left, top, right and bottom of the first frame.
pub fn frame(svg: &str) -> [f64; 4] {
    let closed = |(points, _): &(Vec<[f64; 2]>, bool)| points.len() == 5 && points[0] == points[4];
    let (corners, _) = polylines(svg).into_iter().find(closed).unwrap();
    [corners[0][0], corners[2][1], corners[2][0], corners[0][1]]
}

/// Whether every tag is closed in its order and no bare `&` is left.
pub fn well_formed(document: &str) -> bool {
    let mut open = Vec::new();
    let body = document.strip_prefix("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n");
    let mut rest = body.unwrap_or("<").trim_end();
    while let Some((text, after)) = rest.split_once('<') {
        let Some((tag, next)) = after.split_once('>') else {
            return false;
        };
        let entities = ["amp;", "lt;", "gt;", "quot;"];
        let escaped = |part: &str| entities.iter().any(|entity| part.starts_with(entity));
        let outside = open.is_empty() && !text.is_empty();
        if outside || text.contains('>') || !text.split('&').skip(1).all(escaped) {
            return false;
        }
        match (tag.strip_prefix('/'), tag.ends_with('/')) {
            (Some(name), _) => {
                if open.pop() != Some(name) {
                    return false;
                }
            }
            (None, true) => {}
            (None, false) => open.push(tag.split(' ').next().unwrap_or_default()),
        }
        if tag.matches('"').count() % 2 != 0 {
            return false;
        }
        rest = next;
    }
    rest.is_empty() && open.is_empty()
}
