"""Random systems of one host: nodes of several components, callback groups, threads, stored inputs, orders, sets of cores."""

from __future__ import annotations

import json
import random
from typing import Any

PERIODS = (20, 25, 40, 50, 100, 100, 200)
"""In ms."""
CORE_ORDERS = ("fixed_priority", "non_preemptive", "fifo", "round_robin", "edf")
THREAD_ORDERS = ("ros2_executor", "ros2_executor", "fifo", "non_preemptive", "round_robin", "edf")

Tree = dict[str, object]


def random_threads_text(seed: int) -> str:
    """Return a project by a seed."""
    return json.dumps(ThreadsMaker(random.Random(seed)).project(), indent=1)  # noqa: S311 - a test's dice


class ThreadsMaker:
    """Makes a project; a plain one has no order of a whole thread or core, and no pins."""

    def __init__(self, dice: random.Random, *, is_plain: bool = False) -> None:
        self.dice = dice
        self.queue = "" if is_plain else dice.choice(("", "", "", "thread", "core"))
        """What works off all there is in one order: the thread of a container, or the only core."""
        self.cores = 1 if self.queue else dice.choice((1, 1, 2, 2, 3, 4))
        self.ranked = self.chance(0.7 if self.queue else 0.4)
        self.pinned = not is_plain and self.cores > 1 and self.chance(0.4)
        self.periods: dict[str, float] = {}
        self.fed_by: dict[str, list[str]] = {}
        self.timings: dict[str, Tree] = {}

    def chance(self, share: float) -> bool:
        """Say yes so often."""
        return self.dice.random() < share

    def project(self) -> dict[str, Any]:
        """Return the whole project."""
        names = [f"c{at}" for at in range(self.dice.randint(3, 10))]
        for name in names:
            self._draw_activity(name)
        self._share_load(names)
        nodes, boxes = self._place(names)
        components = {
            name: {
                "inputs": {source: f"g.{source}.out" for source in self.fed_by[name]},
                "outputs": {"out": "Data"},
                "timing": self.timings[name],
            }
            for name in names
        }
        host: Tree = {"cores": self.cores}
        if self.chance(1 if self.queue == "core" else 0.5):
            order = self.dice.choice(CORE_ORDERS)
            host["scheduling"] = {self.dice.randrange(self.cores): order} if self.chance(0.2) else order
        return {
            "groups": {"g": {"components": components}},
            "types": {"Data": {"message": "std_msgs/msg/String", "size": "1 kB"}},
            "nodes": nodes,
            "hosts": {"h": host},
            **({"containers": boxes} if boxes else {}),
            "chains": {f"chain{at}": {"through": way} for at, way in enumerate(self._walks())},
        }

    def _draw_activity(self, name: str) -> None:
        before = list(self.timings)
        near = before[-4:]
        self.fed_by[name] = self.dice.sample(near, min(len(near), self.dice.choice((0, 1, 1, 1, 2, 3))))
        if not self.fed_by[name] or self.chance(0.35):
            period = self.dice.choice(PERIODS)
            self.periods[name] = period
            self.timings[name] = {"behaviour": "periodic", "period": f"{period} ms"}
            if self.chance(0.3):
                self.timings[name]["jitter"] = f"{self.dice.choice((1, 5, 30))} ms"
            sampled = self.fed_by[name]
        else:
            fired_by = self.dice.sample(self.fed_by[name], self.dice.randint(1, len(self.fed_by[name])))
            waits_for_all = len(fired_by) > 1 and self.chance(0.4)
            gaps = [self.periods[source] for source in fired_by]
            self.periods[name] = max(gaps) if waits_for_all else 1 / sum(1 / gap for gap in gaps)
            self.timings[name] = {"behaviour": "event", "trigger": {"all": fired_by} if waits_for_all else fired_by}
            sampled = [source for source in self.fed_by[name] if source not in fired_by]
        stored = {source: {"wcet": f"{self.dice.choice((1, 2, 6))} ms"} for source in sampled if self.chance(0.4)}
        if self.queue == "core" or self.chance(0.1):
            stored = {source: {"stored": "at_once"} for source in sampled}
        if stored:
            self.timings[name]["inputs"] = stored
        if self.chance(0.6 if self.queue else 0.3):
            self.timings[name]["deadline"] = f"{self.dice.choice(PERIODS)} ms"

    def _share_load(self, names: list[str]) -> None:
        load = self.dice.choice((0.15, 0.3, 0.45, 0.6, 0.75)) * self.cores
        shares = {name: self.dice.uniform(0.2, 1) for name in names}
        for name in names:
            cost = min(load * shares[name] / sum(shares.values()), 0.8) * self.periods[name]
            worst = max(1, round(cost * 1000))
            best = self.dice.choice((worst, worst, worst // 2, 0))
            self.timings[name] |= {"wcet": f"{worst} us", "bcet": f"{best} us"}

    def _place(self, names: list[str]) -> tuple[Tree, Tree]:
        if self.queue:
            return self._place_in_queue(names)
        boxes: Tree = {}
        for at in range(self.dice.choice((0, 1, 1, 2))):
            boxes[f"box{at}"] = {"host": "h", "threads": self.dice.choice((1, 1, 2, 2, 3)), **self._thread_order()}
        nodes: dict[str, Tree] = {}
        waiting = list(names)
        self.dice.shuffle(waiting)
        while waiting:
            members = [waiting.pop() for _ in range(min(len(waiting), self.dice.choice((1, 1, 2, 3))))]
            node: Tree = {"implements": [f"g.{name}" for name in members]}
            if boxes and self.chance(0.6):
                node["container"] = self.dice.choice(list(boxes))
            else:
                node["host"] = "h"
                node |= {"threads": self.dice.choice((2, 2, 3))} if self.chance(0.4) else {}
                node |= self._thread_order()
            if self.chance(0.2):
                node["reentrant"] = True
            elif len(members) > 1 and self.chance(0.4):
                cut = self.dice.randint(1, len(members) - 1)
                groups = {"one": members[:cut], "two": members[cut:]}
                node["callback_groups"] = {key: [f"g.{name}" for name in group] for key, group in groups.items()}
            for name in members:
                self._urge(name)
            nodes[f"n{len(nodes)}"] = node
        used = {node.get("container") for node in nodes.values()}
        return dict(nodes), {name: box for name, box in boxes.items() if name in used}

    def _place_in_queue(self, names: list[str]) -> tuple[Tree, Tree]:
        place = {"container": "box"} if self.queue == "thread" else {"host": "h"}
        for name in names:
            self._urge(name)
        nodes: Tree = {f"n{name}": {"implements": [f"g.{name}"], **place} for name in names}
        box = {"host": "h", "threads": 1, "scheduling": self.dice.choice(THREAD_ORDERS)}
        return nodes, {"box": box} if self.queue == "thread" else {}

    def _thread_order(self) -> Tree:
        return {"scheduling": self.dice.choice(THREAD_ORDERS)} if self.chance(0.5) else {}

    def _urge(self, name: str) -> None:
        if self.ranked and self.chance(0.9):
            self.timings[name]["priority"] = self.dice.randint(1, 12)
        if self.pinned and self.chance(0.6):
            if self.chance(0.5):
                self.timings[name]["core"] = self.dice.randrange(self.cores)
            else:
                numbers = self.dice.sample(range(self.cores), self.dice.randint(1, self.cores))
                self.timings[name]["cores"] = sorted(numbers)

    def _walks(self) -> list[list[str]]:
        walks = []
        fed = [name for name, sources in self.fed_by.items() if sources]
        for end in self.dice.sample(fed, min(len(fed), 4)):
            way = [end]
            while self.fed_by[way[0]] and len(way) < 9:
                way.insert(0, self.dice.choice(self.fed_by[way[0]]))
            walks.append([f"g.{name}" for name in way])
        return walks
