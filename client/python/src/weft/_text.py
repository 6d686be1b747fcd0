# SPDX-License-Identifier: Apache-2.0
"""Numbers in messages, as client/base/text.h writes them."""

from __future__ import annotations

import math


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
