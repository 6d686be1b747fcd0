# SPDX-License-Identifier: Apache-2.0
"""Masked arrays are refused, or their masked elements are undefined: what lies under a mask is never used."""
import numpy as np
import pytest

import weft
from weft import triangle


def masked(values, *where):
    array = np.ma.array(values)
    for at in where:
        array[at] = np.ma.masked
    return array


def test_masked_coordinates_are_refused_by_their_place():
    ring = masked([[0.0, 0.0], [4.0, 0.0], [4.0, 3.0], [0.0, 3.0]], (2, 1))
    with pytest.raises(weft.DomainError, match=r"ring 0\[2, 1\] is masked: it has no value here"):
        weft.Domain.rings(ring)
    with pytest.raises(weft.DomainError, match=r"points\[2, 1\] is masked"):
        weft.Domain(ring, [[0, 1], [1, 2], [2, 3], [3, 0]])
    with pytest.raises(weft.DomainError, match=r"segments\[1, 0\] is masked, and 1 more"):
        weft.Domain(ring.data, masked([[0, 1], [1, 2], [2, 3], [3, 0]], (1, 0), (1, 1)))
    with pytest.raises(weft.DomainError, match=r"vertices\[2, 1\] is masked"):
        triangle.triangulate({"vertices": ring}, "")


def test_arrays_without_a_masked_element_are_arrays():
    ring = np.ma.array([[0.0, 0.0], [4.0, 0.0], [4.0, 3.0]], mask=False)
    assert len(weft.Domain.rings(ring).points) == 3


def test_masked_values_of_fields_are_undefined():
    field = weft.raster(masked([[1.0, 2.0], [3.0, 4.0]], (0, 1)), origin=(0, 0), spacing=(1, 1))
    assert np.isnan(field.values[0, 1]) and field.values[1, 1] == 4
    points, corners = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]), [[0, 1, 2]]
    assert np.isnan(weft.on_mesh((points, corners), masked([1, 2, 3], 0)).values[0])
    with pytest.raises(weft.DomainError, match=r"points\[0, 0\] is masked"):
        weft.on_mesh((masked(points, (0, 0)), corners), [1, 2, 3])


def test_masked_sizes_are_refused():
    with pytest.raises(weft.DomainError, match="is nan, in column 1 of row 0"):
        weft.Raster(masked([[1.0, 2.0], [3.0, 4.0]], (0, 1)), (0, 0), (1, 1))
