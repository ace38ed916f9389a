"""Measure the simulation: events a second of CPU time on the case study, and whether any bound is exceeded.

Usage: python benchmarks/simulation.py [ARCHITECTURES], 5,000 random ones where nothing is said.
"""

from __future__ import annotations

import sys
import time
from pathlib import Path

_ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(_ROOT))

from archgen import pipeline  # noqa: E402 - the checkout is what is measured
from archgen.simulation import simulate_system  # noqa: E402
from archgen.timing.system.system_builder import build_system  # noqa: E402
from tests.timing.exceeded import exceeded  # noqa: E402
from tests.timing.random_systems import random_text  # noqa: E402


def speed() -> None:
    """Count the case study's events in a second of CPU time."""
    built, _ = build_system(pipeline.check_project(_ROOT / "example_ramcip").architecture)
    start = time.process_time()
    events = simulate_system(built, 20, 4).events
    taken = time.process_time() - start
    print(f"simulation of example_ramcip: {events} events, {events / taken:,.0f} a second of CPU time")


def bounds(count: int) -> bool:
    """Hold what is seen against the bounds."""
    start, held, wrong = time.process_time(), 0, 0
    for seed in range(count):
        found, several = exceeded(random_text(seed))
        held += several
        wrong += len(found)
        for line in found:
            print(f"seed {seed}: {line}")
    print(f"{count} random architectures: {held} bounds held, {wrong} exceeded, {time.process_time() - start:.0f} s")
    return wrong == 0


if __name__ == "__main__":
    speed()
    sys.exit(0 if bounds(int(sys.argv[1]) if len(sys.argv) > 1 else 5000) else 1)
