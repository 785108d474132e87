//! A function that is known at some places and straight between them: what calibrations leave.

/// Straight between its places, constant before the first and behind the last.
#[derive(Clone, Debug, PartialEq)]
pub struct PiecewiseLinear {
    /// Rising, at least one.
    places: Vec<f64>,
    /// `[place]`.
    values: Vec<f64>,
}

impl PiecewiseLinear {
    /// The same everywhere.
    pub fn constant(value: f64) -> Self {
        PiecewiseLinear { places: vec![0.0], values: vec![value] }
    }

    /// Through these points. Panics unless there is a value for every place and places rise.
    pub fn through(places: Vec<f64>, values: Vec<f64>) -> Self {
        assert!(!places.is_empty() && places.len() == values.len(), "a value for every place");
        assert!(places.windows(2).all(|pair| pair[0] < pair[1]), "places rise");
        PiecewiseLinear { places, values }
    }

    /// The value at `place`.
    pub fn at(&self, place: f64) -> f64 {
        let next = self.places.partition_point(|&known| known <= place);
        if next == 0 {
            return self.values[0];
        }
        if next == self.places.len() {
            return self.values[next - 1];
        }
        let (left, right) = (self.places[next - 1], self.places[next]);
        let share = (place - left) / (right - left);
        self.values[next - 1] + share * (self.values[next] - self.values[next - 1])
    }

    /// Where it is known, and what it is there.
    pub fn points(&self) -> impl Iterator<Item = [f64; 2]> + '_ {
        self.places.iter().zip(&self.values).map(|(&place, &value)| [place, value])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_meets_its_points_and_is_straight_between_them() {
        let curve = PiecewiseLinear::through(vec![1.0, 3.0, 4.0], vec![0.5, -0.5, 2.0]);
        let values = [0.0, 1.0, 1.5, 3.0, 3.5, 4.0, 9.0].map(|place| curve.at(place));
        assert_eq!(values, [0.5, 0.5, 0.25, -0.5, 0.75, 2.0, 2.0]);
        assert_eq!(PiecewiseLinear::constant(0.7).at(-3.0), 0.7);
    }
}
