"""Random robots: two or three computers with links, containers of one thread, a GPU, and chains from sensors to actuators."""

from __future__ import annotations

import random

from tests.timing.sketches import sketch

PERIODS = (10, 20, 20, 50, 50, 100, 100, 200, 500, 1000)
"""In ms."""


def random_robot_text(seed: int) -> str:
    """Return a project by a seed."""
    return _RobotMaker(random.Random(seed)).project()  # noqa: S311 - a test's dice


class _RobotMaker:
    def __init__(self, dice: random.Random) -> None:
        self.dice = dice
        self.hosts = {f"h{at}": dice.choice((1, 2, 2, 4)) for at in range(dice.choice((1, 1, 2, 3)))}
        self.periods: dict[str, float] = {}
        self.sources: dict[str, list[str]] = {}

    def project(self) -> str:
        """Return the whole text."""
        names = [f"n{at}" for at in range(self.dice.randint(6, 16))]
        kinds = {name: self._draw_kind(name, names[:at]) for at, name in enumerate(names)}
        host_of = {name: self.dice.choice(list(self.hosts)) for name in names}
        boxed = {name: self.dice.random() < 0.5 for name in names}
        load, gpu = self.dice.choice((0.2, 0.35, 0.5, 0.65)), self.dice.random() < 0.3
        weights = {name: self.dice.uniform(0.1, 1) for name in names}
        nodes: dict[str, str] = {}
        for name in names:
            host = host_of[name]
            on_host = sum(weights[other] for other in names if host_of[other] == host)
            share = min(load * self.hosts[host] * weights[name] / on_host, 0.6)
            worst = max(1, round(share * self.periods[name] * 1000))
            timing = [kinds[name], f"wcet: {worst} us", f"bcet: {self.dice.choice((worst, worst // 2, worst // 4))} us"]
            if gpu and self.dice.random() < 0.2:
                timing.append(f"uses: {{gpu_{host}: {max(1, round(0.02 * self.periods[name] * 1000))} us}}")
            nodes[f"{name} {'+box_' if boxed[name] else '@'}{host}"] = ", ".join(timing)
        wires = " ".join(f"{source}>{name}" for name in names for source in self.sources[name])
        chains = ", ".join(f"c{at}: {{through: [{', '.join(way)}]}}" for at, way in enumerate(self._walk(names)))
        hosts = ", ".join(f"{name}: {{cores: {cores}}}" for name, cores in self.hosts.items())
        boxes = sorted({host_of[name] for name in names if boxed[name]})
        rest = [f"hosts: {{{hosts}}}", f"chains: {{{chains}}}"]
        rest.append("containers: {" + ", ".join(f"box_{host}: {{host: {host}, threads: 1}}" for host in boxes) + "}")
        rest.append("resources: {" + ", ".join(f"gpu_{host}: {{host: {host}}}" for host in self.hosts) + "}")
        if len(self.hosts) > 1:
            rest.append(
                f"links: {{lan: {{connects: [{', '.join(self.hosts)}], latency: {{best: 100 us, worst: 1 ms}}}}}}"
            )
        return sketch(nodes, wires, "\n".join(rest))

    def _draw_kind(self, name: str, before: list[str]) -> str:
        """Draw what fires a node: a timer, which reads what it reads then; or one of those before it, the others being read."""
        self.sources[name] = self.dice.sample(before[-5:], min(len(before), self.dice.choice((1, 1, 2, 3)), 5))
        if not before or self.dice.random() < 0.5:
            self.sources[name] = self.sources[name] if self.dice.random() < 0.8 else []
            self.periods[name] = self.dice.choice(PERIODS)
            return f"behaviour: periodic, period: {self.periods[name]} ms"
        first = self.sources[name][0]
        self.periods[name] = self.periods[first]
        return f"behaviour: event, trigger: [{first}]"

    def _walk(self, names: list[str]) -> list[list[str]]:
        walks = []
        fed = [name for name in names if self.sources[name]]
        for end in self.dice.sample(fed, min(len(fed), self.dice.choice((2, 3, 4)))):
            way = [end]
            while self.sources[way[0]] and len(way) < 6:
                way.insert(0, self.dice.choice(self.sources[way[0]]))
            walks.append([f"g.{name}" for name in way])
        return walks
