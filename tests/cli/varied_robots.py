"""Random projects over all that the language has: partners, media, variants, instances, schedulings, deadlines, requirements."""

from __future__ import annotations

import itertools
import json
import random
from typing import Any

_HOSTS: tuple[dict[str, Any], ...] = (
    {"cores": 2},
    {"cores": 4, "scheduling": "fair"},
    {"cores": 2, "scheduling": {"fair": {"slice": "3 ms", "tick": "1 ms", "lead": 5, "other_load": "10 %"}}},
    {"cores": 2, "scheduling": "fixed_priority"},
    {"cores": 1, "scheduling": "edf"},
    {"cores": 1, "scheduling": "round_robin"},
    {},
)
_MESSAGES = ("sensor_msgs/msg/Image", "geometry_msgs/msg/PoseStamped", "nav_msgs/msg/Path", "std_msgs/msg/String", None)
_SIZES = ("12 kB", "900 kB", "80 B", None)
_PERIODS = (10, 20, 20, 50, 100, 100, 200, 500)
_STATUSES = ("existing", "adapted", "planned", None)
_TITLES = ("Camera", "Finder", "Planner", "Lift drive", "Watch <dog>", "Map & more", "Über-Monitor", "Estimator")


def draw_project(seed: int) -> tuple[str, str]:
    """Return a project by a seed, and an earlier version of it, both as JSON, which is YAML."""
    maker = _ProjectMaker(random.Random(seed))  # noqa: S311 - a test's dice
    project = maker.make()
    return json.dumps(project, indent=1, ensure_ascii=False), json.dumps(
        maker.make_earlier(project), indent=1, ensure_ascii=False
    )


