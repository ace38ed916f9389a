"""A time limit for all that one call does, however slowly a server answers."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import TypeVar

from archgen.forge.forge_api import ForgeError

T = TypeVar("T")


def run_within(seconds: float, function: Callable[[], T]) -> T:
    """Call a function and return its result; raise ForgeError where it takes longer, and whatever it raises.

    It runs in a thread of its own, since sockets limit the wait for the next byte only. A thread that is not ready in
    time is left behind: it ends with the process.
    """
    results: list[T] = []
    errors: list[BaseException] = []

    def run() -> None:
        try:
            results.append(function())
        except BaseException as error:  # noqa: BLE001 - raised again below, in the thread that called
            errors.append(error)

    thread = threading.Thread(target=run, daemon=True)
    thread.start()
    thread.join(seconds)
    if errors:
        raise errors[0]
    if not results:
        msg = f"no answer within {seconds:g} s"
        raise ForgeError(msg)
    return results[0]
