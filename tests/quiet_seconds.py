"""How long something takes, on whatever machine, with whatever else running: measured against a piece of work beside it.

Seconds of the processor leave out what other processes take, but not that they make it slower: two on one core, full caches.
"""

from __future__ import annotations

import time
from collections.abc import Callable

_REFERENCE_SECONDS = 0.025
"""What the reference takes on a machine of 2024 on which nothing else runs."""


def _do_reference_work() -> None:
    """Do what archgen mostly does: small objects, dictionaries, texts, sorting."""
    words = {f"word {number % 4999}": (number, str(number)) for number in range(40_000)}
    for _ in range(3):
        ordered = sorted(words.items(), key=lambda item: item[1][1])
        words = {key: (value[0] + 1, value[1]) for key, value in ordered}


def _measure_seconds(work: Callable[[], object]) -> float:
    start = time.process_time()
    work()
    return time.process_time() - start


def measure_quiet_seconds(work: Callable[[], object]) -> float:
    """Return the seconds that the work would take on a quiet machine of 2024, as far as the reference beside it tells."""
    before = _measure_seconds(_do_reference_work)
    seconds = _measure_seconds(work)
    return seconds * _REFERENCE_SECONDS / max(before, _measure_seconds(_do_reference_work))
