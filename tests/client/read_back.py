# SPDX-License-Identifier: Apache-2.0
"""Has programs that are not ours read what weft writes, and compares what they find with what was
written; prints a row for every format and reader. DOCS, docs/formats.md, must have these, and every
format that weft writes must be among them.

    read_back.py WEFT DOCS

The mesh: a plate of 12 x 12 unit squares, each cut in two triangles, with a hole of 4 x 4 in the
middle. numpy makes it and `weft convert` writes it in every format. Region 3 is left of x = 6,
region 7 right of it; the sides are marked 1 to 4 from the bottom counter-clockwise, the hole 5, and
the line between the regions 9.

Needs Debian's python3-gmsh, python3-meshio, python3-numpy, python3-shapely and python3-vtk9.
"""

import collections
import json
import os
import re
import subprocess
import sys
import tempfile

import gmsh
import meshio
import numpy
import shapely
import shapely.geometry
import shapely.ops
import vtk
from vtk.util.numpy_support import vtk_to_numpy

import format_table

VERTICES, TRIANGLES, SIDES, AREA = 160, 256, 416, 128.0
REGIONS = {3: 128, 7: 128}
BOUNDARY = {1: 12, 2: 12, 3: 12, 4: 12, 5: 16}
MARKERS = {**BOUNDARY, 9: 8}
EDGES = sum(MARKERS.values())

GMSH = f"Gmsh {gmsh.__version__}"
MESHIO = f"meshio {meshio.__version__}"
NUMPY = f"numpy {numpy.__version__}"
SHAPELY = f"shapely {shapely.__version__}"
VTK = f"VTK {vtk.vtkVersion.GetVTKVersion()}"


def plate():
    """points, triangles, regions, edges, edge_markers, as npz.h has them."""
    n = 12
    hole = lambda x, y: 4 <= x < 8 and 4 <= y < 8
    squares = [(x, y) for y in range(n) for x in range(n) if not hole(x, y)]
    used = sorted({(y + j, x + i) for x, y in squares for i in (0, 1) for j in (0, 1)})
    number = {(x, y): i for i, (y, x) in enumerate(used)}
    triangles, regions, edges, markers = [], [], [], []
    for x, y in squares:
        a, b, c, d = (number[p] for p in ((x, y), (x + 1, y), (x + 1, y + 1), (x, y + 1)))
        triangles += [(a, b, c), (a, c, d)]
        regions += [3 if x < 6 else 7] * 2

    def line(start, step, count, marker):
        for k in range(count):
            ends = [(start[0] + (k + i) * step[0], start[1] + (k + i) * step[1]) for i in (0, 1)]
            edges.append([number[p] for p in ends])
            markers.append(marker)

    line((0, 0), (1, 0), n, 1)
    line((n, 0), (0, 1), n, 2)
    line((n, n), (-1, 0), n, 3)
    line((0, n), (0, -1), n, 4)
    for start, step in (((4, 4), (1, 0)), ((8, 4), (0, 1)), ((8, 8), (-1, 0)), ((4, 8), (0, -1))):
        line(start, step, 4, 5)
    line((6, 0), (0, 1), 4, 9)
    line((6, 8), (0, 1), 4, 9)
    points = numpy.array([(x, y) for y, x in used], float)
    return {"points": points, "triangles": numpy.array(triangles), "regions": numpy.array(regions),
            "edges": numpy.array(edges), "edge_markers": numpy.array(markers)}


def tally(values):
    return dict(collections.Counter(int(v) for v in values))


def equal(what, found, expected):
    if found != expected:
        sys.exit(f"{what}: found {found}, expected {expected}")


def area(points, triangles):
    a, b, c = (numpy.asarray(points)[numpy.asarray(triangles)[:, i], :2] for i in range(3))
    u, v = b - a, c - a
    return float((u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]).sum() / 2)


def check_mesh(points, triangles):
    equal("vertices", len(points), VERTICES)
    equal("triangles", len(triangles), TRIANGLES)
    equal("area", area(points, triangles), AREA)


