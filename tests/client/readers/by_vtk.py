# SPDX-License-Identifier: Apache-2.0
"""What VTK reads."""

import vtk
from vtk.util.numpy_support import vtk_to_numpy

from readers.plate import (AREA, EDGES, MARKERS, NAMES, REGIONS, SIDES, TRIANGLES, VERTICES, area,
                           check_bed, check_midsides, check_parts, equal, tally)


def vtk_grid(path):
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(path)
    reader.Update()
    return reader.GetOutput()


def vtk_vtu(path):
    grid = vtk_grid(path)
    equal("vertices", grid.GetNumberOfPoints(), VERTICES)
    types = [grid.GetCellType(i) for i in range(grid.GetNumberOfCells())]
    equal("cells", tally(types), {vtk.VTK_TRIANGLE: TRIANGLES, vtk.VTK_LINE: EDGES})
    equal("regions", tally(vtk_to_numpy(grid.GetCellData().GetArray("region"))[:TRIANGLES]), REGIONS)
    equal("markers", tally(vtk_to_numpy(grid.GetCellData().GetArray("marker"))[TRIANGLES:]), MARKERS)
    equal("bounds", grid.GetBounds(), (0.0, 12.0, 0.0, 12.0, 0.0, 0.0))


def vtk_vtu_bed(path):
    grid = vtk_grid(path)
    check_bed(vtk_to_numpy(grid.GetPoints().GetData()),
              vtk_to_numpy(grid.GetPointData().GetArray("elevation")))


def vtk_vtu_2(path):
    grid = vtk_grid(path)
    equal("nodes", grid.GetNumberOfPoints(), VERTICES + SIDES)
    types = [grid.GetCellType(i) for i in range(grid.GetNumberOfCells())]
    equal("cells", tally(types),
          {vtk.VTK_QUADRATIC_TRIANGLE: TRIANGLES, vtk.VTK_QUADRATIC_EDGE: EDGES})
    size = vtk.vtkCellSizeFilter()
    size.SetInputData(grid)
    size.Update()
    areas = vtk_to_numpy(size.GetOutput().GetCellData().GetArray("Area"))
    equal("area", round(float(areas.sum()), 9), AREA)
    points = vtk_to_numpy(grid.GetPoints().GetData())
    cells = vtk_to_numpy(grid.GetCells().GetConnectivityArray())
    check_midsides(points, cells[:6 * TRIANGLES].reshape(-1, 6), [(0, 1), (1, 2), (2, 0)])
    check_midsides(points, cells[6 * TRIANGLES:].reshape(-1, 3), [(0, 1)])


def vtk_parts(path):
    grid = vtk_grid(path)
    parts = vtk_to_numpy(grid.GetCellData().GetArray("part"))
    check_parts(parts[:TRIANGLES])
    equal("edges are of no part", tally(parts[TRIANGLES:]), {-1: EDGES})


def exodus_grids(path, kind):
    """Blocks by name, of the elements or of the side sets, as VTK reads them."""
    reader = vtk.vtkExodusIIReader()
    reader.SetFileName(path)
    reader.UpdateInformation()
    for side_set in range(reader.GetNumberOfSideSetArrays()):
        reader.SetSideSetArrayStatus(reader.GetSideSetArrayName(side_set), 1)
    reader.SetAllArrayStatus(vtk.vtkExodusIIReader.NODAL, 1)
    reader.SetAllArrayStatus(vtk.vtkExodusIIReader.ELEM_BLOCK, 1)
    reader.GenerateObjectIdCellArrayOn()
    reader.Update()
    blocks = reader.GetOutput().GetBlock({"element": 0, "side": 4}[kind])
    name = lambda i: blocks.GetMetaData(i).Get(vtk.vtkCompositeDataSet.NAME())
    return {name(i).split(" ID:")[0]: blocks.GetBlock(i) for i in range(blocks.GetNumberOfBlocks())}


