//! Points of VTK (`.vtp`), which ParaView, VTK and OVITO read: a file for every moment.

use std::io::{self, Write};

use super::moment::Moment;
use super::vtk;

/// Writes one moment: points with `velocity`, `radius`, `id` and `species`.
pub(super) fn write(to: &mut dyn Write, moment: &Moment) -> io::Result<()> {
    let single = moment.is_single;
    let vectors = |of: &[[f64; 3]]| of.as_flattened().to_vec().into_iter();
    let points = moment.len();
    vtk::begin(to, "PolyData")?;
    if let Some(remark) = moment.remark() {
        vtk::comment(to, &remark)?;
    }
    writeln!(
        to,
        "<PolyData>\n<Piece NumberOfPoints=\"{points}\" NumberOfVerts=\"{points}\" NumberOfLines=\"0\" \
         NumberOfStrips=\"0\" NumberOfPolys=\"0\">\n<PointData Scalars=\"radius\" Vectors=\"velocity\">"
    )?;
    vtk::floats(to, "velocity", 3, single, vectors(&moment.velocities))?;
    vtk::floats(to, "radius", 1, false, moment.radii.iter().copied())?;
    vtk::integers(to, "id", moment.ids.iter().map(|&id| i64::from(id)))?;
    vtk::integers(to, "species", moment.species.iter().map(|&kind| i64::from(kind) + 1))?;
    if let Some(spins) = &moment.spins {
        vtk::floats(to, "angular_velocity", 3, single, vectors(spins))?;
    }
    writeln!(to, "</PointData>\n<Points>")?;
    vtk::floats(to, "Points", 3, single, vectors(&moment.positions))?;
    writeln!(to, "</Points>\n<Verts>")?;
    vtk::integers(to, "connectivity", 0..points as i64)?;
    vtk::integers(to, "offsets", 1..=points as i64)?;
    writeln!(to, "</Verts>\n</Piece>\n</PolyData>\n</VTKFile>")
}
