"""Projects by dice: types in types, instances that change what is inside, autoconnect, generic filters, hierarchy."""

from __future__ import annotations

import random

import yaml

_TYPES = ("Pose", "Map", "Way")
_MODES = (None, "ports", "types")


class RandomProject:
    """A project that is drawn; `data` is its one file."""

    def __init__(self, seed: int) -> None:
        """Draw it."""
        self._dice = random.Random(seed)  # noqa: S311 - a test's dice
        self._type_ports: dict[str, tuple[list[str], list[str]]] = {}
        component_types: dict[str, object] = {"filter": self._make_filter()}
        for number in range(self._dice.randint(1, 3)):
            component_types[f"leaf_{number}"] = self._make_leaf_type(f"leaf_{number}")
        for number in range(self._dice.randint(1, 3)):
            component_types[f"whole_{number}"] = self._make_whole(f"whole_{number}", depth=0)
        groups = {f"g{number}": self._make_group() for number in range(self._dice.randint(1, 2))}
        messages = {
            "Pose": "geometry_msgs/msg/PoseStamped",
            "Map": "nav_msgs/msg/OccupancyGrid",
            "Way": "nav_msgs/msg/Path",
        }
        self.data = {"archgen": 1, "component_types": component_types, "groups": groups, "types": messages}

    @property
    def text(self) -> str:
        """The file."""
        return yaml.safe_dump(self.data, sort_keys=False)

    def _draw_ports(self, kind: str) -> dict[str, object]:
        names = self._dice.sample(["a", "b", "c"], self._dice.randint(0, 2))
        key = "type"
        del kind
        return {name: {key: self._dice.choice(_TYPES)} for name in names}

    def _make_filter(self) -> dict[str, object]:
        self._type_ports["filter"] = (["raw"], ["clean"])
        return {
            "generic": ["T"],
            "inputs": {"raw": {"type": "T"}},
            "outputs": {"clean": {"type": "T"}},
            "node": {"package": "p", "executable": "f"},
        }

    def _make_leaf_type(self, name: str) -> dict[str, object]:
        inputs, outputs = self._draw_ports("input"), self._draw_ports("output")
        self._type_ports[name] = (list(inputs), list(outputs))
        body: dict[str, object] = {"inputs": inputs, "outputs": outputs, "tags": [name]}
        if self._dice.random() < 0.5:
            body["node"] = {"package": "p", "executable": name}
        if self._dice.random() < 0.5:
            body["timing"] = {"rate": "10 Hz", "wcet": "1 ms"}
        return body

    def _make_whole(self, name: str, depth: int) -> dict[str, object]:
        """Draw a composed component, the innards of a type or of one that is written in place."""
        inputs, outputs = self._draw_ports("input"), self._draw_ports("output")
        components = self._make_components(list(inputs), depth)
        body: dict[str, object] = {"inputs": inputs, "outputs": outputs, "components": components}
        mode = self._dice.choice(_MODES)
        if mode:
            body["autoconnect"] = mode
        inner = [(child, port) for child, part in components.items() for port in self._list_outputs(part)]
        for port in outputs.values():
            if inner and self._dice.random() < 0.6 and isinstance(port, dict):
                child, output = self._dice.choice(inner)
                port["from"] = f"{child}.{output}"
                del port["type"]
        if self._dice.random() < 0.3:
            body["node"] = {
                "namespace": name,
                **({"whole": True, "package": "w", "executable": name} if depth == 0 else {}),
            }
        self._type_ports[name] = (list(inputs), list(outputs))
        return body

    def _list_outputs(self, part: dict[str, object]) -> list[str]:
        name = str(part.get("is", "")).partition("<")[0]
        if name:
            return self._type_ports[name][1]
        outputs = part.get("outputs")
        return list(outputs) if isinstance(outputs, dict) else []

    def _list_inputs(self, part: dict[str, object]) -> list[str]:
        name = str(part.get("is", "")).partition("<")[0]
        if name:
            return self._type_ports[name][0]
        inputs = part.get("inputs")
        return list(inputs) if isinstance(inputs, dict) else []

    def _make_components(self, self_inputs: list[str], depth: int) -> dict[str, dict[str, object]]:
        components: dict[str, dict[str, object]] = {}
        for number in range(self._dice.randint(1, 3)):
            choice = self._dice.random()
            known = list(self._type_ports)
            if choice < 0.6:
                name = self._dice.choice(known)
                expression = f"filter<{self._dice.choice(_TYPES)}>" if name == "filter" else name
                components[f"p{number}"] = {"is": expression}
            elif choice < 0.75 and depth < 2:
                components[f"p{number}"] = self._make_whole(f"inline_{depth}_{number}_{len(known)}", depth + 1)
                del self._type_ports[f"inline_{depth}_{number}_{len(known)}"]
            else:
                components[f"p{number}"] = {
                    "inputs": self._draw_ports("input"),
                    "outputs": self._draw_ports("output"),
                    "functionality": "Does it.",
                }
        sources = [f"{child}.{port}" for child, part in components.items() for port in self._list_outputs(part)]
        sources += [f"self.{name}" for name in self_inputs]
        for child, part in components.items():
            others = [each for each in sources if not each.startswith(f"{child}.")]
            for port in self._list_inputs(part):
                if others and self._dice.random() < 0.5:
                    inputs = part.setdefault("inputs", {})
                    if isinstance(inputs, dict):
                        body = inputs.setdefault(port, {})
                        body["from"] = self._dice.sample(others, min(len(others), self._dice.randint(1, 2)))
            if "is" in part and len(components) > 1 and self._dice.random() < 0.2:
                part["from"] = [self._dice.choice([each for each in components if each != child])]
        return components

    def _make_group(self) -> dict[str, object]:
        group: dict[str, object] = {"title": "Group", "components": self._make_components([], 0)}
        mode = self._dice.choice(_MODES)
        if mode:
            group["autoconnect"] = mode
        return group
