# SPDX-License-Identifier: Apache-2.0
"""The programs weft and weftd: those that the package carries, if it came from a wheel for this
platform, otherwise those in the PATH."""

from __future__ import annotations

import pathlib
import shutil

FOLDER = pathlib.Path(__file__).parent / "carried"
"""Holds bin/, and lib/ with what the programs load, if a wheel carries it; lib/ with libweft.so in the
folder of a build; else it is not there."""


def program(name: str) -> str | None:
    """The path of `weft` or `weftd`; None if there is none."""
    carried = FOLDER / "bin" / name
    return str(carried) if carried.is_file() else shutil.which(name)
