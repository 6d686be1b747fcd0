# SPDX-License-Identifier: Apache-2.0
"""Which band of a raster file is meant, by the rules of files/formats/rasters/gdal_source.cpp."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from .errors import DomainError

_MOST_LISTED = 24


def choose(gdal: Any, path: str, wanted: str) -> tuple[Any, Any]:
    """The open file and its band.

    `wanted`: number or name of a band; of a file of several variables, number or name of one, and
    `name:number` one band of it; empty: the only one. Raises DomainError, and RuntimeError of GDAL.
    """
    data, name = gdal.Open(path), path
    variables = [address for address, _ in data.GetSubDatasets()]
    if data.RasterCount == 0 and variables:
        names = [address[max(map(address.rfind, ":/")) + 1:].strip('"') for address in variables]
        if not wanted and len(names) > 1:
            raise _several(name, "variables", names)
        word, _, wanted = wanted.partition(":")
        index = _find(word, names) if word else 0
        if index is None:
            raise DomainError(f"{name}: has no variable {word!r}; there are {_listed(names)}")
        name += f":{names[index]}"
        data = gdal.Open(variables[index])
    return data, data.GetRasterBand(_band_of(gdal, data, name, wanted))


def _band_of(gdal: Any, data: Any, name: str, wanted: str) -> int:
    """Its number, from 1."""
    bands = [data.GetRasterBand(i + 1) for i in range(data.RasterCount)]
    variables = [band.GetMetadataItem("NETCDF_VARNAME") for band in bands]
    names = [variable or band.GetDescription() for variable, band in zip(variables, bands)]
    opaque = [i for i, band in enumerate(bands)
              if band.GetColorInterpretation() != gdal.GCI_AlphaBand]
    if not bands:
        raise DomainError(f"{name}: has no band")
    word, _, rest = wanted.partition(":")
    if word == names[0] and all(variable == word for variable in variables):
        word, _, rest = rest.partition(":")
    if rest:
        raise DomainError(f"{name}: has no band {wanted!r}; there are {_listed(names)}")
    if word:
        index = _find(word, names)
        if index is None:
            raise DomainError(f"{name}: has no band {word!r}; there are {_listed(names)}")
    elif len(opaque) == 1:
        index = opaque[0]
    else:
        raise _several(name, "bands", names)
    if gdal.DataTypeIsComplex(bands[index].DataType):
        raise DomainError(f"{name}: the values of band {_label(names, index)} are complex numbers")
    return index + 1


def _find(word: str, names: Sequence[str]) -> int | None:
    """The index of the one with that name or number."""
    if word in names:
        return names.index(word)
    number = int(word) if word.isascii() and word.isdigit() and len(word) < 10 else 0
    return number - 1 if 1 <= number <= len(names) else None


def _label(names: Sequence[str], index: int) -> str:
    return f"{index + 1} {names[index]!r}" if names[index] else str(index + 1)


def _listed(names: Sequence[str]) -> str:
    shown = [_label(names, i) for i in range(min(len(names), _MOST_LISTED))]
    return ", ".join(shown + ["..."] * (len(names) > _MOST_LISTED))


def _several(name: str, what: str, names: Sequence[str]) -> DomainError:
    return DomainError(f"{name}: has {len(names)} {what}; choose one as in band=1; there are "
                       f"{_listed(names)}")
