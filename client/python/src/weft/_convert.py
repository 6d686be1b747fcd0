# SPDX-License-Identifier: Apache-2.0
"""Files of the formats that the command line knows, by `weft convert`."""

from __future__ import annotations

import dataclasses
import json
import os
import pathlib
import subprocess

from . import _carried
from .errors import WeftError

_USAGE, _PREFIX = 2, "weft: "


class Refused(Exception):
    """`weft convert` failed; the text is what it said."""

    def __init__(self, text: str, usage: bool) -> None:
        super().__init__(text)
        self.usage = usage
        """Whether its arguments are at fault, such as an extension that it does not know."""


@dataclasses.dataclass(frozen=True)
class Converted:
    """What `weft convert` reports of what it has written."""

    warnings: list[str]
    geographic: bool | None
    """Whether the file says that a domain is in longitude and latitude, or in a plane; None: neither."""


def convert(source: pathlib.Path, target: pathlib.Path, *options: str,
            error: type[WeftError]) -> Converted:
    """Writes `target`. Raises Refused; `error` if the program is missing;
    OSError if `source` cannot be opened."""
    program = _carried.program("weft")
    if not program:
        raise error(f"{source} to {target.suffix}: needs the program weft, which is neither in this "
                    "package nor in the PATH; install a wheel for this platform, or Debian's package "
                    "weft")
    # The variables of weft are for a user who calls it, not for this call.
    environment = {k: v for k, v in os.environ.items() if not k.startswith("WEFT_")}
    done = subprocess.run([program, "convert", str(source.absolute()), str(target.absolute()),
                           "--json", *options],
                          capture_output=True, text=True, env=environment, stdin=subprocess.DEVNULL)
    if done.returncode:
        if done.returncode != _USAGE:
            open(source, "rb").close()  # an OSError says more to those who catch it
        raise Refused(done.stderr.strip().removeprefix(_PREFIX), done.returncode == _USAGE)
    report = json.loads(done.stdout)
    return Converted([warning["sentence"] for warning in report["warnings"]],
                     report.get("coordinates", {}).get("geographic"))
