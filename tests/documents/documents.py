# SPDX-License-Identifier: Apache-2.0
"""Runs what the documents tell their readers to run, and fails, with file and line, where a command
fails or prints something else than the page shows.

    documents.py BUILD [--anew] [--processor NAME] [PAGE...]

BUILD is the folder of weft, weftd and python/, such as build/release. Pages are README.md,
CONTRIBUTING.md, docs/**/*.md and client/python/README.md, but for those that docs/generate.py makes. With --anew the
pages get what their commands print and draw now, for a person to look at. With --processor they run as
on one of processors.py, so that what only holds on this machine is seen on this machine.

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

    <!-- within 1e-4: REASON -->    before a block that shows output: the tolerance of its numbers

Words are compared exactly, numbers within the tolerance of printed.py. What varies from run to run and from machine to machine is in printed.py; a line `...` stands for any number
of lines.

A picture that a page shows must be one that its commands have drawn, in a file of that name, and
must look like it; tests/console makes and compares those of the console, console-*.png. A link to a
file, or a heading, of the repository must lead to one, and a source that the text names, such as
`engine/engine.h`, must be there.
"""

from __future__ import annotations

import argparse
import concurrent.futures
import os
import pathlib
import sys
import tempfile
import time
import traceback

import page as pages
import pictures
import processors
from interpreter import Failed
from session import DATABASE, ROOT, Session

GENERATED = ["api.md", "flags.md"]  # docs/generate.py --check


def run_page(build: pathlib.Path, path: pathlib.Path, anew: bool) -> tuple[bool, str]:
    """Whether all went well, and what to say of it."""
    name = os.path.relpath(path, ROOT)
    start = time.monotonic()
    line = 0  # where we are
    try:
        page = pages.read(path)
        # A server that its shell has ended may still write while the folder goes.
        with tempfile.TemporaryDirectory(prefix="weft-page-", ignore_cleanup_errors=True) as scratch:
            os.chmod(scratch, 0o755)  # PostgreSQL's user has to get through
            session = Session(build, pathlib.Path(scratch), DATABASE in path.read_text(), anew)
            try:
                for block in page.blocks:
                    line = block.line
                    if not block.not_run:
                        session.run(block)
            finally:
                session.close()
            for line, target in page.pictures:
                shown = path.parent / target
                if shown.name.startswith("console-") and shown.exists():
                    continue
                pictures.check(shown, next(pathlib.Path(scratch).rglob(shown.name), None), anew)
        pages.rewrite(path, session.changes)
        for line, target in pages.broken(page):
            raise Failed(line, f"the link leads nowhere: {target}")
        for line, source in pages.missing(page):
            raise Failed(line, f"there is no {source}")
    except pictures.Differs as error:
        return False, f"{name}:{line}: {error}"
    except Failed as error:
        return False, f"{name}:{error.line or line}: {error}"
    except Exception:
        return False, f"{name}:{line}: {traceback.format_exc()}"
    run = [b for b in page.blocks if b.language in ("sh", "console", "python") and not b.not_run]
    compared = [b for b in run if b.output or b.language == "console"]
    said = (f"{name}: {len(run)} blocks run, {len(compared)} with what they print, "
            f"{len(page.pictures)} pictures, {time.monotonic() - start:.1f} s")
    for block in page.blocks:
        if block.not_run:
            said += f"\n  {name}:{block.line} is not run: {block.not_run}"
    return True, said


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("pages", type=pathlib.Path, nargs="*")
    parser.add_argument("--anew", action="store_true")
    parser.add_argument("--processor", choices=processors.NAMES, default="own")
    arguments = parser.parse_intermixed_args()
    os.environ |= processors.environment(arguments.processor)
    paths = [p.resolve() for p in arguments.pages] or [
        ROOT / "README.md", ROOT / "CONTRIBUTING.md", ROOT / "client/python/README.md",
        ROOT / "client/examples/README.md",
        *sorted(p for p in (ROOT / "docs").rglob("*.md") if p.name not in GENERATED)]
    start = time.monotonic()
    failed = []
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        jobs = [pool.submit(run_page, arguments.build.resolve(), path, arguments.anew)
                for path in paths]
        for job in jobs:
            good, said = job.result()
            if good:
                print(said, flush=True)
            else:
                failed.append(said)
    print(*failed, sep="\n")
    print(f"{len(paths)} pages, {len(failed)} of them failed, {time.monotonic() - start:.1f} s")
    sys.exit(bool(failed))


if __name__ == "__main__":
    main()
