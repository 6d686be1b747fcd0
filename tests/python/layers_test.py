# SPDX-License-Identifier: Apache-2.0
"""Layers along walls, through a server and in the process."""
import numpy as np
import pytest
import weft

PLATE = weft.Domain([(0, 0), (2, 0), (2, 1), (0, 1)], [(0, 1), (1, 2), (2, 3), (3, 0)], [4, 1, 1, 1],
                    marker_names={4: "wall"})
ROWS = weft.Layers(first=0.01, rows=5, ratio=1.5)


@pytest.mark.parametrize("wall", ["wall", 4])
def test_rows_have_the_heights_that_are_asked_for(client, wall):
    mesh = client.mesh(PLATE, edge=0.1, layers={wall: ROWS})
    heights = np.cumsum(0.01 * 1.5 ** np.arange(5))
    left = np.sort(mesh.points[mesh.points[:, 0] == 0, 1])
    assert left[1:6] == pytest.approx(heights, abs=1e-15)
    assert mesh.summary.layers.triangles == np.count_nonzero(mesh.regions == 1)
    assert mesh.summary.layers.least_thickness == pytest.approx(heights[-1])
    assert mesh.summary.layers.cut == 0
    assert mesh.summary.area == pytest.approx(2)
    assert client.mesh(PLATE, edge=0.1).summary.layers is None


def test_a_region_may_be_given_and_layers_are_thinner_where_there_is_no_room(client):
    thick = weft.Layers(first=0.1, rows=10, region=7)
    mesh = client.mesh(PLATE, edge=0.1, layers={4: thick})
    assert np.count_nonzero(mesh.regions == 7) == mesh.summary.layers.triangles
    assert mesh.summary.layers.cut == 2
    assert mesh.summary.layers.least_thickness <= 0.4


def test_the_mesh_in_the_process_is_that_of_the_server(client):
    options = {"edge": 0.1, "layers": {"wall": ROWS}}
    assert weft.mesh(PLATE, **options).summary.digest == client.mesh(PLATE, **options).summary.digest
