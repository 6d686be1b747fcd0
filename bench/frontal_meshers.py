# SPDX-License-Identifier: GPL-3.0-or-later
"""weft beside frontal meshers, which aim at edges of a given length and not at a bound: Gmsh's frontal
Delaunay (python3-gmsh) and JIGSAW's (its program, of https://github.com/dengwirda/jigsaw), on one thread.
Their edges are h where weft's triangles are bounded by sqrt(3)/4 h^2. Each mesh is judged here from its
points and triangles alone. Prints the table of bench/README.md.

    PYTHONPATH=build/release/python WEFT_WEFTD=build/release/weftd python3 bench/frontal_meshers.py JIGSAW [CASE]
"""

import dataclasses
import math
import pathlib
import re
import resource
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable

import gmsh
import numpy as np
import shapely.geometry
import shapely.ops
import weft

RUNS = 3
MODELS = pathlib.Path(__file__).parents[1] / "tests/models"
GRID = 1001  # nodes of JIGSAW's size along the longer side
EQUILATERAL = math.sqrt(3) / 4


@dataclasses.dataclass
class Case:
    """A domain and a size. Edges of JIGSAW are taken from `bound`."""

    name: str
    model: str
    size: str  # the bound, for weft
    bound: Callable  # the same of arrays
    fields: list  # the edges for Gmsh, the least of these fields: kind and options of each


def length(bound):
    return math.sqrt(bound / EQUILATERAL)


CASES = [
    Case("cylinder, stepped", "cylinder", "(x>=0 && abs(y)<5) || (x<0 && x^2+y^2<25) ? 0.0012 : 0.01",
         lambda x, y: np.where(np.where(x >= 0, np.abs(y) < 5, x**2 + y**2 < 25), 0.0012, 0.01),
         [("Box", {"VIn": length(0.0012), "VOut": length(0.01), "XMin": 0, "XMax": 45, "YMin": -5, "YMax": 5,
                   "ZMin": -1, "ZMax": 1}),
          ("Ball", {"VIn": length(0.0012), "VOut": length(0.01), "Radius": 5})]),
    Case("pipe, smooth", "pipe", "(0.4*sqrt((x-200)^2+(y-200)^2)+1)/300",
         lambda x, y: (0.4 * np.hypot(x - 200, y - 200) + 1) / 300,
         [("MathEval", {"F": f"Sqrt((0.4*Sqrt((x-200)^2+(y-200)^2)+1)/{300 * EQUILATERAL!r})"})]),
    Case("coast, 1e-3", "us-east-coast", "1e-3", lambda x, y: np.full_like(x, 1e-3),
         [("MathEval", {"F": repr(length(1e-3))})]),
    Case("key", "key", "0.02*abs(y-46)+0.1", lambda x, y: 0.02 * np.abs(y - 46) + 0.1,
         [("MathEval", {"F": f"Sqrt((0.02*Abs(y-46)+0.1)/{EQUILATERAL!r})"})]),
]


@dataclasses.dataclass
class Made:
    points: np.ndarray  # (n, 2)
    triangles: np.ndarray  # (m, 3)
    seconds: float  # of the processor


def processor_seconds(process):
    tasks = pathlib.Path(f"/proc/{process}/task").glob("*/schedstat")
    return sum(int(task.read_text().split()[0]) for task in tasks) / 1e9


def by_weft(client, weftd, domain, case, placement):
    """Counts all of weftd, its sending, too."""
    start = processor_seconds(weftd)
    mesh = client.mesh(domain, size=case.size, placement=placement, threads=1, no_cache=True)
    return Made(mesh.points, mesh.triangles, processor_seconds(weftd) - start)


