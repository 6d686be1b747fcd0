# SPDX-License-Identifier: Apache-2.0
"""Pictures of pages: shrunk from what the commands draw, and held against it."""

from __future__ import annotations

import pathlib

from PIL import Image, ImageChops, ImageStat

WIDTH = 1000  # pixels, at most
MOST_BYTES = 150_000
ALIKE = 6  # of 255: mean difference of two pictures, both shrunk to THUMBNAIL
THUMBNAIL = (50, 50)


class Differs(Exception):
    pass


def check(shown: pathlib.Path, drawn: pathlib.Path | None, anew: bool) -> None:
    """That `shown`, of a page, is what was drawn; with `anew` it becomes so. Raises Differs."""
    if drawn is None:
        raise Differs(f"no command of this page draws {shown.name}")
    if anew:
        shown.parent.mkdir(parents=True, exist_ok=True)
        shrink(drawn, shown)
    if not shown.exists():
        raise Differs(f"there is no picture {shown}; documents.py --anew makes it")
    if shown.stat().st_size > MOST_BYTES:
        raise Differs(f"{shown.name} has {shown.stat().st_size} bytes, more than {MOST_BYTES}")
    difference = ImageChops.difference(thumbnail(shown), thumbnail(drawn))
    mean = sum(ImageStat.Stat(difference).mean) / 3
    if mean > ALIKE:
        raise Differs(f"{shown.name} does not look like what is drawn now: the mean difference is "
                      f"{mean:.1f} of 255; documents.py --anew makes it anew")


def thumbnail(path: pathlib.Path) -> Image.Image:
    return opaque(path).resize(THUMBNAIL, Image.Resampling.BOX)


def opaque(path: pathlib.Path) -> Image.Image:
    picture = Image.open(path).convert("RGBA")
    white = Image.new("RGBA", picture.size, "white")
    return Image.alpha_composite(white, picture).convert("RGB")


def shrink(drawn: pathlib.Path, shown: pathlib.Path) -> None:
    """With as many colours and pixels as fit into MOST_BYTES."""
    picture = opaque(drawn)
    for width in (WIDTH, 900, 800, 700, 600):
        width = min(width, picture.width)
        small = picture.resize((width, round(picture.height * width / picture.width)),
                               Image.Resampling.LANCZOS)
        for colors in (128, 64, 32):
            # A line's colour is that of few pixels, and must stay.
            small.quantize(colors, Image.Quantize.MAXCOVERAGE, kmeans=1,
                           dither=Image.Dither.NONE).save(shown, optimize=True)
            if shown.stat().st_size <= MOST_BYTES:
                return
