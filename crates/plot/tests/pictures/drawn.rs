//! Small charts, and reading pictures again: pixels of a PNG, polylines and tags of an SVG document.
#![allow(dead_code, reason = "each test program uses its own share")]

use whiskmap_plot::{Chart, Ink, Line, Picture, PictureFormat, Plot, Stroke};

/// A line without a name.
pub fn line(points: &[[f64; 2]], ink: Ink, stroke: Stroke) -> Line {
    Line::new(points.to_vec(), ink, stroke)
}

/// A chart of one plot, without a title.
pub fn single(plot: Plot) -> Chart {
    Chart::single("", plot)
}

/// A decoded PNG.
pub struct Pixels {
    pub width: usize,
    pub height: usize,
    pub pixels: Vec<[u8; 3]>,
}

impl Pixels {
    pub fn of(picture: &Picture) -> Self {
        let pixels = Self::decode(&picture.encode(PictureFormat::Png).unwrap());
        assert_eq!(picture.pixels(), [pixels.width, pixels.height]);
        pixels
    }

    pub fn decode(png: &[u8]) -> Self {
        let mut reader = png::Decoder::new(std::io::Cursor::new(png)).read_info().unwrap();
        let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
        let info = reader.next_frame(&mut bytes).unwrap();
        assert_eq!(info.color_type, png::ColorType::Rgb);
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

/// The SVG document of a picture.
pub fn svg(picture: &Picture) -> String {
    String::from_utf8(picture.encode(PictureFormat::Svg).unwrap()).unwrap()
}

/// The polylines of a document: points, and whether they are dashed.
pub fn polylines(svg: &str) -> Vec<(Vec<[f64; 2]>, bool)> {
    let points = |tag: &str| {
        let list = tag.split('"').nth(1).unwrap();
        let pairs = list.split(' ').map(|pair| pair.split_once(',').unwrap());
        pairs.map(|(x, y)| [x.parse().unwrap(), y.parse().unwrap()]).collect()
    };
    let tags = svg.lines().filter(|line| line.starts_with("<polyline"));
    tags.map(|tag| (points(tag), tag.contains("stroke-dasharray"))).collect()
}

/// The rasters of a document: left, top, width and height, and the pixels.
pub fn rasters(svg: &str) -> Vec<([f64; 4], Pixels)> {
    let tags = svg.lines().filter(|line| line.starts_with("<image"));
    tags.map(|tag| {
        let quoted: Vec<&str> = tag.split('"').collect();
        let place = [1, 3, 5, 7].map(|value| quoted[value].parse().unwrap());
        let (_, data) = tag.split_once("data:image/png;base64,").unwrap();
        let data = data.split('"').next().unwrap();
        (place, Pixels::decode(&from_base64(data)))
    })
    .collect()
}

/// Decodes RFC 4648, not strictly.
fn from_base64(text: &str) -> Vec<u8> {
    let value = |digit: u8| match digit {
        b'A'..=b'Z' => digit - b'A',
        b'a'..=b'z' => digit - b'a' + 26,
        b'0'..=b'9' => digit - b'0' + 52,
        b'+' => 62,
        _ => 63,
    };
    let (mut bytes, mut word, mut bits) = (Vec::new(), 0_u32, 0);
    for digit in text.bytes().filter(|digit| *digit != b'=') {
        word = word << 6 | u32::from(value(digit));
        bits += 6;
        if bits >= 8 {
            bits -= 8;
            bytes.push((word >> bits) as u8);
            word &= (1 << bits) - 1;
        }
    }
    bytes
}

/// Left, top, right and bottom of the first frame.
pub fn frame(svg: &str) -> [f64; 4] {
    let closed = |(points, _): &(Vec<[f64; 2]>, bool)| {
        points.len() == 5 && points[0] == points[4] && points[1][0] - points[0][0] > 100.0
    };
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

/// The pixel at fractions, from the left and from below, of the body of a heat map of one panel in its natural size.
pub fn body(picture: &Pixels, across: f64, up: f64) -> [u8; 3] {
    let y = picture.height as f64 - 112.0 - up * 880.0;
    picture.at([136.0 + across * 1280.0, y])
}
