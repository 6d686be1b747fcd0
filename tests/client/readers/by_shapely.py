# SPDX-License-Identifier: Apache-2.0
"""What shapely makes of polygons: of GeoJSON, and of the cells of MODFLOW."""

import json
import os
import re
import subprocess

import numpy
import shapely.geometry
import shapely.ops

from readers.by_vtk import exodus_grids
from readers.plate import AREA, MARKERS, NAMES, REGIONS, VERTICES, check_bed, equal, tally


def disv_cells(path):
    """centres, polygons and tops, by the format's rules."""
    blocks = {}
    for name, body in re.findall(r"BEGIN (\w+)\n(.*?)END \1", open(path).read(), re.S):
        blocks[name] = [line.split() for line in body.splitlines() if line.strip()]
    sizes = {name: int(value) for name, value in blocks["DIMENSIONS"]}
    corners = numpy.array(blocks["VERTICES"], float)
    equal("numbers of vertices", corners[:, 0].tolist(), list(range(1, sizes["NVERT"] + 1)))
    cells = blocks["CELL2D"]
    equal("numbers of cells", [int(c[0]) for c in cells], list(range(1, sizes["NCPL"] + 1)))
    equal("counts of vertices", [int(c[3]) for c in cells], [len(c) - 4 for c in cells])
    polygons = [corners[numpy.array(c[4:], int) - 1, 1:] for c in cells]
    return numpy.array([c[1:3] for c in cells], float), polygons, blocks["GRIDDATA"]


def check_partition(centres, polygons, whole):
    """Clockwise cells that cover the domain, a polygon of shapely, do not overlap, and are those of
    the nearest centres."""
    shapes = [shapely.geometry.Polygon(p) for p in polygons]
    equal("cells are valid", all(s.is_valid for s in shapes), True)
    equal("cells are clockwise",
          any(shapely.geometry.LinearRing(p).is_ccw for p in polygons), False)
    close = lambda a, b: abs(a - b) < 1e-9 * whole.area
    equal("area", close(sum(s.area for s in shapes), whole.area), True)
    together = shapely.ops.unary_union(shapes)
    equal("no overlaps", close(together.area, whole.area), True)
    equal("cells are in the domain", close(together.intersection(whole).area, whole.area), True)
    equal("centres are in their cells",
          all(s.distance(shapely.geometry.Point(c)) < 1e-9 for s, c in zip(shapes, centres)), True)


def shapely_disv(path):
    centres, polygons, griddata = disv_cells(path)
    equal("cells", len(polygons), VERTICES)
    whole = shapely.geometry.box(0, 0, 12, 12) - shapely.geometry.box(4, 4, 8, 8)
    check_partition(centres, polygons, whole)
    equal("cells inside are squares", sum(len(p) == 4 and shapely.geometry.Polygon(p).area == 1
                                          for p in polygons), VERTICES - 64)
    top = griddata[2:2 + VERTICES]
    check_bed(centres, [float(value) for value, in top])


def check_models(weft, folder):
    """Meshes that weft made: Voronoi cells of narrow places, and of triangles that are obtuse at the
    boundary."""
    models = os.path.join(os.path.dirname(__file__), "..", "..", "models")
    for model in ("key.poly", "pipe.poly", "cylinder.poly"):
        disv, exo, npz = (os.path.join(folder, model + end) for end in (".disv", ".exo", ".npz"))
        subprocess.run([weft, "mesh", os.path.join(models, model), "-o", disv, "-o", exo, "-o", npz,
                        "--quiet"], check=True)
        mesh = numpy.load(npz)
        # Ids of Exodus are positive, that of the only region is 0.
        equal("regions", {name: grid.GetNumberOfCells() for name, grid in
                          exodus_grids(exo, "element").items()}, {"region 0": len(mesh["triangles"])})
        centres, polygons, _ = disv_cells(disv)
        equal(f"centres of {model}", centres.tolist(), mesh["points"].tolist())
        whole = shapely.ops.unary_union([shapely.geometry.Polygon(mesh["points"][t])
                                         for t in mesh["triangles"]])
        check_partition(centres, polygons, whole)


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


def shapely_names(path):
    features = json.load(open(path))["features"]
    for kind, table in (("marker", NAMES[1]), ("region", NAMES[2])):
        equal("names", {(p[kind], p[f"{kind}_name"]) for p in (f["properties"] for f in features)
                        if f"{kind}_name" in p}, set(table.items()))