def vtk_exodus(path):
    blocks = exodus_grids(path, "element")
    equal("regions", {name: grid.GetNumberOfCells() for name, grid in blocks.items()},
          {f"region {region}": n for region, n in REGIONS.items()})
    whole = 0
    for name, grid in blocks.items():
        points = vtk_to_numpy(grid.GetPoints().GetData())
        triangles = vtk_to_numpy(grid.GetCells().GetConnectivityArray()).reshape(-1, 3)
        whole += area(points, triangles)
        equal(f"{name} is where it was",
              bool(((points[triangles].mean(axis=1)[:, 0] < 6) == (name == "region 3")).all()), True)
    equal("area", whole, AREA)
    sets = exodus_grids(path, "side")
    equal("markers", {name: grid.GetNumberOfCells() for name, grid in sets.items()},
          {f"marker {marker}": n for marker, n in MARKERS.items()})
    for marker, bounds in {1: (0, 12, 0, 0), 2: (12, 12, 0, 12), 5: (4, 8, 4, 8), 9: (6, 6, 0, 12)}.items():
        equal(f"bounds of marker {marker}", sets[f"marker {marker}"].GetBounds()[:4], bounds)


def vtk_exodus_values(path):
    parts = []
    for grid in exodus_grids(path, "element").values():
        check_bed(vtk_to_numpy(grid.GetPoints().GetData()),
                  vtk_to_numpy(grid.GetPointData().GetArray("elevation")))
        parts += vtk_to_numpy(grid.GetCellData().GetArray("part")).tolist()
    check_parts(parts)


def vtk_exodus_2(path):
    whole = 0
    for name, grid in exodus_grids(path, "element").items():
        equal(f"kinds of {name}", {grid.GetCellType(i) for i in range(grid.GetNumberOfCells())},
              {vtk.VTK_QUADRATIC_TRIANGLE})
        points = vtk_to_numpy(grid.GetPoints().GetData())
        cells = vtk_to_numpy(grid.GetCells().GetConnectivityArray()).reshape(-1, 6)
        check_midsides(points, cells, [(0, 1), (1, 2), (2, 0)])
        check_bed(points, vtk_to_numpy(grid.GetPointData().GetArray("elevation")))
        whole += area(points, cells)
    equal("area", whole, AREA)
    sets = exodus_grids(path, "side")
    equal("markers", {name: grid.GetNumberOfCells() for name, grid in sets.items()},
          {f"marker {marker}": n for marker, n in MARKERS.items()})
    for marker, bounds in {1: (0, 12, 0, 0), 2: (12, 12, 0, 12), 5: (4, 8, 4, 8)}.items():
        equal(f"bounds of marker {marker}", sets[f"marker {marker}"].GetBounds()[:4], bounds)
        # VTK takes a side of three nodes for a triangle; its nodes are the ends and the middle.
        sides = sets[f"marker {marker}"]
        check_midsides(vtk_to_numpy(sides.GetPoints().GetData()),
                       vtk_to_numpy(sides.GetCells().GetConnectivityArray()).reshape(-1, 3), [(0, 1)])


def vtk_exodus_names(path):
    for kind, dimension, word, expected in (("element", 2, "region", REGIONS),
                                            ("side", 1, "marker", MARKERS)):
        equal(f"{word}s", {name: grid.GetNumberOfCells() for name, grid in
                           exodus_grids(path, kind).items()},
              {NAMES[dimension].get(number, f"{word} {number}"): n for number, n in expected.items()})


def vtk_surface(reader):
    def check(path):
        reader.SetFileName(path)
        reader.Update()
        surface = reader.GetOutput()
        equal("triangles", surface.GetNumberOfPolys(), TRIANGLES)
        equal("vertices", surface.GetNumberOfPoints(), VERTICES)
        triangles = vtk.vtkTriangleFilter()
        triangles.PassLinesOff()
        triangles.SetInputData(surface)
        mass = vtk.vtkMassProperties()
        mass.SetInputConnection(triangles.GetOutputPort())
        equal("area", round(mass.GetSurfaceArea(), 9), AREA)
    return check


def vtk_names(path):
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(path)
    reader.Update()
    data = reader.GetOutput().GetFieldData()
    for dimension, names in NAMES.items():
        for number, name in names.items():
            equal(name, vtk_to_numpy(data.GetArray(name)).ravel().tolist(), [number, dimension])
