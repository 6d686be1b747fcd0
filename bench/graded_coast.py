# SPDX-License-Identifier: GPL-3.0-or-later
"""weft beside Gmsh on a graded coast: the US east coast in metres, edges of 500 m at the shore that grow by
0.15 per metre up to 20 km, by the exact distance to the segments in weft and by the fields Distance and
Threshold in Gmsh (python3-gmsh), whose distance is that to sampled points. On one thread. The size is
judged here, at every triangle, from its points and the distance, to 5 m. Prints the table of bench/README.md.

    PYTHONPATH=build/release/python WEFT_WEFTD=build/release/weftd python3 bench/graded_coast.py [NEAR]

NEAR: metres of the least edge, instead of 500.
"""

import pathlib
import statistics
import sys
import time

import gmsh
import numpy as np
import scipy.spatial
import weft
from weft._projection import Projection

COAST = pathlib.Path(__file__).parents[1] / "tests/models/us-east-coast.geojson"
NEAR, FAR, GROWTH = float(sys.argv[1]) if len(sys.argv) > 1 else 500.0, 20_000.0, 0.15
RUNS = 3
SAMPLES = 10  # metres


def by_weft(server, client, domain, edge, **options):
    """Seconds are those of the processor, of all of weftd, its sending, too."""
    def used():
        tasks = pathlib.Path(f"/proc/{server._process.pid}/task").glob("*/schedstat")
        return sum(int(task.read_text().split()[0]) for task in tasks) / 1e9

    start = used()
    mesh = client.mesh(domain, edge=edge, threads=1, no_cache=True, **options)
    return mesh.points, mesh.triangles, used() - start


def by_gmsh(domain, sampling):
    gmsh.initialize(["gmsh", "-nt", "1", "-v", "1"])
    geo, field = gmsh.model.geo, gmsh.model.mesh.field
    for i, (x, y) in enumerate(domain.points.tolist()):
        geo.addPoint(x, y, 0, tag=i + 1)
    lines = [geo.addLine(a + 1, b + 1) for a, b in domain.segments.tolist()]
    geo.addPlaneSurface([geo.addCurveLoop([lines[i] for i in ring]) for ring in rings_of(domain)])
    geo.synchronize()
    start = time.process_time()
    distance = field.add("Distance")
    field.setNumbers(distance, "CurvesList", lines)
    field.setNumber(distance, "NumPointsPerCurve", sampling)
    threshold = field.add("Threshold")
    for option, value in (("InField", distance), ("SizeMin", NEAR), ("SizeMax", FAR), ("DistMin", 0),
                          ("DistMax", (FAR - NEAR) / GROWTH)):
        field.setNumber(threshold, option, value)
    field.setAsBackgroundMesh(threshold)
    for option in ("FromPoints", "FromCurvature", "ExtendFromBoundary"):
        gmsh.option.setNumber(f"Mesh.MeshSize{option}", 0)
    gmsh.option.setNumber("Mesh.Algorithm", 6)
    gmsh.model.mesh.generate(2)
    seconds = time.process_time() - start
    nodes, places, _ = gmsh.model.mesh.getNodes()
    _, corners = gmsh.model.mesh.getElementsByType(2)
    gmsh.finalize()
    index = np.zeros(int(nodes.max()) + 1, np.int64)
    index[nodes] = np.arange(len(nodes))
    return places.reshape(-1, 3)[:, :2], index[corners].reshape(-1, 3), seconds


def rings_of(domain):
    """Segments of each ring, the outermost first; a segment ends where the next begins."""
    follows = dict(zip(domain.segments[:, 0].tolist(), range(len(domain.segments))))
    rings = []
    while follows:
        at, ring = next(iter(follows)), []
        while at in follows:
            ring.append(follows.pop(at))
            at = int(domain.segments[ring[-1], 1])
        rings.append(ring)

    def extent(ring):
        return np.ptp(domain.points[domain.segments[ring, 0], 0])

    return sorted(rings, key=extent, reverse=True)


def sampled(domain):
    """Points on the segments, SAMPLES metres apart: the distance to them is exact to SAMPLES / 2."""
    a, b = domain.points[domain.segments].transpose(1, 0, 2)
    counts = np.ceil(np.hypot(*(b - a).T) / SAMPLES).astype(int)
    which = np.repeat(np.arange(len(counts)), counts)
    first = np.repeat(np.cumsum(counts) - counts, counts)
    t = (np.arange(len(which)) - first) / counts[which]
    return a[which] + t[:, None] * (b - a)[which]


def row(what, made, shore, ours):
    points, triangles, _ = made[0]
    corners = points[triangles]
    sides = np.roll(corners, -1, axis=1) - corners
    areas = np.abs(sides[:, 0, 0] * sides[:, 1, 1] - sides[:, 0, 1] * sides[:, 1, 0]) / 2
    angles = np.degrees(np.arctan2(2 * areas[:, None], -(sides * np.roll(sides, -1, axis=1)).sum(axis=2)))
    wanted = np.minimum(NEAR + GROWTH * shore.query(corners.mean(axis=1))[0], FAR)
    ratio = np.sqrt(areas * 4 / np.sqrt(3)) / wanted
    seconds = statistics.median(m[2] for m in made)
    print(f"| {what} | {len(triangles)} | {ratio.mean():.3f} | {ratio.max():.2f} "
          f"| {100 * (ratio > 1.001).mean():.1f} % | {np.percentile(angles.min(axis=1), 1):.1f} "
          f"| {angles.min():.1f} | {seconds:.3g} | {seconds / ours:.{1 if seconds < 10 * ours else 0}f} "
          f"| {1e-6 * len(triangles) / seconds:.3f} |", flush=True)


def main():
    domain = Projection(weft.Domain.read(COAST), None, True).domain
    shore = scipy.spatial.cKDTree(sampled(domain))
    edge = f"min({NEAR} + {GROWTH}*coast, {FAR})"
    fields = {"coast": weft.distance()}
    print("| mesher | triangles | edge over that wanted, mean | largest | above | 1st percentile of angles "
          "| least | s | times weft | Mtri/s |\n" + "|---" * 10 + "|")
    with weft.LocalServer() as server, weft.Client(server.target) as client:
        by_weft(server, client, domain, edge, fields=fields)  # the server's first pages
        graded = [by_weft(server, client, domain, edge, fields=fields) for _ in range(RUNS)]
        ours = statistics.median(m[2] for m in graded)
        row("weft, `coast=distance`", graded, shore, ours)
        by_marker = [by_weft(server, client, domain, FAR, edge_at={0: NEAR}, gradation=GROWTH)
                     for _ in range(RUNS)]
        row("weft, `--edge-at`", by_marker, shore, ours)
        a, b = domain.points[domain.segments].transpose(1, 2, 0)
        area = abs((a[0] * b[1] - a[1] * b[0]).sum()) / 2
        same = np.sqrt(4 / np.sqrt(3) * area / len(graded[0][1]))
        constant = [by_weft(server, client, domain, same) for _ in range(RUNS)]
        row(f"weft, {same:.0f} m everywhere", constant, shore, ours)
    for sampling in (2, 20):
        row(f"Gmsh, {sampling} points a line", [by_gmsh(domain, sampling) for _ in range(RUNS)], shore, ours)


if __name__ == "__main__":
    main()
