//! Text dumps of LAMMPS (`dump custom`), which OVITO, VMD and many scripts read: all moments in one file.

use std::io::{self, Write};

use super::moment::Moment;
use super::volume::Volume;

/// Writes one moment. The time step is the number of the recording; the time stands beside it. `with_units` puts the
/// line on top that belongs to the first moment.
///
/// Axes that are not periodic are `ff`: what lies outside of the box stays where it is.
pub(super) fn write(
    to: &mut dyn Write,
    moment: &Moment,
    volume: &Volume,
    with_units: bool,
) -> io::Result<()> {
    if with_units {
        writeln!(to, "ITEM: UNITS\nlj")?;
    }
    writeln!(to, "ITEM: TIME\n{:?}", moment.time)?;
    writeln!(to, "ITEM: TIMESTEP\n{}", moment.number)?;
    writeln!(to, "ITEM: NUMBER OF ATOMS\n{}", moment.len())?;
    let flags = volume.periodic.map(|is_periodic| if is_periodic { "pp" } else { "ff" });
    writeln!(to, "ITEM: BOX BOUNDS {}", flags.join(" "))?;
    for axis in 0..3 {
        writeln!(to, "{:?} {:?}", volume.lower[axis], volume.upper[axis])?;
    }
    let turning = if moment.spins.is_some() { " omegax omegay omegaz" } else { "" };
    writeln!(to, "ITEM: ATOMS id type x y z vx vy vz radius{turning}")?;
    for row in 0..moment.len() {
        let lead = format!("{} {}", moment.ids[row], u32::from(moment.species[row]) + 1);
        moment.write_row(to, row, &lead, " ")?;
    }
    Ok(())
}
