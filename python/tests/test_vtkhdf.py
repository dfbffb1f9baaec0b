"""VTKHDF files against the specification of the format, by a reader that is written here, and by VTK where it is here."""

import importlib.util
import tempfile
import unittest
from pathlib import Path

import h5py
import numpy as np
import synthetic
from small_runs import small_run
from test_space import write_run_in_space

import softgrain
from softgrain.export.__main__ import export
from softgrain.options import parse

HAS_VTK = importlib.util.find_spec("vtkmodules") is not None


def read_step(root, step):
    """Points, cells (type, points), and data of one step, by the table "Size of partition i" and the offsets of Steps."""
    steps = root.get("Steps")
    part = 0 if steps is None else steps["PartOffsets"][step]
    counts = {name: root[f"NumberOf{name}"][part] for name in ("Points", "Cells", "ConnectivityIds")}
    starts = dict.fromkeys(counts, 0) if steps is None else {
        "Points": steps["PointOffsets"][step], "Cells": steps["CellOffsets"][step, 0],
        "ConnectivityIds": steps["ConnectivityIdOffsets"][step, 0]}

    def slab(name, what, extra=0, shift=0):
        begin = starts[what] + shift
        return root[name][begin:begin + counts[what] + extra]

    ends = slab("Offsets", "Cells", extra=1, shift=part)  # cells + 1 in each part
    connectivity = slab("Connectivity", "ConnectivityIds")
    cells = [(kind, connectivity[a:b].tolist()) for kind, a, b in zip(slab("Types", "Cells"), ends, ends[1:])]
    data = {}
    for group, what in (("PointData", "Points"), ("CellData", "Cells")):
        for name, values in root[group].items():
            begin = starts[what] if steps is None else steps[f"{group}Offsets/{name}"][step]
            data[group, name] = values[begin:begin + counts[what]]
    return slab("Points", "Points"), cells, data


