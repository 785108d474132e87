"""Exports a grainflow log into every format and checks what OVITO, ASE, VTK and pandas read.

    python check_exports.py GRAINFLOW LOG [--thinned]

GRAINFLOW is the program. What the log itself holds is read with the MCAP project's own packages. Prints
`N passed, M failed`; the exit code is 1 where something failed.
"""

import subprocess
import sys
import tempfile
from pathlib import Path
from xml.etree import ElementTree

import ase.io
import numpy as np
import pandas
from mcap.reader import make_reader
from mcap_protobuf.decoder import DecoderFactory
from ovito.io import import_file
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLImageDataReader, vtkXMLPolyDataReader

from read_log import Checks, points


class Log:
    """What a log holds: frames, states, box."""

    def __init__(self, path):
        with open(path, "rb") as file:
            reader = make_reader(file, validate_crcs=True, decoder_factories=[DecoderFactory()])
            self.metadata = next(one.metadata for one in reader.iter_metadata() if one.name == "grainflow")
            messages = {topic: [] for topic in ("/measures", "/particles", "/state", "/walls")}
            for _, channel, raw, message in reader.iter_decoded_messages(topics=list(messages)):
                messages[channel.topic].append((raw.sequence, message))
        # A frame belongs to the recording with its number; not every recording has one.
        recordings = dict(messages["/measures"])
        self.numbers = [number for number, _ in messages["/particles"]]
        self.times = [recordings[number].time for number in self.numbers]
        self.grains = [recordings[number].grains_in_gas for number in self.numbers]
        self.frames = [points(cloud) for _, cloud in messages["/particles"]]
        self.states = [one for _, one in messages["/state"] if one.first_row == 0]
        box = {pair.key: pair.value for pair in messages["/walls"][0][1].entities[0].metadata}
        self.lower = np.array([float(word) for word in box["lower"].split()])
        self.upper = np.array([float(word) for word in box["upper"].split()])
        self.periodic = [box[f"{axis}.lower"] == "periodic" for axis in "xyz"]
        sides = [[box[f"{axis}.{side}"] for side in ("lower", "upper")] for axis in "xyz"]
        self.is_open = np.array(["open" in pair for pair in sides])
        self.dimension = int(self.metadata["dimension"])

    def position(self, frame):
        return np.column_stack([self.frames[frame][name] for name in ("x", "y", "z")])

    def velocity(self, frame):
        return np.column_stack([self.frames[frame][name] for name in ("vx", "vy", "vz")])

    def radii(self, frame):
        """Radii by the species that the last state tells, from the sizes that the scenario gives."""
        return self.radius_of[self.frames[frame]["id"]]

    def set_radii(self, scenario_radii):
        last = self.states[-1]
        ids = np.frombuffer(last.ids, "<u4")
        species = np.frombuffer(last.species, "u1") if last.species else np.zeros(len(ids), "u1")
        self.species_of = np.zeros(int(ids.max()) + 1, int)
        self.species_of[ids] = species
        self.radius_of = np.array(scenario_radii)[self.species_of]

    def inside(self, frame):
        """Which grains are in the box: all but those that have left it through an open side. Rounding to single precision
        keeps order, so that no grain of the box is beyond the rounded ends."""
        axes = slice(self.dimension)
        ends = [end[axes].astype(np.float32) for end in (self.lower, self.upper)]
        position = self.position(frame)[:, axes]
        within = (position >= ends[0]) & (position <= ends[1])
        return within.all(axis=1), within[:, ~self.is_open[axes]].all()


def scenario_radii(path):
    """Radii of the species, as the scenario in the log has them."""
    import tomllib

    with open(path, "rb") as file:
        text = next(one.data for one in make_reader(file).iter_attachments() if one.name == "scenario.toml")
    particles = tomllib.loads(text.decode("utf-8"))["particles"]
    return [0.5 * one.get("diameter", 1.0) for one in particles.get("species", [particles])]


class Exporter:
    """Runs `grainflow export` in a folder of its own."""

    def __init__(self, program, log, folder):
        self.program, self.log, self.folder = program, log, Path(folder)

    def __call__(self, kind, *more):
        out = self.folder / f"{kind}{len(list(self.folder.iterdir()))}"
        command = [self.program, "export", self.log, "--format", kind, "--out", out, *more]
        run = subprocess.run(command, capture_output=True, text=True)
        if run.returncode != 0:
            sys.exit(f"{command}: {run.stderr}")
        self.said = run.stderr
        return out