def check_midsides(points, cells, between):
    """Each midside node lies in the middle of the corners that `between` gives."""
    points = numpy.asarray(points)[:, :2]
    for node, (a, b) in enumerate(between, start=cells.shape[1] - len(between)):
        middle = (points[cells[:, a]] + points[cells[:, b]]) / 2
        equal(f"node {node} is a midside node", bool((points[cells[:, node]] == middle).all()), True)


def blocks(mesh, kind, name):
    values = [mesh.cell_data[name][i] for i, b in enumerate(mesh.cells) if b.type == kind]
    return tally(numpy.concatenate(values))


def meshio_vtu(path):
    mesh = meshio.read(path)
    check_mesh(mesh.points, mesh.cells_dict["triangle"])
    equal("regions", blocks(mesh, "triangle", "region"), REGIONS)
    equal("markers", blocks(mesh, "line", "marker"), MARKERS)


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


def meshio_2(path):
    mesh = meshio.read(path)
    equal("nodes", len(mesh.points), VERTICES + SIDES)
    equal("area", area(mesh.points, mesh.cells_dict["triangle6"]), AREA)
    check_midsides(mesh.points, mesh.cells_dict["triangle6"], [(0, 1), (1, 2), (2, 0)])
    check_midsides(mesh.points, mesh.cells_dict["line3"], [(0, 1)])


def gmsh_msh(path, order=1):
    gmsh.initialize(["gmsh", "-v", "2"])
    gmsh.open(path)
    nodes = gmsh.model.mesh.getNodes()[0]
    equal("nodes", len(nodes), VERTICES + (SIDES if order == 2 else 0))
    kinds = {1: {1: 1, 2: 2}, 2: {1: 8, 2: 9}}[order]
    for dimension, expected, word in ((2, REGIONS, "region"), (1, MARKERS, "marker")):
        found = {}
        for _, group in gmsh.model.getPhysicalGroups(dimension):
            name = gmsh.model.getPhysicalName(dimension, group)
            count = 0
            for entity in gmsh.model.getEntitiesForPhysicalGroup(dimension, group):
                types, tags, _ = gmsh.model.mesh.getElements(dimension, entity)
                equal(f"element types of {name}", list(types), [kinds[dimension]])
                count += len(tags[0])
            found[name] = count
        equal(f"{word}s", found, {f"{word} {k}": n for k, n in expected.items()})
    # Gmsh integrates over the elements as it understands them.
    elements = gmsh.model.mesh.getElementsByType(kinds[2])[0]
    weights = gmsh.model.mesh.getIntegrationPoints(kinds[2], "Gauss2")[1]
    _, determinants, _ = gmsh.model.mesh.getJacobians(
        kinds[2], gmsh.model.mesh.getIntegrationPoints(kinds[2], "Gauss2")[0])
    equal("area", round(float((determinants.reshape(len(elements), -1) @ weights).sum()), 9), AREA)
    gmsh.finalize()


def gmsh_msh_2(path):
    gmsh_msh(path, order=2)


def meshio_msh(path):
    mesh = meshio.read(path)
    check_mesh(mesh.points, mesh.cells_dict["triangle"])
    equal("regions", blocks(mesh, "triangle", "gmsh:physical"), REGIONS)
    equal("markers", blocks(mesh, "line", "gmsh:physical"), MARKERS)


def rows(path, skip=1):
    """numpy's reading of a text file of numbers with a line of counts on top."""
    return numpy.loadtxt(path, skiprows=skip)


def numpy_node(path):
    nodes, elements = rows(path), rows(path.replace(".node", ".ele"))
    check_mesh(nodes[:, 1:3], elements[:, 1:4].astype(int) - 1)
    equal("regions", tally(elements[:, 4]), REGIONS)
    with open(path.replace(".node", ".poly")) as poly:
        segments = numpy.loadtxt(poly.readlines()[2:-1])
    equal("markers", tally(segments[:, 3]), MARKERS)


