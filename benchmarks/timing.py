"""Measure the timing analysis and all chains, once a project is loaded, and whether both are linear: CPU seconds for so many edges.

Usage: python benchmarks/timing.py [ACTIVITIES ...], 2,500 to 20,000 where nothing is said. Twenty activities share each host;
a third runs by timers, the others are fired by one of their two or three inputs, some by all of them. One chain of four for 40 activities.
"""

from __future__ import annotations

import gc
import random
import sys
import tempfile
import time
from pathlib import Path

_ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(_ROOT))

from archgen import pipeline  # noqa: E402 - the checkout is what is measured
from archgen.timing.chains.chain_bounds import bound_all_chains  # noqa: E402
from archgen.timing.run_analysis import analyse_architecture  # noqa: E402

_RUNS = 3
_ON_ONE_HOST = 20
_ACTIVITIES_PER_CHAIN = 40
_STEPS = 3
_PERIODS = (20, 25, 40, 50, 100, 200, 500)


def project(activities: int) -> str:
    """Write a project with this many activities, and five edges for every two of them."""
    chance = random.Random(activities)  # noqa: S311 - reproducible wiring, no secret
    components, nodes, first_sources = [], [], {}
    for number in range(activities):
        sources = {chance.randrange(max(0, number - 200), number) for _ in range(2 + number % 2)} if number else set()
        first_sources[number] = min(sources, default=None)
        inputs = ", ".join(f"i{place}: c{source}.out" for place, source in enumerate(sorted(sources)))
        components.append(f"      c{number}: {{inputs: {{{inputs}}}, outputs: {{out: std_msgs/msg/Empty}}}}")
        nodes.append(
            f"  c{number}: {{implements: c{number}, host: h{number // _ON_ONE_HOST}, timing: {_timing(number, chance)}}}"
        )
    chains = []
    for number in range(_ACTIVITIES_PER_CHAIN - 1, activities, _ACTIVITIES_PER_CHAIN):
        through = [number]
        while len(through) <= _STEPS and (source := first_sources[through[0]]) is not None:
            through.insert(0, source)
        chains.append(f"  k{number}: {{through: [{', '.join(f'c{each}' for each in through)}], deadline: 1 s}}")
    hosts = [f"h{number}" for number in range(-(-activities // _ON_ONE_HOST))]
    return "\n".join(
        [
            "groups:\n  g:\n    components:",
            *components,
            "nodes:",
            *nodes,
            "chains:",
            *chains,
            "hosts:",
            *(f"  {host}: {{cores: {1 + place % 2 * 3}}}" for place, host in enumerate(hosts)),
            f"links: {{lan: {{connects: [{', '.join(hosts)}], bandwidth: 10 GB/s, latency: 100 us}}}}\n",
        ]
    )


def _timing(number: int, chance: random.Random) -> str:
    figures = f"wcet: {chance.randrange(100, 400)} us, bcet: 100 us, priority: {number % 50 + 1}"
    if number % 3 == 0:
        return f"{{period: {chance.choice(_PERIODS)} ms, {figures}}}"
    trigger = "all" if number % 10 == 1 else "[i0]"
    return f"{{behaviour: event, trigger: {trigger}, {figures}}}"


def measure(activities: int) -> None:
    """Print how long one analysis takes."""
    with tempfile.TemporaryDirectory() as place:
        file = Path(place) / "project.yaml"
        file.write_text(project(activities), encoding="utf-8")
        architecture = pipeline.check_project(file).architecture
    taken, taken_by_chains = [], []
    for _ in range(_RUNS):
        start = time.process_time()
        found = analyse_architecture(architecture)
        taken.append(time.process_time() - start)
        start = time.process_time()
        chains = bound_all_chains(found, architecture)
        taken_by_chains.append(time.process_time() - start)
    edges, best, best_of_chains = len(found.system.arcs), min(taken), min(taken_by_chains)
    print(
        f"{activities:7,} activities {edges:7,} edges {best:8.2f} s   {1e6 * best / edges:6.1f} us an edge"
        f" {len(chains):5,} chains {best_of_chains:8.2f} s"
    )


if __name__ == "__main__":
    gc.disable()  # as the command line does
    for count in [int(word) for word in sys.argv[1:]] or [2_500, 5_000, 10_000, 20_000]:
        measure(count)
