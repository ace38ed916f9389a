"""Random systems of one style each: chains in executors, on cores that are shared, by priority, crowded, pinned.

`random_systems` has every kind of element, mostly few of them on a core. These have many on one host, at a load that is
known: there the busy periods of whole cascades count.
"""

from __future__ import annotations

import random

from tests.timing.sketches import sketch

STYLES = ("executor", "cores", "ranked cores", "crowded", "pinned", "ranked core", "free core")
PERIODS = (20, 25, 40, 50, 100, 100, 200)
"""In ms."""


def random_style_text(seed: int) -> str:
    """Return a project by a seed, the styles taking turns."""
    return _StyleMaker(random.Random(seed), STYLES[seed % len(STYLES)]).project()  # noqa: S311 - a test's dice


class _StyleMaker:
    def __init__(self, dice: random.Random, style: str) -> None:
        self.dice, self.style = dice, style
        self.count = dice.randint(5, 12)
        self.cores = dice.choice((2, 2, 3, 4)) if style in {"cores", "ranked cores", "crowded", "pinned"} else 1
        self.wires: list[str] = []
        self.periods: dict[str, float] = {}

    def project(self) -> str:
        """Return the whole text."""
        kinds = {f"n{at}": self._kind(at) for at in range(self.count)}
        load = self.dice.choice((0.15, 0.3, 0.45, 0.6)) * self.cores
        shares = {name: self.dice.uniform(0.2, 1) for name in kinds}
        nodes: dict[str, str] = {}
        for name, timing in kinds.items():
            cost = min(load * shares[name] / sum(shares.values()), 0.8) * self.periods[name]
            nodes[f"{name} {self._place()}"] = ", ".join([*timing, self._costs(cost), *self._urgency()])
        chains = ", ".join(f"chain{at}: {{through: [{', '.join(way)}]}}" for at, way in enumerate(self._walks()))
        rest = f"hosts: {{h: {{cores: {self.cores}}}}}\nchains: {{{chains}}}"
        if self.style == "executor":
            rest += "\ncontainers: {box: {threads: 1, host: h}}"
        if self.style == "crowded":
            rest += f"\ncontainers: {{box: {{threads: {self.dice.choice((2, 2, 3))}, host: h}}}}"
        return sketch(nodes, " ".join(self.wires), rest)

    def _kind(self, at: int) -> list[str]:
        """Draw what fires the activity of a number: a timer, or some of those before it."""
        name, before = f"n{at}", [f"n{other}" for other in range(at)]
        if at == 0 or self.dice.random() < 0.25:
            period = self.dice.choice(PERIODS)
            self.periods[name] = period
            if before and self.dice.random() < 0.3:
                self.wires.append(f"{self.dice.choice(before)}>{name}")
            jitter = [f"jitter: {self.dice.choice((1, 5, 30))} ms"] if self.dice.random() < 0.2 else []
            return ["behaviour: periodic", f"period: {period} ms", *jitter]
        # The last ones, as a rule: long chains.
        near = before[-3:]
        fed_by = self.dice.sample(near, min(len(near), self.dice.choice((1, 1, 1, 1, 2, 3))))
        self.wires += [f"{source}>{name}" for source in fed_by]
        waits_for_all = len(fed_by) > 1 and self.dice.random() < 0.4
        gaps = [self.periods[source] for source in fed_by]
        self.periods[name] = max(gaps) if waits_for_all else 1 / sum(1 / gap for gap in gaps)
        if len(before) > 3 and self.dice.random() < 0.15:
            self.wires += [f"{before[0]}>{name}"] if before[0] not in fed_by else []
            named_inputs = f"[{', '.join(fed_by)}]"
            timing = [f"trigger: {{all: {named_inputs}}}" if waits_for_all else f"trigger: {named_inputs}"]
        else:
            timing = [f"trigger: {'all' if waits_for_all else 'any'}"]
        if self.dice.random() < 0.08:
            self.periods[name] *= 2
            timing.append("every: 2")
        elif self.dice.random() < 0.08:
            timing.append(f"throttle: {self.dice.choice((10, 30, 60))} ms")
        if self.dice.random() < 0.05:
            timing.append("jitter: 3 ms")
        return ["behaviour: event", *timing]

    def _costs(self, cost: float) -> str:
        # Some take no time at all: they only pass on.
        if self.dice.random() < 0.06:
            return "wcet: 0 ms, bcet: 0 ms"
        worst = max(1, round(cost * 1000))
        return f"wcet: {worst} us, bcet: {self.dice.choice((worst, worst, worst // 2, 0))} us"

    def _urgency(self) -> list[str]:
        ranked = self.style in {"ranked cores", "ranked core"} or (
            self.style in {"crowded", "pinned"} and self.count % 2
        )
        priority = [f"priority: {self.dice.randint(1, 12)}"] if ranked and self.dice.random() < 0.9 else []
        pinned = self.style == "pinned" and self.dice.random() < 0.7
        return [*priority, *([f"core: {self.dice.randrange(self.cores)}"] if pinned else [])]

    def _place(self) -> str:
        is_in_box = self.style == "executor" or (self.style == "crowded" and self.dice.random() < 0.6)
        return "+box" if is_in_box and self.dice.random() < 0.9 else "@h"

    def _walks(self) -> list[list[str]]:
        """Draw some ways along the wires."""
        sources: dict[str, list[str]] = {}
        for wire in self.wires:
            source, _, target = wire.partition(">")
            sources.setdefault(target, []).append(source)
        walks = []
        for end in self.dice.sample(sorted(sources), min(len(sources), 4)):
            way = [end]
            while way[0] in sources and len(way) < 9:
                way.insert(0, self.dice.choice(sources[way[0]]))
            walks.append([f"g.{name}" for name in way])
        return walks
