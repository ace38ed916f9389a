"""Random systems that join two features of the language each, by pair and seed; further ones are there by chance.

They begin with `random_threads` (crowded containers, groups, orders, storing, pins), of which some things are forced, and
have parts of the project written otherwise: each writer of a feature changes the tree of a whole project.
"""

from __future__ import annotations

import json
import random
from collections.abc import Callable, Iterator, Mapping
from itertools import combinations
from pathlib import Path
from typing import Any

import archgen
from archgen.model.architecture import Architecture
from tests.timing.random_systems import architecture
from tests.timing.random_threads import ThreadsMaker

Tree = dict[str, Any]


def random_pair_text(pair: tuple[str, str], seed: int) -> str:
    """Return a project with both features of a pair, by a seed."""
    dice = random.Random(f"{pair} {seed}")  # noqa: S311 - a test's dice
    project: Tree = ThreadsMaker(dice, is_plain=dice.random() < 0.5).project()
    others = [name for name in FEATURES if name not in pair and dice.random() < 0.08]
    # Features that come into play in the order in which they are listed: services before links, variants last.
    for name, write in FEATURES.items():
        if name in pair or name in others:
            write(dice, project)
    return json.dumps(project, indent=1)


def list_pairs() -> list[tuple[str, str]]:
    """Return all pairs of features."""
    return list(combinations(FEATURES, 2))


def read_variants(text: str, place: Path) -> Iterator[Architecture]:
    """Yield the architecture of a project, and what it is in each variant."""
    variants = json.loads(text).get("variants", {})
    if not variants:
        yield architecture(text)
        return
    file = place / "archgen.yaml"
    file.write_text(text, encoding="utf-8")
    loaded = archgen.load(file)
    yield loaded.architecture
    for name in variants:
        yield loaded.in_variant(name).architecture


def _components(project: Tree) -> dict[str, Tree]:
    components: dict[str, Tree] = project["groups"]["g"]["components"]
    return components


def _some(dice: random.Random, names: Mapping[str, Any], share: float = 0.4) -> list[str]:
    """Draw some names, one at least."""
    return [name for name in names if dice.random() < share] or [dice.choice(list(names))]


def _crowd(dice: random.Random, project: Tree) -> None:
    """Put most nodes into one container with fewer threads than callback groups."""
    project["containers"] = {"crowd": {"host": "h", "threads": dice.choice((1, 2, 2, 3))}}
    project["hosts"]["h"]["cores"] = dice.choice((2, 2, 3, 4))
    for node in project["nodes"].values():
        node.pop("container", None)
        if dice.random() < 0.7:
            for key in ("host", "threads", "scheduling"):
                node.pop(key, None)
            node["container"] = "crowd"
        else:
            node["host"] = "h"


def _use_gpu(dice: random.Random, project: Tree) -> None:
    """Let some use a GPU, and more rarely two."""
    order = dice.choice(({}, {}, {"scheduling": "fifo"}, {"scheduling": "fixed_priority"}))
    project["resources"] = {"gpu": {"host": "h", **order}}
    for name in _some(dice, _components(project), 0.3):
        longest = dice.choice((200, 1000, 4000))
        _components(project)[name]["timing"]["uses"] = {"gpu": {"max": f"{longest} us", "min": f"{longest // 2} us"}}


def _run_beside_itself(dice: random.Random, project: Tree) -> None:
    for name in _some(dice, project["nodes"]):
        node = project["nodes"][name]
        node.pop("callback_groups", None)
        node["reentrant"] = True
        if "container" not in node:
            node["threads"] = dice.choice((2, 3, 4))


def _pin(dice: random.Random, project: Tree) -> None:
    cores = project["hosts"]["h"]["cores"] = dice.choice((2, 2, 3))
    project["hosts"]["h"].pop("scheduling", None)
    for name in _some(dice, _components(project)):
        timing = _components(project)[name]["timing"]
        timing.pop("cores", None)
        timing["core"] = dice.randrange(cores)


