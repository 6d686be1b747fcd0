# SPDX-License-Identifier: Apache-2.0
"""Masked arrays of NumPy: what lies under a mask is no number, and NumPy's conversions forget the mask."""
from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from .errors import DomainError


def refuse_masked(name: str, values: npt.ArrayLike) -> None:
    """Raises DomainError, which names the first masked element, if there is one."""
    if not isinstance(values, np.ma.MaskedArray) or not np.ma.is_masked(values):
        return
    where = np.argwhere(np.ma.getmaskarray(values))
    more = f", and {len(where) - 1:,} more" if len(where) > 1 else ""
    raise DomainError(f"{name}{where[0].tolist()} is masked{more}: it has no value here")


def nan_where_masked(values: npt.ArrayLike, dtype: Any) -> npt.NDArray[Any]:
    """An array of floating-point numbers, contiguous; a number is an array of shape ()."""
    if isinstance(values, np.ma.MaskedArray):
        values = np.ma.filled(values.astype(dtype), np.nan)
    return np.asarray(values, dtype, "C")
