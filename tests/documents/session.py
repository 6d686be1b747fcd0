# SPDX-License-Identifier: Apache-2.0
"""A page while it is run: its folder, its shell and its Python, its servers and its database."""

from __future__ import annotations

import itertools
import os
import pathlib
import re
import shutil
import time

import interpreter
import page as pages
from interpreter import Failed
from page import ROOT
from postgres import Postgres
from printed import is_as_shown, without_progress

DATABASE = "postgres://weft@db/weft"  # as pages call the one that they are given

addresses = (f"127.{n >> 16 & 127 | 64}.{n >> 8 & 255}.{n & 255}"  # no two pages share one
             for n in itertools.count(os.getpid() * 61))


class Session:
    """Runs the blocks of a page in `folder`, which is empty, with the programs of `build`. With
    `anew`, output that is not as shown is not a failure, but noted in `changes`."""

    def __init__(self, build: pathlib.Path, folder: pathlib.Path, needs_database: bool, anew: bool):
        self.folder = folder
        self.anew = anew
        self.changes: list[tuple[pages.Block, str]] = []
        self.database = self.python = None
        # Pages name the addresses and the database that a reader has; here many pages, tests and
        # people share a machine.
        own = next(addresses)
        self.names = {"127.0.0.1": own, "0.0.0.0": own}
        if needs_database:
            (folder / ".postgres").mkdir()
            self.database = Postgres(folder / ".postgres")
            self.names[DATABASE] = self.database.uri
        for name in ("CMakeLists.txt", "LICENSE", "NOTICE", "tests", "deploy", "proto"):
            (folder / name).symlink_to(ROOT / name)
        shutil.copytree(ROOT / "client/python", folder / "client/python",
                        ignore=shutil.ignore_patterns("__pycache__", "build", "*.egg-info"))
        self.ready = folder / ".ready"
        (folder / ".bin").mkdir()
        server = folder / ".bin/weftd"  # ends with the shell that started it
        server.write_text(f"#!/bin/sh\nWEFT_PORT_FILE='{self.ready}' exec setpriv --pdeathsig TERM -- "
                          f"'{build}/weftd' \"$@\"\n")
        server.chmod(0o755)
        self.environment = {k: v for k, v in os.environ.items() if not k.startswith("WEFT_")}
        self.environment |= {
            "PATH": f"{folder}/.bin:{build}:/usr/bin:/bin:{os.environ['PATH']}", "LC_ALL": "C.UTF-8",
            "WEFT_LISTEN": f"{own}:7421", "WEFT_WEFTD": f"{build}/weftd",
            "PYTHONPATH": f"{build}/python", "MPLBACKEND": "agg", "HOME": str(folder)}
        self.shell = interpreter.shell(folder, self.environment)

    def close(self) -> None:
        for each in (self.python, self.shell, self.database):
            if each:
                each.close()

    def run(self, block: pages.Block) -> None:
        """Raises Failed."""
        if block.file:
            path = self.folder / block.file
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(block.code)
        elif block.language == "sh":
            self._compare(block.output, self._run_shell(block))
        elif block.language == "python":
            self.python = self.python or interpreter.python(self.folder, self.environment)
            code = pages.on_line(block.line, block.code)
            self._compare(block.output, self._call(self.python, code))
        elif block.language == "console":
            self._run_console(block)
        elif block.language != "text" and re.search(r"^(\$|weftd?) ", block.code, re.M):
            raise Failed(block.line, f"commands in a block of '{block.language}' are not run")

    def _run_shell(self, block: pages.Block) -> str:
        """Waits for a server to listen before it goes on, as its reader does."""
        printed = ""
        line = block.line
        for part in re.split(r"(?<=\n)(?<!\\\n)(?=weftd )", block.code):
            self.ready.unlink(missing_ok=True)
            first, rest = part.split("\n", 1)
            serves = re.match(r"weftd .*&( *#.*)?$", first)
            if serves:
                printed += self._call(self.shell, pages.on_line(line, first))
                self._wait_until_it_listens(line)
                line, part = line + 1, rest
            printed += self._call(self.shell, pages.on_line(line, part))
            line += part.count("\n")
        return printed

    def _wait_until_it_listens(self, line: int) -> None:
        end = time.monotonic() + interpreter.PATIENCE
        while not self.ready.exists():
            if self.shell.run("kill -0 $! 2> /dev/null || echo ended", shown=True):
                raise Failed(line, "the server has ended")
            if time.monotonic() > end:
                raise Failed(line, "the server does not listen")
            time.sleep(0.02)

    def _run_console(self, block: pages.Block) -> None:
        lines = block.code.splitlines(keepends=True)
        at = 0
        while at < len(lines):
            command = [lines[at].removeprefix("$ ")]
            while command[-1].endswith("\\\n"):
                command.append(lines[at + len(command)])
            at += len(command)
            shown = list(itertools.takewhile(lambda line: not line.startswith("$ "), lines[at:]))
            printed = self._call(self.shell, "".join(command), shown=True)
            self._compare(pages.Block("text", "".join(shown), block.line + at, tolerance=block.tolerance),
                          printed)
            at += len(shown)

    def _call(self, runner: interpreter.Interpreter, code: str, shown: bool = False) -> str:
        for name, own in self.names.items():
            code = code.replace(name, own)
        printed = runner.run(code, shown)
        for name, own in self.names.items():
            printed = printed.replace(own, name)  # the first of two names for the same
        return without_progress(printed)

    def _compare(self, expected: pages.Block | None, printed: str) -> None:
        if expected is None or is_as_shown(printed, expected.code, expected.tolerance):
            return
        if not self.anew:
            raise Failed(expected.line, f"the page shows\n{expected.code}but it prints\n{printed}")
        self.changes.append((expected, printed))
