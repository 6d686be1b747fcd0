# SPDX-License-Identifier: Apache-2.0
"""What is taken for a domain from Python, and how it is shown."""

import pydoc

import numpy as np
import pytest
import weft
from conftest import MODELS

SQUARE = [(0, 0), (1, 0), (1, 1), (0, 1)]


@pytest.mark.parametrize("empty", [[], (), [[]], [[], []], np.zeros((0, 2)), [np.zeros((0, 2))]], ids=repr)
def test_what_is_empty_is_refused_as_that(empty):
    with pytest.raises(weft.DomainError, match="an empty (list|tuple|ndarray) is no domain: it has no points"):
        weft.domain.as_domain(empty)


def test_a_data_frame_of_x_and_y_is_a_ring():
    pandas = pytest.importorskip("pandas")
    ring = weft.domain.as_domain(SQUARE)
    for frame in (pandas.DataFrame(SQUARE, columns=["x", "y"]),
                  pandas.DataFrame([(y, x) for x, y in SQUARE], columns=["y", "x"])):
        assert np.array_equal(weft.domain.as_domain(frame).points, ring.points)
    with pytest.raises(weft.DomainError, match="if its columns are x and y; this one has x, y, depth"):
        weft.domain.as_domain(pandas.DataFrame([(0, 0, 3)], columns=["x", "y", "depth"]))


def test_records_that_hold_arrays_are_printed_in_a_line():
    coast = weft.Domain.read(MODELS / "us-east-coast.geojson")
    assert repr(coast).startswith("Domain(points=<float64 (9370, 2)>, segments=<int32 (9370, 2)>, ")
    many = weft.Domain(SQUARE, [(0, 1), (1, 2), (2, 3), (3, 0)],
                       regions=[weft.Region(0.5, 0.5, id=i) for i in range(9)])
    values = np.ones((30, 40))
    for record in (coast, many, weft.Raster(values, (0, 0), (1, 1)), weft.distance(points=np.ones((99, 2))),
                   weft.raster(values, origin=(0, 0), spacing=(1, 1))):
        assert "\n" not in repr(record) and len(repr(record)) < 400, repr(record)


def test_help_says_what_is_taken_for_a_domain_and_a_size():
    assert "a DataFrame with the columns x and y" in pydoc.plain(pydoc.render_doc(weft.DomainLike))
    assert "an expression in x, y and names of fields" in pydoc.plain(pydoc.render_doc(weft.Size))
