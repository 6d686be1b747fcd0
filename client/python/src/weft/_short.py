# SPDX-License-Identifier: Apache-2.0
"""How records that hold arrays are printed."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np

_FEW = 4  # elements that are printed


class ShortRepr:
    """Of a dataclass: one line, with arrays by their type and shape, and long lists by their length; what is
    empty or None is left out."""

    def __repr__(self) -> str:
        fields = ((field.name, getattr(self, field.name)) for field in dataclasses.fields(self))
        shown = ", ".join(f"{name}={_text(value)}" for name, value in fields if not _is_empty(value))
        return f"{type(self).__name__}({shown})"


def _is_empty(value: Any) -> bool:
    return value is None or (isinstance(value, (np.ndarray, tuple, list, dict, str)) and not len(value))


def _text(value: Any) -> str:
    if isinstance(value, np.ndarray):
        return f"<{value.dtype} {value.shape}>"
    if isinstance(value, (tuple, list, dict)) and len(value) > _FEW:
        return f"<{len(value)} of them>"
    return repr(value)
