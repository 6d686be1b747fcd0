# SPDX-License-Identifier: Apache-2.0
"""Sizes by edge lengths, named fields and gradation."""

import numpy as np
import pytest
import weft

SQUARE = weft.Domain(points=[[0, 0], [8, 0], [8, 8], [0, 8], [2, 4], [6, 4]],
                     segments=[[0, 1], [1, 2], [2, 3], [3, 0], [4, 5]], markers=[1, 1, 1, 1, 7])


def centroids(mesh):
    return mesh.points[mesh.triangles].mean(axis=1)


def edges_allowed(mesh):
    """Of each triangle, the edge of the equilateral one with its area."""
    return np.sqrt(mesh.quality().areas * 4 / np.sqrt(3))


def distance(p, a, b):
    """Of points (n, 2) to the segment from a to b."""
    a, b = np.asarray(a, float), np.asarray(b, float)
    t = np.clip((p - a) @ (b - a) / ((b - a) @ (b - a)), 0, 1)
    return np.hypot(*(p - a - t[:, None] * (b - a)).T)


def test_an_edge_bounds_areas_by_an_equilateral_triangle_and_is_the_mean_edge(client):
    mesh = client.mesh(SQUARE, edge=0.1)
    assert edges_allowed(mesh).max() <= 0.1
    corners = mesh.points[mesh.triangles]
    lengths = np.hypot(*(corners - np.roll(corners, 1, axis=1)).reshape(-1, 2).T)
    assert lengths.mean() == pytest.approx(0.1, rel=0.03)


def test_an_edge_may_be_a_function_or_a_raster(client):
    by_expression = client.mesh(SQUARE, edge="0.1 + 0.02*x")
    by_function = client.mesh(SQUARE, edge=lambda x, y: 0.1 + 0.02 * x)
    assert by_function.summary.triangles == pytest.approx(by_expression.summary.triangles, rel=0.02)


def test_size_and_edge_exclude_each_other(client):
    with pytest.raises(ValueError, match="exclude each other"):
        client.mesh(SQUARE, size=1, edge=1)


def test_a_distance_to_marked_segments_grades_the_mesh(client):
    mesh = client.mesh(SQUARE, edge="0.05 + 0.2*wall", fields={"wall": weft.distance(marker=7)})
    bound = 0.05 + 0.2 * distance(centroids(mesh), (2, 4), (6, 4))
    assert (edges_allowed(mesh) <= bound * (1 + 1e-9)).all()
    assert mesh.summary.triangles < 4000


def test_a_distance_to_points_and_to_their_segments(client):
    ends = [[9, 9], [9, -1]]
    to_points = client.mesh(SQUARE, edge="0.1*d", fields={"d": weft.distance(points=ends)})
    p = centroids(to_points)
    nearest = np.min([np.hypot(*(p - end).T) for end in ends], axis=0)
    assert (edges_allowed(to_points) <= 0.1 * nearest * (1 + 1e-9)).all()
    to_line = client.mesh(SQUARE, edge="0.1*d",
                          fields={"d": weft.distance(points=ends, segments=[[0, 1]])})
    p = centroids(to_line)
    assert (edges_allowed(to_line) <= 0.1 * distance(p, *ends) * (1 + 1e-9)).all()


def test_a_raster_may_be_negative_and_undefined_if_guarded(client):
    values = np.full((9, 9), -4.0)
    values[:, 5:] = np.nan
    depth = weft.raster(values, origin=(0, 0), spacing=(1, 1))
    mesh = client.mesh(SQUARE, edge="coalesce(abs(depth)/10, 0.2)", fields={"depth": depth})
    left = centroids(mesh)[:, 0] < 4
    assert edges_allowed(mesh)[left].max() <= 0.4
    assert edges_allowed(mesh)[~left].max() <= 0.2
    with pytest.raises(weft.InvalidRequest, match="depth is undefined"):
        client.mesh(SQUARE, edge="abs(depth)/10", fields={"depth": depth})


def test_a_mesh_may_be_refined_by_what_was_found_on_an_earlier_one(client):
    mesh = client.mesh(SQUARE, edge=1)
    for _ in range(3):
        h = 0.02 + 0.3 * np.hypot(*(mesh.points - 3).T)
        mesh = client.mesh(SQUARE, edge="h", fields={"h": weft.on_mesh(mesh, h)})
    bound = 0.02 + 0.3 * np.hypot(*(centroids(mesh) - 3).T)
    ratio = edges_allowed(mesh) / bound
    assert np.percentile(ratio, 99) < 1.05
    assert mesh.summary.triangles > 500


def test_a_gradation_limits_how_edges_grow(client):
    jump = "hypot(x-4, y-1) < 0.5 ? 0.02 : 2"
    steep = client.mesh(SQUARE, edge=jump)
    graded = client.mesh(SQUARE, edge=jump, gradation=0.15)
    assert graded.summary.triangles > 1.5 * steep.summary.triangles
    away = np.maximum(np.hypot(*(centroids(graded) - (4, 1)).T) - 0.5, 0)
    assert (edges_allowed(graded) <= 0.02 + 0.15 * away + 1e-9).all()


