# SPDX-License-Identifier: GPL-3.0-or-later
"""Snapshots read back to the last bit by what users open them with: meshio, VTK, ParaView.

Usage: python3 tests/mesh/test_vtu_files.py, after a build. VTK and pvpython are asked where they are installed.
"""
import json
import os
import shutil
import subprocess
import sys
import tempfile
import unittest
from xml.etree import ElementTree

import meshio
import numpy as np

try:
    import vtk
    from vtk.util.numpy_support import vtk_to_numpy
except ImportError:
    vtk = None

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
SAMPLES = os.path.join(ROOT, os.environ.get("BUILD", "build"), "bin", "vtu_samples")
PVD = 'τ = 0.1 & "<R>".pvd'
TIMES = [0.0, 1e-17, 0.1, 0.1 + 0.2, 1 / 3]
DEGREES = {1: (3, 5, "triangle"), 2: (6, 22, "triangle6"), 3: (10, 69, "VTK_LAGRANGE_TRIANGLE"),
           4: (15, 69, "VTK_LAGRANGE_TRIANGLE")}  # nodes of a cell, VTK's type, meshio's name
FIELDS = {"H": 1, "v": 3, "|A|²": 1}  # components
# Run by pvpython, whose Python may be another one: prints what ParaView sees of a collection.
PVPYTHON = """
import json, sys
from paraview import servermanager, simple
reader = simple.PVDReader(FileName=sys.argv[1])
reader.UpdatePipelineInformation()
seen = []
for time in reader.TimestepValues:
    reader.UpdatePipeline(time)
    grid = servermanager.Fetch(reader)
    while grid.IsA("vtkCompositeDataSet"):
        grid = grid.GetBlock(0)
    fields = grid.GetFieldData()
    arrays = [fields.GetArray(i) for i in range(fields.GetNumberOfArrays())]
    values = {array.GetName(): [array.GetValue(j) for j in range(array.GetNumberOfTuples())] for array in arrays}
    seen.append({"time": time, "H": grid.GetPointData().GetArray("H").GetValue(0), "type": grid.GetCellType(0),
                 "bounds": grid.GetBounds(), "field data": values})
print(json.dumps(seen))
"""


def setUpModule():
    """Writes the samples, and says what is not asked."""
    global FOLDER
    holder = tempfile.TemporaryDirectory()
    unittest.addModuleCleanup(holder.cleanup)
    FOLDER = holder.name
    if not os.path.exists(SAMPLES):
        raise RuntimeError(f"{SAMPLES}: no such program; cmake --build build --target vtu_samples makes it")
    subprocess.run([SAMPLES, FOLDER], check=True)
    missing = [name for name, found in (("VTK (python3-vtk9)", vtk), ("ParaView (pvpython)", shutil.which("pvpython")))
               if not found]
    if missing:
        print(f"test_vtu_files: {' and '.join(missing)} not installed: the files are not read by it", file=sys.stderr)


def sample(name):
    return os.path.join(FOLDER, name)


def raw(name, dtype, columns):
    """The array of rows that vtu_samples has written."""
    return np.fromfile(sample(name), dtype).reshape(-1, columns)


def expected():
    with open(sample("expected.json"), encoding="utf-8") as file:
        return json.load(file)


def text_of(codes):
    """A text of the field data."""
    return np.asarray(codes, np.uint8).tobytes().decode()


def bits(values):
    return np.ascontiguousarray(values, np.float64).reshape(len(values), -1).view(np.uint64)


class Reading(unittest.TestCase):
    def assert_same_bits(self, found, wanted):
        self.assertEqual(np.asarray(found).dtype, np.float64)
        np.testing.assert_array_equal(bits(found), bits(wanted))

    def assert_field_data(self, arrays):
        """arrays: name -> numbers."""
        wanted = expected()
        self.assertEqual(set(arrays), {"TimeValue", "step", "flow", "configuration"})
        self.assertEqual(list(arrays["TimeValue"]), [wanted["t"]])
        self.assertEqual(list(arrays["step"]), [wanted["step"]])
        for name in ("flow", "configuration"):
            self.assertEqual(text_of(arrays[name]), wanted[name])
        self.assertEqual(json.loads(text_of(arrays["configuration"]))["axes"], [1, 2.5, 1e-300])


