//! Images of VTK (`.vti`), which ParaView and VTK read: fields on a grid, a file for every moment.

use std::io::{self, Write};

use super::fields::{FieldGrid, Fields};
use super::vtk;

/// Writes one set of fields as data of cells. A plane is an image without depth at z = 0.
pub(super) fn write(to: &mut dyn Write, fields: &Fields) -> io::Result<()> {
    let FieldGrid { mut origin, spacing, cells, dimension, .. } = fields.grid;
    let mut extent = cells;
    for axis in dimension..3 {
        (origin[axis], extent[axis]) = (0.0, 0);
    }
    let extent = extent.map(|cells| format!("0 {cells}")).join(" ");
    let listed = |numbers: [f64; 3]| numbers.map(|number| format!("{number:?}")).join(" ");
    vtk::begin(to, "ImageData")?;
    if let Some(remark) = &fields.remark {
        vtk::comment(to, remark)?;
    }
    writeln!(
        to,
        "<ImageData WholeExtent=\"{extent}\" Origin=\"{}\" Spacing=\"{}\">\n<Piece Extent=\"{extent}\">\n\
         <CellData Scalars=\"volume_fraction\" Vectors=\"velocity\">",
        listed(origin),
        listed(spacing)
    )?;
    for field in &fields.fields {
        vtk::floats(to, &field.name, field.components, fields.is_single, field.values.iter().copied())?;
    }
    writeln!(to, "</CellData>\n</Piece>\n</ImageData>\n</VTKFile>")
}