def _store(dice: random.Random, project: Tree) -> None:
    """Let timers read what others send, and storing take time."""
    components = _components(project)
    names = list(components)
    for name in _some(dice, components):
        timing = components[name]["timing"]
        read = dice.choice(names)
        if timing["behaviour"] == "periodic" and read != name and read not in components[name]["inputs"]:
            components[name]["inputs"][read] = f"g.{read}.out"
            timing["inputs"] = {**timing.get("inputs", {}), read: {"wcet": f"{dice.choice((0, 1, 3))} ms"}}


def _rank(dice: random.Random, project: Tree) -> None:
    for name in _some(dice, _components(project), 0.8):
        _components(project)[name]["timing"]["priority"] = dice.randint(1, 12)


def _call(dice: random.Random, project: Tree) -> None:
    """Add a server or two, and callers."""
    components = _components(project)
    callers = list(components)
    project["types"]["Ask"] = {"message": "std_srvs/srv/Trigger", "size": "500 B"}
    for number in range(dice.choice((1, 1, 2))):
        server = f"s{number}"
        cost = dice.choice((100, 500, 2000))
        components[server] = {
            "inputs": {},
            "outputs": {"serve": "Ask"},
            "timing": {"behaviour": "on_demand", "wcet": f"{cost} us", "bcet": f"{cost // 2} us"},
        }
        place = dice.choice([{"host": "h"}, *({"container": key} for key in project.get("containers", {}))])
        project["nodes"][f"n{server}"] = {"implements": [f"g.{server}"], **place}
        for name in _some(dice, dict.fromkeys(callers), 0.25):
            components[name]["inputs"][server] = f"g.{server}.serve"
            if dice.random() < 0.3:
                components[name]["timing"]["calls"] = {server: dice.choice((0.5, 2))}


def _filter(dice: random.Random, project: Tree) -> None:
    """Let some inputs be matched by time."""
    components = _components(project)
    sources = [name for name, one in components.items() if "out" in one["outputs"]]
    for number in range(dice.choice((1, 1, 2))):
        chosen = dice.sample(sources, min(len(sources), dice.choice((2, 2, 3))))
        within = dice.choice((0, 5, 20, 50, 100))
        cost = dice.choice((200, 1000))
        components[f"f{number}"] = {
            "inputs": {name: f"g.{name}.out" for name in chosen},
            "outputs": {"out": "Data"},
            "timing": {
                "behaviour": "event",
                "trigger": {"match": chosen, "within": f"{within} ms"},
                "wcet": f"{cost} us",
                "bcet": f"{cost} us",
            },
        }
        project["nodes"][f"nf{number}"] = {"implements": [f"g.f{number}"], "host": "h"}
        project["chains"][f"matched{number}"] = {"through": [f"g.{chosen[0]}", f"g.f{number}"]}


def _link(dice: random.Random, project: Tree) -> None:
    """Move some nodes to a second host behind a link."""
    project["hosts"]["far"] = {"cores": dice.choice((1, 1, 2))}
    low, high = sorted((dice.randint(0, 3000), dice.randint(0, 6000)))
    speed = {"bandwidth": f"{dice.choice((5, 20, 100))} Mbit/s"} if dice.random() < 0.5 else {}
    project["links"] = {
        "lan": {"connects": ["h", "far"], "latency": {"best": f"{low} us", "worst": f"{high} us"}, **speed}
    }
    if project.get("containers") and dice.random() < 0.3:
        _move(project, "containers", dice.choice(list(project["containers"])))
    lone = {name: node for name, node in project["nodes"].items() if "host" in node}
    for name in _some(dice, lone) if lone else ():
        _move(project, "nodes", name)


def _move(project: Tree, section: str, name: str) -> None:
    project[section][name]["host"] = "far"
    for node_id, node in project["nodes"].items():
        if (section == "nodes" and node_id == name) or (section == "containers" and node.get("container") == name):
            for component in node["implements"]:
                timing = _components(project)[component.removeprefix("g.")]["timing"]
                for key in ("core", "cores", "uses"):
                    timing.pop(key, None)