def numpy_node_2(path):
    nodes, elements = rows(path), rows(path.replace(".node", ".ele"))
    equal("nodes", len(nodes), VERTICES + SIDES)
    # Triangle's nodes 4, 5 and 6 are opposite corners 1, 2 and 3.
    check_midsides(nodes[:, 1:3], elements[:, 1:7].astype(int) - 1, [(1, 2), (2, 0), (0, 1)])


def numpy_edge(path):
    edges = rows(path)
    equal("edges", len({tuple(e) for e in edges[:, 1:3]}), SIDES)
    equal("markers", tally(edges[:, 3]), {**MARKERS, 0: SIDES - EDGES})


def numpy_neigh(path):
    neighbours = rows(path)[:, 1:].astype(int)
    equal("sides on the boundary", int((neighbours == -1).sum()), sum(BOUNDARY.values()))
    corners = rows(path.replace(".neigh", ".ele"))[:, 1:4].astype(int)
    for t, row in enumerate(neighbours):
        for k, other in enumerate(row):
            if other == -1:
                continue
            shared = set(corners[t]) & set(corners[other - 1])
            equal("what neighbours share", shared, set(corners[t]) - {corners[t][k]})


def numpy_adcirc(path):
    lines = open(path).read().splitlines()
    triangles, vertices = map(int, lines[1].split())
    nodes = numpy.loadtxt(lines[2:2 + vertices])
    elements = numpy.loadtxt(lines[2 + vertices:2 + vertices + triangles], dtype=int)
    check_mesh(nodes[:, 1:3], elements[:, 2:] - 1)
    rest = iter(lines[2 + vertices + triangles:])
    found = {}
    for kind in ("open", "land"):
        count, total = int(next(rest).split()[0]), int(next(rest).split()[0])
        found[kind] = []
        for _ in range(count):
            words = next(rest).split()
            ids = [int(next(rest)) for _ in range(int(words[0]))]
            total -= len(ids)
            found[kind].append((int(words[1]), nodes[numpy.array(ids) - 1, 1:3]))
        equal(f"{kind} boundary nodes beyond their total", total, 0)
    equal("end of the file", list(rest), [])
    # --open-boundary 2: the right side, from below, where the domain is on the left.
    equal("open", [(t, p.tolist()) for t, p in found["open"]],
          [(0, [[12.0, float(y)] for y in range(13)])])
    equal("land", sorted((t, len(p)) for t, p in found["land"]), [(0, 13), (0, 13), (0, 13), (1, 16)])
    ends = sorted((p[0].tolist(), p[-1].tolist()) for t, p in found["land"] if t == 0)
    equal("mainland", ends, [([0.0, 0.0], [12.0, 0.0]), ([0.0, 12.0], [0.0, 0.0]),
                             ([12.0, 12.0], [0.0, 12.0])])
    island = next(p for t, p in found["land"] if t == 1)
    x, y = island[:, 0], island[:, 1]
    equal("island, clockwise", float((x * numpy.roll(y, -1) - y * numpy.roll(x, -1)).sum() / 2), -16.0)


def meshio_su2(path):
    mesh = meshio.read(path)
    check_mesh(mesh.points, mesh.cells_dict["triangle"])
    equal("markers", blocks(mesh, "line", "su2:tag"), BOUNDARY)


def numpy_npz(path):
    mesh = numpy.load(path)
    expected = plate()
    equal("arrays", sorted(mesh.files), sorted(expected))
    for name, values in expected.items():
        equal(f"{name} are the same", bool((mesh[name] == values).all()), True)
    equal("types", {n: mesh[n].dtype.str for n in mesh.files},
          {"points": "<f8", "triangles": "<u4", "regions": "<i4", "edges": "<u4",
           "edge_markers": "<i4"})


