# SPDX-License-Identifier: Apache-2.0
"""Has `weft convert` read domains that programs of others wrote, and compares what it makes of them
with what was meant; prints a row for every format and writer. DOCS, docs/formats.md, must have these.

    read_others.py WEFT DOCS

The domain: a plate of 12 x 12 with a hole of 4 x 4 in the middle and, beside it, a triangle. The
.poly file that comes out is judged by shapely: the faces between its segments, less those with a
seed of a hole, are the domain.

Needs Debian's python3-gmsh, python3-numpy, python3-pyshp and python3-shapely.
"""

import os
import subprocess
import sys
import tempfile

import gmsh
import numpy
import shapefile
import shapely
import shapely.wkt
from shapely.geometry import LineString, MultiPolygon, Point, Polygon
from shapely.ops import polygonize, unary_union

import format_table

OUTER = [(0, 0), (12, 0), (12, 12), (0, 12)]
HOLE = [(4, 4), (4, 8), (8, 8), (8, 4)]
BESIDE = [(20, 0), (24, 0), (20, 4)]
PLATE = Polygon(OUTER, [HOLE])
AREA = PLATE.area + Polygon(BESIDE).area


def equal(what, found, expected):
    if found != expected:
        sys.exit(f"{what}: found {found}, expected {expected}")


def read_poly(path):
    """points, segments with markers, holes, regions"""
    lines = iter(open(path).read().splitlines())
    sections = []
    for _ in range(4):
        count = int(next(lines).split()[0])
        sections.append([[float(w) for w in next(lines).split()[1:]] for _ in range(count)])
    return sections


def check(path, markers=None, regions=None):
    points, segments, holes, seeds = read_poly(path)
    lines = [LineString([points[int(a) - 1], points[int(b) - 1]]) for a, b, _ in segments]
    faces = list(polygonize(unary_union(lines)))
    filled = [f for f in faces if not any(f.contains(Point(h)) for h in holes)]
    equal("area", round(sum(f.area for f in filled), 9), AREA)
    if markers is not None:
        found = {int(m) for _, _, m in segments}
        equal("markers", found, markers)
    if regions is not None:
        found = {int(r): round(sum(f.area for f in filled if f.contains(Point(x, y))), 9)
                 for x, y, r, _ in seeds}
        equal("areas of regions", found, regions)


def write_wkt(path):
    with open(path, "w") as file:
        file.write(shapely.wkt.dumps(MultiPolygon([PLATE, Polygon(BESIDE)])))


def write_shapefile(path):
    with shapefile.Writer(path) as writer:
        writer.field("marker", "N", 9)
        writer.field("region", "N", 9)
        writer.poly([OUTER[::-1], HOLE[::-1]])
        writer.record(3, 7)
        writer.poly([BESIDE[::-1]])
        writer.record(4, 8)


def write_csv(path):
    rows = [(ring, x, y, ring * 10) for ring, points in enumerate((OUTER, HOLE, BESIDE), start=1)
            for x, y in points]
    numpy.savetxt(path, rows, fmt=["%d", "%.18g", "%.18g", "%d"], delimiter=",",
                  header="ring,x,y,marker", comments="")


def gmsh_model(triangles, version, binary=0):
    """Physical curves 5, around the plate, and 6, around the triangle; the hole has none if the
    triangles tell of it. Physical surfaces 7 and 8."""
    def write(path):
        gmsh.initialize(["gmsh", "-v", "2"])
        gmsh.option.setNumber("Mesh.MshFileVersion", version)
        gmsh.option.setNumber("Mesh.Binary", binary)
        geo = gmsh.model.geo

        def loop(points):
            corners = [geo.addPoint(x, y, 0, 2.5) for x, y in points]
            return [geo.addLine(a, b) for a, b in zip(corners, corners[1:] + corners[:1])]

        outer, hole, beside = loop(OUTER), loop(HOLE), loop(BESIDE)
        loops = [geo.addCurveLoop(curves) for curves in (outer, hole, beside)]
        surfaces = [geo.addPlaneSurface(loops[:2]), geo.addPlaneSurface(loops[2:])]
        geo.synchronize()
        gmsh.model.addPhysicalGroup(1, outer, 5)
        gmsh.model.addPhysicalGroup(1, beside, 6)
        if triangles:
            for tag, surface in zip((7, 8), surfaces):
                gmsh.model.addPhysicalGroup(2, [surface], tag)
        gmsh.model.mesh.generate(2 if triangles else 1)
        gmsh.write(path)
        gmsh.finalize()
    return write


GMSH = f"Gmsh {gmsh.__version__}"
REGIONS = {7: PLATE.area, 8: 8.0}
CASES = [  # file, kind, writer, what writes, what is expected
    ("d.wkt", "", f"shapely {shapely.__version__}", write_wkt, {}),
    ("d.shp", "", f"pyshp {shapefile.__version__}", write_shapefile,
     {"markers": {3, 4}, "regions": REGIONS}),
    ("d.csv", "", f"numpy {numpy.__version__}", write_csv, {"markers": {10, 20, 30}}),
    ("d41.msh", " 4.1, text", GMSH, gmsh_model(True, 4.1), {"markers": {0, 5, 6}, "regions": REGIONS}),
    ("d41b.msh", " 4.1, binary", GMSH, gmsh_model(True, 4.1, 1), {"markers": {0, 5, 6}, "regions": REGIONS}),
    ("d22.msh", " 2.2, text", GMSH, gmsh_model(True, 2.2), {"markers": {0, 5, 6}, "regions": REGIONS}),
    ("d22b.msh", " 2.2, binary", GMSH, gmsh_model(True, 2.2, 1), {"markers": {0, 5, 6}, "regions": REGIONS}),
]


def lines_only(weft, folder):
    """Without triangles every bounded face is filled: the hole has no group, so it is not there."""
    path, poly = (os.path.join(folder, name) for name in ("lines.msh", "lines.poly"))
    gmsh_model(False, 4.1)(path)
    subprocess.run([weft, "convert", path, poly, "--quiet"], check=True)
    points, segments, holes, _ = read_poly(poly)
    lines = [LineString([points[int(a) - 1], points[int(b) - 1]]) for a, b, _ in segments]
    equal("areas of faces", sorted(round(f.area, 9) for f in polygonize(unary_union(lines))), [8.0, 144.0])
    equal("holes", holes, [])
    equal("markers", {int(m) for _, _, m in segments}, {5, 6})


def main():
    weft, docs = sys.argv[1:]
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        for name, kind, writer, write, expected in CASES:
            path = os.path.join(folder, name)
            write(path)
            poly = path + ".poly"
            subprocess.run([weft, "convert", path, poly, "--quiet"], check=True)
            row = f"| `{os.path.splitext(name)[1]}`{kind} | {writer} |"
            print(row, flush=True)
            rows.append(row)
            check(poly, **expected)
        lines_only(weft, folder)
    format_table.check(docs, "| read by weft | written by |", rows)


main()
