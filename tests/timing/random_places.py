"""What of a random architecture runs where: nodes of one component or two, containers, hosts, cores, links, queues."""

from __future__ import annotations

import random
from collections.abc import Mapping
from dataclasses import dataclass, field

Tree = dict[str, object]


@dataclass
class Places:
    """Puts components into nodes, and these onto hosts; adds priorities and cores to their timing."""

    dice: random.Random
    components: Mapping[str, Tree]
    timings: Mapping[str, Tree]
    nodes: dict[str, Tree] = field(default_factory=dict)

    def chance(self, share: float) -> bool:
        """Say yes so often."""
        return self.dice.random() < share

    def project(self) -> Tree:
        """Give the parts of the project that say what runs where."""
        hosts: dict[str, Tree] = {
            f"h{at}": {} if self.chance(0.1) else {"cores": self.dice.choice((1, 1, 2, 3))}
            for at in range(self.dice.choice((1, 2, 2, 3)))
        }
        self.place(hosts)
        containers = {
            name: {
                "threads": self.dice.choice((1, 1, 2, 3)),
                **({} if self.chance(0.15) else {"host": self.dice.choice(list(hosts))}),
            }
            for name in dict.fromkeys(str(node["container"]) for node in self.nodes.values() if "container" in node)
        }
        links = {
            "lan": {"connects": list(hosts), "bandwidth": "10 Mbit/s", **self.latency()},
            "wlan": {"connects": list(hosts)[:2], **self.latency()},
        }
        if self.chance(0.7):
            del links["wlan"]
        found: Tree = {"nodes": self.nodes, "hosts": hosts}
        return {
            **found,
            **({"containers": containers} if containers else {}),
            **({"links": links} if len(hosts) > 1 else {}),
        }

    def latency(self) -> Tree:
        """Draw a link's latency."""
        low, high = sorted((self.dice.randint(0, 20), self.dice.randint(0, 60)))
        return {} if self.chance(0.1) else {"latency": {"best": f"{low * 100} us", "worst": f"{high * 100} us"}}

    def place(self, hosts: Mapping[str, Tree]) -> None:
        """Make the nodes."""
        ranked, pinned = self.chance(0.4), self.chance(0.3)
        ranks = self.dice.sample(range(1, 90), len(self.components))
        waiting = list(self.components)
        while waiting:
            names = [waiting.pop(0) for _ in range(min(len(waiting), 2 if self.chance(0.15) else 1))]
            node: Tree = {"implements": [f"g.{name}" for name in names]}
            drawn = self.dice.random()
            if drawn < 0.25:
                node["container"] = self.dice.choice(("box_a", "box_b"))
            elif drawn < 0.85:
                node["host"] = self.dice.choice(list(hosts))
            for name in names:
                timing = self.timings[name]
                if pinned and "host" in node and self.chance(0.7):
                    timing["core"] = self.dice.randrange(int(str(hosts[str(node["host"])].get("cores", 1))))
                if ranked:
                    timing["priority"] = ranks.pop() if self.chance(0.8) else self.dice.choice((10, 20))
            self.timed(names, node)
            self.nodes[f"n{len(self.nodes)}"] = node

    def timed(self, names: list[str], node: Tree) -> None:
        """Write timing and queues; of a node of several components each says its own timing."""
        if len(names) == 1 and self.chance(0.7):
            node["timing"] = self.timings[names[0]]
        else:
            for name in names:
                self.components[name]["timing"] = self.timings[name]
        read = {
            f"{name}.{key}" if len(names) > 1 else key: {
                "qos": {"profile": "default", "depth": self.dice.choice((1, 2, 5))}
            }
            for name in names
            for key in self.components[name]["inputs"]  # type: ignore[attr-defined]
            if key not in {"ask", "beg", "world"} and self.chance(0.5)
        }
        if read:
            node["subscribes"] = read
