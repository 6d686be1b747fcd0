# SPDX-License-Identifier: Apache-2.0
"""The cells of a mesh by what they carry: `mesh.boundaries["inlet"]`, `mesh.subdomains[1]`."""

from __future__ import annotations

import operator
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

Ints = npt.NDArray[np.int32]


class Groups(Mapping[Any, Ints]):
    """The cells with each number, by the number or by its name.

    `kind`: "marker" or "region". `numbers`: (k,), of each cell. `cells`: (k, ...), of which a group has the
    rows. Its keys are the names, and the numbers of what has none; a name that no cell carries has no
    rows. A KeyError lists the keys.
    """

    def __init__(self, kind: str, numbers: Ints, cells: Ints, names: Mapping[int, str]) -> None:
        self._kind = kind
        self._numbers = numbers
        self._cells = cells
        self._names = names
        self._known = sorted({*np.unique(numbers).tolist(), *names})

    def number(self, key: str | int) -> int:
        """The number of a name, or itself."""
        if isinstance(key, str):
            for number, name in self._names.items():
                if name == key:
                    return number
        elif (number := operator.index(key)) in self._known:
            return number
        raise KeyError(f"there is no {self._kind} {key!r}; there are {', '.join(map(repr, self)) or 'none'}")

    def __getitem__(self, key: str | int) -> Ints:
        rows: Ints = self._cells[self._numbers == self.number(key)]
        return rows

    def __iter__(self) -> Iterator[Any]:
        return (self._names.get(number, number) for number in self._known)

    def __len__(self) -> int:
        return len(self._known)

    def named(self) -> dict[str, Ints]:
        """Of each name, and of `marker 2` or `region 2` if 2 has none; cells with 0 carry nothing."""
        return {self._names.get(number, f"{self._kind} {number}"): self[number]
                for number in self._known if number or number in self._names}
