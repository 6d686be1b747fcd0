#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Writes the manual pages of weft, of each of its commands and of weftd, from their --help.

    deploy/package/man_pages.py BUILD OUT

BUILD is the folder of weftd and weft. OUT gets weft.1.gz, weft-mesh.1.gz and so on, and weftd.8.gz.
SOURCE_DATE_EPOCH, if set, is the date that they bear; otherwise it is that of today.
"""
import datetime
import gzip
import os
import pathlib
import re
import sys
import time

import program_help

SERVER_TEXT = """\
Serves the protocol weft.v1 over gRPC: refines meshes on all cores and streams them while it does.
With --data or --store it also keeps jobs. On SIGTERM it finishes open calls, then exits.
"""
SERVER_FILES = {
    "/etc/default/weftd": "Variables of the service, such as WEFT_LISTEN.",
    "/var/lib/weftd": "Jobs and meshes of the service.",
}


def escaped(text):
    """For roff: what it would read as its own, and what it would print as another character."""
    for plain, roff in (("\\", "\\e"), ("-", "\\-"), ("'", "\\(aq"), ("`", "\\(ga"), ("^", "\\(ha"),
                        ("~", "\\(ti")):
        text = text.replace(plain, roff)
    return text


def line(roff):
    """As a line of text: a point at its beginning would make it a request."""
    return "\\&" + roff if roff.startswith(".") else roff


def prose(text):
    """A paragraph; what is in backticks is bold."""
    return line("".join(rf"\fB{escaped(part)}\fR" if i % 2 else escaped(part)
                        for i, part in enumerate(re.split(r"`([^`]*)`", text))))


class Page:
    """One page of the manual, as roff."""

    def __init__(self, name, section, summary, version, date):
        self.file = f"{name}.{section}.gz"
        self.lines = [
            f'.TH "{escaped(name.upper())}" "{section}" "{date}" "weft {version}" "Manual of weft"',
            ".SH NAME",
            f"{escaped(name)} \\- {escaped(summary[0].lower() + summary[1:].rstrip('.'))}"]

    def section(self, title, *lines):
        self.lines += [f".SH {title}", *lines]

    def paragraphs(self, text):
        self.lines += [prose(" ".join(text.split()))]

    def literal(self, lines):
        self.lines += [".nf", *(line(escaped(text)) for text in lines), ".fi"]

    def item(self, head, *texts):
        self.lines += [".TP", head]
        for i, text in enumerate(texts):
            self.lines += [".br"] * (i > 0) + [prose(text)]

    def synopsis(self, usage):
        words = usage.split()
        fonts = ["I" if word.strip("[].").isupper() else "B" for word in words]
        self.section("SYNOPSIS", " ".join(
            rf"\f{font}{escaped(word)}\fR" for font, word in zip(fonts, words)))

    def flags(self, help_):
        for title, rows in help_.flags.items():
            self.lines += [".SH OPTIONS"] if title == "Options" else [f".SS {escaped(title)}"]
            for row in rows:
                self.item(*flag_item(row))

    def closing(self, help_):
        """What a help says below its rows, by its headings; without one it is a note."""
        titles = {"Exit codes": "EXIT STATUS", "Example": "EXAMPLES", "Examples": "EXAMPLES"}
        last = ""
        for block in filter(None, "\n".join(help_.closing).strip("\n").split("\n\n")):
            lines = block.split("\n")
            title = titles.get(lines[0].rstrip(":"), "NOTES")
            self.lines += [".PP"] if title == last else [f".SH {title}"]
            last = title
            if title != "NOTES":
                self.literal([text.removeprefix("  ") for text in lines[1:]])
            elif any(text.startswith(" ") for text in lines):
                self.literal(lines)
            else:
                self.paragraphs(block)

    def see_also(self, *pages):
        references = [rf"\fB{escaped(name)}\fR({section})" for name, section in pages]
        self.section("SEE ALSO", ", ".join(references))

    def write(self, folder):
        # No name and no time in the header: the same page is the same file.
        text = "\n".join(self.lines) + "\n"
        (folder / self.file).write_bytes(gzip.compress(text.encode(), 9, mtime=0))


def flag_item(row):
    """The head and the texts of a flag."""
    head = ", ".join(rf"\fB{escaped(name)}\fR" for name in row.names)
    if row.value:
        head += rf" \fI{escaped(row.value)}\fR" + (" ..." if row.repeated else "")
    facts = []
    facts += [f"Default: {row.default}."] * bool(row.default)
    facts += ["Required."] * row.required
    facts += [f"Needs {row.needs}."] * bool(row.needs)
    facts += [f"Excludes {row.excludes}."] * bool(row.excludes)
    facts += [f"Environment: {row.variable}."] * bool(row.variable)
    return head, row.text.rstrip(".") + ".", *([" ".join(facts)] if facts else [])


def main():
    build, out = (pathlib.Path(word).resolve() for word in sys.argv[1:])
    weft, weftd = build / "weft", build / "weftd"
    version = program_help.version_of(weft)
    epoch = os.environ.get("SOURCE_DATE_EPOCH")
    seconds = int(epoch) if epoch else time.time()
    date = datetime.datetime.fromtimestamp(seconds, datetime.timezone.utc).date()
    out.mkdir(parents=True, exist_ok=True)

    of_weft = program_help.parse(program_help.help_of(weft))
    names = [row.names[0] for row in of_weft.commands]
    page = Page("weft", 1, of_weft.summary, version, date)
    page.synopsis(of_weft.usage)
    page.section("COMMANDS")
    for row in of_weft.commands:
        page.item(rf"\fBweft {escaped(row.names[0])}\fR", row.text + ".")
    page.flags(of_weft)
    page.closing(of_weft)
    page.see_also(*((f"weft-{name}", 1) for name in sorted(names)), ("weftd", 8))
    page.write(out)

    for name in names:
        help_ = program_help.parse(program_help.help_of(weft, name))
        if help_.closing == of_weft.closing:  # of a command that has none of its own
            help_.closing = []
        page = Page(f"weft-{name}", 1, help_.summary, version, date)
        page.synopsis(help_.usage)
        page.section("DESCRIPTION")
        page.paragraphs(help_.summary + ".")
        for row in help_.positionals:
            page.item(rf"\fI{escaped(row.names[0])}\fR", row.text + ".")
        page.flags(help_)
        page.closing(help_)
        page.see_also(("weft", 1), ("weftd", 8))
        page.write(out)

    help_ = program_help.parse(program_help.help_of(weftd))
    page = Page("weftd", 8, help_.summary.removeprefix("weftd: "), version, date)
    page.synopsis(help_.usage)
    page.section("DESCRIPTION")
    page.paragraphs(SERVER_TEXT)
    page.flags(help_)
    page.closing(help_)
    page.section("FILES")
    for file, text in SERVER_FILES.items():
        page.item(rf"\fI{escaped(file)}\fR", text)
    page.see_also(("weft", 1))
    page.write(out)


if __name__ == "__main__":
    main()
