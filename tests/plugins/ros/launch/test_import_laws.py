"""Importing again, by laws: random changes of a robot's launch file beside random edits of its slice, through their texts."""

from __future__ import annotations

import random
import re
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

import pytest

from archgen.edit.earlier_import import ImportOrigin, read_slice_content
from archgen.edit.imported_slices import ImportPlan, plan_import
from archgen.plugins.ros.launch.launch_import import read_launch
from archgen.syntax.yaml_parser import list_comments
from tests.property_sizes import try_some

SLICE = "robot_launch.yaml"
NAMES = [f"n{number}" for number in range(8)]
Robot = dict[str, dict[str, Any]]


class Import:
    """A launch file and the project that is imported from it."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.project = folder / "robot"

    def bring_in(self, robot: Robot, project: Path | None = None) -> ImportPlan:
        """Import a robot, again where it is there, and write what changes."""
        project = project or self.project
        file = self.folder / "robot.launch.xml"
        file.write_text(write_launch(robot), encoding="utf-8")
        plan = plan_import(read_launch([file]), ImportOrigin("launch", (file.name,)), project, merge=project.exists())
        for planned in plan.slices:
            for name, text in {planned.file: planned.text, **planned.records}.items():
                (project / name).parent.mkdir(parents=True, exist_ok=True)
                (project / name).write_text(text, encoding="utf-8")
        return plan

    def read(self) -> str:
        """Return the slice."""
        return (self.project / SLICE).read_text(encoding="utf-8")


def write_launch(robot: Robot) -> str:
    lines = ['<launch><arg name="extra" default="false"/>']
    for name, facts in robot.items():
        words = "".join(f' {key}="{facts[key]}"' for key in ("namespace", "args", "respawn", "if") if key in facts)
        lines.append(f'<node pkg="p" exec="{name}" name="{name}"{words}>')
        lines += [f'<param name="{key}" value="{value}"/>' for key, value in facts["params"].items()]
        lines += [f'<remap from="{key}" to="{value}"/>' for key, value in facts["remaps"].items()]
        lines.append("</node>")
    return "\n".join([*lines, "</launch>"])


def make_node(draw: random.Random) -> dict[str, Any]:
    facts: dict[str, Any] = {"params": {}, "remaps": {}}
    for _ in range(draw.randrange(5)):
        change_node(facts, draw)
    return facts


def change_node(facts: dict[str, Any], draw: random.Random) -> None:
    """Change one fact of a node: it comes, goes, or is another one."""
    choice = draw.randrange(6)
    values = ["args", "namespace", "respawn", "if"]
    if choice < len(values):
        key = values[choice]
        if key in facts and draw.random() < 0.5:
            del facts[key]
        else:
            facts[key] = {
                "args": f"-v --level {draw.randrange(3)}",
                "namespace": f"/space{draw.randrange(3)}",
                "respawn": "true",
                "if": "$(var extra)",
            }[key]
        return
    holder = facts["params" if choice == 4 else "remaps"]
    key = f"key{draw.randrange(3)}"
    if key in holder and draw.random() < 0.5:
        del holder[key]
    else:
        holder[key] = f"/topic{draw.randrange(4)}"


def change_robot(robot: Robot, draw: random.Random) -> Robot:
    changed = {
        name: {**facts, "params": {**facts["params"]}, "remaps": {**facts["remaps"]}} for name, facts in robot.items()
    }
    for _ in range(draw.randrange(7)):
        name = draw.choice(NAMES)
        if name not in changed:
            changed[name] = make_node(draw)
        elif draw.random() < 0.2 and len(changed) > 1:
            del changed[name]
        else:
            change_node(changed[name], draw)
    return changed


def edit_slice(text: str, draw: random.Random) -> str:
    """Edit a slice as people do: values changed, keys added and struck out, nodes added, comments."""
    for number in range(draw.randrange(7)):
        own = f"own{number}"
        lines = text.splitlines(keepends=True)
        nodes = [place for place, line in enumerate(lines) if re.fullmatch(r"  n\d:.*\n", line)]
        if not nodes:
            break
        place = draw.choice(nodes)
        end = next((each for each in range(place + 1, len(lines)) if not lines[each].startswith("   ")), len(lines))
        draw.choice(EDITS)(lines, range(place + 1, end), draw, own)
        edited = "".join(lines)
        if not read_slice_content(SLICE, edited).diagnostics:
            text = edited
    return text


def change_value(lines: list[str], node: range, draw: random.Random, own: str) -> None:
    places = [each for each in node if re.search(r"(?:namespace|key\d): /", lines[each])]
    if places:
        place = draw.choice(places)
        lines[place] = re.sub(r": /.*", f": /{own}  # why {own}", lines[place])


def strike_out(lines: list[str], node: range, draw: random.Random, _own: str) -> None:
    places = [each for each in node if re.match(r"    (?:namespace|status|name): ", lines[each])]
    if places:
        del lines[draw.choice(places)]


def add_inside(lines: list[str], node: range, draw: random.Random, own: str) -> None:
    places = [each for each in node if re.match(r"    (?:remaps|parameters):\n", lines[each])]
    if places:
        lines.insert(draw.choice(places) + 1, f"      {own}: /{own}\n")


def describe(lines: list[str], node: range, _draw: random.Random, own: str) -> None:
    lines.insert(node.start, f"    description: By hand {own}.  # why {own}\n")


def comment(lines: list[str], node: range, _draw: random.Random, own: str) -> None:
    lines.insert(node.start - 1, f"  # Above, {own}.\n")


def add_node(lines: list[str], _node: range, _draw: random.Random, own: str) -> None:
    lines.append(f"  {own}: {{package: {own}, executable: {own}}}\n")


EDITS: tuple[Callable[[list[str], range, random.Random, str], None], ...] = (
    change_value,
    strike_out,
    add_inside,
    describe,
    comment,
    add_node,
)
"""What people do: the lines of a slice, those of the node that they edit, and a word of their own."""


def list_leaves(value: object, path: tuple[str, ...] = ()) -> Iterator[tuple[tuple[str, ...], object]]:
    if isinstance(value, Mapping) and value:
        for key, inner in value.items():
            yield from list_leaves(inner, (*path, key))
    else:
        yield path, value


def read_leaves(text: str) -> dict[tuple[str, ...], object]:
    content = read_slice_content(SLICE, text)
    assert not content.diagnostics
    return dict(list_leaves(content.data))


@pytest.mark.parametrize("seed", try_some(range(160), 4, 53))
def test_a_second_import_follows_the_laws(seed: int, tmp_path: Path) -> None:
    draw = random.Random(seed)  # noqa: S311 - no secret
    robot = {name: make_node(draw) for name in draw.sample(NAMES, 5)}
    changed = change_robot(robot, draw)
    imports = Import(tmp_path)
    imports.bring_in(robot)
    base = imports.read()

    # With an unchanged robot the slice is untouched, whatever people wrote.
    mine = edit_slice(base, draw)
    (imports.project / SLICE).write_text(mine, encoding="utf-8")
    assert not imports.bring_in(robot).is_out_of_date
    assert imports.read() == mine

    merged_plan = imports.bring_in(changed)
    merged = imports.read()
    assert not any(planned.is_rewritten for planned in merged_plan.slices)
    # A second run changes nothing, and tells nothing.
    assert not imports.bring_in(changed).is_out_of_date
    assert imports.read() == merged

    # Without people's edits the result is a fresh import, in its order where something changed.
    untouched = Import(tmp_path / "untouched")
    untouched.folder.mkdir()
    untouched.bring_in(robot)
    untouched.bring_in(changed)
    fresh = Import(tmp_path / "fresh")
    fresh.folder.mkdir()
    fresh.bring_in(changed)
    assert read_leaves(untouched.read()) == read_leaves(fresh.read())
    assert untouched.read() in {fresh.read(), base}

    # What people wrote is in the result, what they struck out is not, and all else is what the robot says now.
    old, our, new, result = map(read_leaves, (base, mine, fresh.read(), merged))
    for path, value in our.items():
        if old.get(path, new.get(path)) != value:
            assert result[path] == value
    for path in old.keys() - our.keys():
        assert path not in result
    for path, value in new.items():
        if path not in old.keys() | our.keys() or our.get(path) == old.get(path):
            assert result.get(path) == value, path
    for path, value in old.items():
        if path not in new and our.get(path) == value:
            assert path not in result
    by_people = [comment for comment in list_comments(mine) if "own" in comment]
    assert sorted(by_people) == sorted(comment for comment in list_comments(merged) if "own" in comment)