class Files(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def write(self, run, *words):
        path = self.folder / f"{run.name}.vtkhdf"
        return export(parse("export", [str(run.path), "--to=vtkhdf", "-o", str(path), *words]))

    def check_shapes(self, root):
        """What the specification says of every file of this type."""
        self.assertEqual(root.attrs["Type"], b"UnstructuredGrid")
        self.assertEqual(h5py.check_string_dtype(root.attrs.get_id("Type").dtype).encoding, "ascii")
        self.assertEqual(root.attrs["Version"].shape, (2,))
        self.assertEqual(root["Types"].dtype, np.uint8)
        parts = len(root["NumberOfPoints"])
        sizes = {name: root[f"NumberOf{name}"][()].sum() for name in ("Points", "Cells", "ConnectivityIds")}
        self.assertEqual(root["Points"].shape, (sizes["Points"], 3))
        self.assertEqual(len(root["Types"]), sizes["Cells"])
        self.assertEqual(len(root["Offsets"]), sizes["Cells"] + parts)
        self.assertEqual(len(root["Connectivity"]), sizes["ConnectivityIds"])
        for group, what in (("PointData", "Points"), ("CellData", "Cells")):
            for values in root[group].values():
                self.assertEqual(len(values), sizes[what])
        if "Steps" not in root:
            self.assertEqual((parts, root.attrs["Version"][0]), (1, 1))
            return
        steps = root["Steps"]
        count = int(steps.attrs["NSteps"])
        self.assertEqual(root.attrs["Version"][0], 2)
        self.assertTrue(np.issubdtype(steps.attrs.get_id("NSteps").dtype, np.integer))
        for name in ("Values", "PartOffsets", "NumberOfParts", "PointOffsets"):
            self.assertEqual(steps[name].shape, (count,))
        for name in ("CellOffsets", "ConnectivityIdOffsets"):
            self.assertEqual(steps[name].shape, (count, 1))  # one topology
        for group in ("PointData", "CellData"):
            self.assertEqual(set(steps[f"{group}Offsets"]), set(root[group]))

    def check_step(self, root, step, snapshot):
        points, cells, data = read_step(root, step)
        position = snapshot.particles["position"]
        count, size = len(position), position.shape[1]
        np.testing.assert_array_equal(points[:count, :size], position)
        np.testing.assert_array_equal(points[:, size:], 0)
        self.assertEqual(cells[:count], [(1, [k]) for k in range(count)])
        shapes = [points[ids, :2] for kind, ids in cells[count:] if kind == 7]
        rims = softgrain.picture.outlines(snapshot) if snapshot.outlines else []
        self.assertEqual(len(cells) - count, len(rims))
        for shape, (_, rim) in zip(shapes, rims):
            np.testing.assert_array_equal(shape, rim)
        np.testing.assert_array_equal(data["CellData", "grain"][count:], [grain for grain, _ in rims])
        np.testing.assert_array_equal(data["CellData", "shape"], np.repeat([0, 1], [count, len(rims)]))
        for name in ("radius", "pressure"):
            np.testing.assert_array_equal(data["PointData", name][:count], snapshot.particles[name])
        if rims:  # the mean pressure over a grain is that over its area, which its points share
            of_first = snapshot.particles["grain"] == rims[0][0]
            weights = snapshot.particles["radius"][of_first] ** 2
            mean = np.average(snapshot.particles["pressure"][of_first], weights=weights)
            self.assertAlmostEqual(data["CellData", "pressure"][count] / mean, 1)

    def test_all_snapshots_of_runs_of_every_model_are_read_back_by_the_specification(self):
        for name in ("bonded", "elastic", "packing"):
            run = small_run(name)
            with h5py.File(self.write(run)) as file:
                root = file["VTKHDF"]
                self.check_shapes(root)
                np.testing.assert_allclose(root["Steps/Values"][()], run.times)
                for step, snapshot in enumerate(run):
                    self.check_step(root, step, snapshot)

    def test_one_snapshot_is_a_file_of_the_format_s_first_version(self):
        run = small_run("packing")
        with h5py.File(self.write(run, "--frame=-1")) as file:
            self.check_shapes(file["VTKHDF"])
            self.check_step(file["VTKHDF"], 0, run[-1])

    def test_a_number_of_particles_that_changes_moves_the_offsets(self):
        """Runs do not do this; the format allows it."""
        folder = synthetic.write_run(self.folder / "changing", snapshots=3)
        run = softgrain.open(folder)
        with h5py.File(run.snapshots[1], "r+") as file:
            for name in ("position", "radius", "pressure"):
                kept = file[f"scene/particles/{name}"][5:]
                del file[f"scene/particles/{name}"]
                file[f"scene/particles/{name}"] = kept
        with h5py.File(self.write(run)) as file:
            root = file["VTKHDF"]
            self.check_shapes(root)
            self.assertEqual(np.diff(root["NumberOfPoints"]).tolist(), [-5, 5])
            for step, snapshot in enumerate(run):
                self.check_step(root, step, snapshot)

    def test_surfaces_in_space_are_quadrilaterals_with_their_pressure(self):
        run = softgrain.open(write_run_in_space(self.folder))
        with h5py.File(self.write(run)) as file:
            root = file["VTKHDF"]
            self.check_shapes(root)
            for step, snapshot in enumerate(run):
                points, cells, data = read_step(root, step)
                self.assertEqual([kind for kind, _ in cells], [1] + [9] * 6)
                quads = points[[ids for kind, ids in cells if kind == 9]]
                np.testing.assert_array_equal(quads, snapshot.outlines["position"][snapshot.surface["quad"]])
                np.testing.assert_array_equal(data["CellData", "pressure"][1:], 1e5 * step)

    @unittest.skipUnless(HAS_VTK, "VTK is not here, so it did not read our file: apt install python3-vtk9")
    def test_vtk_reads_what_its_version_can(self):
        """One snapshot from 9.1 on, all of them with their times from 9.3 on."""
        from vtkmodules.util.numpy_support import vtk_to_numpy
        from vtkmodules.vtkCommonCore import vtkVersion
        from vtkmodules.vtkIOHDF import vtkHDFReader

        run = small_run("packing")

        def grid_of(path, time=None):
            reader = vtkHDFReader()
            self.assertEqual(reader.CanReadFile(str(path)), 1)
            reader.SetFileName(str(path))
            reader.UpdateInformation()
            reader.Update() if time is None else reader.UpdateTimeStep(time)
            return reader.GetOutput()

        def check(grid, snapshot):
            count = len(snapshot.particles["position"])
            self.assertEqual(grid.GetNumberOfCells(), count + snapshot.outlines["grain"].max() + 1)
            np.testing.assert_array_equal(vtk_to_numpy(grid.GetPoints().GetData())[:count, :2], snapshot.particles["position"])
            np.testing.assert_array_equal(vtk_to_numpy(grid.GetPointData().GetArray("pressure"))[:count],
                                          snapshot.particles["pressure"])
            self.assertEqual(grid.GetCellType(count), 7)
            corners = grid.GetCell(count).GetPoints()
            rim = [corners.GetPoint(k)[:2] for k in range(corners.GetNumberOfPoints())]
            np.testing.assert_array_equal(rim, softgrain.picture.outlines(snapshot)[0][1])

        check(grid_of(self.write(run, "--frame=2")), run[2])
        version = vtkVersion()
        if (version.GetVTKMajorVersion(), version.GetVTKMinorVersion()) >= (9, 3):
            path = self.write(run)
            for time, snapshot in zip(run.times, run):
                check(grid_of(path, time), snapshot)


if __name__ == "__main__":
    unittest.main()
