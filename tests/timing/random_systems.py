"""Random architectures with every kind of timing element, as text of the language, by seed: for tests and benchmarks.

Triggers and calls lead from earlier components to later ones or back to servers, so that no event circulates for ever;
sampled inputs lead anywhere, and so close rings. `random_places` says what runs where.
"""

from __future__ import annotations

import json
import random
from dataclasses import dataclass, field

from archgen.derivation import derive_low_level
from archgen.frozen import replace
from archgen.link.slice_merging import merge_documents
from archgen.model.architecture import Architecture
from archgen.schema import normalise_document, validate_document
from archgen.syntax import yaml_parser
from tests.linking import link_table
from tests.timing.random_places import Places, Tree

PERIODS = (2, 4, 5, 8, 10, 10, 12, 20, 20, 25, 40, 50)
"""In ms."""


def architecture(text: str, *, is_fair: bool = False) -> Architecture:
    """Read a project that is one text; nothing in it may be wrong.

    Hosts that name no order have any one, unless `is_fair`: then threads share their cores as Linux does it.
    """
    document, found = yaml_parser.parse_yaml("random.yaml", text)
    assert document is not None, found
    assert (validate_document(document), normalise_document(document)) == ((), ()), text
    table, _ = merge_documents([document])
    linked, problems = link_table(table)
    assert not problems, (problems, text)
    derived = derive_low_level(linked)
    return derived if is_fair else in_any_order(derived)


def in_any_order(linked: Architecture) -> Architecture:
    """Return a project whose hosts that name no order have any one below the priorities."""
    hosts = {name: replace(host, scheduling=host.scheduling or "fixed_priority") for name, host in linked.hosts.items()}
    return replace(linked, hosts=hosts)


def random_text(seed: int) -> str:
    """Make a project by a seed, as JSON (which is YAML)."""
    return json.dumps(_Maker(random.Random(seed)).project(), indent=1)  # noqa: S311 - a test's dice


