#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks that limits which stand in texts and in other languages are those of the library's headers: prints
each that is another, or is no longer where PLACES has it, and fails then.
"""

from __future__ import annotations

import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]
CONSTANT = re.compile(r"inline constexpr [\w:]+ (k\w+) = ([\d.]+);")
PROTO = "proto/weft/v1/mesh_service.proto"
# By the constant: files, and there the only text in which the number stands. White space, and the
# comment that goes on in the next line, count as one space.
PLACES = {
    "kMaxMinAngleDeg": [
        (PROTO, r"Lower bound on every angle, in degrees, from 0 to (\d+)\."),
        (PROTO, r"Minimum angle of every triangle, in degrees\. Range: 0 to (\d+)"),
        ("client/python/src/weft/client.py", r"lower bound on every angle, degrees, 0 to (\d+);"),
        ("console/src/mesh/mesh-form.tsx", r'max="(\d+)" step="0\.5" aria-label="Smallest angle'),
        ("README.md", r"minimum angle is 20 degrees unless you say otherwise, and (\d+) at most"),
        ("README.md", r"ended, and most at (\d+)\."),
        ("docs/how-it-works.md", r"up to the (\d+) that `--min-angle`")],
    "kMaxSweeps": [
        (PROTO, r"Sweeps of smoothing, from 0 to (\d+):"),
        (PROTO, r'around them is largest\. Range: 0 to (\d+)')],
    "kMaxExpressionBytes": [
        (PROTO, r"Limits: (\d+) bytes, 256 levels"),
        ("docs/size.md", r"An expression may have ([\d,]+) bytes")],
    "kMaxSizeFields": [(PROTO, r"Limit: (\d+) fields, and for the arrays")],
    "kMaxFieldNameBytes": [(PROTO, r"Letters, digits and _, no digit first, at most (\d+) bytes")],
    "kMaxPeriodicPairs": [(PROTO, r"Limit: (\d+) pairs of sides")],
    "kMaxSizesAt": [(PROTO, r"on top of the value\. Limit: (\d+) markers")],
}


def constants() -> dict[str, float]:
    return {name: float(value) for header in sorted((ROOT / "include/weft").glob("*.h"))
            for name, value in CONSTANT.findall(header.read_text())}


def faults() -> list[str]:
    limits = constants()
    found = []
    for name, places in PLACES.items():
        for file, pattern in places:
            text = re.sub(r"\s+(?:(?://|#) )?", " ", (ROOT / file).read_text())
            numbers = re.findall(pattern, text)
            if len(numbers) != 1:
                found.append(f"{file}: '{pattern}' is there {len(numbers)} times, not once")
            elif float(numbers[0].replace(",", "")) != limits[name]:
                found.append(f"{file}: says {numbers[0]}; {name} is {limits[name]:g}")
    return found


def main() -> None:
    wrong = faults()
    for fault in wrong:
        print(fault)
    print(f"{sum(map(len, PLACES.values()))} places that name limits, {len(wrong)} wrong")
    sys.exit(bool(wrong))


if __name__ == "__main__":
    main()
