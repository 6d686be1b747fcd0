# SPDX-License-Identifier: Apache-2.0
"""The mesh that read_back.py writes in every format, and checks that those who read it share."""

import collections
import sys

import numpy

VERTICES, TRIANGLES, SIDES, AREA = 160, 256, 416, 128.0
REGIONS = {3: 128, 7: 128}
BOUNDARY = {1: 12, 2: 12, 3: 12, 4: 12, 5: 16}
MARKERS = {**BOUNDARY, 9: 8}
EDGES = sum(MARKERS.values())


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


def bed_file(path):
    """An ESRI ASCII grid of the elevation, whose cells are not centred at the nodes."""
    with open(path, "w") as file:
        file.write("ncols 15\nnrows 15\nxllcorner -1\nyllcorner -1\ncellsize 1\n")
        for row in reversed(range(15)):
            file.write(" ".join(str(c - 0.5 + 2 * (row - 0.5) - 100) for c in range(15)) + "\n")


def check_bed(points, values, sign=1):
    points, values = numpy.asarray(points), numpy.asarray(values)
    elevation = points[:, 0] + 2 * points[:, 1] - 100
    equal("bed", bool((values == sign * elevation).all()) and len(values) == len(elevation), True)


def check_parts(parts):
    """METIS's parts of the 256 triangles: each within a quarter of 64."""
    sizes = tally(parts)
    equal("parts", sorted(sizes), [0, 1, 2, 3])
    equal("sizes of the parts are alike", all(48 <= n <= 80 for n in sizes.values()), True)


NAMES = {1: {2: "inlet", 4: "outer wall"}, 2: {3: "fluid"}}  # by dimension


def names_of_source():
    """What the plate has besides in an archive of names."""
    return {f"{kind}_{what}": numpy.array(values)
            for kind, table in (("marker", NAMES[1]), ("region", NAMES[2]))
            for what, values in (("ids", list(table)), ("names", list(table.values())))}
