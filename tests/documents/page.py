# SPDX-License-Identifier: Apache-2.0
"""A page of Markdown as what can be run of it. documents.py tells the conventions."""

from __future__ import annotations

import dataclasses
import pathlib
import re

from interpreter import Failed
from printed import TOLERANCE

FENCE = re.compile(r"```(\w*)")
NOT_RUN = re.compile(r"<!-- not run: (.+) -->")
WITHIN = re.compile(r"<!-- within (\S+): .+ -->")
FILE_NAME = re.compile(r"# ([\w./-]+\.\w+)")
ROOT = pathlib.Path(__file__).resolve().parents[2]
ROOMS = "proto|engine|server|client|checker|tests|bench|deploy|docs"
LINK = re.compile(r"(!?)\[[^\]]*\]\(([^)\s]+)\)")


@dataclasses.dataclass
class Block:
    """Code between two fences."""

    language: str
    code: str
    line: int
    """Of the page, on which the code begins."""
    not_run: str = ""
    """Why, where it is not."""
    tolerance: float = TOLERANCE
    """Of the numbers that it shows as output."""
    output: Block | None = None
    """What it must print, where the page shows that."""

    @property
    def file(self) -> str:
        """The name of the file that it is, if it is one."""
        name = FILE_NAME.fullmatch(self.code.split("\n", 1)[0])
        return name[1] if name and self.language not in ("sh", "console", "python", "text") else ""


@dataclasses.dataclass
class Page:
    path: pathlib.Path
    blocks: list[Block]
    pictures: list[tuple[int, str]]
    """Line and path of each picture that it shows."""
    links: list[tuple[int, str]]
    """Line and target of every other link."""


def on_line(line: int, code: str) -> str:
    """The code on the very lines that it has in the page, so that errors name those."""
    return "\n" * (line - 1) + code


def read(path: pathlib.Path) -> Page:
    """Raises Failed."""
    blocks: list[Block] = []
    links: dict[str, list[tuple[int, str]]] = {"": [], "!": []}
    block = None
    not_run, tolerance = "", TOLERANCE
    for number, line in enumerate(path.read_text().splitlines(), start=1):
        if block is None:
            if fence := FENCE.fullmatch(line):
                block = Block(fence[1], "", number + 1, not_run, tolerance)
                not_run, tolerance = "", TOLERANCE
            elif line.lstrip().startswith("```"):
                raise Failed(number, "this begins no block that the test knows")
            elif reason := NOT_RUN.fullmatch(line):
                not_run = reason[1]
            elif within := WITHIN.fullmatch(line):
                tolerance = float(within[1])
            else:
                for mark, target in LINK.findall(re.sub("`[^`]*`", "`", line)):
                    links[mark].append((number, target))
        elif line == "```":
            if block.language == "text":
                if not blocks or blocks[-1].language not in ("sh", "python"):
                    raise Failed(block.line, "there is no block above that prints this")
                blocks[-1].output = block
            blocks.append(block)
            block = None
        else:
            block.code += line + "\n"
    if block is not None:
        raise Failed(block.line, "this block has no end")
    return Page(path, blocks, links["!"], links[""])


def broken(page: Page) -> list[tuple[int, str]]:
    """Line and target of the links that lead to no file, or no heading of it."""
    found = []
    for line, target in page.links:
        if re.match(r"https?:", target):
            continue
        name, _, anchor = target.partition("#")
        path = page.path.parent / name if name else page.path
        if not path.exists() or (anchor and anchor not in anchors(path)):
            found.append((line, target))
    return found


def missing(page: Page) -> list[tuple[int, str]]:
    """Line and path of the sources that the text names in `code`, from the root, and that are not there."""
    text = re.sub(r"^```.*?^```$", lambda block: "\n" * block[0].count("\n"), page.path.read_text(),
                  flags=re.M | re.S)
    return [(number, name)
            for number, line in enumerate(text.splitlines(), 1)
            for name in re.findall(rf"`((?:{ROOMS})/[\w./-]*)`", line)
            if not (ROOT / name).exists()]


def anchors(path: pathlib.Path) -> set[str]:
    """Of the headings of a page, as GitHub and GitLab name them."""
    text = re.sub(r"^```.*?^```$", "", path.read_text(), flags=re.M | re.S)
    headings = re.findall(r"^#+ (.*)$", text, re.M)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


def rewrite(path: pathlib.Path, changes: list[tuple[Block, str]]) -> None:
    """Replaces blocks, given in the order of the page, at once: other pages may be reading its headings."""
    if not changes:
        return
    lines = path.read_text().splitlines(keepends=True)
    for block, text in reversed(changes):
        first = block.line - 1
        lines[first:first + block.code.count("\n")] = [line.rstrip() + "\n" for line in text.splitlines()]
    whole = path.with_suffix(".new")
    whole.write_text("".join(lines))
    whole.replace(path)
