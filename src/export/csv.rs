//! One long table of all moments: pandas reads it as it is, ParaView by its filter Table To Points.

use std::io::{self, Write};

use super::moment::Moment;

/// Writes the lines of one moment, with the header above the first.
pub(super) fn write(to: &mut dyn Write, moment: &Moment, with_header: bool) -> io::Result<()> {
    if with_header {
        let turning = if moment.spins.is_some() { ",wx,wy,wz" } else { "" };
        writeln!(to, "frame,time,id,species,x,y,z,vx,vy,vz,radius{turning}")?;
    }
    for row in 0..moment.len() {
        let species = u32::from(moment.species[row]) + 1;
        let lead = format!("{},{:?},{},{species}", moment.number, moment.time, moment.ids[row]);
        moment.write_row(to, row, &lead, ",")?;
    }
    Ok(())
}
