# SPDX-License-Identifier: Apache-2.0
"""The names of markers and regions."""

from __future__ import annotations

import collections
import operator
from collections.abc import Mapping
from typing import Any, Union

from ._warning import warn
from .errors import DomainError


def checked(table: str, names: Mapping[int, str]) -> dict[int, str]:
    """Names by number, of the argument `table`. Raises DomainError."""
    found: dict[int, str] = {}
    for key, name in names.items():
        try:
            number = operator.index(key)
            fault = _fault(name)
        except (AttributeError, TypeError, UnicodeEncodeError):
            raise DomainError(f"{table}: {key!r}: {name!r} is no number of a text") from None
        where = f"{table}[{number}]"
        if not -2**31 <= number < 2**31:
            raise DomainError(f"{where}: the number is not one of 32 bits")
        if fault:
            raise DomainError(f"{where} is {name[:80]!r}, which {fault}")
        found[number] = name
    counts = collections.Counter(found.values())
    for name in found.values():
        if counts[name] > 1:
            raise DomainError(f"{table}: {name!r} is there twice")
    return found


def marker_of(marker: Any, names: Mapping[int, str]) -> int:
    """The number of a marker: itself, or that of the name. Raises DomainError."""
    if isinstance(marker, str):
        for number, name in names.items():
            if name == marker:
                return number
        known = f"there are {', '.join(names.values())}" if names else "it names none"
        raise DomainError(f"no marker of the domain is named {marker!r}: {known}")
    try:
        number = operator.index(marker)
    except TypeError:
        raise DomainError(f"the marker {marker!r} is neither a number nor a name") from None
    if not -2**31 <= number < 2**31:
        raise DomainError(f"the marker {number} is not a number of 32 bits")
    return number


def _fault(name: str) -> str:
    size = len(name.encode())
    if not 1 <= size <= 255:
        return f"has {size} bytes; a name has 1 to 255"
    if any(letter < " " or "\x7f" <= letter <= "\x9f" for letter in name):
        return "has a control character"
    return ""


class FileNames:
    """Names that a file has: `table`, by number. What cannot be a name, or would be there twice, is
    left out with a WeftWarning, as files/formats/names.h does it."""

    def __init__(self, kind: str, file: str) -> None:
        self.table: dict[int, str] = {}
        self._what = f"{file}: a name of {kind}" if file else f"a name of {kind}"

    def add(self, number: int, name: str) -> None:
        """The same name for the same number again is no fault."""
        known = self.table.get(number)
        if known == name:
            return
        try:
            why = _fault(name)
        except UnicodeEncodeError:
            why = "is not UTF-8"
        if why:
            why = f"it {why}"
        elif known is not None:
            why = f"the first is {known!r}"
        elif name in self.table.values():
            why = f"{name!r} is another one's, too"
        if why:
            warn(f"{self._what} {number} is left out: {why}")
        else:
            self.table[number] = name


Label = Union[int, str]


class Labels:
    """Markers or regions that a file's features give by number or by name. A name without a number
    gets the smallest positive number that the file does not use, in the order in which the names
    appear."""

    def __init__(self, kind: str, file: str) -> None:
        self._kind = kind
        self._names = FileNames(kind, file)
        self._numbers: set[int] = set()
        self._alone: dict[str, None] = {}  # names without a number, in order

    def of(self, properties: Mapping[str, Any]) -> Label:
        """What to call the marker or region of a feature until all is read."""
        number: int = properties.get(self._kind, 0)
        name: str = properties.get(f"{self._kind}_name", "")
        if name and number == 0:
            self._alone[name] = None
            return name
        if name:
            self._names.add(number, name)
        self._numbers.add(number)
        return number

    def numbers(self) -> tuple[dict[Label, int], dict[int, str]]:
        """The number of each label, and the names by number."""
        numbers: dict[Label, int] = {number: number for number in self._numbers}
        free = 1
        for name in self._alone:
            while free in self._numbers:
                free += 1
            numbers[name] = free
            self._names.add(free, name)
            free += 1
        return numbers, self._names.table
