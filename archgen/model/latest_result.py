"""What was made of an object last: of one object several ask for the same, one after another."""

from __future__ import annotations

import functools
import threading
from collections.abc import Callable
from typing import TypeVar

_Argument = TypeVar("_Argument")
_Result = TypeVar("_Result")


def remember_latest(make: Callable[[_Argument], _Result]) -> Callable[[_Argument], _Result]:
    """Return a function that makes nothing anew of the very object that it was asked for last; each thread has its own memory."""
    memory = threading.local()

    @functools.wraps(make)
    def recall_or_make(argument: _Argument) -> _Result:
        if getattr(memory, "latest", (None,))[0] is not argument:
            memory.latest = argument, make(argument)
        result: _Result = memory.latest[1]
        return result

    return recall_or_make
