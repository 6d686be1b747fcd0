# SPDX-License-Identifier: Apache-2.0
"""Masked arrays of NumPy: what lies under a mask is no number, and NumPy's conversions forget the mask."""
from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from .errors import DomainError


def refuse_masked(name: str, values: npt.ArrayLike) -> None:
    """Raises DomainError, which names the first masked element, if there is one."""
    where = np.argwhere(_mask_of(values))
    if len(where) == 0:
        return
    more = f", and {len(where) - 1:,} more" if len(where) > 1 else ""
    raise DomainError(f"{name}{where[0].tolist()} is masked{more}: it has no value here")


def nan_where_masked(values: npt.ArrayLike, dtype: Any) -> npt.NDArray[Any]:
    """An array of floating-point numbers, contiguous; a number is an array of shape ()."""
    if not isinstance(values, np.ma.MaskedArray):
        return np.asarray(values, dtype, "C")
    return np.where(_mask_of(values), dtype(np.nan), np.asarray(values.data, dtype))


def _mask_of(values: npt.ArrayLike) -> npt.NDArray[np.bool_]:
    if not isinstance(values, np.ma.MaskedArray):
        return np.zeros((), np.bool_)
    return np.broadcast_to(np.asarray(values.mask, np.bool_), values.shape)
