# SPDX-License-Identifier: Apache-2.0
"""What meshio reads."""

import re

import meshio
import numpy

from readers.plate import (AREA, BOUNDARY, MARKERS, NAMES, REGIONS, SIDES, TRIANGLES, VERTICES,
                           area, check_bed, check_mesh, check_midsides, equal, tally)


def blocks(mesh, kind, name):
    values = [mesh.cell_data[name][i] for i, b in enumerate(mesh.cells) if b.type == kind]
    return tally(numpy.concatenate(values))


def meshio_vtu(path):
    mesh = meshio.read(path)
    check_mesh(mesh.points, mesh.cells_dict["triangle"])
    equal("regions", blocks(mesh, "triangle", "region"), REGIONS)
    equal("markers", blocks(mesh, "line", "marker"), MARKERS)


def meshio_2(path):
    mesh = meshio.read(path)
    equal("nodes", len(mesh.points), VERTICES + SIDES)
    equal("area", area(mesh.points, mesh.cells_dict["triangle6"]), AREA)
    check_midsides(mesh.points, mesh.cells_dict["triangle6"], [(0, 1), (1, 2), (2, 0)])
    check_midsides(mesh.points, mesh.cells_dict["line3"], [(0, 1)])


def meshio_bed(path):
    mesh = meshio.read(path)
    check_bed(mesh.points, numpy.ravel(mesh.point_data["elevation"]))


def meshio_msh(path):
    mesh = meshio.read(path)
    check_mesh(mesh.points, mesh.cells_dict["triangle"])
    equal("regions", blocks(mesh, "triangle", "gmsh:physical"), REGIONS)
    equal("markers", blocks(mesh, "line", "gmsh:physical"), MARKERS)


def meshio_exodus(path):
    mesh = meshio.read(path)
    triangles = numpy.concatenate([c.data for c in mesh.cells])
    check_mesh(mesh.points, triangles)
    check_bed(mesh.points, mesh.point_data["elevation"])


def meshio_exodus_2(path):
    mesh = meshio.read(path)
    cells = numpy.concatenate([c.data for c in mesh.cells])
    equal("kinds", {c.type for c in mesh.cells}, {"triangle6"})
    equal("nodes", len(mesh.points), VERTICES + SIDES)
    equal("area", area(mesh.points, cells), AREA)
    check_midsides(mesh.points, cells, [(0, 1), (1, 2), (2, 0)])


def meshio_su2(path):
    mesh = meshio.read(path)
    check_mesh(mesh.points, mesh.cells_dict["triangle"])
    equal("markers", blocks(mesh, "line", "su2:tag"), BOUNDARY)


def meshio_inp(path):
    mesh = meshio.read(path)
    check_mesh(mesh.points, mesh.cells_dict["triangle"])
    equal("regions", inp_sets(mesh.cell_sets, "region"), REGIONS)
    # Nodes of a marker: a line has one more than edges, the ring around the hole as many, and marker 9 is two lines.
    equal("nodes of markers", inp_sets(mesh.point_sets, "marker"),
          {marker: edges + {5: 0, 9: 2}.get(marker, 1) for marker, edges in MARKERS.items()})


def inp_sets(sets, kind):
    """How many elements or nodes the sets have, by the number that their names have."""
    return {int(name.removeprefix(kind + "_")): numpy.hstack(members).size for name, members in sets.items()}


def meshio_inp_names(path):
    mesh = meshio.read(path)
    check_mesh(mesh.points, mesh.cells_dict["triangle"])
    equal("regions", sorted(mesh.cell_sets), ["fluid", "region_7"])
    equal("markers", sorted(mesh.point_sets), ["inlet", "marker_1", "marker_3", "marker_5", "marker_9", "outer_wall"])


def meshio_surface(path):
    mesh = meshio.read(path)
    check_mesh(mesh.points, mesh.cells_dict["triangle"])


def meshio_stl(path):
    mesh = meshio.read(path)
    equal("triangles", len(mesh.cells_dict["triangle"]), TRIANGLES)
    equal("area", area(mesh.points, mesh.cells_dict["triangle"]), AREA)


def meshio_names(path):
    """Both of .msh and of .vtu, as meshio has Gmsh's physical names."""
    data = {name: tuple(value) for name, value in meshio.read(path).field_data.items()}
    for dimension, names in NAMES.items():
        for number, name in names.items():
            equal(name, data.get(name), (number, dimension))


def meshio_su2_names(path):
    tags = re.findall(r"MARKER_TAG= (.*)", open(path).read())
    equal("tags", sorted(tags), sorted(["1", "inlet", "3", "outer_wall", "5"]))
    check_mesh(*(lambda m: (m.points, m.cells_dict["triangle"]))(meshio.read(path)))


def meshio_medit(path):
    mesh = meshio.read(path)
    check_mesh(mesh.points, mesh.cells_dict["triangle"])
    equal("dimension", mesh.points.shape[1], 2)
    equal("regions", blocks(mesh, "triangle", "medit:ref"), REGIONS)
    equal("markers", blocks(mesh, "line", "medit:ref"), MARKERS)
