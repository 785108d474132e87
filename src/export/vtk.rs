//! The parts that files of VTK's XML kind share: arrays of numbers, and collections with times.
//!
//! Arrays stand inline in base64, which every reader takes; OVITO refuses appended arrays and field data.

use std::io::{self, Write};

use base64::Engine;
use base64::engine::general_purpose::STANDARD;

/// Opens a file that holds a `kind` of data set.
pub(super) fn begin(to: &mut dyn Write, kind: &str) -> io::Result<()> {
    writeln!(
        to,
        "<?xml version=\"1.0\"?>\n\
         <VTKFile type=\"{kind}\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">"
    )
}

/// A comment, for those who open the file with an editor.
pub(super) fn comment(to: &mut dyn Write, text: &str) -> io::Result<()> {
    writeln!(to, "  <!-- {} -->", text.replace("--", "- -"))
}

/// Writes an array of floats with `components` each, in single precision where that is all there is.
pub(super) fn floats(
    to: &mut dyn Write,
    name: &str,
    components: usize,
    is_single: bool,
    values: impl Iterator<Item = f64>,
) -> io::Result<()> {
    let bytes: Vec<u8> = match is_single {
        true => values.flat_map(|value| (value as f32).to_le_bytes()).collect(),
        false => values.flat_map(f64::to_le_bytes).collect(),
    };
    array(to, if is_single { "Float32" } else { "Float64" }, name, components, &bytes)
}

/// Writes an array of whole numbers.
pub(super) fn integers(to: &mut dyn Write, name: &str, values: impl Iterator<Item = i64>) -> io::Result<()> {
    let bytes: Vec<u8> = values.flat_map(i64::to_le_bytes).collect();
    array(to, "Int64", name, 1, &bytes)
}

fn array(to: &mut dyn Write, kind: &str, name: &str, components: usize, bytes: &[u8]) -> io::Result<()> {
    // The length stands in front, in the same run of base64.
    let mut block = Vec::with_capacity(8 + bytes.len());
    block.extend_from_slice(&(bytes.len() as u64).to_le_bytes());
    block.extend_from_slice(bytes);
    writeln!(
        to,
        "<DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{components}\" format=\"binary\">\n\
         {}\n</DataArray>",
        STANDARD.encode(&block)
    )
}

/// Writes the collection of `files` with their times [time], which ParaView opens as one animation.
pub(super) fn collection(to: &mut dyn Write, files: &[(f64, String)]) -> io::Result<()> {
    begin(to, "Collection")?;
    writeln!(to, "  <Collection>")?;
    for (time, file) in files {
        writeln!(to, "    <DataSet timestep=\"{time:?}\" group=\"\" part=\"0\" file=\"{file}\"/>")?;
    }
    writeln!(to, "  </Collection>\n</VTKFile>")
}
