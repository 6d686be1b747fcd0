# SPDX-License-Identifier: Apache-2.0
"""Sizes that are functions: where they are sampled, and what is said of those that are missed."""

import inspect
import warnings

import numpy as np
import pytest
import weft

BOX = (0, 0, 512, 512)  # a sample of the first grid at each integer


class Counted:
    """A function that remembers how often it was called, and for how many points."""

    def __init__(self, function):
        self.function, self.calls, self.points = function, 0, 0

    def __call__(self, x, y):
        self.calls += 1
        self.points += x.size
        return self.function(x, y)


def ridge(width, least, most=100.0):
    """A valley of small sizes along x = 100.5, between two samples of the first grid."""
    return lambda x, y: np.where(np.abs(x - 100.5) < width, least, most)


def value_at(raster, x, y):
    i, j = (x - raster.origin[0]) / raster.spacing[0], (y - raster.origin[1]) / raster.spacing[1]
    assert (i, j) == (round(i), round(j)), "not a node"
    return raster.values[round(j), round(i)]


def test_a_smooth_function_is_sampled_once():
    smooth = Counted(lambda x, y: 1 + 0.01 * np.hypot(x - 200, y - 300))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        raster = weft.Raster.adaptive(smooth, BOX, lengths=True)
    assert raster.values.shape == (513, 513)
    assert smooth.points == 513**2 + 512**2


def test_a_feature_narrower_than_the_first_grid_is_found_between_its_samples():
    raster = weft.Raster.adaptive(ridge(0.3, 0.6), BOX, lengths=True)
    assert raster.spacing == (0.5, 0.5)
    assert value_at(raster, 100.5, 7) == 0.6
    assert value_at(raster, 100, 7) == value_at(raster, 101, 7) == 100
    assert (weft.Raster.sample(ridge(0.3, 0.6), BOX).values == 100).all()  # the grid alone misses it


def test_only_the_part_that_needs_it_is_evaluated_again():
    counted = Counted(ridge(0.3, 0.01))
    with pytest.warns(weft.WeftWarning):
        raster = weft.Raster.adaptive(counted, BOX, lengths=True)
    assert raster.values.shape == (2049, 2049)
    assert counted.points < 0.2 * 2049**2
    assert counted.calls <= 10


def test_a_feature_narrower_than_the_last_grid_is_warned_of_with_its_place():
    with pytest.warns(weft.WeftWarning, match=r"every 0.25, .*at \(100.\d*, .*give an expression") as caught:
        weft.Raster.adaptive(ridge(0.3, 0.01), BOX, lengths=True)
    assert caught[0].filename == __file__


def test_a_jump_between_triangles_that_are_larger_than_the_samples_is_no_fault():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        raster = weft.Raster.adaptive(lambda x, y: np.where(x < 100.5, 2, 50), BOX, lengths=True)
        assert raster.spacing == (1, 1)
        areas = weft.Raster.adaptive(lambda x, y: np.where(x < 100.5, 2, 50), BOX)  # edges of 2.1
        assert areas.spacing == (1, 1)


def test_the_vertices_of_the_domain_are_looked_at():
    spike = lambda x, y: np.where(np.hypot(x - 100.3, y - 200.2) < 0.2, 0.2, 100)  # noqa: E731
    assert weft.Raster.adaptive(spike, BOX, lengths=True).spacing == (1, 1)
    with pytest.warns(weft.WeftWarning, match=r"at \(100\.\d+, 200\.\d+\)"):
        raster = weft.Raster.adaptive(spike, BOX, [(100.3, 200.2)], lengths=True)
    assert raster.spacing == (0.25, 0.25) and raster.values.min() == 0.2


def test_the_same_function_gives_the_same_samples():
    with pytest.warns(weft.WeftWarning):
        one, other = (weft.Raster.adaptive(ridge(0.3, 0.01), BOX, lengths=True) for _ in range(2))
    assert np.array_equal(one.values, other.values)


def test_a_mesh_follows_a_narrow_valley_and_warns_where_it_cannot(client):
    square = np.array([(0, 0), (512, 0), (512, 512), (0, 512)])
    mesh = client.mesh(square, edge=ridge(0.3, 0.9), gradation=0.3)
    assert mesh.summary.triangles > 10 * client.mesh(square, edge=100).summary.triangles
    with pytest.warns(weft.WeftWarning) as caught:
        client.mesh(square, edge=ridge(0.3, 0.01, 400), max_triangles=100, allow_unrefined=True)
    assert caught[0].filename == __file__


def test_a_function_that_is_no_size_between_the_samples_is_refused():
    with pytest.raises(weft.DomainError, match=r"the size at \(100.5, 0.5\) is -1"):
        weft.Raster.adaptive(ridge(0.3, -1), BOX)


def test_help_explains_every_argument_and_option():
    text = weft.Client.mesh.__doc__
    names = [*weft.MeshOptions.__annotations__, *inspect.signature(weft.Client.mesh).parameters]
    missing = [name for name in names if name not in ("self", "options") and f"`{name}`:" not in text]
    assert not missing
    for name in weft.MeshOptions.__annotations__:
        entry = text.partition(f"`{name}`:")[2].partition("\n        `")[0]
        assert "efault:" in entry or name == "crs", name
    for twin in (weft.aio.Client.mesh, weft.aio.Client.stream):
        assert "weft.Client" in twin.__doc__
