# SPDX-License-Identifier: Apache-2.0
"""What a command prints, against what a page shows of it: words exactly, numbers within a tolerance,
because the last digits of what numpy and libm compute are those of the processor."""

from __future__ import annotations

import re

TOLERANCE = 1e-9
"""How far a number may be from the page's, as a part of the larger of both."""

# From run to run, and from machine to machine.
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
# A word of its own, such as -1, 1.5e-3 and 1,234,567: no part of a digest, a name or a version.
NUMBER = re.compile(r"(?<![\w.,])[-+]?(?:\d{1,3}(?:,\d{3})+|\d+)(?:\.\d+)?(?:[eE][-+]?\d+)?(?!\w|[.,]\w)")


def without_progress(text: str) -> str:
    return re.sub(PROGRESS, "", text)


def is_as_shown(printed: str, shown: str, tolerance: float = TOLERANCE) -> bool:
    """A line `...` of the page stands for any number of lines."""
    lines = settled(printed)
    reached = {0}  # the numbers of printed lines that those of the page so far can stand for
    for line in settled(shown):
        if line == "...":
            reached = set(range(min(reached), len(lines) + 1))
        else:
            reached = {n + 1 for n in reached if n < len(lines) and is_same(lines[n], line, tolerance)}
        if not reached:
            return False
    return len(lines) in reached


def is_same(line: str, other: str, tolerance: float) -> bool:
    if line == other:
        return True
    if NUMBER.sub("0", line) != NUMBER.sub("0", other):
        return False
    pairs = zip(*([float(n.replace(",", "")) for n in NUMBER.findall(text)] for text in (line, other)))
    return all(abs(a - b) <= tolerance * max(abs(a), abs(b)) for a, b in pairs)


def settled(text: str) -> list[str]:
    """Lines that are the same for all that differs only in what varies, or in blanks at their ends."""
    for varies in VARIES:
        text = re.sub(varies, "*", text)
    return [line.rstrip() for line in text.splitlines()]
