# SPDX-License-Identifier: Apache-2.0
"""Packages that only some functions need."""

from __future__ import annotations

import importlib
from typing import Any

from .errors import MissingPackage


def need(module: str, what: str, package: str | None = None) -> Any:
    """The module; raises MissingPackage, which says that `what` needs it. `package`: its name, if
    it is not that of the module."""
    try:
        return importlib.import_module(module)
    except ImportError as error:
        package = package or module.partition(".")[0]
        raise MissingPackage(f"{what} needs {package}: apt-get install python3-{package}, or "
                             f"pip install {package} ({error})") from None