def _lose(dice: random.Random, project: Tree) -> None:
    """Let some send with best effort, and keep few messages."""
    for name in _some(dice, project["nodes"]):
        node = project["nodes"][name]
        qos = {"reliability": "best_effort", "depth": dice.choice((1, 1, 2, 5))}
        owners = [component.removeprefix("g.") for component in node["implements"]]
        keys = {
            f"{owner}.{key}" if len(owners) > 1 else key
            for owner in owners
            for key, source in _components(project)[owner]["inputs"].items()
            if isinstance(source, str) and source.endswith(".out")
        }
        if keys:
            node["subscribes"] = {key: {"qos": qos} for key in sorted(keys)}


def _send_sometimes(dice: random.Random, project: Tree) -> None:
    """Let some send only when there is something to say, with or without a promise."""
    senders = {name: one for name, one in _components(project).items() if "out" in one["outputs"]}
    for name in _some(dice, senders, 0.3):
        limit = {"max_gap": f"{dice.choice((300, 800, 2000))} ms"} if dice.random() < 0.5 else {}
        senders[name]["timing"]["outputs"] = {"out": {"conditional": True, **limit}}


def _drop(dice: random.Random, project: Tree) -> None:
    """Thin what fires some, and forget what is dropped."""
    fired = {
        name: one
        for name, one in _components(project).items()
        if one["timing"]["behaviour"] == "event" and "match" not in str(one["timing"]["trigger"])
    }
    for name in _some(dice, fired) if fired else ():
        timing = fired[name]["timing"]
        timing |= dice.choice(({"every": 2}, {"every": 3}, {"throttle": "30 ms"}, {"every": 2, "throttle": "50 ms"}))
        if dice.random() < 0.5:
            timing["dropped"] = "forgotten"


def _compose(dice: random.Random, project: Tree) -> None:
    """Put some components into composed ones, whose ports are what others see, and make some of types."""
    components = _components(project)
    types = project["component_types"] = {}
    for name in _some(dice, components, 0.3):
        one = components[name]
        outputs = {key: {"from": f"leaf.{key}"} for key in one["outputs"]}
        leaf = {**one, "inputs": {key: f"self.{key}" for key in one["inputs"]}}
        if dice.random() < 0.5:
            # A type's inputs have a data type each, and no source.
            kinds = {key: "Ask" if str(source).endswith(".serve") else "Data" for key, source in one["inputs"].items()}
            types[f"kind_{name}"] = {**one, "inputs": kinds}
            leaf = {"is": f"kind_{name}", "inputs": leaf["inputs"]}
        components[name] = {"inputs": one["inputs"], "outputs": outputs, "components": {"leaf": leaf}}
        for node in project["nodes"].values():
            node["implements"] = [f"g.{name}.leaf" if each == f"g.{name}" else each for each in node["implements"]]
            groups = node.get("callback_groups", {})
            for key, members in groups.items():
                groups[key] = [f"g.{name}.leaf" if each == f"g.{name}" else each for each in members]
            for key in [key for key in node.get("subscribes", {}) if key.startswith(f"{name}.")]:
                node["subscribes"][f"{name}.leaf.{key.partition('.')[2]}"] = node["subscribes"].pop(key)
    if not types:
        del project["component_types"]


def _vary(dice: random.Random, project: Tree) -> None:
    """Add a variant in which something takes another time, or a host has more cores."""
    project["project"] = {"id": "r", "title": "Random"}
    leaves = {name: one for name, one in _components(project).items() if "wcet" in one.get("timing", {})}
    changes: Tree = {"hosts": {"h": {"cores": project["hosts"]["h"]["cores"] + 1}}}
    if leaves:
        slow = dice.choice(list(leaves))
        cost = int(leaves[slow]["timing"]["wcet"].split()[0])
        changes["groups"] = {"g": {"components": {slow: {"timing": {"wcet": f"{cost + cost // 3 + 1} us"}}}}}
    project["variants"] = {"slow": {"changes": changes}}


FEATURES: dict[str, Callable[[random.Random, Tree], None]] = {
    "crowded containers": _crowd,
    "reentrant": _run_beside_itself,
    "pins": _pin,
    "storing": _store,
    "priorities": _rank,
    "services": _call,
    "filters": _filter,
    "dropped": _drop,
    "conditional outputs": _send_sometimes,
    "GPU": _use_gpu,
    "links": _link,
    "lossy media": _lose,
    "composed parts": _compose,
    "variants": _vary,
}
