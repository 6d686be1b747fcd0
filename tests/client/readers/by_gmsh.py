# SPDX-License-Identifier: Apache-2.0
"""What Gmsh reads."""

import gmsh

from readers.plate import AREA, MARKERS, NAMES, REGIONS, SIDES, VERTICES, check_bed, equal


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


def gmsh_bed(path):
    gmsh.initialize(["gmsh", "-v", "2"])
    gmsh.open(path)
    tags, points, _ = gmsh.model.mesh.getNodes()
    points = dict(zip(tags.tolist(), points.reshape(-1, 3)))
    view, = gmsh.view.getTags()
    kind, nodes, values, _, components = gmsh.view.getModelData(view, 0)
    equal("kind of values", (kind, components, len(nodes)), ("NodeData", 1, len(points)))
    equal("name", gmsh.option.getString("View[0].Name"), "elevation")
    check_bed([points[n] for n in nodes], [v[0] for v in values])
    gmsh.finalize()


def gmsh_msh_2(path):
    gmsh_msh(path, order=2)


def gmsh_names(path):
    gmsh.initialize(["gmsh", "-v", "2"])
    gmsh.open(path)
    for dimension, names in NAMES.items():
        found = {tag: gmsh.model.getPhysicalName(dimension, tag)
                 for _, tag in gmsh.model.getPhysicalGroups(dimension)}
        equal("names", {tag: name for tag, name in found.items() if tag in names}, names)
    gmsh.finalize()