class WithMeshio(Reading):
    def test_every_degree_to_the_last_bit(self):
        for degree, (nodes, _, kind) in DEGREES.items():
            with self.subTest(degree=degree):
                mesh = meshio.read(sample(f"degree_{degree}.vtu"))
                self.assert_same_bits(mesh.points, raw(f"degree_{degree}.points", float, 3))
                self.assertEqual([block.type for block in mesh.cells], [kind])
                np.testing.assert_array_equal(mesh.cells[0].data, raw(f"degree_{degree}.cells", np.int32, nodes))
                self.assertEqual(list(mesh.point_data), list(FIELDS))
                for name, columns in FIELDS.items():
                    self.assert_same_bits(mesh.point_data[name], raw(f"degree_{degree}.{name}", float, columns))
                self.assertEqual(mesh.point_data["H"].ndim, 1)
                self.assert_field_data(mesh.field_data)

    def test_collection(self):
        root = ElementTree.parse(sample(PVD)).getroot()
        self.assertEqual(root.get("type"), "Collection")
        listed = [(float(entry.get("timestep")), entry.get("file")) for entry in root.iter("DataSet")]
        self.assertEqual([t for t, _ in listed], TIMES)
        for n, (t, name) in enumerate(listed):
            mesh = meshio.read(sample(name))
            self.assertEqual([mesh.field_data["TimeValue"][0], mesh.field_data["step"][0]], [t, 10 * n])
            np.testing.assert_allclose(np.linalg.norm(mesh.points, axis=1), 1 + t, rtol=1e-15)


@unittest.skipUnless(vtk, "VTK (python3-vtk9) is not installed")
class WithVtk(Reading):
    def read(self, name):
        reader = vtk.vtkXMLUnstructuredGridReader()
        reader.SetFileName(sample(name))
        reader.Update()
        self.assertEqual(reader.GetErrorCode(), 0)
        return reader

    def distance_of_maps(self, grid, degree):
        """The largest distance between VTK's cells and the element maps at the reference points."""
        points = raw("reference.points", float, 2)
        maps = raw(f"degree_{degree}.maps", float, 3).reshape(grid.GetNumberOfCells(), len(points), 3)
        sub_cell, place, weights = vtk.reference(0), [0.0] * 3, [0.0] * DEGREES[degree][0]
        distance = 0
        for e, images in enumerate(maps):
            cell = grid.GetCell(e)
            for point, image in zip(points, images):
                cell.EvaluateLocation(sub_cell, [*point, 0], place, weights)
                distance = max(distance, np.linalg.norm(place - image))
        return distance

    def test_every_degree_to_the_last_bit(self):
        for degree, (nodes, kind, _) in DEGREES.items():
            with self.subTest(degree=degree):
                reader = self.read(f"degree_{degree}.vtu")
                grid = reader.GetOutput()
                self.assert_same_bits(vtk_to_numpy(grid.GetPoints().GetData()),
                                      raw(f"degree_{degree}.points", float, 3))
                cells = raw(f"degree_{degree}.cells", np.int32, nodes)
                self.assertEqual(grid.GetNumberOfCells(), len(cells))
                for e, cell in enumerate(cells):
                    ids = grid.GetCell(e).GetPointIds()
                    self.assertEqual([ids.GetId(i) for i in range(ids.GetNumberOfIds())], list(cell))
                    self.assertEqual(grid.GetCellType(e), kind)
                data = grid.GetPointData()
                self.assertEqual([data.GetArrayName(i) for i in range(data.GetNumberOfArrays())], list(FIELDS))
                for name, columns in FIELDS.items():
                    self.assert_same_bits(vtk_to_numpy(data.GetArray(name)),
                                          raw(f"degree_{degree}.{name}", float, columns))
                fields = grid.GetFieldData()
                self.assert_field_data({fields.GetArrayName(i): vtk_to_numpy(fields.GetArray(i))
                                        for i in range(fields.GetNumberOfArrays())})
                times = reader.GetOutputInformation(0).Get(vtk.vtkStreamingDemandDrivenPipeline.TIME_STEPS())
                self.assertEqual(times, (expected()["t"],))

    def test_cells_are_the_element_maps(self):
        for degree in DEGREES:
            self.assertLess(self.distance_of_maps(self.read(f"degree_{degree}.vtu").GetOutput(), degree), 1e-12)

    def test_the_check_sees_a_wrong_node_order(self):
        wrong = [name for name in os.listdir(FOLDER) if name.startswith("wrong_")]
        self.assertEqual(len(wrong), 5)
        for name in wrong:
            self.assertGreater(self.distance_of_maps(self.read(name).GetOutput(), int(name.split("_")[1])), 1e-2, name)


@unittest.skipUnless(shutil.which("pvpython"), "ParaView (pvpython) is not installed")
class WithParaView(Reading):
    def test_collection(self):
        script = sample("see.py")
        with open(script, "w", encoding="utf-8") as file:
            file.write(PVPYTHON)
        done = subprocess.run(["pvpython", script, sample(PVD)], capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        seen = json.loads(done.stdout.splitlines()[-1])
        self.assertEqual([found["time"] for found in seen], TIMES)
        for n, (t, found) in enumerate(zip(TIMES, seen)):
            self.assertEqual(found["type"], 22)
            self.assertEqual(found["H"], 2 / (1 + t))
            self.assertAlmostEqual(found["bounds"][1], 1 + t, delta=0.06)
            fields = found["field data"]
            self.assertEqual([fields["TimeValue"], fields["step"]], [[t], [10 * n]])
            self.assertEqual([text_of(fields[name]) for name in ("flow", "configuration")],
                             [expected()["flow"], expected()["configuration"]])


if __name__ == "__main__":
    unittest.main()
