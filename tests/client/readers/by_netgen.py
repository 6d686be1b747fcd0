# SPDX-License-Identifier: Apache-2.0
"""What Netgen reads, and with it NGSolve."""

import collections

from netgen import meshing

from readers.plate import MARKERS, NAMES, REGIONS, check_mesh, equal

meshing.SetMessageImportance(0)


def check(path, markers, regions):
    """`markers`, `regions`: the names of all that have none in the plate."""
    mesh = meshing.Mesh(dim=2)
    mesh.Load(path)
    points = [point.p for point in mesh.Points()]
    triangles = [[v.nr - 1 for v in element.vertices] for element in mesh.Elements2D()]
    check_mesh(points, triangles)
    named = collections.Counter(mesh.GetMaterial(element.index) for element in mesh.Elements2D())
    equal("domains", named, {regions.get(r, f"region_{r}"): n for r, n in REGIONS.items()})
    edges = list(mesh.Elements1D())
    named = collections.Counter(mesh.GetBCName(edge.index - 1) for edge in edges)
    equal("conditions", named, {markers.get(m, f"marker_{m}"): n for m, n in MARKERS.items()})
    corners = collections.defaultdict(set)  # of the domains on the left
    for element, corner in zip(mesh.Elements2D(), triangles):
        for k in range(3):
            corners[corner[k], corner[(k + 1) % 3]].add(element.index - 1)
    for edge in edges:
        a, b = (v.nr - 1 for v in edge.vertices)
        equal("domains on the left and right", tuple(edge.surfaces),
              (*corners[a, b], *(corners[b, a] or {-1})))


def netgen_vol(path):
    check(path, {}, {})


def netgen_names(path):
    check(path, {number: name.replace(" ", "_") for number, name in NAMES[1].items()}, NAMES[2])
