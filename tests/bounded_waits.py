"""No test waits for ever for a process that it started: after some minutes the process is ended, and the test fails.

Else pytest ends itself (`faulthandler_timeout`), with all tests of the same process of tests. Who names a time has that one.
"""

from __future__ import annotations

import functools
import subprocess
from collections.abc import Callable
from typing import Any

LONGEST_WAIT_SECONDS = 800
"""Sooner than pytest ends itself, and three times as long as the longest test."""


def bound_waits() -> None:
    """Give every wait for a process that has no time of its own one."""
    subprocess.Popen.wait = _bound(subprocess.Popen.wait, 0)  # type: ignore[method-assign]
    subprocess.Popen.communicate = _bound(subprocess.Popen.communicate, 1)  # type: ignore[method-assign]


def _bound(wait: Callable[..., Any], place: int) -> Callable[..., Any]:
    """Return a method that waits for a bounded time; `place` is where the time stands among its arguments."""

    @functools.wraps(wait)
    def wait_bounded(process: subprocess.Popen[Any], *others: Any, **named: Any) -> Any:  # noqa: ANN401 - of any such method
        if len(others) > place or named.get("timeout") is not None:
            return wait(process, *others, **named)
        try:
            return wait(process, *others, **{**named, "timeout": LONGEST_WAIT_SECONDS})
        except subprocess.TimeoutExpired:
            process.kill()
            raise

    return wait_bounded
