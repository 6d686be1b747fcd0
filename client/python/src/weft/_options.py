# SPDX-License-Identifier: Apache-2.0
"""The options of a request that are one value: fields that weft.v1.option annotates."""

from __future__ import annotations

import dataclasses
import functools
import textwrap
from collections.abc import Callable
from typing import Any, TypeVar

from . import _protocol


@dataclasses.dataclass(frozen=True)
class Option:
    """A field of GenerateMeshRequest."""

    part: str
    """The message of the request that has the field; empty if it is the request itself."""
    field: Any
    """Its descriptor."""
    help: str
    """What it is or does, its range and its default."""

    @property
    def path(self) -> str:
        """As errors of servers call it."""
        return f"{self.part}.{self.field.name}" if self.part else str(self.field.name)

    def set(self, request: Any, value: Any) -> None:
        """Raises ValueError for what is no name of a choice, TypeError for what the field cannot hold."""
        message = getattr(request, self.part) if self.part else request
        choices = _choices(self.field)
        if choices and value not in choices:
            raise ValueError(f"{self.field.name} is {value!r}; there are {', '.join(choices)}")
        setattr(message, self.field.name, choices[value] if choices else value)


def _choices(field: Any) -> dict[str, int]:
    """Numbers of the enumerators but the first, which is none of them, by what people call them."""
    if field.enum_type is None:
        return {}
    prefix = len(field.enum_type.name) + 1
    return {value.name[prefix:].lower(): value.number for value in field.enum_type.values[1:]}


def _help(annotation: Any, is_switch: bool) -> str:
    text: str = annotation.about
    if annotation.HasField("max"):
        text += f". Range: {annotation.min:g} to {annotation.max:g}"
    default = annotation.default or ("False" if is_switch else "")
    return text + (f". Default: {default}." if default else ".")


@functools.cache
def by_keyword() -> dict[str, Option]:
    """In the order of the fields."""
    found: dict[str, Option] = {}

    def add(message: Any, part: str) -> None:
        for field in message.fields:
            if annotation := _protocol.annotation(field):
                name = (annotation.name or field.name).replace("-", "_")
                found[name] = Option(part, field, _help(annotation, field.cpp_type == field.CPPTYPE_BOOL))
            if not part and field.message_type is not None:
                add(field.message_type, field.name)

    add(_protocol.GENERATE_MESH.request.DESCRIPTOR, "")
    return found


_Function = TypeVar("_Function", bound=Callable[..., Any])


def documented(function: _Function) -> _Function:
    """The function with the help of all options but `min_angle`, which is a parameter, in place of the
    line "{options}" of its docstring."""
    lines = (textwrap.fill(f"`{name}`: {option.help}", 112, initial_indent=8 * " ", subsequent_indent=8 * " ")
             for name, option in by_keyword().items() if name != "min_angle")
    function.__doc__ = (function.__doc__ or "").replace(8 * " " + "{options}", "\n".join(lines))
    return function
