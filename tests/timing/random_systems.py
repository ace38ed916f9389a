"""Random architectures with every kind of timing element, as text of the language, by seed: for tests and benchmarks.

Triggers lead from earlier components to later ones, so that no event circulates for ever; sampled inputs lead anywhere.
"""

from __future__ import annotations

import json
import random
from dataclasses import dataclass, field

from archgen.link.declare import link
from archgen.link.merge import merge
from archgen.model.architecture import Architecture
from archgen.model.interfaces import Interfaces
from archgen.schema import normalise, validate
from archgen.syntax import yaml
from archgen.transform import transform

Tree = dict[str, object]
PERIODS = (2, 4, 5, 8, 10, 10, 12, 20, 20, 25, 40, 50)
"""In ms."""


def architecture(text: str) -> Architecture:
    """Read a project that is one text; nothing in it may be wrong."""
    document, found = yaml.parse("random.yaml", text)
    assert document is not None, found
    assert (validate(document), normalise(document)) == ((), ()), text
    table, _ = merge([document])
    linked, problems = link(table, default_id="r", default_title="R", shipped={}, interfaces=Interfaces("jazzy"))
    assert not problems, (problems, text)
    return transform(linked)


def random_text(seed: int) -> str:
    """Make a project by a seed, as JSON (which is YAML)."""
    return json.dumps(_Maker(random.Random(seed)).project(), indent=1)  # noqa: S311 - a test's dice


