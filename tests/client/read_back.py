# SPDX-License-Identifier: Apache-2.0
"""Reads weft's mesh files with meshio, VTK and Gmsh and compares what they find with what was
written: the sample mesh of 10 x 10 squares (support/sample_mesh.h).

Needs Debian's python3-meshio, python3-vtk9 and python3-gmsh.
"""

import collections
import os
import subprocess
import sys
import tempfile

import gmsh
import meshio
import numpy
import vtk
from vtk.util.numpy_support import vtk_to_numpy

VERTICES, TRIANGLES, EDGES = 121, 200, 40
REGIONS = {0: 100, 7: 100}
MARKERS = {1: 10, 2: 10, 3: 10, 4: 10}


def tally(values):
    return dict(collections.Counter(int(v) for v in values))


def equal(what, found, expected):
    if found != expected:
        sys.exit(f"{what}: found {found}, expected {expected}")
    print(f"ok {what}: {found}")


def area(points, triangles):
    a, b, c = (numpy.asarray(points)[triangles[:, i], :2] for i in range(3))
    u, v = b - a, c - a
    return float((u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]).sum() / 2)


def check_meshio(path):
    mesh = meshio.read(path)
    equal("meshio vertices", len(mesh.points), VERTICES)
    counts, regions, markers = collections.Counter(), [], []
    for i, block in enumerate(mesh.cells):
        counts[block.type] += len(block.data)
        if block.type == "triangle":
            regions += list(mesh.cell_data["region"][i])
            equal("meshio area", area(mesh.points, block.data), 100.0)
        if block.type == "line":
            markers += list(mesh.cell_data["marker"][i])
    equal("meshio cells", dict(counts), {"triangle": TRIANGLES, "line": EDGES})
    equal("meshio regions", tally(regions), REGIONS)
    equal("meshio markers", tally(markers), MARKERS)


def check_vtk(path):
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(path)
    reader.Update()
    grid = reader.GetOutput()
    equal("VTK vertices", grid.GetNumberOfPoints(), VERTICES)
    types = [grid.GetCellType(i) for i in range(grid.GetNumberOfCells())]
    equal("VTK cells", tally(types), {vtk.VTK_TRIANGLE: TRIANGLES, vtk.VTK_LINE: EDGES})
    regions = vtk_to_numpy(grid.GetCellData().GetArray("region"))
    markers = vtk_to_numpy(grid.GetCellData().GetArray("marker"))
    equal("VTK regions", tally(regions[:TRIANGLES]), REGIONS)
    equal("VTK markers", tally(markers[TRIANGLES:]), MARKERS)
    equal("VTK bounds", grid.GetBounds(), (0.0, 10.0, 0.0, 10.0, 0.0, 0.0))


def check_gmsh(path):
    gmsh.initialize(["gmsh", "-v", "2"])
    gmsh.open(path)
    equal("Gmsh vertices", len(gmsh.model.mesh.getNodes()[0]), VERTICES)
    for dimension, kind, expected, word in ((2, 2, REGIONS, "region"), (1, 1, MARKERS, "marker")):
        found = {}
        for _, group in gmsh.model.getPhysicalGroups(dimension):
            name = gmsh.model.getPhysicalName(dimension, group)
            count = 0
            for entity in gmsh.model.getEntitiesForPhysicalGroup(dimension, group):
                types, tags, _ = gmsh.model.mesh.getElements(dimension, entity)
                equal(f"Gmsh element types of {name}", list(types), [kind])
                count += len(tags[0])
            found[name] = count
        equal(f"Gmsh {word}s", found, {f"{word} {k}": n for k, n in expected.items()})
    gmsh.finalize()


def main():
    with tempfile.TemporaryDirectory() as folder:
        vtu, msh = (os.path.join(folder, name) for name in ("sample.vtu", "sample.msh"))
        subprocess.run([sys.argv[1], vtu, msh], check=True)
        check_meshio(vtu)
        check_vtk(vtu)
        check_gmsh(msh)
        # meshio reads Gmsh's format on its own code.
        mesh = meshio.read(msh)
        equal("meshio .msh triangles", len(mesh.cells_dict["triangle"]), TRIANGLES)
        equal("meshio .msh area", area(mesh.points, mesh.cells_dict["triangle"]), 100.0)


main()
