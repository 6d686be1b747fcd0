# SPDX-License-Identifier: Apache-2.0
"""A part of a mesh anew, and meshes that are joined, by the program weft."""
import dataclasses

import numpy as np
import pytest
import weft

SQUARE = weft.Domain([(0, 0), (4, 0), (4, 4), (0, 4)], [(0, 1), (1, 2), (2, 3), (3, 0)], [1, 2, 3, 4],
                     marker_names={2: "outlet"})
PATCH = [(1, 1), (3, 1), (3, 3), (1, 3)]


@pytest.fixture(scope="module")
def square(client):
    made = client.mesh(SQUARE, edge=0.3)
    return dataclasses.replace(made, values={"depth": made.points.sum(axis=1)})


def within(mesh):
    corners = mesh.points[mesh.triangles]
    return ((corners > 1) & (corners < 3)).all(axis=(1, 2))


@pytest.mark.parametrize("polygons", [PATCH, [PATCH], {"type": "Polygon", "coordinates": [[*PATCH, PATCH[0]]]}])
def test_a_part_is_finer_and_the_rest_as_it_was(square, polygons):
    made = square.remesh(polygons, edge=0.05)
    assert len(made.triangles) > 5 * len(square.triangles)
    outside = square.points[np.unique(square.triangles[~within(square)])]
    assert {tuple(p) for p in outside} <= {tuple(p) for p in made.points}
    assert made.values["depth"] == pytest.approx(made.points.sum(axis=1), abs=1e-12)
    assert made.marker_names == {2: "outlet"}
    assert made.quality().areas.sum() == pytest.approx(16)


def test_options_are_those_of_the_program(square, tmp_path):
    file = tmp_path / "patch.geojson"
    file.write_text('{"type": "Polygon", "coordinates": [[[-1, -1], [2, -1], [2, 2], [-1, 2], [-1, -1]]]}')
    kept = square.remesh(file, "0.001 + 0.01*x", 25, keep=[1, 4], gradation=0.3)
    sides = [np.count_nonzero(kept.edge_markers == marker) for marker in (1, 4)]
    assert sides == [np.count_nonzero(square.edge_markers == marker) for marker in (1, 4)]
    with pytest.raises(TypeError, match="remesh has no option 'optimize'"):
        square.remesh(file, optimize=2)
    with pytest.raises(weft.WeftError, match="no triangle"):
        square.remesh([(9, 9), (10, 9), (10, 10)], 0.1)


def test_meshes_are_joined_where_their_outlines_meet(client):
    left = weft.Domain([(0, 0), (1, 0), (1, 1), (0, 1)], [(0, 1), (1, 2), (2, 3), (3, 0)], [1, 5, 1, 1])
    right = weft.Domain([(1, 0), (2, 0), (2, 1), (1, 1)], [(0, 1), (1, 2), (2, 3), (3, 0)], [2, 2, 2, 5])
    meshes = [client.mesh(domain, edge=0.2, keep=[5]) for domain in (left, right)]
    both = weft.stitch(*meshes)
    assert len(both.triangles) == sum(len(mesh.triangles) for mesh in meshes)
    assert len(both.points) == sum(len(mesh.points) for mesh in meshes) - 2
    assert np.array_equal(both.points[:len(meshes[0].points)], meshes[0].points)
    with pytest.raises(weft.MeshFileError, match="overlap"):
        weft.stitch(meshes[0], meshes[0])
    with pytest.raises(ValueError, match="two meshes or more"):
        weft.stitch(meshes[0])
