# SPDX-License-Identifier: Apache-2.0
import json

import numpy as np
import pytest
import shapely.geometry
import weft
from conftest import MODELS

SQUARE = [[0, 0], [4, 0], [4, 4], [0, 4], [0, 0]]
HOLE = [[1, 1], [2, 1], [2, 2], [1, 2], [1, 1]]


@pytest.mark.parametrize("name", ["key.poly", "pipe.poly", "us-east-coast.poly",
                                  "us-east-coast.geojson"])
def test_a_file_means_what_it_means_to_the_command_line(client, digest_of, name):
    assert client.mesh(MODELS / name).digest == digest_of(MODELS / name)


def test_a_feature_collection_means_what_it_means_to_the_command_line(client, digest_of, tmp_path):
    def feature(kind, coordinates, **properties):
        return {"type": "Feature", "properties": properties,
                "geometry": {"type": kind, "coordinates": coordinates}}
    path = tmp_path / "all.geojson"
    path.write_text(json.dumps({"type": "FeatureCollection", "features": [
        feature("Polygon", [SQUARE, HOLE], marker=5, region=7, max_area=0.1),
        feature("MultiPolygon", [[[[5, 0], [6, 0], [6, 1], [5, 0]]], [[[5, 2], [6, 2], [6, 3], [5, 2]]]],
                region=-2),
        feature("LineString", [[0.5, 3], [0.5, 3], [3, 3.5]], marker=9),
        feature("Polygon", [[[10, 0], [12, 0], [12, 2], [10, 2], [10, 0]]]),
        feature("LineString", [[9, 1], [13, 1]], marker=9),  # through and out again
        feature("LineString", [[10.5, 0.2], [11.5, 0.2], [11, 0.8], [10.5, 0.2]]),  # no hole
        feature("MultiPoint", [[3, 1], [3, 2]]),
        {"type": "Feature", "properties": None, "geometry": None}]}))
    mesh = client.mesh(path)
    assert mesh.digest == digest_of(path)
    assert set(mesh.regions) == {7, -2, 0}
    assert set(mesh.edge_markers) == {0, 5, 9}


def test_arrays_shapely_and_geojson_are_the_same_domain(client):
    polygon = shapely.geometry.Polygon(SQUARE, [HOLE])
    digests = {client.mesh(domain, size=0.1).digest for domain in (
        polygon, polygon.__geo_interface__, [np.array(SQUARE), np.array(HOLE)],
        weft.Domain.rings(SQUARE[:-1], HOLE[:-1]))}
    assert len(digests) == 1


def test_one_array_is_a_ring(client):
    assert client.mesh(np.array(SQUARE)).summary.area == pytest.approx(16)


def test_a_multipolygon_of_shapely_is_meshed_in_all_its_parts(client):
    parts = shapely.geometry.MultiPolygon([shapely.geometry.box(0, 0, 1, 1),
                                            shapely.geometry.box(3, 0, 5, 1)])
    assert client.mesh(parts).summary.area == pytest.approx(3)


def test_attributes_of_triangles_regions_may_be_any_numbers(client, digest_of, tmp_path):
    path = tmp_path / "regions.poly"
    path.write_text("4 2 0 0\n1 0 0\n2 4 0\n3 4 4\n4 0 4\n5 0\n1 1 2\n2 2 3\n3 3 4\n4 4 1\n5 1 3\n"
                    "0\n2\n1 3 1 0.7\n2 1 3 0.35 -1  # the first is its own maximum area\n")
    domain = weft.Domain.read(path)
    first, second = domain.regions
    assert domain.region_values == {1: 0.35, 2: 0.7}
    assert (first.id, first.max_area, second.id, second.max_area) == (2, 0.7, 1, None)
    assert client.mesh(path).digest == digest_of(path)


def test_holes_and_regions_of_seeds_are_kept(client):
    rings = weft.Domain.rings(SQUARE, HOLE)
    domain = weft.Domain(rings.points, rings.segments, markers=np.arange(8), holes=[(1.5, 1.5)],
                         regions=[weft.Region(3, 3, id=4, max_area=0.05)])
    mesh = client.mesh(domain)
    assert mesh.summary.area == pytest.approx(15)
    assert set(mesh.regions) == {4}
    assert mesh.quality().areas.max() <= 0.05
    assert (mesh.edge_markers == mesh.edge_segments).all()
    assert set(mesh.edge_markers) == set(range(8))


