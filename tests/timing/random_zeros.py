"""Random systems in whole ms, where some take no time at all: busy periods touch, and what waits there waits for both."""

from __future__ import annotations

import json
import random
from collections.abc import Iterator

import yaml


def take_no_time(text: str, seed: int) -> str:
    """Round all execution times of a project to whole ms, and let some activities take none."""
    dice = random.Random(seed)  # noqa: S311 - a test's dice
    project = yaml.safe_load(text)
    for times in list(_list_times(project)):
        share = 0 if dice.random() < 0.4 else 1
        for key in {"wcet", "bcet"} & times.keys():
            times[key] = f"{share * _read_ms(times[key])} ms"
    return json.dumps(project, indent=1)


def _list_times(tree: object) -> Iterator[dict[str, object]]:
    """Yield what says an execution time, wherever it is written."""
    if isinstance(tree, list):
        for part in tree:
            yield from _list_times(part)
    if isinstance(tree, dict):
        if "wcet" in tree:
            yield tree
        for part in tree.values():
            yield from _list_times(part)


def _read_ms(duration: object) -> int:
    """Return a duration of whole or fine units, in ms, rounded up."""
    number, unit = str(duration).split()
    return -(-int(number) // {"us": 1000, "ms": 1}[unit])