def test_the_width_of_a_channel(client):
    channel = weft.Domain(points=[[0, 0], [40, 0], [40, 1], [0, 1]],
                          segments=[[0, 1], [1, 2], [2, 3], [3, 0]])
    mesh = client.mesh(channel, edge="w/4", fields={"w": weft.width()})
    middle = np.abs(centroids(mesh)[:, 0] - 20) < 10
    assert edges_allowed(mesh)[middle].max() <= 0.27


@pytest.mark.parametrize("make, words", [
    (lambda: weft.raster([1.0, 2.0], origin=(0, 0), spacing=(1, 1)), r"shape \(2,\)"),
    (lambda: weft.raster([[1.0, np.inf]], origin=(0, 0), spacing=(1, 1)), "column 1 of row 0"),
    (lambda: weft.raster([[1.0]]), "needs origin and spacing"),
    (lambda: weft.distance(segments=[[0, 1]]), "without points"),
    (lambda: weft.distance(marker=1, points=[[0, 0]]), "exclude each other"),
    (lambda: weft.distance(points=[1, 2, 3]), r"expected \(n, 2\)"),
    (lambda: weft.on_mesh(([[0, 0], [1, 0], [0, 1]], [[0, 1, 2]]), [1, 2]), "for 3 points"),
])
def test_fields_with_a_fault_say_what_is_wrong(make, words):
    with pytest.raises(weft.DomainError, match=words):
        make()


def test_an_unknown_name_is_refused_with_a_suggestion(client):
    with pytest.raises(weft.InvalidRequest, match="did you mean 'coast'"):
        client.mesh(SQUARE, edge="1 + cost", fields={"coast": weft.distance()})


def edge_lengths(mesh):
    return np.hypot(*(mesh.points[mesh.edges[:, 0]] - mesh.points[mesh.edges[:, 1]]).T)


def test_a_size_at_a_marker_bounds_the_edges_that_carry_it(client):
    mesh = client.mesh(SQUARE, edge_at={7: 0.1})
    marked = mesh.edge_markers == 7
    assert edge_lengths(mesh)[marked].max() <= 0.1 * (1 + 1e-9)
    assert edge_lengths(mesh)[~marked].max() > 1


def test_a_size_at_a_marker_grows_by_the_gradation(client):
    mesh = client.mesh(SQUARE, edge=2, edge_at={7: 0.1}, gradation=0.2)
    bound = np.minimum(2, 0.1 + 0.2 * distance(centroids(mesh), (2, 4), (6, 4)))
    assert (edges_allowed(mesh) <= bound * (1 + 1e-9)).all()
    assert edge_lengths(mesh)[mesh.edge_markers == 7].max() <= 0.1 * (1 + 1e-9)
    assert mesh.summary.triangles > 1.5 * client.mesh(SQUARE, edge=2, edge_at={7: 0.1}).summary.triangles


def test_a_size_at_a_marker_is_that_of_the_command_line(client, digest_of, tmp_path):
    domain = tmp_path / "box.geojson"
    domain.write_text('{"type": "Feature", "properties": {"marker": 3, "max_edge": 0.5}, "geometry":'
                      '{"type": "Polygon", "coordinates": [[[0, 0], [4, 0], [4, 3], [0, 0]]]}}')
    mesh = client.mesh(domain, edge_at={3: 0.1}, gradation=0.3)
    assert mesh.digest == digest_of(domain, "--edge-at", "marker=3:0.1", "--gradation", 0.3)
    assert mesh.digest != client.mesh(domain, edge_at={3: 0.2}, gradation=0.3).digest
    assert edges_allowed(mesh).max() <= 0.5 * (1 + 1e-12)


def test_a_size_at_a_marker_that_no_segment_has_is_refused_by_name(client):
    with pytest.raises(weft.InvalidRequest, match="marker of no segment") as caught:
        client.mesh(SQUARE, edge_at={7: 1, 8: 1})
    assert caught.value.violations[0].field == "size.at[1].marker"


def test_a_region_may_have_a_length_of_edges(client):
    seed = {"x": 1, "y": 1, "id": 4}
    ring = dict(points=SQUARE.points[:4], segments=SQUARE.segments[:4])
    by_edge = client.mesh(weft.Domain(**ring, regions=[weft.Region(**seed, max_edge=0.5)]))
    area = np.sqrt(3) / 4 * 0.25
    by_area = client.mesh(weft.Domain(**ring, regions=[weft.Region(**seed, max_area=area)]))
    assert edges_allowed(by_edge).max() <= 0.5 * (1 + 1e-12)
    assert by_edge.digest == by_area.digest
