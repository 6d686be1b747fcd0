# SPDX-License-Identifier: Apache-2.0
"""What Python calls the fields of a request that the server names in errors."""

from __future__ import annotations

import re
from typing import Any

from . import _options

_EDGE = 2  # weft.v1.Measure

_OTHERS = {"size.fields": "fields", "size.at": "edge_at", "quality.keep": "keep", "quality.periodic": "periodic",
           "quality.layers": "layers"}
_ENTRY = re.compile(r"(\.markers|(?<=quality\.periodic)|(?<=quality\.layers))\[.*")
_ELEMENT = re.compile(r"size\.(fields|at)\[(\d+)\]")
_VALUE = re.compile(r"size($|\.constant|\.expression|\.raster|\.measure)")


def argument_of(field: str, request: Any) -> str:
    """The argument of Client.mesh that the field was made of, such as `fields['coast']` of
    `size.fields[0].distance.markers`; empty if it has no other name, or the request must be known to
    tell. `request`: the GenerateMeshRequest; None or another for none."""
    field_of_option = _ENTRY.sub("", field)
    if name := _OTHERS.get(field_of_option):
        return name
    for name, option in _options.by_keyword().items():
        if option.path == field_of_option:
            return name
    if request is None or not hasattr(request, "size"):  # such as a FetchMeshRequest
        return ""
    if element := _ELEMENT.match(field):
        kind, index = element[1], int(element[2])
        elements = getattr(request.size, kind)
        if index >= len(elements):
            return ""
        if kind == "fields":
            name = elements[index].name
            return name if name in ("size", "edge") else f"fields[{name!r}]"
        marker = elements[index].marker
        names = {entry.id: entry.name for entry in request.domain.marker_names}
        return f"edge_at[{names.get(marker, marker)!r}]"
    if _VALUE.match(field) and request.size.WhichOneof("field"):
        return "edge" if request.size.measure == _EDGE else "size"
    return ""
