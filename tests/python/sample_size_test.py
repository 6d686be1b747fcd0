# SPDX-License-Identifier: Apache-2.0
"""weft.sample_size: what a size asks for, without a mesh. The bounds at the centroids of the mesh that the
same request makes must be those that the mesh was counted by."""

import re

import numpy as np
import pytest
import weft
from conftest import KEY, KEY_SIZE, MODELS

COAST = MODELS / "us-east-coast.poly"
HOLED = weft.Domain(
    points=[[0, 0], [9, 0], [9, 9], [0, 9], [3, 3], [6, 3], [6, 6], [3, 6], [0, 1], [9, 1]],
    segments=[[0, 1], [1, 2], [2, 3], [3, 0], [4, 5], [5, 6], [6, 7], [7, 4], [8, 9]],
    markers=[1, 1, 1, 1, 2, 2, 2, 2, 3], holes=[[4, 4]],
    regions=[weft.Region(1, 0.5, id=5, max_area=0.003)])
SLOPE = weft.Raster.sample(lambda x, y: 0.01 + 0.002 * (x + y), (0, 0, 9, 9), 10)


def centroids(mesh):
    return mesh.points[mesh.triangles].mean(axis=1)


def areas(mesh):
    a, b, c = (mesh.points[mesh.triangles[:, k]] for k in range(3))
    return 0.5 * np.cross(b - a, c - a)


@pytest.mark.parametrize(("domain", "options"), [
    (KEY, {"size": KEY_SIZE}),
    (HOLED, {}),  # but that of a region
    (HOLED, {"size": 0.01}),
    (HOLED, {"size": SLOPE}),
    (HOLED, {"edge": "0.05 + 0.2*distance", "fields": {"distance": weft.distance(marker=2)}}),
    (HOLED, {"edge": 2, "edge_at": {2: 0.1}, "gradation": 0.2}),
    (HOLED, {"edge": 2, "edge_at": {2: 0.1}, "gradation": 0.2, "gradation_within": True}),
    (HOLED, {"edge": 2, "cells_across": 6, "gradation": 0.3}),
    (COAST, {"edge": 0.3, "simplify": 0.5}),
])
def test_the_bounds_at_centroids_are_those_of_the_mesh(domain, options):
    mesh = weft.mesh(domain, **options)
    sampled = weft.sample_size(domain, centroids(mesh), **options)
    bounded = np.isfinite(sampled.bounds)
    shares = areas(mesh)[bounded] / sampled.bounds[bounded]
    bins = np.bincount(np.clip((10 * shares).astype(int), 0, 9), minlength=10)
    away = np.abs(bins - mesh.summary.size_histogram).sum()
    assert away <= 2 + len(shares) // 2000, (bins, mesh.summary.size_histogram)  # on an edge of a bin, by rounding
    assert not np.isnan(sampled.bounds).any()
    assert 0.6 < sampled.expected_triangles / len(mesh.triangles) < 1.3


def test_edges_are_those_of_equilateral_triangles():
    sampled = weft.sample_size(HOLED, [[8, 8], [1, 0.5]], edge=0.5)
    assert sampled.edges[0] == pytest.approx(0.5)
    assert sampled.bounds[1] == 0.003


def test_outside_and_in_holes_there_is_no_bound_to_tell():
    sampled = weft.sample_size(HOLED, [[4.5, 4.5], [-1, 2], [1e50, 0], [8, 8]])
    assert np.isnan(sampled.bounds[:3]).all()
    assert sampled.bounds[3] == np.inf


def test_points_lie_where_those_of_the_domain_do():
    pytest.importorskip("pyproj")
    options = {"edge": "2e4 + 0.1*shore", "fields": {"shore": weft.distance()}, "lonlat": True}
    coast = MODELS / "us-east-coast.geojson"
    mesh = weft.mesh(coast, **options)
    sampled = weft.sample_size(coast, centroids(mesh), **options)
    inside = ~np.isnan(sampled.bounds)
    assert inside.mean() > 0.99  # a side of a triangle is straight in the plane
    assert sampled.edges[inside].min() > 1.9e4
    assert sampled.edges[inside].max() > 3e4


def test_a_warning_is_that_of_the_mesh():
    with pytest.warns(weft.WeftWarning, match="bounds nothing"):
        weft.sample_size(HOLED, [[1, 2]], edge=1e4)


@pytest.mark.parametrize(("points", "error", "message"), [
    ([[1, 2], [np.nan, 1]], weft.InvalidRequest, "sample_points[1] is (not a number, 1)"),
    (np.zeros((262145, 2)), weft.InvalidRequest, "262145 points"),
    ([], ValueError, "must be (n, 2)"),
    ([1, 2], ValueError, "must be (n, 2)"),
])
def test_points_that_are_none_are_refused(points, error, message):
    with pytest.raises(error, match=re.escape(message)):
        weft.sample_size(HOLED, points, size=1)


def test_a_job_makes_a_mesh(job_server):
    request = weft._requests.job_request(HOLED, 1, 20, {})
    request.sample_points.extend([1, 1])
    with weft.Client(job_server.target) as client, pytest.raises(weft.InvalidRequest, match="a job makes a mesh"):
        client._call(weft._protocol.SUBMIT_JOB, mesh=request)