def by_gmsh(faces, case):
    gmsh.initialize(["gmsh", "-nt", "1", "-v", "1"])
    geo = gmsh.model.geo
    numbers = {}

    def loop(ring):
        ends = [numbers.setdefault(p, len(numbers) + 1) for p in ring.coords[:-1]]
        for number, p in zip(ends, ring.coords):
            geo.addPoint(*p, 0, tag=number)
        return geo.addCurveLoop([geo.addLine(a, b) for a, b in zip(ends, ends[1:] + ends[:1])])

    for face in faces:
        geo.addPlaneSurface([loop(face.exterior), *map(loop, face.interiors)])
    geo.synchronize()
    tags = []
    for kind, options in case.fields:
        tags.append(gmsh.model.mesh.field.add(kind))
        for option, value in options.items():
            if option == "F":
                gmsh.model.mesh.field.setString(tags[-1], option, value)
            else:
                gmsh.model.mesh.field.setNumber(tags[-1], option, value)
    least = gmsh.model.mesh.field.add("Min")
    gmsh.model.mesh.field.setNumbers(least, "FieldsList", tags)
    gmsh.model.mesh.field.setAsBackgroundMesh(least)
    for option in ("FromPoints", "FromCurvature", "ExtendFromBoundary"):
        gmsh.option.setNumber(f"Mesh.MeshSize{option}", 0)
    gmsh.option.setNumber("Mesh.Algorithm", 6)
    start = time.process_time()
    gmsh.model.mesh.generate(2)
    seconds = time.process_time() - start
    nodes, places, _ = gmsh.model.mesh.getNodes()
    _, corners = gmsh.model.mesh.getElementsByType(2)
    gmsh.finalize()
    index = np.zeros(int(nodes.max()) + 1, np.int64)
    index[nodes] = np.arange(len(nodes))
    return Made(places.reshape(-1, 3)[:, :2], index[corners].reshape(-1, 3), seconds)


def table_of(text, name, columns):
    """The numbers of a section of JIGSAW's .msh."""
    head = re.search(rf"^{name}=(\d+)\s*\n", text, re.M)
    values = np.fromstring(text[head.end():].split("=", 1)[0].rsplit("\n", 1)[0].replace(";", " "), sep=" ")
    return values.reshape(int(head[1]), columns)


def by_jigsaw(program, domain, case, options=""):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        with open(folder / "domain.msh", "w") as out:
            print("MSHID=3;EUCLIDEAN-MESH\nNDIMS=2", file=out)
            print(f"POINT={len(domain.points)}", *(f"{x!r};{y!r};0" for x, y in domain.points.tolist()),
                  f"EDGE2={len(domain.segments)}", *(f"{a};{b};0" for a, b in domain.segments.tolist()),
                  sep="\n", file=out)
        low, high = domain.points.min(axis=0), domain.points.max(axis=0)
        counts = np.ceil((high - low) / (high - low).max() * (GRID - 1)).astype(int) + 1
        x, y = (np.linspace(low[k], high[k], counts[k]) for k in (0, 1))
        with open(folder / "size.msh", "w") as out:  # the second coordinate varies first
            print("MSHID=3;EUCLIDEAN-GRID\nNDIMS=2", file=out)
            for k, at in enumerate((x, y), 1):
                print(f"COORD={k};{len(at)}", *map(repr, at.tolist()), sep="\n", file=out)
            h = np.sqrt(case.bound(*np.meshgrid(x, y, indexing="ij")) / EQUILATERAL)
            print(f"VALUE={h.size};1", *map(repr, h.ravel().tolist()), sep="\n", file=out)
        (folder / "run.jig").write_text(
            f"GEOM_FILE={folder}/domain.msh\nHFUN_FILE={folder}/size.msh\nMESH_FILE={folder}/mesh.msh\n"
            f"HFUN_SCAL=ABSOLUTE\nHFUN_HMAX={float(h.max())!r}\nMESH_DIMS=2\nMESH_KERN=DELFRONT\nGEOM_FEAT=TRUE\n"
            f"MESH_TOP1=TRUE\nNUMTHREAD=1\nVERBOSITY=1\n{options}")
        start = resource.getrusage(resource.RUSAGE_CHILDREN)
        log = subprocess.run([program, folder / "run.jig"], capture_output=True, text=True, check=True).stdout
        end = resource.getrusage(resource.RUSAGE_CHILDREN)
        stages = [(stage.lstrip(), float(re.search(r"Done\.\s+\((\S+)sec\)", stage)[1]))
                  for stage in re.split(r"#-{70,}\n\n", log) if "Done." in stage]
        meshing = sum(took for stage, took in stages if not stage.startswith(("Reading", "Writing")))
        seconds = (end.ru_utime + end.ru_stime - start.ru_utime - start.ru_stime) * (
            meshing / sum(took for _, took in stages))
        mesh = (folder / "mesh.msh").read_text()
        return Made(table_of(mesh, "POINT", 3)[:, :2], table_of(mesh, "TRIA3", 4)[:, :3].astype(int), seconds)


