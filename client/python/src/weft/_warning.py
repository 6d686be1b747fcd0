# SPDX-License-Identifier: Apache-2.0
"""Warnings that name the line of the user, however deep in the package they arise, and in whatever
thread."""

from __future__ import annotations

import asyncio
import contextlib
import os
import sys
import warnings
from collections.abc import Callable, Iterator
from contextvars import ContextVar
from typing import ParamSpec, TypeVar

from .errors import WeftWarning

_P = ParamSpec("_P")
_T = TypeVar("_T")
_PACKAGE = os.path.dirname(__file__) + os.sep
_kept: ContextVar[list[str] | None] = ContextVar("_kept", default=None)


def warn(sentence: str) -> None:
    """Warns of it with a WeftWarning."""
    if (kept := _kept.get()) is not None:
        kept.append(sentence)
        return
    level = 1
    frame = sys._getframe(1)
    while frame.f_back and frame.f_code.co_filename.startswith(_PACKAGE):
        frame, level = frame.f_back, level + 1
    warnings.warn(sentence, WeftWarning, stacklevel=level + 1)


@contextlib.contextmanager
def keeping_warnings() -> Iterator[list[str]]:
    """What is warned of in the context is in the list instead."""
    kept: list[str] = []
    before = _kept.set(kept)
    try:
        yield kept
    finally:
        _kept.reset(before)


async def in_thread(function: Callable[_P, _T], *arguments: _P.args, **options: _P.kwargs) -> _T:
    """Calls the function in a thread, for the event loop to go on. What it warns of is kept until it
    has ended, and left out if it failed, because the lines of the user are on the stack here alone."""
    def call() -> tuple[_T, list[str]]:
        with keeping_warnings() as kept:
            return function(*arguments, **options), kept
    result, sentences = await asyncio.to_thread(call)
    for sentence in sentences:
        warn(sentence)
    return result
