"""Random systems of elements that use resources (GPUs), match inputs by time, or forget what they drop, by seed."""

from __future__ import annotations

import random
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

from archgen.timing.system.timing_system import (
    Activity,
    Arc,
    Executor,
    ResourceUse,
    SharedResource,
    StoringCallback,
    TimingSystem,
)
from tests.simulation.systems import arc, system


def random_use_system(seed: int) -> TimingSystem:
    """Make a system by a seed."""
    return _Maker(random.Random(seed)).make()  # noqa: S311 - a test's dice


def random_walks(of: TimingSystem, seed: int) -> dict[str, tuple[str, ...]]:
    """Return up to three chains along the arcs of a system."""
    dice = random.Random(seed)  # noqa: S311
    walks: dict[str, tuple[str, ...]] = {}
    for number in range(3):
        way = [dice.choice(list(of.activities))]
        while nexts := [one.target for one in of.arcs_from[way[-1]] if one.target not in way]:
            way.append(dice.choice(nexts))
        if len(way) > 1:
            walks[f"chain_{number}"] = tuple(way)
    return walks


class _Maker:
    def __init__(self, dice: random.Random) -> None:
        self.dice = dice
        self.activities: list[Activity] = []
        self.arcs: list[Arc] = []
        self.executors: dict[str, Executor] = {}
        self.threads: dict[str, int | None] = {}
        self.cores = {host: dice.choice((1, 1, 1, 2, 3)) for host in ("pc", "box")[: dice.choice((1, 1, 2))]}
        orders = (None, "fifo", "fifo", "fixed_priority")
        self.resources = {
            name: SharedResource(name, "pc", dice.choice(orders))  # type: ignore[arg-type]
            for name in ("gpu", "npu")[: dice.choice((1, 1, 2))]
        }
        self.load = dice.choice((0.2, 0.4, 0.6, 0.9))
        self.is_ranked = dice.random() < 0.5

    def make(self) -> TimingSystem:
        for number in range(self.dice.randint(2, 8)):
            self.add_activity(f"a{number}")
        return system(
            self.activities,
            self.arcs,
            self.cores,
            resources=self.resources,
            executors=self.executors,
            bandwidths={"l": None},
        )

    def chance(self, share: float) -> bool:
        return self.dice.random() < share

    def add_activity(self, name: str) -> None:
        earlier = [activity.id for activity in self.activities]
        kinds = ("periodic", "periodic", "event", "match", "all", "any") if len(earlier) > 1 else ("periodic",)
        kind = self.dice.choice(kinds)
        period = self.dice.choice((10, 20, 20, 40, 50, 100))
        values = {**self.work(period), **self.place(name)}
        if kind == "periodic":
            jitter = self.dice.choice((0, 0, 0, period // 4, period))
            self.activities.append(Activity(name, name, None, "periodic", period=period, jitter=jitter, **values))
            if earlier and self.chance(0.4):
                read = self.arc(self.dice.choice(earlier), name)
                self.arcs.append(read)
                storing = {read.input: StoringCallback(self.dice.choice((0, 0, 1)))}
                self.activities[-1] = replace(self.activities[-1], storing=storing)
            return
        sources = self.dice.sample(earlier, {"event": 1}.get(kind, 2))
        if self.chance(0.15):
            values["throttle"] = self.dice.choice((5, 20, 50))
        if self.chance(0.15):
            values["every"] = self.dice.choice((2, 3))
        if kind != "event":
            values["mode"] = kind
        if kind == "match":
            values["within"] = self.dice.choice((0, 5, 20, 50, 100))
        arcs = self.arcs_of_one(sources[0], name) if kind == "match" and self.chance(0.2) else self.plain(sources, name)
        self.arcs += arcs
        values["triggers"] = tuple(one.input for one in arcs)
        self.activities.append(Activity(name, name, None, "event", keeps_dropped=self.chance(0.6), **values))

    def plain(self, sources: Sequence[str], name: str) -> list[Arc]:
        return [self.arc(source, name) for source in sources]

    def arcs_of_one(self, source: str, name: str) -> list[Arc]:
        """Return two outputs of one job: with the same time."""
        return [
            replace(self.arc(source, name), input=f"{source}_{side}", topic=f"/{source}_{side}") for side in ("l", "r")
        ]

    def arc(self, source: str, target: str) -> Arc:
        one = arc(source, target)
        if self.chance(0.25):
            best = self.dice.randint(0, 5)
            one = replace(one, best=best, worst=best + self.dice.choice((0, 3, 15)), link="l")
        return replace(one, depth=self.dice.choice((1, 5, 50))) if self.chance(0.2) else one

    def work(self, period: int) -> dict[str, Any]:
        wcet = self.share_of(period)
        values: dict[str, Any] = {
            "wcet": wcet,
            "bcet": self.dice.randint(0, wcet) if self.chance(0.5) else wcet,
            "outputs": ("out",),
        }
        if self.chance(0.5):
            keys = self.dice.sample(list(self.resources), self.dice.randint(1, len(self.resources)))
            values["uses"] = {
                key: ResourceUse(longest := self.share_of(period), self.dice.randint(0, longest)) for key in keys
            }
        return values

    def share_of(self, period: int) -> int:
        return max(1, round(period * self.load / 3 * self.dice.random()))

    def place(self, name: str) -> dict[str, Any]:
        host = self.dice.choice((*self.cores, *self.cores, None))
        values: dict[str, Any] = {"host": host, "callback_group": name}
        if self.is_ranked and self.chance(0.8):
            values["priority"] = self.dice.randint(1, 4)
        if host and self.cores[host] > 1 and self.chance(0.3):
            cores = range(self.cores[host])
            values["cores"] = tuple(sorted(self.dice.sample(cores, self.dice.choice((1, 1, 2)))))
        executor = f"node {name}"
        if self.chance(0.35):
            container = f"k_{host}"
            values["container"], executor = container, f"container {container}"
            self.threads.setdefault(container, self.dice.choice((1, 1, 2, 3)))
        threads = self.threads[values["container"]] if "container" in values else self.dice.choice((1, 1, 1, 1, 2, 3))
        self.executors[executor] = Executor(executor, threads, host)
        if threads != 1 and self.chance(0.3):
            values["callback_group"] = None
        return {**values, "executor": executor}