def picked(log):
    """Some frames to be looked at in full."""
    return sorted({0, len(log.frames) // 2, len(log.frames) - 1})


def check_ovito(path, log, checks, name):
    """A file of all frames, or a pattern of files, as OVITO reads it."""
    pipeline = import_file(str(path))
    checks.that(pipeline.num_frames == len(log.frames), f"{name}: {pipeline.num_frames} frames of {len(log.frames)}")
    for frame in picked(log):
        data = pipeline.compute(frame)
        checks.that(data.particles.count == len(log.frames[frame]), f"{name}: points of frame {frame}")
        if data.particles.count == 0:
            continue
        particles = data.particles
        order = np.argsort(particles["Particle Identifier"])
        checks.that(np.array_equal(particles["Particle Identifier"][order], log.frames[frame]["id"]), f"{name}: ids")
        close = np.allclose(particles["Position"][order], log.position(frame), rtol=2e-7, atol=1e-7)
        checks.that(close, f"{name}: positions of frame {frame}")
        checks.that(np.allclose(particles["Radius"][order], log.radii(frame)), f"{name}: radii")
        if name == "vtp":
            continue
        checks.that(np.allclose(particles["Velocity"][order], log.velocity(frame), rtol=2e-7), f"{name}: velocities")
        cell = data.cell
        sizes = np.diag(cell[:, :3])[: log.dimension]
        checks.that(np.allclose(sizes, (log.upper - log.lower)[: log.dimension]), f"{name}: box {sizes}")
        corner = cell[: log.dimension, 3]
        checks.that(np.allclose(corner, log.lower[: log.dimension]), f"{name}: corner of the box {corner}")
        checks.that(list(cell.pbc) == log.periodic, f"{name}: periodic axes {cell.pbc}")
        time = data.attributes.get("Time")
        checks.that(time is not None and np.isclose(time, log.times[frame], rtol=1e-12), f"{name}: time {time}")


def check_ase(path, log, checks, name):
    """All frames of an extended XYZ file as ASE reads it, told by nothing but its name and by the name of its format."""
    for more in ({}, {"format": "extxyz"}):
        frames = ase.io.read(path, index=":", **more)
        checks.that(len(frames) == len(log.frames), f"{name}: {len(frames)} frames of {len(log.frames)}")
        for frame in picked(log):
            atoms, ids = frames[frame], log.frames[frame]["id"]
            checks.that(len(atoms) == len(ids), f"{name}: {len(atoms)} grains of {len(ids)} in frame {frame}")
            if len(ids) == 0:
                continue
            checks.that(np.array_equal(atoms.arrays["id"], ids), f"{name}: ids of frame {frame}")
            checks.that(np.array_equal(atoms.numbers, log.species_of[ids] + 1), f"{name}: species of frame {frame}")
            checks.that(np.allclose(atoms.arrays["radius"], log.radii(frame)), f"{name}: radii of frame {frame}")
            close = np.allclose(atoms.positions, log.position(frame), rtol=2e-7, atol=1e-7)
            checks.that(close, f"{name}: positions of frame {frame}")
            checks.that(np.allclose(atoms.arrays["velo"], log.velocity(frame), rtol=2e-7), f"{name}: velocities")
            checks.that(list(atoms.pbc) == log.periodic, f"{name}: periodic axes {atoms.pbc}")
            checks.that(np.isclose(atoms.info["Time"], log.times[frame], rtol=1e-12), f"{name}: time of frame {frame}")


def check_ase_states(path, log, checks):
    """The last state, with its spins where grains have them."""
    atoms, last = ase.io.read(path, index=-1, format="extxyz"), log.states[-1]
    order = np.argsort(np.frombuffer(last.ids, "<u4"))
    position = np.frombuffer(last.positions, "<f8").reshape(-1, last.dimension)[order]
    checks.that(np.array_equal(atoms.positions[:, : last.dimension], position), "ase: positions of the last state")
    spins = np.frombuffer(last.spins, "<f8").reshape(len(order), -1)[order] if last.spins else None
    found = atoms.arrays.get("angular_velocity")
    checks.that((found is None) == (spins is None), "ase: spins where grains have them")
    if spins is not None:
        checks.that(np.array_equal(found[:, 3 - spins.shape[1] :], spins), "ase: spins of the last state")


def collection(folder, stem):
    """Times and files of a .pvd."""
    found = ElementTree.parse(folder / f"{stem}.pvd").findall("./Collection/DataSet")
    return [float(one.get("timestep")) for one in found], [folder / one.get("file") for one in found]


def read_vtk(reader, path):
    reader.SetFileName(str(path))
    reader.Update()
    return reader.GetOutput()


def check_vtp(folder, log, checks):
    times, files = collection(folder, "particles")
    checks.that(times == log.times, "vtp: times of the collection")
    for frame in picked(log):
        data = read_vtk(vtkXMLPolyDataReader(), files[frame])
        checks.that(data.GetNumberOfPoints() == len(log.frames[frame]), f"vtp: points of frame {frame}")
        checks.that(data.GetNumberOfVerts() == len(log.frames[frame]), "vtp: every point is drawn")
        if data.GetNumberOfPoints() == 0:
            continue
        column = lambda name: vtk_to_numpy(data.GetPointData().GetArray(name))
        checks.that(np.array_equal(vtk_to_numpy(data.GetPoints().GetData()), log.position(frame)), "vtp: positions")
        checks.that(np.array_equal(column("velocity"), log.velocity(frame)), "vtp: velocities")
        checks.that(np.array_equal(column("id"), log.frames[frame]["id"]), "vtp: ids")
        checks.that(np.allclose(column("radius"), log.radii(frame), rtol=0, atol=0), "vtp: radii")
    check_ovito(folder / "particles-*.vtp", log, checks, "vtp")


def check_vti(folder, log, checks):
    times, files = collection(folder, "fields")
    checks.that(times == log.times, "vti: times of the collection")
    for frame in picked(log):
        image = read_vtk(vtkXMLImageDataReader(), files[frame])
        cells = [max(one, 1) for one in np.array(image.GetDimensions()) - 1]
        checks.that(image.GetNumberOfCells() == np.prod(cells), "vti: cells")
        spans = (np.array(image.GetSpacing()) * cells)[: log.dimension]
        checks.that(np.allclose(spans, (log.upper - log.lower)[: log.dimension]), f"vti: box {spans}")
        column = lambda name: vtk_to_numpy(image.GetCellData().GetArray(name)).astype(float)
        volume = np.prod(np.array(image.GetSpacing())[: log.dimension])
        # Grains that have left the box through an open side count nowhere.
        inside, are_held = log.inside(frame)
        checks.that(are_held, f"vti: walls and periodic axes hold the grains of frame {frame}")
        stands_for = log.grains[frame] / max(len(inside), 1)
        total = column("number_density").sum() * volume
        checks.that(np.isclose(total, inside.sum() * stands_for, rtol=1e-4), f"vti: {total} grains in frame {frame}")
        flow = np.nansum(column("velocity") * column("number_density")[:, None], axis=0) * volume
        if len(set(log.radius_of)) == 1:
            expected = log.velocity(frame)[inside].sum(axis=0) * stands_for
            scale = np.abs(log.velocity(frame)).sum() * stands_for + 1e-9
            checks.that(np.allclose(flow, expected, atol=1e-5 * scale), f"vti: flow {flow}, expected {expected}")
        temperature = column("temperature")
        checks.that(np.all(np.isnan(temperature) | (temperature >= 0)), "vti: temperatures")


def check_csv(path, log, checks):
    table = pandas.read_csv(path)
    checks.that(len(table) == sum(map(len, log.frames)), "csv: a line for every point")
    for frame in picked(log):
        part = table[table.frame == log.numbers[frame]]
        checks.that(np.array_equal(part.id, log.frames[frame]["id"]), "csv: ids")
        checks.that((part.time == log.times[frame]).all(), "csv: times")
        found = part[["x", "y", "z"]].to_numpy(np.float32)
        checks.that(np.array_equal(found, log.position(frame)), "csv: positions, bit for bit")
        checks.that(np.array_equal(part.radius, log.radii(frame)), "csv: radii")


def check_states(export, log, checks):
    """States have the bits that the log has."""
    table = pandas.read_csv(export("csv", "--states"))
    checks.that(table.frame.nunique() == len(log.states), "states: all of them")
    last = log.states[-1]
    part = table[table.frame == len(log.states) - 1].sort_values("id")
    order = np.argsort(np.frombuffer(last.ids, "<u4"))
    position = np.frombuffer(last.positions, "<f8").reshape(-1, last.dimension)[order]
    names = ["x", "y", "z"][: last.dimension]
    checks.that(np.array_equal(part[names].to_numpy(), position), "states: positions, bit for bit")
    checks.that((part.time == last.time).all(), "states: time")


def check_part(export, log, checks):
    """A span, and every second frame of it."""
    start, end = log.times[1], log.times[-2]
    table = pandas.read_csv(export("csv", "--from", repr(start), "--to", repr(end), "--every", "2"))
    expected = [log.numbers[k] for k in range(1, len(log.times) - 1, 2) if len(log.frames[k])]
    checks.that(sorted(table.frame.unique()) == expected, "a part: every second frame between two times")


def main(program, path, is_thinned):
    checks, log = Checks(), Log(path)
    log.set_radii(scenario_radii(path))
    with tempfile.TemporaryDirectory() as folder:
        export = Exporter(program, path, folder)
        check_ovito(export("lammps"), log, checks, "lammps")
        xyz = export("xyz")
        check_ovito(xyz, log, checks, "xyz")
        check_ase(xyz.rename(xyz.with_suffix(".xyz")), log, checks, "ase")
        xyz = xyz.with_suffix(".xyz")
        comment = xyz.read_text().splitlines()[len(log.frames[0]) + 3] if len(log.frames) > 1 else ""
        checks.that(("remark=" in comment) == is_thinned, f"xyz: thinning is told: {comment[:200]}")
        checks.that(("thinned" in export.said) == is_thinned, f"thinning is told: {export.said}")
        check_vtp(export("vtp"), log, checks)
        check_vti(export("vti"), log, checks)
        check_csv(export("csv"), log, checks)
        if not is_thinned:
            check_states(export, log, checks)
            check_ase_states(export("xyz", "--states"), log, checks)
        check_part(export, log, checks)
    print(f"{path}: {len(log.frames)} frames, {len(log.states)} states")
    print(f"{checks.passed} passed, {checks.failed} failed")
    return 1 if checks.failed else 0


if __name__ == "__main__":
    arguments = [one for one in sys.argv[1:] if one != "--thinned"]
    if len(arguments) != 2:
        sys.exit(__doc__)
    sys.exit(main(*arguments, "--thinned" in sys.argv))
