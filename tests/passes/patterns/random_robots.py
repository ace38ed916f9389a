"""Robots at random, with all that passes rewrite: groups, types, components inside of components, libraries, generics."""

from __future__ import annotations

import random
from pathlib import Path

import yaml

TYPES = ("Pose", "Map", "Way", "Image")
_PORTS = ("a", "b", "c", "d")


def make_robot(seed: int, folder: Path) -> Path:
    """Write a robot with a library, and return its folder."""
    draw = random.Random(seed)  # noqa: S311 - the same robot for the same seed
    maker = _RobotMaker(draw)
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "common").mkdir(exist_ok=True)
    (folder / "archgen.yaml").write_text(yaml.safe_dump(maker.make(), sort_keys=False), encoding="utf-8")
    library = {"component_types": {f"part_{n}": maker.make_leaf(is_type=True) for n in range(2)}}
    (folder / "common" / "parts.yaml").write_text(yaml.safe_dump(library, sort_keys=False), encoding="utf-8")
    return folder


class _RobotMaker:
    def __init__(self, draw: random.Random) -> None:
        self._draw = draw
        self._types: dict[str, dict[str, object]] = {}

    def make(self) -> dict[str, object]:
        for number in range(3):
            self._types[f"kind_{number}"] = self.make_leaf(is_type=True)
        self._types["filter"] = {
            "generic": ["T"],
            "title": "Filter",
            "inputs": {"raw": {"type": "T"}},
            "outputs": {"clean": {"type": "T"}},
        }
        self._types["whole"] = self._make_shell(is_type=True)
        self._types["derived"] = {"is": "kind_0", "outputs": {"more": {"type": self._draw.choice(TYPES)}}}
        groups = {f"group_{number}": self._make_group() for number in range(2)}
        return {
            "archgen": 1,
            "project": {"id": "robot"},
            "libraries": {"common": "common"},
            "component_types": self._types,
            "groups": groups,
            "types": {
                name: f"std_msgs/msg/{kind}"
                for name, kind in zip(TYPES, ("String", "Int32", "Bool", "Byte"), strict=True)
            },
        }

    def make_leaf(self, *, is_type: bool = False) -> dict[str, object]:
        del is_type
        names = self._draw.sample(_PORTS, self._draw.randint(1, 4))
        cut = self._draw.randint(0, len(names) - 1)
        return {
            "inputs": {name: {"type": self._draw.choice(TYPES)} for name in names[:cut]},
            "outputs": {name: {"type": self._draw.choice(TYPES)} for name in names[cut:]},
        }

    def _make_group(self) -> dict[str, object]:
        group: dict[str, object] = {"components": self._make_parts(5, depth=0)}
        self._add_autoconnect(group)
        return group

    def _make_shell(self, *, is_type: bool = False, depth: int = 1) -> dict[str, object]:
        shell = self.make_leaf(is_type=is_type)
        shell["components"] = self._make_parts(3, depth=depth, only_leaves=is_type)
        self._add_autoconnect(shell)
        return shell

    def _make_parts(self, count: int, *, depth: int, only_leaves: bool = False) -> dict[str, object]:
        return {f"x{depth}_{number}": self._make_part(depth, only_leaves=only_leaves) for number in range(count)}

    def _make_part(self, depth: int, *, only_leaves: bool) -> dict[str, object]:
        choice = self._draw.random()
        if choice < 0.3 or (only_leaves and choice > 0.6):
            return self.make_leaf()
        if choice < 0.6:
            return {"is": self._draw.choice(("kind_0", "kind_1", "kind_2", f"filter<{self._draw.choice(TYPES)}>"))}
        if choice < 0.85 or depth > 1:
            return {"is": self._draw.choice(("derived", "common.part_0", "common.part_1", "whole"))}
        return self._make_shell(depth=depth + 1)

    def _add_autoconnect(self, holder: dict[str, object]) -> None:
        mode = self._draw.choice(("ports", "types", None))
        if mode:
            holder["autoconnect"] = mode
