#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Looks for files that comments name and that are not there, such as refine/lens.h after it has moved.

A name of a source, with or without folders, must be the end of the path of a file of the tree. Names of
the C and C++ libraries and of others' programs are listed below.
"""

from __future__ import annotations

import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]
SOURCES = ("*.h", "*.cpp", "*.ts", "*.tsx", "*.js", "*.mjs", "*.py", "*.sh", "*.proto", "CMakeLists.txt")
COMMENT = {".py": r"#.*", ".sh": r"#.*", ".txt": r"#.*"}
NAME = re.compile(r"(?<![\w./*$<}-])((?:[\w-]+/)*[\w-]+\.(?:h|cpp|hpp|ts|tsx|mjs|py|sh|proto|patch))(?![\w*/]|\.\w)")
ELSEWHERE = {"libpq-fe.h"}


def tracked(*patterns: str) -> list[str]:
    listed = subprocess.run(["git", "ls-files", "--cached", "--others", "--exclude-standard", "--", *patterns],
                            cwd=ROOT, check=True, capture_output=True, text=True).stdout.split("\n")
    return [name for name in listed if name and (ROOT / name).exists()]


def main() -> None:
    files = set(tracked())
    ends = {"/".join(parts[i:]) for parts in (name.split("/") for name in files) for i in range(len(parts))}
    checked = missing = 0
    for name in tracked(*SOURCES):
        comment = re.compile(COMMENT.get(pathlib.Path(name).suffix, r"//.*"))
        for number, line in enumerate((ROOT / name).read_text().split("\n"), 1):
            found = comment.search(line)
            for named in NAME.findall(found[0]) if found else []:
                checked += 1
                if named in ends or named in ELSEWHERE:
                    continue
                missing += 1
                print(f"{name}:{number}: there is no {named}")
    print(f"{checked} names of files in comments, {missing} of files that are not there")
    sys.exit(missing > 0)


if __name__ == "__main__":
    main()
