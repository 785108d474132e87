//! Two perceptually even colour maps that stay readable for the colour-blind.

/// A colour map from 0 … 1 to sRGB.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ColourMap {
    /// Deep blue over magenta to amber: speeds of grains on light paper, so its light end is left out.
    Speed,
    /// Violet over green to yellow: fields that fill an area.
    Field,
}

/// After `plasma` of Smith and van der Walt (2015), its first 84 %.
const SPEED: [[u8; 3]; 8] = [
    [0x1b, 0x0a, 0x8c],
    [0x4b, 0x03, 0xa1],
    [0x7d, 0x03, 0xa8],
    [0xa8, 0x22, 0x96],
    [0xcb, 0x46, 0x79],
    [0xe5, 0x6b, 0x5d],
    [0xf8, 0x94, 0x41],
    [0xfd, 0xb4, 0x2f],
];

/// After `viridis` of the same authors.
const FIELD: [[u8; 3]; 9] = [
    [0x44, 0x01, 0x54],
    [0x47, 0x2d, 0x7b],
    [0x3b, 0x52, 0x8b],
    [0x2c, 0x72, 0x8e],
    [0x21, 0x91, 0x8c],
    [0x28, 0xae, 0x80],
    [0x5e, 0xc9, 0x62],
    [0xad, 0xdc, 0x30],
    [0xfd, 0xe7, 0x25],
];

/// The colour of a field at `share` of its range, held to 0 … 1, in sRGB.
pub fn field_colour(share: f64) -> [u8; 3] {
    ColourMap::Field.at(share)
}

impl ColourMap {
    /// The colours between which the map is a straight line.
    pub(crate) fn anchors(self) -> &'static [[u8; 3]] {
        match self {
            Self::Speed => &SPEED,
            Self::Field => &FIELD,
        }
    }

    /// The colour at `share`, held to 0 … 1; what is not a number counts as 0.
    pub(crate) fn at(self, share: f64) -> [u8; 3] {
        let anchors = self.anchors();
        let share = if share.is_nan() { 0.0 } else { share.clamp(0.0, 1.0) };
        let place = share * (anchors.len() - 1) as f64;
        let below = (place.floor() as usize).min(anchors.len() - 2);
        let between = place - below as f64;
        let (first, second) = (anchors[below], anchors[below + 1]);
        std::array::from_fn(|c| {
            let (first, second) = (f64::from(first[c]), f64::from(second[c]));
            (first + between * (second - first)).round() as u8
        })
    }

    /// The colour at `share` as `#rrggbb`.
    pub(crate) fn hexadecimal(self, share: f64) -> String {
        let [red, green, blue] = self.at(share);
        format!("#{red:02x}{green:02x}{blue:02x}")
    }

    /// The map as a CSS gradient from left to right.
    pub(crate) fn gradient(self) -> String {
        let anchors = self.anchors();
        let stops: Vec<String> =
            (0..anchors.len()).map(|k| self.hexadecimal(k as f64 / (anchors.len() - 1) as f64)).collect();
        format!("linear-gradient(to right, {})", stops.join(", "))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Relative luminance with linearised sRGB.
    fn luminance(colour: [u8; 3]) -> f64 {
        let linear = |c: u8| (f64::from(c) / 255.0).powf(2.2);
        0.2126 * linear(colour[0]) + 0.7152 * linear(colour[1]) + 0.0722 * linear(colour[2])
    }

    #[test]
    fn brightness_rises_all_the_way() {
        for map in [ColourMap::Speed, ColourMap::Field] {
            let steps: Vec<f64> = (0..=40).map(|k| luminance(map.at(f64::from(k) / 40.0))).collect();
            assert!(steps.windows(2).all(|pair| pair[1] > pair[0]), "{map:?}: {steps:?}");
        }
    }

    #[test]
    fn ends_are_held() {
        assert_eq!(ColourMap::Speed.at(-1.0), SPEED[0]);
        assert_eq!(ColourMap::Field.at(9.0), FIELD[8]);
        assert_eq!(ColourMap::Field.at(f64::NAN), FIELD[0]);
    }
}
