# SPDX-License-Identifier: Apache-2.0
"""The program weft, and files of the formats that it knows, by `weft convert`."""

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
    """weft failed; the text is what it said."""

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


def run(command: str, *arguments: str, error: type[WeftError], purpose: str = "") -> str:
    """What `weft COMMAND ARGUMENTS` prints. Raises Refused; `error` if the program is missing.

    `purpose`: of the call, for that error; default: the command.
    """
    program = _carried.program("weft")
    if not program:
        raise error(f"{purpose or command}: needs the program weft, which is neither in this package nor in the "
                    "PATH; install a wheel for this platform, or Debian's package weft")
    # The variables of weft are for a user who calls it, not for this call.
    environment = {k: v for k, v in os.environ.items() if not k.startswith("WEFT_")}
    done = subprocess.run([program, command, *arguments], capture_output=True, text=True, env=environment,
                          stdin=subprocess.DEVNULL)
    if done.returncode:
        raise Refused(done.stderr.strip().removeprefix(_PREFIX), done.returncode == _USAGE)
    return done.stdout


def convert(source: pathlib.Path, target: pathlib.Path, *options: str,
            error: type[WeftError]) -> Converted:
    """Writes `target`. Raises Refused; `error` if the program is missing;
    OSError if `source` cannot be opened."""
    try:
        said = run("convert", str(source.absolute()), str(target.absolute()), "--json", *options, error=error,
                   purpose=f"{source} to {target.suffix}")
    except Refused as refused:
        if not refused.usage:
            open(source, "rb").close()  # an OSError says more to those who catch it
        raise
    report = json.loads(said)
    return Converted([warning["sentence"] for warning in report["warnings"]],
                     report.get("coordinates", {}).get("geographic"))
