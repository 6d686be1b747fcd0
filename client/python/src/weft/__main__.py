# SPDX-License-Identifier: Apache-2.0
"""`python -m weft`: the command line."""

from __future__ import annotations

import os
import sys
from typing import NoReturn

from ._carried import program


def main(name: str = "weft") -> NoReturn:
    """Becomes the program of that name, with the arguments of this process."""
    path = program(name)
    if not path:
        sys.exit(f"{name}: this package carries no programs, and none is in the PATH; install a wheel "
                 "for this platform, or Debian's package weft")
    os.execv(path, [name, *sys.argv[1:]])


def server() -> NoReturn:
    """Becomes weftd."""
    main("weftd")


if __name__ == "__main__":
    main()
