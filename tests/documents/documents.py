# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs what the documents tell their readers to run, and fails, with file and line, where a command
fails or prints something else than the page shows.

    documents.py BUILD [--pictures] [PAGE...]

BUILD is the folder of weft, weftd and python/, such as build/release. Pages are README.md,
docs/**/*.md and client/python/README.md, but for those that docs/generate.py makes. With --pictures
the pictures that pages show are made anew: from the files of that name that their commands draw.

A page is run from its top in an empty folder that stands for the root of the repository: tests/,
deploy/ and client/ are there. Programs, servers, certificates and databases are real.

    sh        runs in bash. All blocks of a page share a shell; a command that fails ends the page.
    python    runs in Python, all blocks of a page in the same.
    text      after one of these: what it printed.
    console   commands after `$ `, and what each printed, errors included. A command that fails must
              show what it says; its exit code matters where `$ echo $?` shows it.
    any other is a file, where its first line is `# NAME`; otherwise it is for looking at, and holds
              no commands.

    <!-- not run: REASON -->    on a line of its own before a block that cannot be run here

What varies from run to run and from machine to machine is in VARIES; a line `...` stands for any
number of lines.

A picture that a page shows must be one that its commands have drawn, in a file of that name, and
must look like it. A link to a file, or a heading, of the repository must lead to one.
"""

from __future__ import annotations

import argparse
import concurrent.futures
import itertools
import os
import pathlib
import re
import shutil
import sys
import tempfile
import time

import interpreter
import page as pages
import pictures
from interpreter import Failed
from postgres import Postgres

ROOT = pathlib.Path(__file__).resolve().parents[2]
GENERATED = ["api.md", "flags.md"]  # docs/generate.py --check
DATABASE = "postgres://weft@db/weft"  # as pages call the one that they are given

VARIES = [
    r"\d+(\.\d+)?(?= (s|ms)\b)",                   # seconds
    r"(?<=seconds=)\d+\.\d+",                     # in the log
    r"(?<=on )\d+ threads?",                       # of the machine
    r"\b[0-9A-HJKMNP-TV-Z]{26}\b",                 # ids of jobs
    r"\b\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d(\.\d+)?Z",  # times
    r"(?<=unix:)/tmp/weft-\w+/socket",             # of the server that weft starts
]
# Steps of the progress that stderr shows where it is no terminal: how many depends on the time.
PROGRESS = r"weft: (connecting|waiting|working|triangulating|sizing|refining|receiving|drawing)\b.*\n"

addresses = (f"127.{n >> 16 & 127 | 64}.{n >> 8 & 255}.{n & 255}"  # no two pages share one
             for n in itertools.count(os.getpid() * 61))


class Session:
    """The folder of a page, and what runs in it."""

    def __init__(self, build: pathlib.Path, folder: pathlib.Path, needs_database: bool):
        self.folder = folder
        self.database = None
        # Pages name the addresses and the database that a reader has; here many pages, tests and
        # people share a machine.
        self.names = {"127.0.0.1": next(addresses)}
        if needs_database:
            (folder / ".postgres").mkdir()
            self.database = Postgres(folder / ".postgres")
            self.names[DATABASE] = self.database.uri
        for name in ("tests", "deploy", "proto"):
            (folder / name).symlink_to(ROOT / name)
        shutil.copytree(ROOT / "client/python", folder / "client/python",
                        ignore=shutil.ignore_patterns("__pycache__", "build", "*.egg-info"))
        self.ready = folder / ".ready"
        (folder / ".bin").mkdir()
        server = folder / ".bin/weftd"  # ends with the shell that started it
        server.write_text(f"#!/bin/sh\nWEFT_PORT_FILE='{self.ready}' exec setpriv --pdeathsig TERM -- "
                          f"'{build}/weftd' \"$@\"\n")
        server.chmod(0o755)
        environment = {k: v for k, v in os.environ.items() if not k.startswith("WEFT_")}
        environment |= {
            "PATH": f"{folder}/.bin:{build}:/usr/bin:/bin:{environment['PATH']}", "LC_ALL": "C.UTF-8",
            "WEFT_LISTEN": self.names["127.0.0.1"] + ":7421", "WEFT_WEFTD": f"{build}/weftd",
            "PYTHONPATH": f"{build}/python", "MPLBACKEND": "agg", "HOME": str(folder)}
        self.environment = environment
        self.shell = interpreter.shell(folder, environment)
        self.python = None

    def close(self) -> None:
        for each in (self.python, self.shell, self.database):
            if each:
                each.close()

    def run(self, block: pages.Block) -> None:
        if block.file:
            path = self.folder / block.file
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(block.code)
        elif block.language == "sh":
            self._compare(block.output, self._run_shell(block))
        elif block.language == "python":
            self.python = self.python or interpreter.python(self.folder, self.environment)
            self._compare(block.output, self._call(self.python, block.padded()))
        elif block.language == "console":
            self._run_console(block)
        elif block.language != "text" and re.search(r"^(\$|weftd?) ", block.code, re.M):
            raise Failed(block.line, f"commands in a block of '{block.language}' are not run")

    def _run_shell(self, block: pages.Block) -> str:
        """Waits for a server to listen before it goes on, as its reader does."""
        printed = ""
        start = block.line
        for number, line in enumerate(block.code.splitlines(), start=block.line):
            last = number == block.line + block.code.count("\n") - 1
            serves = re.match(r"weftd .*&( *#.*)?$", line)
            if not (serves or last):
                continue
            part = block.code.splitlines()[start - block.line:number - block.line + 1]
            self.ready.unlink(missing_ok=True)
            printed += self._call(self.shell, block.padded("\n".join(part) + "\n", start))
            start = number + 1
            if serves:
                self._wait_until_it_listens(number)
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
        command, shown, at = "", "", block.line
        for number, line in enumerate([*block.code.splitlines(), "$ "], start=block.line):
            if line.startswith("$ "):
                if command:
                    printed = self._call(self.shell, command, shown=True)
                    self._compare(pages.Block("text", shown, at), printed)
                command, shown, at = line[2:] + "\n", "", number
            elif command.endswith("\\\n"):
                command += line + "\n"
            else:
                shown += line + "\n"

    def _call(self, runner: interpreter.Interpreter, code: str, shown: bool = False) -> str:
        for name, own in self.names.items():
            code = code.replace(name, own)
        printed = runner.run(code, shown)
        for name, own in self.names.items():
            printed = printed.replace(own, name)
        return re.sub(PROGRESS, "", printed)

    @staticmethod
    def _compare(expected: pages.Block | None, printed: str) -> None:
        if expected and not re.fullmatch(pattern_of(expected.code), settled(printed)):
            raise Failed(expected.line, f"the page shows\n{expected.code}but it prints\n{printed}")


def settled(text: str) -> str:
    """The same for all that differs only in what varies."""
    for varies in VARIES:
        text = re.sub(varies, "*", text)
    return "".join(line.rstrip() + "\n" for line in text.splitlines())


def pattern_of(shown: str) -> str:
    return "".join(r"(.*\n)*?" if line.strip() == "..." else re.escape(line) + r"\n"
                   for line in settled(shown).splitlines())


def run_page(build: pathlib.Path, path: pathlib.Path, anew: bool) -> tuple[bool, str]:
    """Whether all went well, and what to say of it."""
    name = path.relative_to(ROOT)
    page = pages.read(path)
    start = time.monotonic()
    counts = {"run": 0, "compared": 0}
    with tempfile.TemporaryDirectory(prefix="weft-page-") as scratch:
        os.chmod(scratch, 0o755)  # PostgreSQL's user has to get through
        session = Session(build, pathlib.Path(scratch), DATABASE in path.read_text())
        line = 0
        try:
            for block in page.blocks:
                line = block.line
                if block.language in ("sh", "console", "python") and not block.not_run:
                    counts["run"] += 1
                    counts["compared"] += block.language == "console" or block.output is not None
                if not block.not_run:
                    session.run(block)
            for line, target in page.pictures:
                shown = path.parent / target
                pictures.check(shown, next(pathlib.Path(scratch).rglob(shown.name), None), anew)
            for line, target in pages.broken(page):
                raise Failed(line, f"the link leads nowhere: {target}")
        except (Failed, pictures.Differs) as error:
            return False, f"{name}:{getattr(error, 'line', 0) or line}: {error}"
        finally:
            session.close()
    said = (f"{name}: {counts['run']} blocks run, {counts['compared']} with what they print, "
            f"{len(page.pictures)} pictures, {time.monotonic() - start:.1f} s")
    for block in page.blocks:
        if block.not_run:
            said += f"\n  {name}:{block.line} is not run: {block.not_run}"
    return True, said


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("pages", type=pathlib.Path, nargs="*")
    parser.add_argument("--pictures", action="store_true")
    arguments = parser.parse_args()
    paths = [p.resolve() for p in arguments.pages] or [
        ROOT / "README.md", ROOT / "client/python/README.md",
        *sorted(p for p in (ROOT / "docs").rglob("*.md") if p.name not in GENERATED)]
    start = time.monotonic()
    failed = 0
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        jobs = [pool.submit(run_page, arguments.build.resolve(), path, arguments.pictures)
                for path in paths]
        for job in jobs:
            good, said = job.result()
            print(said, flush=True)
            failed += not good
    print(f"{len(paths)} pages, {failed} of them failed, {time.monotonic() - start:.1f} s")
    sys.exit(failed != 0)


main()