def row(case, what, made, least, weft_seconds):
    mesh = made[0]
    corners = mesh.points[mesh.triangles]
    sides = np.roll(corners, -1, axis=1) - corners
    areas = np.abs(sides[:, 0, 0] * sides[:, 1, 1] - sides[:, 0, 1] * sides[:, 1, 0]) / 2
    squares = (sides**2).sum(axis=2)
    # The angle between sides i and i + 1: a dot product over a cross product.
    angles = np.degrees(np.arctan2(2 * areas[:, None], -(sides * np.roll(sides, -1, axis=1)).sum(axis=2)))
    smallest = angles.min(axis=1)
    over = areas / case.bound(*corners.mean(axis=1).T)
    seconds = statistics.median(m.seconds for m in made)
    times = seconds / weft_seconds
    print(f"| {case.name} | {what} | {len(areas)} | {len(areas) / least:.3f} "
          f"| {(16 * EQUILATERAL * areas / squares.sum(axis=1)).mean():.3f} | {np.percentile(smallest, 1):.1f} "
          f"| {smallest.min():.1f} | {angles.max():.0f} | {100 * (over > 1 + 1e-6).mean():.0f} % | {over.max():.2f} "
          f"| {seconds:.3g} | {times:.{0 if times >= 10 else 1}f} |", flush=True)


def main():
    program, only = sys.argv[1], sys.argv[2] if len(sys.argv) > 2 else ""
    print("| domain, size | mesher | triangles | over the least | quality | 1st percentile | least angle "
          "| largest | over the bound | worst | s | times weft |\n" + "|---" * 12 + "|")
    for case in CASES:
        if only not in case.name:
            continue
        domain = weft.Domain.read(MODELS / f"{case.model}.poly")
        faces = shapely.ops.polygonize(domain.points[domain.segments])
        carved = shapely.geometry.MultiPoint(domain.holes)
        faces = [face for face in faces if not face.intersects(carved)]
        made = {placement: [] for placement in ("lattice", "circumcentre")}
        with weft.LocalServer() as server, weft.Client(server.target) as client:
            weftd = server._process.pid
            first = client.mesh(domain, size=case.size, threads=1)  # and the server's first pages
            for placement, meshes in list(made.items()) * RUNS:
                meshes.append(by_weft(client, weftd, domain, case, placement))
        least = len(first.triangles) / first.summary.ideal_ratio
        ours = statistics.median(m.seconds for m in made["lattice"])
        for placement, meshes in made.items():
            row(case, f"weft, {placement}", meshes, least, ours)
        row(case, "Gmsh", [by_gmsh(faces, case) for _ in range(RUNS)], least, ours)
        row(case, "JIGSAW", [by_jigsaw(program, domain, case) for _ in range(RUNS)], least, ours)
        row(case, "JIGSAW, not optimised",
            [by_jigsaw(program, domain, case, "OPTM_ITER=0\n") for _ in range(RUNS)], least, ours)


if __name__ == "__main__":
    main()