@dataclass
class _Maker:
    dice: random.Random
    components: dict[str, Tree] = field(default_factory=dict)
    timings: dict[str, Tree] = field(default_factory=dict)
    types: dict[str, Tree] = field(default_factory=dict)

    def chance(self, share: float) -> bool:
        return self.dice.random() < share

    def project(self) -> Tree:
        count = self.dice.randint(2, 9)
        self.fine = self.chance(0.5)
        self.load = self.dice.choice((0.3, 0.6, 0.9))
        for at in range(count):
            self.component(at)
        for name in self.components:
            self.sampling(name)
        placed = Places(self.dice, self.components, self.timings).project()
        chains = {f"chain_{at}": {"through": self.walk(), "deadline": "1 s"} for at in range(3)}
        return {
            "groups": {"g": {"components": self.components}},
            "types": self.types,
            "chains": {key: chain for key, chain in chains.items() if chain["through"]},
            **placed,
        }

    def duration(self, ms: float) -> str:
        return f"{max(1, round(ms * 1000)) if self.fine else max(1, round(ms)) * 1000} us"

    def component(self, at: int) -> None:
        name = f"c{at}"
        kinds = ("periodic", "event", "event", "event", "server", "server", "once", "world")
        kind = "periodic" if at == 0 else self.dice.choice(kinds)
        timing: Tree = {"behaviour": {"server": "on_demand", "world": "event"}.get(kind, kind)}
        outputs: Tree = {}
        inputs: Tree = {}
        self.outputs(at, kind, outputs)
        if kind == "periodic":
            self.periodic(timing)
        elif kind == "world":
            self.world(timing, inputs)
        elif kind == "event":
            self.event(at, timing, inputs)
        if kind != "once":
            self.work(kind, timing)
            self.client(kind, timing, inputs)
        if "out" in outputs and kind != "once" and self.chance(0.25):
            limit = {"max_gap": f"{self.dice.randint(50, 400)} ms"} if self.chance(0.4) else {}
            timing["outputs"] = {"out": {"conditional": True, **limit}}
        self.components[name] = {"inputs": inputs, "outputs": outputs}
        self.timings[name] = timing

    def outputs(self, at: int, kind: str, outputs: Tree) -> None:
        if kind == "server" or (kind in {"periodic", "event"} and self.chance(0.08)):
            flow = self.dice.choice(("srv", "srv", "action"))
            outputs["serve"] = {"type": f"S{at}"}
            self.types[f"S{at}"] = {"message": f"my_msgs/{flow}/S{at}", "size": "500 B"}
        if kind != "server" or self.chance(0.3):
            outputs["out"] = {"type": f"T{at}"}
            self.types[f"T{at}"] = {"message": f"my_msgs/msg/T{at}", "size": f"{self.dice.choice((100, 1000, 5000))} B"}

    def periodic(self, timing: Tree) -> None:
        period = self.dice.choice(PERIODS)
        timing["period"] = f"{period} ms"
        if self.chance(0.1):
            del timing["period"]
            timing["rate"] = self.dice.choice(("15 Hz", "30 Hz", "60 Hz"))
        if self.chance(0.3):
            timing["jitter"] = self.duration(period * self.dice.choice((0.1, 0.5, 1.5)))
        if self.chance(0.05):
            timing["every"] = 2

    def world(self, timing: Tree, inputs: Tree) -> None:
        """Make a source of events: one for each period, no two closer than the period less the jitter."""
        period = self.dice.choice(PERIODS)
        inputs["world"] = {"external": "Something happens", "medium": "physical"}
        timing |= {"trigger": ["world"], "period": f"{period} ms", "jitter": self.duration(period * self.dice.random())}

    def event(self, at: int, timing: Tree, inputs: Tree) -> None:
        writers = [f"c{other}" for other in range(at) if "out" in self.components[f"c{other}"]["outputs"]]  # type: ignore[operator]
        chosen = self.dice.sample(writers, min(len(writers), self.dice.choice((1, 1, 2, 2, 3))))
        for place, writer in enumerate(chosen):
            inputs[f"i{place}"] = f"{writer}.out"
        if len(chosen) > 1 and self.chance(0.2):
            inputs.clear()
            inputs["i0"] = [f"{writer}.out" for writer in chosen[:2]]
            if len(chosen) > 2:
                inputs["i1"] = f"{chosen[2]}.out"
        names = list(inputs)
        some = self.dice.sample(names, self.dice.randint(1, len(names)))
        timing["trigger"] = self.dice.choice(("any", "all", some, {"all": some}))
        if self.chance(0.15):
            timing["every"] = self.dice.choice((2, 3))
        if self.chance(0.15):
            timing["throttle"] = f"{self.dice.choice((7, 15, 30))} ms"
        if self.chance(0.1):
            timing["jitter"] = self.duration(self.dice.choice((1, 3, 12)))

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
        calls: Tree = {}
        for key in ("ask", "beg"):
            if servers and self.chance((0.5 if kind != "server" else 0.2) if key == "ask" else 0.2):
                chosen = self.dice.choice(servers)
                if self.reaches(chosen, set(self.sources(inputs))):
                    continue
                inputs[key] = f"{chosen}.serve"
                if self.chance(0.4):
                    calls[key] = self.dice.choice((0.5, 2, 1.5))
        if calls:
            timing["calls"] = calls

    def sampling(self, name: str) -> None:
        timing, inputs = self.timings[name], self.components[name]["inputs"]
        assert isinstance(inputs, dict)
        writers = [
            other
            for other, c in self.components.items()
            if other != name and "out" in c["outputs"]  # type: ignore[operator]
        ]
        named = isinstance(timing.get("trigger"), list | dict)
        if writers and timing["behaviour"] != "once" and (named or timing["behaviour"] != "event"):
            for place, writer in enumerate(self.dice.sample(writers, min(len(writers), self.dice.randint(0, 2)))):
                inputs[f"s{place}"] = f"{writer}.out"

    def sources(self, inputs: Tree) -> list[str]:
        """Name the components that feed a component's inputs."""
        return [
            str(one).split(".", maxsplit=1)[0]
            for some in inputs.values()
            if not isinstance(some, dict)
            for one in (some if isinstance(some, list) else [some])
        ]

    def reaches(self, server: str, fired_by: set[str]) -> bool:
        """Say whether what a server does fires one of several components in the end: a call to it would close a ring."""
        seen, waiting = set[str](), [server]
        while waiting:
            name = waiting.pop()
            if name in fired_by:
                return True
            if name not in seen:
                seen.add(name)
                waiting += [other for other in self.components if name in self.fired_by(other)]
                waiting += [
                    source
                    for key in ("ask", "beg")
                    if key in self.inputs(name)
                    for source in self.sources({key: self.inputs(name)[key]})
                ]
        return False

    def fired_by(self, name: str) -> list[str]:
        return self.sources({key: source for key, source in self.inputs(name).items() if key.startswith("i")})

    def inputs(self, name: str) -> Tree:
        inputs = self.components[name]["inputs"]
        assert isinstance(inputs, dict)
        return inputs

    def walk(self) -> list[str]:
        """Walk along inputs, backwards from anywhere."""
        way = [self.dice.choice(list(self.components))]
        for _ in range(self.dice.randint(1, 4)):
            fresh = [source for source in self.sources(self.inputs(way[0])) if source not in way]
            if not fresh:
                break
            way.insert(0, self.dice.choice(fresh))
        return [f"g.{name}" for name in way] if len(way) > 1 else []
