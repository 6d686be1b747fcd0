# SPDX-License-Identifier: Apache-2.0
"""Text of files, as files/bytes/file_contents.h and number_text.h read it, and numbers in
messages, as files/base/text.h writes them."""

from __future__ import annotations

import codecs
import math
import pathlib
import re

# A number with an exponent as Fortran writes it: 1.0D+03, or 1.0+103 without a letter.
_FORTRAN = re.compile(r"(?<![^\s,])([+-]?(?:\d+\.?\d*|\.\d+))[dD]([+-]?\d+)(?![^\s,])")
_NO_LETTER = re.compile(r"(?<![^\s,])([+-]?(?:\d+\.\d*|\.\d+))([+-]\d{3})(?![^\s,])")


def read_text(path: pathlib.Path, errors: str = "strict") -> str:
    """Without a byte order mark, of UTF-8 or, with a mark, UTF-16; lines end in line feeds. Raises
    ValueError if the bytes are neither."""
    raw = path.read_bytes()
    if raw.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        text = raw.decode("utf-16")
    else:
        text = raw.removeprefix(codecs.BOM_UTF8).decode("utf-8", errors)
    return re.sub(r"\r+\n|\r", "\n", text)


def without_fortran(line: str) -> str:
    """The line with its numbers' exponents as Python reads them."""
    return _NO_LETTER.sub(r"\1e\2", _FORTRAN.sub(r"\1e\2", line))


def number_of(text: str) -> float | None:
    """The finite number that a text is as a whole, blanks around it aside; None if it is none."""
    word = without_fortran(text.strip())
    if not re.fullmatch(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?", word, re.ASCII):
        return None
    value = float(word)
    return value if math.isfinite(value) else None


def shortest(value: float) -> str:
    """The shortest text that reads back as the same number."""
    exact = repr(float(value))
    if not math.isfinite(value):
        return exact
    digits = len(exact.partition("e")[0].replace(".", "").strip("-0"))
    scientific = f"{value:.{max(digits - 1, 0)}e}"
    fixed = f"{value:.0f}" if value == int(value) else f"{value:.{_decimals(scientific)}f}"
    return scientific if len(scientific) < len(fixed) else fixed


def _decimals(scientific: str) -> int:
    mantissa, _, exponent = scientific.partition("e")
    return max(0, len(mantissa.partition(".")[2]) - int(exponent))


def coordinates(x: float, y: float) -> str:
    """"(x, y)" in shortest numbers."""
    return f"({shortest(x)}, {shortest(y)})"
