#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks that tests/ mirrors the sources: prints each test that breaks a rule below, and fails then.

    tests/mirror.py [FOLDER]     FOLDER is the root of the sources; default: the one this lies in

Rules, on the x_test.cpp below tests/engine, tests/wire, tests/server, tests/files, tests/client,
tests/checker, tests/loader and tests/bench:
  - The folder is that of a source folder: tests/engine/size/ tests engine/size/.
  - If a source of the room is named x, one in the same folder is: tests/engine/refine/cavity_test.cpp
    tests engine/refine/cavity.h.
  - A test named after no source has a subject of the whole folder, and says in its first comment
    which.
  - A suite is in one file, so that its name in a report leads there; but for those of fixtures in headers,
    which several files share.
"""
import pathlib
import re
import sys

ROOMS = ("engine", "wire", "server", "files", "client", "checker", "loader", "bench")


def fault_of(test: pathlib.PurePosixPath, text: str, folders: dict[str, set[str]]) -> str | None:
    """What is wrong with the test, whose path is from tests/; None if nothing is. `folders`: the
    names of sources, without their extensions, by folder."""
    folder, name = test.parent.as_posix(), test.name.removesuffix("_test.cpp")
    if folder not in folders:
        return f"there is no {folder}/"
    if name in folders[folder]:
        return None
    room = test.parts[0]
    elsewhere = [f for f, names in folders.items() if f.split("/")[0] == room and name in names]
    if elsewhere:
        return f"{name} is in {', '.join(sorted(elsewhere))}"
    if not re.match(r"// SPDX[^\n]*\n// ", text):
        return "tests no source of its name, and does not say what it tests"
    return None


def suites_in_several(tests: pathlib.Path) -> list[str]:
    """Each with its files."""
    files: dict[str, set[str]] = {}
    for path in tests.rglob("*.cpp"):
        for suite in re.findall(r"^ *(?:TYPED_)?TEST(?:_[FP])?\((\w+)", path.read_text(), re.M):
            files.setdefault(suite, set()).add(path.relative_to(tests).as_posix())
    shared = {name for path in tests.rglob("*.h")
              for name in re.findall(r"^class (\w+)", path.read_text(), re.M)}
    return [f"{suite} is in {', '.join(sorted(at))}"
            for suite, at in sorted(files.items()) if len(at) > 1 and suite not in shared]


def main() -> int:
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).parent.parent)
    folders: dict[str, set[str]] = {}
    for room in ROOMS:
        for path in (root / room).rglob("*"):
            if path.suffix in (".h", ".cpp"):
                folders.setdefault(path.relative_to(root).parent.as_posix(), set()).add(path.stem)
    tests = sorted(t for room in ROOMS for t in (root / "tests" / room).rglob("*_test.cpp"))
    faults = 0
    for path in tests:
        test = pathlib.PurePosixPath(path.relative_to(root / "tests").as_posix())
        if why := fault_of(test, path.read_text(), folders):
            faults += 1
            print(f"tests/{test}: {why}")
    for said in suites_in_several(root / "tests"):
        faults += 1
        print(said)
    print(f"{len(tests)} tests, {faults} out of place")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
