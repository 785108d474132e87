//! Extended XYZ, which OVITO, ASE and VMD read: all moments in one file, each with its box and time.

use std::io::{self, Write};

use super::moment::Moment;
use super::volume::Volume;

/// Writes one moment. A thinned one says so in its comment, under `grains`.
pub(super) fn write(to: &mut dyn Write, moment: &Moment, volume: &Volume) -> io::Result<()> {
    let lattice: Vec<String> = (0..9)
        .map(|k| if k % 4 == 0 { format!("{:?}", volume.length(k / 4)) } else { "0.0".to_owned() })
        .collect();
    let origin = volume.lower.map(|corner| format!("{corner:?}")).join(" ");
    let pbc = volume.periodic.map(|is_periodic| if is_periodic { "T" } else { "F" }).join(" ");
    let turning = if moment.spins.is_some() { ":angular_velocity:R:3" } else { "" };
    writeln!(to, "{}", moment.len())?;
    write!(
        to,
        "Lattice=\"{}\" Origin=\"{origin}\" \
         Properties=species:S:1:id:I:1:pos:R:3:velo:R:3:radius:R:1{turning} Time={:?} pbc=\"{pbc}\"",
        lattice.join(" "),
        moment.time
    )?;
    match moment.remark() {
        Some(remark) => writeln!(to, " grains={} remark=\"{remark}\"", moment.grains)?,
        None => writeln!(to, " grains={}", moment.grains)?,
    }
    for row in 0..moment.len() {
        let lead = format!("{} {}", name(moment.species[row]), moment.ids[row]);
        moment.write_row(to, row, &lead, " ")?;
    }
    Ok(())
}

/// A species as a word: programs take it for a chemical symbol, and none is called so.
fn name(species: u8) -> String {
    format!("G{}", u32::from(species) + 1)
}