def test_a_region_of_a_polygon_with_a_hole_is_outside_the_hole(client):
    # The widest gap between ordinates is at the height of the hole.
    json = {"type": "Feature", "properties": {"region": 3}, "geometry": {
        "type": "Polygon", "coordinates": [SQUARE, [[0.1, 0.5], [3, 0.5], [3, 3.5], [0.1, 3.5], [0.1, 0.5]]]}}
    mesh = client.mesh(json)
    assert set(mesh.regions) == {3}


def test_a_region_keeps_off_the_lines_inside_it(client):
    mesh = client.mesh({"type": "FeatureCollection", "features": [
        {"type": "Feature", "properties": {"region": 3},
         "geometry": {"type": "Polygon", "coordinates": [SQUARE]}},
        {"type": "Feature", "geometry": {"type": "LineString", "coordinates": [[2, 1], [2, 3]]}}]})
    assert set(mesh.regions) == {3}


def test_a_poly_counts_from_0_or_1_and_finds_its_points_beside_it(client, tmp_path):
    nodes = "{}  0 0\n{}  1 0 # a comment\n\n{} 0 1\n"
    segments = "3 1\n 0 {0} {1} 7\n 1 {1} {2} 8\n 2 {2} {0} 9\n0\n"
    (tmp_path / "one.poly").write_text("3 2 0 0\n" + nodes.format(1, 2, 3) + segments.format(1, 2, 3))
    (tmp_path / "two.node").write_text("3 2 0 0\n" + nodes.format(0, 1, 2))
    (tmp_path / "two.poly").write_text("0 2 0 0\n" + segments.format(0, 1, 2))
    meshes = [client.mesh(tmp_path / name) for name in ("one.poly", "two.poly")]
    assert meshes[0].digest == meshes[1].digest
    assert set(meshes[0].edge_markers) == {7, 8, 9}


@pytest.mark.parametrize("domain, words", [
    (np.zeros((3, 3)), r"\(3, 3\)"),
    (np.array([[0, 0], [1, np.nan], [1, 1]]), r"ring 0\[1\]"),
    (42, "int is no domain"),
    ("no.stl", "no.stl"),
    ({"type": "Circle", "coordinates": [0, 0]}, "'Circle'"),
    ({"type": "Polygon", "coordinates": [SQUARE[:-1]]}, r"coordinates\[0\] is a ring that is not closed"),
    ({"type": "Polygon", "coordinates": [SQUARE, [["x", 1]] * 4]}, r"coordinates\[1\]"),
    ({"type": "FeatureCollection", "features": [{"type": "Feature", "geometry": 3}]},
     r"features\[0\]\.geometry"),
    ({"type": "Feature", "properties": {"marker": 0.5},
      "geometry": {"type": "Polygon", "coordinates": [SQUARE]}}, "properties.marker is 0.5"),
])
def test_what_is_no_domain_is_refused_by_name(domain, words):
    with pytest.raises(weft.DomainError, match=words):
        weft.domain.as_domain(domain)


@pytest.mark.parametrize("arguments, words", [
    (([(0, 0), (1, 0), (0, 1)], [(0, 1), (1, 3)]), r"segments\[1\] names point 3 of 3"),
    (([(0, 0), (1, 0), (0, 1)], [(0, 1), (1, 2)], [1]), "markers: 1 for 2 segments"),
    (([(0, 0), (1, 0), (0, 1)], [(0, 1.5)]), "segments: not integers"),
])
def test_what_is_no_graph_is_refused_by_name(arguments, words):
    with pytest.raises(weft.DomainError, match=words):
        weft.Domain(*arguments)


@pytest.mark.parametrize("text, words", [
    ("3 2 0 0\n1 0 0\n2 1 0\n", "ends after 2 of 3 points"),
    ("1 2 0 0\n1 0 x\n", "points: "),
    ("2 2 0 0\n5 0 0\n6 1 1\n0 0\n0\n", "not numbered"),
])
def test_a_poly_that_is_wrong_is_refused_by_file_and_part(tmp_path, text, words):
    path = tmp_path / "bad.poly"
    path.write_text(text)
    with pytest.raises(weft.DomainError, match=f"bad.poly: .*{words}"):
        weft.Domain.read(path)