class _ProjectMaker:
    def __init__(self, dice: random.Random) -> None:
        self.dice = dice
        self.partners = [f"p{at}" for at in range(dice.choice((1, 2, 2, 3, 4, 5)))]
        self.hosts = {f"h{at}": dict(dice.choice(_HOSTS)) for at in range(dice.choice((1, 1, 2, 3)))}
        self.types: dict[str, Any] = {}
        self.names: list[str] = []
        self.outputs: dict[str, list[str]] = {}
        self.feeds: dict[str, list[str]] = {}
        self.periods: dict[str, int] = {}

    def chance(self, share: float) -> bool:
        """Say whether something happens in so many of all cases."""
        return self.dice.random() < share

    def make(self) -> dict[str, Any]:
        """Return the whole project."""
        groups = {f"g{at}": self._draw_group(at) for at in range(self.dice.choice((1, 2, 3, 4)))}
        project: dict[str, Any] = {
            "archgen": 1,
            "project": {"id": "varied", "title": "Varied <robot> & more", "version": "1.0"},
            "ros": {"distro": self.dice.choice(("jazzy", "humble"))},
            "partners": {
                each: self.dice.choice(
                    (f"Partner {each[1:]}", {"title": f"Partner {each[1:]}", "contact": f"{each}@x.example"})
                )
                for each in self.partners
            },
            "groups": groups,
            "types": self.types,
            "hosts": self.hosts,
            "requirements": {
                f"R-{at}": self.dice.choice(
                    (f"The robot does {at}", {"title": f"The robot does {at}", "kind": "safety"})
                )
                for at in range(8)
            },
        }
        project["nodes"] = {name.replace(".", "_"): self._draw_node(name) for name in self.names if self.chance(0.9)}
        if len(self.hosts) > 1:
            project["links"] = {"lan": self._draw_link()}
        project["chains"] = self._draw_chains()
        project["use_cases"] = {f"UC-{at}": self._draw_use_case(at) for at in range(self.dice.choice((0, 1, 2)))}
        if self.chance(0.5):
            project["milestones"] = {
                f"m{at}": {
                    "title": f"Step {at}",
                    "date": f"2099-0{at + 1}-01",
                    "needs": f"owner:{self.dice.choice(self.partners)}",
                }
                for at in range(2)
            }
        if self.chance(0.4):
            name = self.dice.choice(list(project["nodes"]) or [""])
            changes = {"nodes": {name: {"timing": {"priority": 3}}}} if name else {}
            project["variants"] = {"other": {"title": "Otherwise", "changes": changes}}
        if self.chance(0.4):
            self._add_instances(project)
        return project

    def _draw_group(self, at: int) -> dict[str, Any]:
        components = {f"c{each}": self._draw_component(f"g{at}.c{each}") for each in range(self.dice.randint(1, 5))}
        group: dict[str, Any] = {"title": f"Group {at}", "components": components}
        if self.chance(0.8):
            group["owner"] = self.dice.choice(self.partners)
        return group

    def _draw_component(self, name: str) -> dict[str, Any]:
        component: dict[str, Any] = {"outputs": {}}
        number = len(self.names)
        if self.chance(0.8):
            component["title"] = f"{self.dice.choice(_TITLES)} {number}"
        if self.chance(0.3):
            component["owner"] = self.dice.choice(self.partners)
        if self.chance(0.5):
            component["requirements"] = self.dice.sample([f"R-{at}" for at in range(8)], 2)
        if self.chance(0.5):
            component["functionality"] = "Does *what* it is to do."
        inputs = {}
        before = [each for each in self.names[-8:] if self.outputs[each]]
        for at, source in enumerate(self.dice.sample(before, min(len(before), self.dice.choice((1, 1, 2, 3))))):
            inputs[f"i{at}"] = self.dice.choice(self.outputs[source])
            self.feeds.setdefault(name, []).append(source)
        component["inputs"] = inputs or {"world": {"external": "The world", "medium": "physical"}}
        for at in range(self.dice.choice((1, 1, 2))):
            component["outputs"][f"o{at}"] = self._draw_output(number, at)
        if self.chance(0.2):
            component["outputs"]["moves"] = {"type": "Motion", "medium": "physical", "external": "It moves"}
            self.types["Motion"] = None
        self.names.append(name)
        self.outputs[name] = [f"{name}.o0"] + ([f"{name}.o1"] if "o1" in component["outputs"] else [])
        return component

    def _draw_output(self, number: int, at: int) -> dict[str, Any]:
        kind = f"Data {number}.{at}"
        output: dict[str, Any] = {"type": kind}
        medium = self.dice.choice((None, None, None, None, "mqtt", "can", "rest"))
        if medium:
            output["medium"] = medium
            self.types[kind] = None
        else:
            entry = {"message": self.dice.choice(_MESSAGES), "size": self.dice.choice(_SIZES)}
            self.types[kind] = {key: value for key, value in entry.items() if value} or None
        if self.chance(0.2):
            output["promise"] = {"rate": "5 Hz", "max_age": f"{self.dice.choice((20, 200, 2000))} ms"}
        return output

    def _draw_node(self, name: str) -> dict[str, Any]:
        node: dict[str, Any] = {"implements": name}
        if self.chance(0.9):
            node["host"] = self.dice.choice(list(self.hosts))
        status = self.dice.choice(_STATUSES)
        if status:
            node["status"] = status
        if self.chance(0.9):
            node["timing"] = self._draw_timing(name)
        return node

    def _draw_timing(self, name: str) -> dict[str, Any]:
        feeding = [source for source in self.feeds.get(name, []) if source in self.periods]
        timing: dict[str, Any] = {}
        if feeding and self.chance(0.5):
            timing["behaviour"] = "event"
            timing["trigger"] = ["i0"]
            self.periods[name] = self.periods[feeding[0]]
        else:
            self.periods[name] = self.dice.choice(_PERIODS)
            timing["period"] = f"{self.periods[name]} ms"
        if self.chance(0.9):
            worst = max(1, round(self.periods[name] * self.dice.choice((0.02, 0.05, 0.1, 0.3)) * 1000))
            timing["wcet"] = (
                {"max": f"{worst} us", "p50": f"{worst // 2 or 1} us", "p99": f"{worst} us"}
                if self.chance(0.3)
                else f"{worst} us"
            )
            if self.chance(0.5):
                timing["bcet"] = f"{worst // 3 or 1} us"
        if self.chance(0.2):
            timing["priority"] = self.dice.randint(1, 90)
        return timing

    def _draw_link(self) -> dict[str, Any]:
        link: dict[str, Any] = {"connects": list(self.hosts)}
        if self.chance(0.7):
            link["bandwidth"] = self.dice.choice(("1 Gbit/s", "100 Mbit/s", "1 Mbit/s"))
        if self.chance(0.7):
            link["latency"] = {"best": "50 us", "worst": "1 ms"}
        if self.chance(0.5):
            link["owner"] = self.dice.choice(self.partners)
        return link

    def _draw_chains(self) -> dict[str, Any]:
        chains = {}
        fed = [name for name in self.names if self.feeds.get(name)]
        for at, end in enumerate(self.dice.sample(fed, min(len(fed), self.dice.choice((0, 1, 2, 3, 5))))):
            way = [end]
            while self.feeds.get(way[0]) and len(way) < 6:
                way.insert(0, self.dice.choice(self.feeds[way[0]]))
            chain: dict[str, Any] = {"through": way}
            bound = self.dice.choice((5, 60, 150, 400, 2000, 10000))
            deadline = self.dice.choice(
                (None, f"{bound} ms", f"{bound} ms", {"always": f"{bound} ms", "95 %": f"{bound * 0.7:.0f} ms"})
            )
            if deadline:
                chain["deadline"] = deadline
            if self.chance(0.6):
                chain["title"] = f"Chain {at} & on"
            if self.chance(0.5):
                chain["requirements"] = [f"R-{self.dice.randrange(8)}"]
            chains[f"k{at}"] = chain
        return chains

    def _draw_use_case(self, at: int) -> dict[str, Any]:
        walk = self.dice.sample(self.names, min(len(self.names), 5))
        steps = [{"from": one, "to": other, "say": "asks"} for one, other in itertools.pairwise(walk)]
        return {
            "title": f"Use case {at}",
            "actors": {"person": "A person"},
            "steps": [{"from": "person", "to": walk[0], "say": "calls"}, *steps],
        }

    def _add_instances(self, project: dict[str, Any]) -> None:
        project["component_types"] = {
            "smooth": {
                "title": "Smoother",
                "inputs": {"raw": "Raw"},
                "outputs": {"clean": "Raw"},
                "timing": {"behaviour": "event", "wcet": "1 ms"},
                "node": {"package": "smoothers", "executable": "smooth", "host": next(iter(self.hosts))},
            }
        }
        self.types["Raw"] = "sensor_msgs/msg/Image"
        project["groups"]["extra"] = {
            "title": "Extra",
            "owner": self.partners[-1],
            "components": {
                "source": {
                    "inputs": {},
                    "outputs": {"raw": "Raw"},
                    "timing": {"period": "100 ms", "wcet": "2 ms"},
                    "node": {"host": next(iter(self.hosts))},
                },
                "one": {"is": "smooth", "inputs": {"raw": "source.raw"}},
                "other": {"is": "smooth", "inputs": {"raw": "one.clean"}},
            },
        }
        project["chains"]["smoothing"] = {"through": ["source", "extra.one", "extra.other"], "deadline": "300 ms"}

    def make_earlier(self, project: dict[str, Any]) -> dict[str, Any]:
        """Return the project with another deadline, another rate, and a node less."""
        earlier: dict[str, Any] = json.loads(json.dumps(project))
        for chain in earlier["chains"].values():
            if isinstance(chain.get("deadline"), str):
                chain["deadline"] = "1 s"
        for node in list(earlier["nodes"].values())[:2]:
            if "period" in node.get("timing", {}):
                node["timing"]["period"] = "70 ms"
        return earlier
