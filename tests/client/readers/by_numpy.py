# SPDX-License-Identifier: Apache-2.0
"""What is so plain that numpy reads it: text of numbers, and arrays."""

import re

import numpy
import shapely.geometry

from readers.plate import (BOUNDARY, EDGES, MARKERS, NAMES, REGIONS, SIDES, TRIANGLES, VERTICES,
                           check_bed, check_mesh, check_midsides, check_parts, equal, plate, tally)


def rows(path, skip=1):
    """numpy's reading of a text file of numbers with a line of counts on top."""
    return numpy.loadtxt(path, skiprows=skip)


def numpy_node(path):
    nodes, elements = rows(path), rows(path.replace(".node", ".ele"))
    check_mesh(nodes[:, 1:3], elements[:, 1:4].astype(int) - 1)
    equal("regions", tally(elements[:, 4]), REGIONS)
    segments = numpy.loadtxt(path.replace(".node", ".poly"), skiprows=2, max_rows=EDGES)
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


def numpy_adcirc_bed(path):
    """ADCIRC's depths are positive down."""
    numpy_adcirc(path)
    nodes = numpy.loadtxt(open(path).readlines()[2:2 + VERTICES])
    check_bed(nodes[:, 1:3], nodes[:, 3], sign=-1)


def numpy_2dm(path):
    """Node strings, which QGIS does not read: along the boundary, the last node negative, a marker."""
    lines = [line.split() for line in open(path)]
    strings, nodes = [], []
    for line in lines:
        if line[0] != "NS":
            continue
        numbers = [int(word) for word in line[1:]]
        end = next((i for i, n in enumerate(numbers) if n < 0), None)
        nodes += numbers if end is None else numbers[:end]
        if end is not None:
            strings.append(([*nodes, -numbers[end]], numbers[end + 1]))
            nodes = []
    equal("left over", nodes, [])
    equal("edges of the boundary", {m: len(n) - 1 for n, m in strings},
          {m: n for m, n in MARKERS.items() if m != 9})
    equal("strings", len(strings), 5)
    points = numpy.array([line[2:4] for line in lines if line[0] == "ND"], float)
    for string, marker in strings:
        steps = numpy.diff(points[numpy.array(string) - 1], axis=0)
        equal(f"steps of string {marker}", bool((abs(steps).sum(axis=1) == 1).all()), True)


def numpy_selafin(path):
    """Records of Fortran. The boundary, which QGIS does not read, is numbered around the outside
    counter-clockwise, then around the hole clockwise."""
    data, records = open(path, "rb").read(), []
    while data:
        size = int.from_bytes(data[:4], "big")
        records.append(data[4:4 + size])
        equal("end of record", data[4 + size:8 + size], data[:4])
        data = data[8 + size:]
    title, counts, name, dates, sizes, triangles, boundary, x, y, time, bed = records
    equal("title", title[72:], b"SERAFIND")
    equal("counts", numpy.frombuffer(counts, ">i4").tolist(), [1, 0])
    equal("variable", name, b"BOTTOM".ljust(16) + b"M".ljust(16))
    equal("sizes", numpy.frombuffer(sizes, ">i4").tolist(), [TRIANGLES, VERTICES, 3, 1])
    points = numpy.column_stack([numpy.frombuffer(v, ">f8") for v in (x, y)])
    check_mesh(points, numpy.frombuffer(triangles, ">i4").reshape(-1, 3) - 1)
    check_bed(points, numpy.frombuffer(bed, ">f8"))
    numbers = numpy.frombuffer(boundary, ">i4")
    ring = points[numpy.argsort(numbers)[(numbers == 0).sum():]]
    equal("numbers", sorted(numbers[numbers > 0].tolist()), list(range(1, 65)))
    areas = [shapely.geometry.LinearRing(r) for r in (ring[:48], ring[48:])]
    equal("outside, hole", [(r.is_ccw, r.length) for r in areas], [(True, 48.0), (False, 16.0)])


def numpy_parts(path):
    check_parts(numpy.load(path)["parts"])


