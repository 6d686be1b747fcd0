# SPDX-License-Identifier: Apache-2.0
"""What the programs tell of themselves by `--help`: the text, and its rows.

docs/generate.py writes the pages of flags from the text, man_pages.py and completions.py write
theirs from the rows. Text that is no row as CLI11 prints them raises ValueError: nothing is lost
silently.
"""
import dataclasses
import os
import pathlib
import re
import subprocess

COLUMN = 30  # where the text of a row begins, less in groups, which are indented


@dataclasses.dataclass
class Row:
    """A flag, a positional or a command."""
    names: list[str]  # of a flag, as -o, --output; otherwise one
    text: str
    value: str = ""  # what a flag takes, as FILE or lattice|circumcentre; empty: nothing
    default: str = ""
    variable: str = ""  # of the environment
    needs: str = ""  # the flag without which it is refused
    excludes: str = ""  # the flag with which it is refused
    repeated: bool = False
    required: bool = False

    def choices(self):
        """The words that a value may be; empty if it may be others."""
        words = re.fullmatch(r"[a-z0-9.]+(\|[a-z0-9.]+)+", self.value)
        return self.value.split("|") if words else []

    def extensions(self):
        """Of the files that it takes, as poly; empty if any. The text lists them after a colon."""
        lists = re.findall(r": (\.\w+(?:, \.\w+)*)(?=;|$)", self.text)
        return re.findall(r"\.(\w+)", " ".join(lists))

    def kind(self):
        """What the value is: choice, file, folder, other; or nothing if it takes none."""
        if self.choices():
            return "choice"
        if self.value == "DIR":
            return "folder"
        if re.search(r"\b(FILE|INPUT|MESH|MANIFEST|IN|OUT)\b", self.value):
            return "file"
        return "other" if self.value else "nothing"


@dataclasses.dataclass
class Help:
    summary: str
    usage: str
    positionals: list[Row] = dataclasses.field(default_factory=list)
    commands: list[Row] = dataclasses.field(default_factory=list)
    flags: dict[str, list[Row]] = dataclasses.field(default_factory=dict)  # by the group's title
    closing: list[str] = dataclasses.field(default_factory=list)  # lines below the rows

    def all_flags(self):
        return [row for group in self.flags.values() for row in group]


def _printed_by(program, *words):
    """Where no variable of weft is set. WEFT_EMULATOR is the command that runs programs of another
    processor."""
    environment = {k: v for k, v in os.environ.items() if not k.startswith("WEFT_")}
    emulator = os.environ.get("WEFT_EMULATOR", "").split()
    return subprocess.run([*emulator, program, *words], check=True, capture_output=True, text=True,
                          env=environment).stdout


def help_of(program, *words):
    """The help, as it is where no variable of weft is set."""
    # Programs name themselves as they were called; defaults that the machine decides are left out.
    text = _printed_by(program, *words, "--help").replace(str(program), pathlib.Path(program).name)
    text = re.sub(r"^(  --threads .*)=\d+ \(", r"\1 (", text, flags=re.M)
    return "\n".join(line.rstrip() for line in text.strip().splitlines())


def version_of(program):
    """As 0.1.0."""
    return _printed_by(program, "--version").split()[1]


def commands_of(weft):
    """The rows of the commands of the program `weft`."""
    return parse(help_of(weft)).commands


_FLAG = re.compile(r"""(?P<names>-[^\s,]+(,-[^\s,]+)*)
                       ([ ](?P<value>[^\s=(]+?))?
                       (=(?P<default>\S+))?(?P<repeated>[ ]\.\.\.)?
                       (?P<required>[ ]REQUIRED)?([ ]\(Env:(?P<variable>\w+)\))?
                       ([ ]Needs:[ ](?P<needs>\S+))?([ ]Excludes:[ ](?P<excludes>\S+))?""", re.X)
_POSITIONAL = re.compile(r"(?P<name>[A-Z]+) TEXT(?P<repeated> \.\.\.)?(?P<required> REQUIRED)?")


def _flag(head, text):
    found = _FLAG.fullmatch(head)
    if not found:
        return None
    part = {k: v or "" for k, v in found.groupdict().items()}
    names = [re.sub(r"\{.*", "", name) for name in part["names"].split(",")]
    return Row(names, text, part["value"], part["default"].strip("[]"), part["variable"],
               part["needs"], part["excludes"], bool(part["repeated"]), bool(part["required"]))


def _positional(head, text):
    found = _POSITIONAL.fullmatch(head)
    return found and Row([found["name"]], text, found["name"], repeated=bool(found["repeated"]),
                         required=bool(found["required"]))


def _command(head, text):
    return Row([head], text) if re.fullmatch("[a-z-]+", head) else None


def _row(lines, make):
    """The row at the beginning of `lines`, and how many lines it takes; None if there is none."""
    line = lines[0] if lines else ""
    indent = len(line) - len(line.lstrip())
    column = COLUMN + indent - 2
    head, text, taken = line[:column], line[column:], 1
    following = "".join(lines[1:2])
    if following.startswith(" " * column):  # the head is too long for its column
        head, text, taken = line, following, 2
    row = make(head.strip(), text.strip()) if indent in (2, 4) else None
    return row and (row, taken)


def _reader(title, following):
    """What reads the rows below a heading, by its title and the line after it; None if none are."""
    if title == "Positionals":
        return _positional
    if following == "  Options:" or following.startswith("  -"):
        return _flag
    return _command if _row([following], _command) else None


def parse(text):
    """The rows of a help."""
    lines = text.splitlines()
    usage = next(i for i, line in enumerate(lines) if line.startswith("Usage: "))
    result = Help(" ".join(lines[:usage]), lines[usage].removeprefix("Usage: "))
    at, title, make = usage + 1, "", None
    while at < len(lines):
        line = lines[at]
        if heading := re.fullmatch(r"\[Option Group: (.*)\]|(\S.*):", line):
            title = heading[1] or heading[2]
            make = _reader(title, "".join(lines[at + 1:at + 2]))
            if not make:
                break  # such as Examples
            at += 1
        elif line in ("", "  Options:"):
            at += 1
        elif make and (found := _row(lines[at:], make)):
            row, taken = found
            at += taken
            if make is _flag:
                result.flags.setdefault(title, []).append(row)
            else:
                (result.positionals if make is _positional else result.commands).append(row)
        else:
            break
    result.closing = lines[at:]
    if lost := [line for line in result.closing if re.match(r" {2,4}-.*\(Env:| {28,}\S", line)]:
        raise ValueError(f"no row of a help: {lost[0]}")
    return result
