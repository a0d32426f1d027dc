//! Colours of charts and heat maps that people with any colour vision can tell apart.

/// Red, green and blue of an sRGB colour, each from 0 to 255.
pub type Rgb = [u8; 3];

/// The colour of a number of six hexadecimal digits.
const fn rgb(number: u32) -> Rgb {
    let [_, red, green, blue] = number.to_be_bytes();
    [red, green, blue]
}

pub const WHITE: Rgb = rgb(0xffffff);
/// Colour of text, frames, and black lines of charts.
pub const INK: Rgb = rgb(0x222b33);
pub const BLUE: Rgb = rgb(0x1c6cc4);
/// Colours of the lines of a chart. They differ on white for readers with any colour vision (Okabe and Ito 2008, with indigo for yellow).
pub const SERIES: [Rgb; 7] = [
    rgb(0x0072b2),
    rgb(0xd55e00),
    rgb(0x009e73),
    rgb(0xcc79a7),
    rgb(0x332288),
    rgb(0xe69f00),
    rgb(0x56b4e9),
];
/// Colour of grey lines of charts, of squares that an inset enlarges, and of dark discs.
pub const GREY: Rgb = rgb(0x9aa1a8);
pub const SHADE_LIGHT: Rgb = rgb(0xdbe4ee);
pub const SHADE_DARK: Rgb = rgb(0xa9bdd2);
/// Colour of cells without a value, and of light discs of charts.
pub const BLANK: Rgb = rgb(0xdcddde);

/// The fill of a cell or a legend's swatch: one colour, or stripes of two.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Fill {
    ground: Rgb,
    stripes: Rgb,
}

impl Fill {
    /// The grey fill of cells without a value.
    pub const BLANK: Self = Self::plain(BLANK);

    /// Creates a fill of one colour.
    #[must_use]
    pub const fn plain(colour: Rgb) -> Self {
        Self::striped(colour, colour)
    }

    /// Creates a fill of the colour `ground` with stripes of another colour.
    #[must_use]
    pub const fn striped(ground: Rgb, stripes: Rgb) -> Self {
        Self { ground, stripes }
    }

    /// Returns the colours of the fill: ground and stripes, which are equal in a fill of one colour.
    #[must_use]
    pub const fn colours(self) -> [Rgb; 2] {
        [self.ground, self.stripes]
    }

    /// Returns the fill's ground colour with black or white stripes, whichever contrast more.
    #[must_use]
    pub fn hatched(self) -> Self {
        let [red, green, blue] = self.ground.map(f64::from);
        // Luma by ITU-R BT.601.
        let is_light = 0.299 * red + 0.587 * green + 0.114 * blue > 127.5;
        Self::striped(self.ground, if is_light { INK } else { WHITE })
    }

    /// Returns the fill of category `index`; after nine colours they repeat (Okabe and Ito 2008, Color Universal Design).
    #[must_use]
    pub fn qualitative(index: usize) -> Self {
        const COLOURS: [u32; 9] = [
            0x56b4e9, 0xe69f00, 0x009e73, 0xcc79a7, 0x0072b2, 0xd55e00, 0xf0e442, 0x999999,
            0x332288,
        ];
        Self::plain(rgb(COLOURS[index % COLOURS.len()]))
    }

    /// Returns the colour of the fill at pixels where `x + y` is `sum`: stripes run from the lower left to the upper right.
    pub(crate) fn at(self, sum: f64) -> Rgb {
        if sum % 10.0 < 3.0 { self.stripes } else { self.ground }
    }
}

/// Returns the colour at a fraction of a sequential scale: dark blue at 0, green, yellow at 1 (viridis by S. van der Walt and N. Smith,
/// at each ninth).
pub fn sequential(at: f64) -> Rgb {
    const STOPS: [u32; 10] = [
        0x440154, 0x482878, 0x3e4989, 0x31688e, 0x26828e, 0x1f9e89, 0x35b779, 0x6ece58, 0xb5de2b,
        0xfde725,
    ];
    between(&STOPS, at)
}

/// Returns the colour at a fraction of a diverging scale: blue at 0, white, red at 1 (ColorBrewer, RdBu).
pub fn diverging(at: f64) -> Rgb {
    const STOPS: [u32; 7] = [0x2166ac, 0x67a9cf, 0xd1e5f0, 0xf7f7f7, 0xfddbc7, 0xef8a62, 0xb2182b];
    between(&STOPS, at)
}

/// Interpolates equidistant colours at a fraction of their range.
fn between(stops: &[u32], at: f64) -> Rgb {
    let place = at.clamp(0.0, 1.0) * (stops.len() - 1) as f64;
    let stop = (place as usize).min(stops.len() - 2);
    let [from, to] = [stop, stop + 1].map(|stop| rgb(stops[stop]).map(f64::from));
    std::array::from_fn(|i| (from[i] + (place - stop as f64) * (to[i] - from[i])).round() as u8)
}