def numpy_rcm(path):
    """The plate is 12 wide, and its sides are 4 wide beside the hole."""
    file = numpy.load(path)
    check_mesh(file["points"], file["triangles"])
    triangles = file["triangles"].astype(int)
    bandwidth = int((triangles.max(axis=1) - triangles.min(axis=1)).max())
    equal("bandwidth at most 14", (bandwidth, bandwidth <= 14), (bandwidth, True))


def numpy_npz(path):
    mesh = numpy.load(path)
    expected = plate()
    equal("arrays", sorted(mesh.files), sorted(expected))
    for name, values in expected.items():
        equal(f"{name} are the same", bool((mesh[name] == values).all()), True)
    equal("types", {n: mesh[n].dtype.str for n in mesh.files},
          {"points": "<f8", "triangles": "<u4", "regions": "<i4", "edges": "<u4",
           "edge_markers": "<i4"})


def numpy_node_names(path):
    """Names are comments, which do not disturb."""
    numpy_node(path)
    found = {1: {}, 2: {}}
    for kind, number, name in re.findall(r"^# (marker|region)=(\d+):(.*)$",
                                         open(path.replace(".node", ".poly")).read(), re.M):
        found[{"marker": 1, "region": 2}[kind]][int(number)] = name
    equal("names", found, NAMES)


def numpy_2dm_names(path):
    lines = open(path).read().splitlines()
    equal("materials", [l for l in lines if l.startswith("MAT")], ['MAT 3 "fluid"'])
    equal("node strings", sorted(re.findall(r'^NS.* -\d+ (.*)$', "\n".join(lines), re.M)),
          sorted(["1", '2 "inlet"', "3", '4 "outer wall"', "5"]))


def numpy_npz_names(path):
    with numpy.load(path) as file:
        for kind, table in (("marker", NAMES[1]), ("region", NAMES[2])):
            equal("names", dict(zip(file[f"{kind}_ids"].tolist(), file[f"{kind}_names"].tolist())),
                  table)


def mfem_file(path):
    """A mesh by MFEM's definition of its formats: the version, the vertices, the elements and the boundary
    as rows of numbers, and the sets of attributes of both by name. MFEM itself passes over what stands
    behind a name on its line."""
    lines = (line.strip() for line in open(path))
    lines = iter([line for line in lines if line and not line.startswith("#")])
    version = re.fullmatch(r"MFEM mesh v(1\.[03])", next(lines))[1]

    def section(name, read):
        equal("section", next(lines), name)
        return [read() for _ in range(int(next(lines)))]

    def numbers(kind=int):
        return [kind(word) for word in next(lines).split()]

    def attribute_set():
        name = re.fullmatch('"(.*)"', next(lines))[1]
        return name, [int(next(lines)) for _ in range(int(next(lines)))]

    has_sets = version == "1.3"
    equal("dimension", (next(lines), next(lines)), ("dimension", "2"))
    elements = section("elements", numbers)
    sets = section("attribute_sets", attribute_set) if has_sets else []
    boundary = section("boundary", numbers)
    boundary_sets = section("bdr_attribute_sets", attribute_set) if has_sets else []
    equal("section", next(lines), "vertices")
    count = int(next(lines))
    equal("space dimension", next(lines), "2")
    points = [numbers(float) for _ in range(count)]
    equal("the end", list(lines), ["mfem_mesh_end"] if has_sets else [])
    return points, numpy.array(elements), numpy.array(boundary), dict(boundary_sets), dict(sets)


def numpy_mfem(path, names=({}, {})):
    points, elements, boundary, *sets = mfem_file(path)
    equal("kinds", (set(elements[:, 1]), set(boundary[:, 1])), ({2}, {1}))  # triangles, segments
    check_mesh(points, elements[:, 2:])
    equal("attributes", tally(elements[:, 0]), REGIONS)
    equal("boundary attributes", tally(boundary[:, 0]), MARKERS)
    equal("sets", sets, [{name: [number] for number, name in table.items()} for table in names])


def numpy_mfem_names(path):
    numpy_mfem(path, (NAMES[1], NAMES[2]))
