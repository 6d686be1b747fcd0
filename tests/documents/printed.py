# SPDX-License-Identifier: Apache-2.0
"""What a command prints, against what a page shows of it."""

from __future__ import annotations

import re

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


def without_progress(text: str) -> str:
    return re.sub(PROGRESS, "", text)


def is_as_shown(printed: str, shown: str) -> bool:
    """A line `...` of the page stands for any number of lines."""
    pattern = "".join(r"(.*\n)*?" if line == "..." else re.escape(line) + r"\n"
                      for line in settled(shown).splitlines())
    return re.fullmatch(pattern, settled(printed)) is not None


def settled(text: str) -> str:
    """The same for all that differs only in what varies, or in blanks at the ends of lines."""
    for varies in VARIES:
        text = re.sub(varies, "*", text)
    return "".join(line.rstrip() + "\n" for line in text.splitlines())
