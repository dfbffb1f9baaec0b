"""A scene for ParaView: grains as polygons, in space by their surfaces, one series per kind of thing, and a script that shows them all."""

import re
from pathlib import Path
from xml.sax.saxutils import quoteattr

import numpy as np

from .. import view
from ..picture import outlines

SCRIPT = Path(__file__).with_name("paraview_scene.py")


def write_scene(run, folder):
    """Fills `folder`: grains_*.vtp (of the plane), a .pvd for each kind, scene.py. Returns the path of scene.py.

    Points, contacts, walls and surfaces in space stay where the run has written them (output.vtk)."""
    folder.mkdir(parents=True, exist_ok=True)
    snapshots = [run[i] for i in range(len(run))]
    for kind in ("surfaces" if run.in_space else "particles", "contacts", "walls"):
        files = run.vtk_files(kind)
        frames = [(s.time, f"../vtk/{files[s.step].name}") for s in snapshots if s.step in files]
        if not frames:
            raise ValueError(f"{run.path} has no vtk/{kind}_*.vtp: it was run with output.vtk = false")
        (folder / f"{kind}.pvd").write_text(pvd_text(frames))
    if not run.in_space:
        (folder / "grains.pvd").write_text(pvd_text(_write_grains(snapshots, folder)))
    low, high = pressure_range(snapshots)
    text = _fill(SCRIPT.read_text(), FOLDER=f"Path({str(folder.resolve())!r})", PRESSURES=f"({low:.6g}, {high:.6g})",
                 RADIUS=f"{chain_width(snapshots[0]):.6g}", IN_SPACE=str(run.in_space),
                 TOWARDS=f"({', '.join(f'{x:.6g}' for x in view.directions()[2])})")
    scene = folder / "scene.py"
    scene.write_text(text)
    return scene


def _write_grains(snapshots, folder):
    """Outlines as polygons, a file for each snapshot that has some; returns (time, name)."""
    grains, width = [], max(6, len(str(snapshots[-1].step)))
    for snapshot in snapshots:
        if snapshot.outlines:
            grains.append((snapshot.time, f"grains_{snapshot.step:0{width}}.vtp"))
            (folder / grains[-1][1]).write_text(grains_vtp(snapshot))
    return grains


def chain_width(snapshot):
    """Of the largest force [m]: as wide as a particle, or a quarter of an elastic grain."""
    return snapshot.body_radii().mean() * (0.25 if snapshot.contacts_of_grains else 1)


def pressure_range(snapshots):
    """One range for all frames, without the extreme 3 % on either side; (0, 1) if no pressure is recorded."""
    pressures = [fields["pressure"] for s in snapshots for fields in (s.particles, s.surface) if "pressure" in fields]
    return np.percentile(np.concatenate(pressures), (3, 97)) if pressures else (0, 1)


def pvd_text(frames):
    lines = [f'<DataSet timestep="{time:.9g}" part="0" file={quoteattr(file)}/>' for time, file in frames]
    return "\n".join(['<?xml version="1.0"?>', '<VTKFile type="Collection" version="0.1">', "<Collection>", *lines,
                      "</Collection>", "</VTKFile>", ""])


def grains_vtp(snapshot):
    """The outlines as polygons: cell data grain and pressure [Pa], its mean over the grain's particles."""
    polygons = outlines(snapshot)
    vertices = np.concatenate([v for _, v in polygons])
    points = np.column_stack([vertices, np.zeros(len(vertices))])
    particles = snapshot.particles
    pressure = particles.get("pressure", np.zeros(len(particles["radius"])))
    means = [pressure[particles["grain"] == grain].mean() for grain, _ in polygons]
    return (f'<?xml version="1.0"?>\n<VTKFile type="PolyData" version="1.0" byte_order="LittleEndian">\n<PolyData>\n'
            f'<Piece NumberOfPoints="{len(points)}" NumberOfVerts="0" NumberOfLines="0" NumberOfStrips="0" '
            f'NumberOfPolys="{len(polygons)}">\n'
            f"<CellData>\n{_array('grain', 'Int64', [g for g, _ in polygons])}"
            f"{_array('pressure', 'Float32', means)}</CellData>\n"
            f"<Points>\n{_array('position', 'Float32', points, components=3)}</Points>\n"
            f"<Polys>\n{_array('connectivity', 'Int64', np.arange(len(points)))}"
            f"{_array('offsets', 'Int64', np.cumsum([len(v) for _, v in polygons]))}</Polys>\n"
            "</Piece>\n</PolyData>\n</VTKFile>\n")


def _fill(script, **values):
    """The script with `NAME = ...` replaced by `NAME = value`; its comments stay."""
    for name, value in values.items():
        script = re.sub(rf"^{name} = .*?(?=  #|$)", lambda _: f"{name} = {value}", script, flags=re.M)
    return script


def _array(name, kind, values, components=1):
    words = " ".join(f"{value:.9g}" if kind == "Float32" else str(int(value)) for value in np.ravel(values))
    return (f'<DataArray type="{kind}" Name="{name}" NumberOfComponents="{components}" format="ascii">\n{words}\n'
            "</DataArray>\n")