@dataclass
class _Maker:
    dice: random.Random
    components: dict[str, Tree] = field(default_factory=dict)
    nodes: dict[str, Tree] = field(default_factory=dict)
    types: dict[str, Tree] = field(default_factory=dict)
    sampled: list[tuple[str, str]] = field(default_factory=list)

    def chance(self, share: float) -> bool:
        return self.dice.random() < share

    def project(self) -> Tree:
        count = self.dice.randint(2, 9)
        self.fine = self.chance(0.5)
        self.load = self.dice.choice((0.3, 0.6, 0.9))
        hosts = self.hosts()
        for at in range(count):
            self.component(at)
        self.sampling(count)
        self.place(hosts)
        containers = {
            name: {"host": self.dice.choice(list(hosts)), "threads": self.dice.choice((1, 1, 2))}
            for name in dict.fromkeys(str(node["container"]) for node in self.nodes.values() if "container" in node)
        }
        links: Tree = {}
        if len(hosts) > 1:
            links["lan"] = {"connects": list(hosts), "bandwidth": "10 Mbit/s", **self.latency()}
        chains = {f"chain_{at}": {"through": self.walk(), "deadline": "1 s"} for at in range(3)}
        found: Tree = {
            "groups": {"g": {"components": self.components}},
            "nodes": self.nodes,
            "types": self.types,
            "hosts": hosts,
            "chains": {key: chain for key, chain in chains.items() if chain["through"]},
        }
        return {**found, **({"containers": containers} if containers else {}), **({"links": links} if links else {})}

    def hosts(self) -> dict[str, Tree]:
        return {
            f"h{at}": {} if self.chance(0.1) else {"cores": self.dice.choice((1, 1, 2, 3))}
            for at in range(self.dice.randint(1, 2))
        }

    def latency(self) -> Tree:
        low, high = sorted((self.dice.randint(0, 20), self.dice.randint(0, 60)))
        return {} if self.chance(0.1) else {"latency": {"best": f"{low * 100} us", "worst": f"{high * 100} us"}}

    def duration(self, ms: float) -> str:
        return f"{max(1, round(ms * 1000)) if self.fine else max(1, round(ms)) * 1000} us"

    def component(self, at: int) -> None:
        name = f"c{at}"
        kind = "periodic" if at == 0 else self.dice.choice(("periodic", "event", "event", "event", "server", "once"))
        timing: Tree = {"behaviour": {"server": "on_demand"}.get(kind, kind)}
        outputs: Tree = {}
        inputs: Tree = {}
        if kind == "server":
            outputs["serve"] = {"type": f"S{at}"}
            self.types[f"S{at}"] = {"message": f"my_msgs/srv/S{at}", "size": "500 B"}
        if kind != "server" or self.chance(0.3):
            outputs["out"] = {"type": f"T{at}"}
            self.types[f"T{at}"] = {"message": f"my_msgs/msg/T{at}", "size": f"{self.dice.choice((100, 1000, 5000))} B"}
        if kind == "periodic":
            self.periodic(timing)
        if kind == "event":
            self.event(at, timing, inputs)
        if kind != "once":
            self.work(kind, timing)
            self.client(kind, timing, inputs)
        if kind in {"periodic", "event"} and self.chance(0.15):
            limit = {"max_gap": f"{self.dice.randint(50, 400)} ms"} if self.chance(0.6) else {}
            timing["outputs"] = {"out": {"conditional": True, **limit}}
        self.components[name] = {"inputs": inputs, "outputs": outputs}
        self.nodes[f"n{at}"] = {"implements": f"g.{name}", "timing": timing}

    def periodic(self, timing: Tree) -> None:
        period = self.dice.choice(PERIODS)
        timing["period"] = f"{period} ms"
        if self.chance(0.3):
            timing["jitter"] = self.duration(period * self.dice.choice((0.1, 0.5, 1.5)))
        if self.chance(0.05):
            timing["every"] = 2

    def event(self, at: int, timing: Tree, inputs: Tree) -> None:
        writers = [f"c{other}" for other in range(at) if "out" in self.components[f"c{other}"]["outputs"]]  # type: ignore[operator]
        chosen = self.dice.sample(writers, min(len(writers), self.dice.choice((1, 1, 2, 2, 3))))
        for place, writer in enumerate(chosen):
            inputs[f"i{place}"] = f"{writer}.out"
        if len(chosen) > 2 and self.chance(0.3):
            inputs.clear()
            inputs.update({"i0": [f"{chosen[0]}.out", f"{chosen[1]}.out"], "i1": f"{chosen[2]}.out"})
        names = list(inputs)
        some = self.dice.sample(names, self.dice.randint(1, len(names)))
        timing["trigger"] = self.dice.choice(("any", "all", some, {"all": some}))
        if self.chance(0.15):
            timing["every"] = self.dice.choice((2, 3))
        if self.chance(0.15):
            timing["throttle"] = f"{self.dice.choice((7, 15, 30))} ms"

    def work(self, kind: str, timing: Tree) -> None:
        if self.chance(0.04):
            return
        longest = self.dice.uniform(0.02, self.load) * (3 if kind != "server" else 1)
        timing["wcet"] = self.duration(longest)
        if self.chance(0.7):
            timing["bcet"] = "0 us" if self.chance(0.2) else self.duration(longest * self.dice.choice((0.1, 0.5, 1)))
            if int(str(timing["bcet"]).split()[0]) > int(str(timing["wcet"]).split()[0]):
                timing["bcet"] = timing["wcet"]
        if self.chance(0.06):
            timing["response"] = f"{self.dice.randint(5, 60)} ms"

    def client(self, kind: str, timing: Tree, inputs: Tree) -> None:
        servers = [name for name, c in self.components.items() if "serve" in c["outputs"]]  # type: ignore[operator]
        if servers and self.chance(0.5 if kind != "server" else 0.2):
            inputs["ask"] = f"{self.dice.choice(servers)}.serve"
            if self.chance(0.4):
                timing["calls"] = {"ask": self.dice.choice((0.5, 2, 1.5))}

    def sampling(self, count: int) -> None:
        for at in range(count):
            timing, inputs = self.nodes[f"n{at}"]["timing"], self.components[f"c{at}"]["inputs"]
            assert isinstance(timing, dict)
            assert isinstance(inputs, dict)
            writers = [
                name
                for name, c in self.components.items()
                if name != f"c{at}" and "out" in c["outputs"]  # type: ignore[operator]
            ]
            named = isinstance(timing.get("trigger"), list | dict)
            if writers and timing["behaviour"] != "once" and (named or timing["behaviour"] != "event"):
                for place, writer in enumerate(self.dice.sample(writers, min(len(writers), self.dice.randint(0, 2)))):
                    inputs[f"s{place}"] = f"{writer}.out"

    def place(self, hosts: dict[str, Tree]) -> None:
        ranked, pinned = self.chance(0.4), self.chance(0.3)
        ranks = self.dice.sample(range(1, 90), len(self.nodes))
        for rank, (name, node) in zip(ranks, self.nodes.items(), strict=True):
            timing = node["timing"]
            assert isinstance(timing, dict)
            drawn = self.dice.random()
            if drawn < 0.25:
                node["container"] = self.dice.choice(("box_a", "box_b"))
            elif drawn < 0.85:
                node["host"] = self.dice.choice(list(hosts))
                if pinned and self.chance(0.7):
                    timing["core"] = self.dice.randrange(int(str(hosts[str(node["host"])].get("cores", 1))))
            if ranked:
                timing["priority"] = rank if self.chance(0.8) else self.dice.choice(ranks)
            self.queues(name, node)

    def queues(self, name: str, node: Tree) -> None:
        inputs = self.components[name.replace("n", "c")]["inputs"]
        assert isinstance(inputs, dict)
        read = {
            key: {"qos": {"profile": "default", "depth": self.dice.choice((1, 2, 5))}}
            for key in inputs
            if key != "ask" and self.chance(0.5)
        }
        if read:
            node["subscribes"] = read

    def walk(self) -> list[str]:
        """Walk along inputs, backwards from anywhere."""
        way = [self.dice.choice(list(self.components))]
        for _ in range(self.dice.randint(1, 4)):
            inputs = self.components[way[0]]["inputs"]
            assert isinstance(inputs, dict)
            sources = [
                str(one).split(".")[0]
                for some in inputs.values()
                for one in (some if isinstance(some, list) else [some])
            ]
            fresh = [source for source in sources if source not in way]
            if not fresh:
                break
            way.insert(0, self.dice.choice(fresh))
        return way if len(way) > 1 else []
