//! Pictures made of pixels: painted with antialiased discs, or coloured from a table, and packed as PNG.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;

use super::colour::ColourMap;

/// A picture in sRGB, rows from the top.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Raster {
    width: usize,
    height: usize,
    pixels: Vec<[u8; 3]>,
}

impl Raster {
    /// A picture of one colour.
    pub(super) fn new(width: usize, height: usize, colour: [u8; 3]) -> Self {
        let (width, height) = (width.max(1), height.max(1));
        Self { width, height, pixels: vec![colour; width * height] }
    }

    /// A table coloured by `map` from `range[0]` to `range[1]`; `[column][row]`, row 0 at the bottom.
    pub(super) fn from_table(table: &[Vec<f64>], map: ColourMap, range: [f64; 2]) -> Self {
        let height = table.iter().map(Vec::len).max().unwrap_or(0);
        let mut raster = Self::new(table.len(), height, [0x80; 3]);
        for (x, column) in table.iter().enumerate() {
            for (row, value) in column.iter().enumerate().filter(|(_, v)| v.is_finite()) {
                let share = (value - range[0]) / (range[1] - range[0]);
                let place = (height - 1 - row) * raster.width + x;
                raster.pixels[place] = map.at(share);
            }
        }
        raster
    }

    /// Paints a disc; its edge covers pixels in part. Coordinates in pixels from the upper left corner.
    pub(super) fn disc(&mut self, centre: [f64; 2], radius: f64, colour: [u8; 3]) {
        // A disc below half a pixel keeps its area by growing pale.
        let (radius, strength) = if radius < 0.5 { (0.5, (radius / 0.5).powi(2)) } else { (radius, 1.0) };
        let [x, y] = centre;
        let reach = radius + 0.5;
        if !(x + reach > 0.0 && y + reach > 0.0) {
            return;
        }
        let rows = ((y - reach).max(0.0) as usize)..((y + reach).ceil().max(0.0) as usize).min(self.height);
        for row in rows {
            let first = (x - reach).max(0.0) as usize;
            let last = ((x + reach).ceil().max(0.0) as usize).min(self.width);
            for column in first..last {
                let (dx, dy) = (column as f64 + 0.5 - x, row as f64 + 0.5 - y);
                let cover = (reach - (dx * dx + dy * dy).sqrt()).clamp(0.0, 1.0) * strength;
                self.blend(row * self.width + column, colour, cover);
            }
        }
    }

    /// Paints a rectangle given by two corners.
    pub(super) fn rectangle(&mut self, from: [f64; 2], to: [f64; 2], colour: [u8; 3]) {
        let within = |v: f64, most: usize| (v.round().max(0.0) as usize).min(most);
        for row in within(from[1], self.height)..within(to[1], self.height) {
            for column in within(from[0], self.width)..within(to[0], self.width) {
                self.pixels[row * self.width + column] = colour;
            }
        }
    }

    fn blend(&mut self, place: usize, colour: [u8; 3], cover: f64) {
        for (old, new) in self.pixels[place].iter_mut().zip(colour) {
            *old = (f64::from(*old) + cover * (f64::from(new) - f64::from(*old))).round() as u8;
        }
    }

    /// The picture as a PNG file.
    pub(super) fn png(&self) -> Vec<u8> {
        let mut file = Vec::new();
        let mut encoder = png::Encoder::new(&mut file, self.width as u32, self.height as u32);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
        let mut writer = encoder.write_header().expect("memory takes every header of a picture with pixels");
        writer
            .write_image_data(self.pixels.as_flattened())
            .expect("as many bytes as the header promised go to memory");
        writer.finish().expect("memory takes the end of a picture");
        file
    }

    /// The picture as a `data:` address.
    pub(super) fn address(&self) -> String {
        format!("data:image/png;base64,{}", STANDARD.encode(self.png()))
    }
}

#[cfg(test)]
impl Raster {
    /// How many pixels have exactly this colour.
    pub(super) fn pixels_of(&self, colour: [u8; 3]) -> usize {
        self.pixels.iter().filter(|pixel| **pixel == colour).count()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const WHITE: [u8; 3] = [255; 3];
    const BLACK: [u8; 3] = [0; 3];

    #[test]
    fn discs_cover_their_area() {
        for radius in [0.2, 0.5, 1.3, 6.0] {
            let mut raster = Raster::new(32, 24, WHITE);
            raster.disc([15.3, 11.8], radius, BLACK);
            let covered: f64 = raster.pixels.iter().map(|p| 1.0 - f64::from(p[0]) / 255.0).sum();
            let area = std::f64::consts::PI * radius * radius;
            // A linear edge of one pixel overstates the area by up to π/12 of a pixel, and small discs by more.
            assert!((covered - area).abs() < 0.35, "{radius}: {covered} for {area}");
        }
    }

    #[test]
    fn what_lies_outside_is_left_out() {
        let mut raster = Raster::new(8, 8, WHITE);
        for centre in [[-20.0, 4.0], [4.0, 900.0], [f64::NAN, 2.0], [1e300, -1e300]] {
            raster.disc(centre, 2.0, BLACK);
        }
        assert_eq!(raster, Raster::new(8, 8, WHITE));
    }

    #[test]
    fn tables_stand_upright() {
        let raster = Raster::from_table(&[vec![0.0, 1.0], vec![1.0, f64::NAN]], ColourMap::Field, [0.0, 1.0]);
        assert_eq!((raster.width, raster.height), (2, 2));
        assert_eq!(raster.pixels[2], ColourMap::Field.at(0.0));
        assert_eq!(raster.pixels[0], ColourMap::Field.at(1.0));
        assert_eq!(raster.pixels[1], [0x80; 3]);
    }

    #[test]
    fn a_png_has_the_size_of_its_raster() {
        let file = Raster::new(31, 7, WHITE).png();
        let mut reader = png::Decoder::new(std::io::Cursor::new(file)).read_info().unwrap();
        assert_eq!((reader.info().width, reader.info().height), (31, 7));
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut pixels).unwrap();
        assert!(pixels.iter().all(|&value| value == 255));
    }
}
