# SPDX-License-Identifier: Apache-2.0
"""The tables of docs/formats.md that tell which program read or wrote what. They hold what the tests
have done, no row less and none more, so that a version in them is never an old one."""

import sys


def check(docs, head, rows):
    """`docs`: path; `head`: the first line of the table; `rows`: as the table must have them. Ends
    the program where it has not."""
    lines = iter(open(docs).read().splitlines())
    if head not in lines:  # leaves the iterator behind it
        sys.exit(f"{docs} has no table {head}")
    next(lines)
    found = []
    for line in lines:
        if not line.startswith("|"):
            break
        found.append(line)
    if found == rows:
        return
    for what, left in (("lacks", [r for r in rows if r not in found]),
                       ("has, though nothing tests it", [r for r in found if r not in rows])):
        for row in left:
            print(f"{docs} {what}: {row}", file=sys.stderr)
    sys.exit(f"{docs}: the table {head} is not that of the tests, or not in their order")
