"""A comparison tells of each key that the description has: one that is left out in the second version is a change."""

from __future__ import annotations

import copy
import json
from collections.abc import Callable, Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

import pytest
import yaml

from archgen import pipeline
from archgen.compare.compare_versions import compare_versions
from archgen.compare.kinds import ELEMENT_KINDS
from archgen.language.key_paths import SLICE, find_inner_part
from archgen.language.language_tables import KEY_FACTS
from archgen.products.compared_versions import make_comparison_input
from tests.compare.test_element_kinds import READ_OFF_PATTERNS, ROBOT

Key = tuple[str, str]
Place = tuple[str, ...]
MORE = """\
groups: {more: {components: {k: {layout: {direction: top-bottom}, outputs: {o: {type: T, medium: mqtt}}}}}}
nodes: {k1: {implements: k, timing: {rate: 1 Hz}}, k2: k}
frames: {odom: {parent: map, by: more.k}}
"""
"""What `ROBOT` does not say."""
UNTOLD = {
    ("project", "id"): "without it the project is called after its file",
    ("project", "title"): "without it the project is called after its file",
    ("component", "inputs"): "elements of their own",
    ("component", "outputs"): "elements of their own",
    ("component", "owner"): "that of its group",
    ("node", "owner"): "that of its component",
    ("node", "host"): "that of its container",
    ("input", "medium"): "`digital` goes without saying",
    ("type", "fields"): "the fields of its message",
    ("view", "show"): "without it there is no view",
}
"""Keys of this robot that may be left out without a change, or with another one."""


class _TextLoader(yaml.SafeLoader):
    """Reads words such as `ON`, and days, as text."""

    yaml_implicit_resolvers = {  # noqa: RUF012 - so named by its base
        first: [(tag, pattern) for tag, pattern in resolvers if not tag.endswith("timestamp")]
        for first, resolvers in yaml.SafeLoader.yaml_implicit_resolvers.items()
        if first not in {*"yYnNoO"}
    }


def _read_robot() -> dict[str, Any]:
    robot, more = (yaml.load(text, _TextLoader) for text in (ROBOT, MORE))  # noqa: S506 - derived from the safe one
    for section, elements in more.items():
        robot[section] |= elements
    # At a component's own frame its writer goes without saying.
    del robot["groups"]["g"]["components"]["a"]["frames"]["base"]["by"]
    return dict(robot)


def _list_places(part: str, value: object, path: Place) -> Iterator[tuple[Key, Place]]:
    """Yield each key of each element with its place; the components that a composed one holds are elements themselves."""
    entries: Mapping[str, object] = value if isinstance(value, dict) else {}
    for key, inner in entries.items():
        if part in KEY_FACTS.keys() & ELEMENT_KINDS.keys() and not (part == "component" and "components" in entries):
            yield (part, key), (*path, key)
        yield from _list_places(find_inner_part(part, key), inner, (*path, key))


def _leave_out(robot: Mapping[str, Any], places: Iterable[Place]) -> Mapping[str, Any]:
    rest = copy.deepcopy(robot)
    for place in places:
        del _find_holder(rest, place)[place[-1]]
    return rest


def _find_holder(robot: Any, place: Place) -> Any:  # noqa: ANN401 - plain data
    for step in place[:-1]:
        robot = robot[step]
    return robot


def _gather_rounds(places: Mapping[Key, Place]) -> list[dict[Key, Place]]:
    """Return the keys in rounds of which each has a key of a kind once, and no key below another: few comparisons do."""
    rounds: list[dict[Key, Place]] = []
    for key, place in sorted(places.items()):
        free = (each for each in rounds if all(key[0] != other[0] for other in each) and not _overlaps(place, each))
        chosen = next(free, None)
        if chosen is None:
            rounds.append({key: place})
        else:
            chosen[key] = place
    return rounds


def _overlaps(place: Place, others: Mapping[Key, Place]) -> bool:
    return any(place[: len(other)] == other or other[: len(place)] == place for other in others.values())


@pytest.fixture
def find_lost_keys(tmp_path: Path) -> Callable[[Mapping[str, Any], Mapping[str, Any]], set[Key]]:
    """Give a function that returns what a comparison of two robots tells of."""

    def find(*robots: Mapping[str, Any]) -> set[Key]:
        versions = []
        for robot in robots:
            (tmp_path / "robot.yaml").write_text(json.dumps(robot), encoding="utf-8")
            versions.append(make_comparison_input(pipeline.check_project(tmp_path / "robot.yaml")))
        changes = compare_versions(*versions).changes
        return {(change.element_kind, (change.key or "").partition(".")[0]) for change in changes}

    return find


def test_each_described_key_that_is_left_out_is_a_change(
    find_lost_keys: Callable[[Mapping[str, Any], Mapping[str, Any]], set[Key]],
) -> None:
    robot = _read_robot()
    places = dict(reversed(list(_list_places(SLICE, robot, ()))))
    for (_, key), place in _list_places(SLICE, robot, ()):
        if key == "title":
            # One that is the id in words is not missed.
            _find_holder(robot, place)[key] = f"Titled {place[-2]}"
    described = {
        (kind, name.removesuffix("."))
        for kind, facts in KEY_FACTS.items()
        if kind in ELEMENT_KINDS
        for name in facts
        if kind != "component_type" or name.removesuffix(".") not in {*READ_OFF_PATTERNS, "layout", "outputs"}
    }
    assert sorted(described - places.keys()) == [], "the robot has no such key"
    told: set[Key] = set()
    for keys in _gather_rounds({key: places[key] for key in described}):
        told |= keys.keys() & find_lost_keys(robot, _leave_out(robot, keys.values()))
    assert sorted(described - told) == sorted(UNTOLD)