def shapely_geojson(path):
    with open(path) as file:
        features = json.load(file)["features"]
    shapes = [(shapely.geometry.shape(f["geometry"]), f["properties"]) for f in features]
    polygons = [(s, p["region"]) for s, p in shapes if s.geom_type == "Polygon"]
    lines = [(s, p["marker"]) for s, p in shapes if s.geom_type == "LineString"]
    equal("regions", tally(r for _, r in polygons), REGIONS)
    equal("markers", tally(m for _, m in lines), MARKERS)
    whole = shapely.ops.unary_union([s for s, _ in polygons])
    equal("area and hole", (whole.area, shapely.geometry.Polygon(whole.interiors[0]).area),
          (AREA, 16.0))


def meshio_surface(path):
    mesh = meshio.read(path)
    check_mesh(mesh.points, mesh.cells_dict["triangle"])


def meshio_stl(path):
    mesh = meshio.read(path)
    equal("triangles", len(mesh.cells_dict["triangle"]), TRIANGLES)
    equal("area", area(mesh.points, mesh.cells_dict["triangle"]), AREA)


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


SECOND = ["--order", "2"]
CHECKS = [  # file, flags of weft convert, reader, check
    ("plate.vtu", [], VTK, vtk_vtu),
    ("plate.vtu", [], MESHIO, meshio_vtu),
    ("plate2.vtu", SECOND, VTK, vtk_vtu_2),
    ("plate2.vtu", SECOND, MESHIO, meshio_2),
    ("plate.msh", [], GMSH, gmsh_msh),
    ("plate.msh", [], MESHIO, meshio_msh),
    ("plate2.msh", SECOND, GMSH, gmsh_msh_2),
    ("plate2.msh", SECOND, MESHIO, meshio_2),
    ("plate22.msh", ["--msh-version", "2.2"], GMSH, gmsh_msh),
    ("plate22.msh", ["--msh-version", "2.2"], MESHIO, meshio_msh),
    ("plate222.msh", ["--msh-version", "2.2", *SECOND], GMSH, gmsh_msh_2),
    ("plate222.msh", ["--msh-version", "2.2", *SECOND], MESHIO, meshio_2),
    ("plate.node", [], NUMPY, numpy_node),
    ("plate2.node", SECOND, NUMPY, numpy_node_2),
    ("plate.edge", [], NUMPY, numpy_edge),
    ("plate.neigh", [], NUMPY, numpy_neigh),
    ("fort.14", ["--open-boundary", "2"], NUMPY, numpy_adcirc),
    ("plate.grd", ["--open-boundary", "2"], NUMPY, numpy_adcirc),
    ("plate.su2", [], MESHIO, meshio_su2),
    ("plate.npz", [], NUMPY, numpy_npz),
    ("plate.geojson", [], SHAPELY, shapely_geojson),
    ("plate.obj", [], MESHIO, meshio_surface),
    ("plate.obj", [], VTK, vtk_surface(vtk.vtkOBJReader())),
    ("plate.off", [], MESHIO, meshio_surface),
    ("plate.ply", [], MESHIO, meshio_surface),
    ("plate.ply", [], VTK, vtk_surface(vtk.vtkPLYReader())),
    ("plate.stl", [], MESHIO, meshio_stl),
    ("plate.stl", [], VTK, vtk_surface(vtk.vtkSTLReader())),
]


def main():
    weft, docs = sys.argv[1:]
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        source = os.path.join(folder, "source.npz")
        numpy.savez_compressed(source, **plate())
        for name, flags, reader, check in CHECKS:
            path = os.path.join(folder, name)
            if not os.path.exists(path):
                subprocess.run([weft, "convert", source, path, "--quiet", *flags], check=True)
            row = f"| `{' '.join([os.path.splitext(name)[1], *flags])}` | {reader} |"
            print(row, flush=True)
            rows.append(row)
            check(path)
    format_table.check(docs, "| written by weft | read by |", rows)
    usage = subprocess.run([weft, "convert", "--help"], check=True, capture_output=True, text=True).stdout
    written = re.search(r"^  OUT .*? Mesh: ([^;]*)", usage, re.M)[1].split(", ")
    equal("formats that weft writes", sorted({os.path.splitext(c[0])[1] for c in CHECKS}),
          sorted(written))


main()
