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
        let lead = format!("{} {}", symbol(moment.species[row]), moment.ids[row]);
        moment.write_row(to, row, &lead, " ")?;
    }
    Ok(())
}

/// The chemical elements in the order of their atomic numbers, from 1 on.
const ELEMENTS: &str = "H He Li Be B C N O F Ne Na Mg Al Si P S Cl Ar K Ca Sc Ti V Cr Mn Fe Co Ni Cu Zn Ga Ge As Se Br Kr \
    Rb Sr Y Zr Nb Mo Tc Ru Rh Pd Ag Cd In Sn Sb Te I Xe Cs Ba La Ce Pr Nd Pm Sm Eu Gd Tb Dy Ho Er Tm Yb Lu Hf Ta W Re Os \
    Ir Pt Au Hg Tl Pb Bi Po At Rn Fr Ra Ac Th Pa U Np Pu Am Cm Bk Cf Es Fm Md No Lr Rf Db Sg Bh Hs Mt Ds Rg Cn Nh Fl Mc \
    Lv Ts Og";

/// The word for a species: ASE takes no other words than chemical symbols, so that species n is the element of atomic
/// number n, and `X`, the symbol for none, beyond the last element.
fn symbol(species: u8) -> &'static str {
    ELEMENTS.split_whitespace().nth(species.into()).unwrap_or("X")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn species_are_elements_by_their_numbers() {
        assert_eq!(ELEMENTS.split_whitespace().count(), 118);
        assert_eq!([0, 1, 91, 117, 118, 254].map(symbol), ["H", "He", "U", "Og", "X", "X"]);
    }
}
