"""What is no change: another form, order or file; and what holds for any two versions."""

from __future__ import annotations

import random
import shutil
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest
import yaml

from archgen import pipeline
from archgen.checking.checked_packing import pack_checked_project
from archgen.compare import ArchitectureVersion, Change, Comparison
from archgen.compare.compare_versions import compare_versions
from archgen.products.compared_versions import make_comparison_input
from archgen.syntax import yaml_writer as writer
from tests.judged_projects import SAID_BY_PACKING, judge_ramcip
from tests.property_sizes import try_some
from tests.running import RAMCIP


def read(path: Path) -> ArchitectureVersion:
    return make_comparison_input(pipeline.check_project(path))


@pytest.fixture(scope="module")
def ramcip() -> ArchitectureVersion:
    return read(RAMCIP)


@pytest.fixture(scope="module")
def packed() -> dict[str, object]:
    data: dict[str, object] = pack_checked_project(judge_ramcip()).data
    return data


def assert_same(one: ArchitectureVersion, other: ArchitectureVersion) -> None:
    for found in (compare_versions(one, other), compare_versions(other, one)):
        assert [change.text for change in found.changes] == []
        assert [
            f"{d.rule} {d.message}"
            for d in (*found.new_findings, *found.cured_findings)
            if d.rule not in SAID_BY_PACKING
        ] == []
        assert (found.concerned_owners, found.chains) == ((), ())


def test_a_version_is_itself(ramcip: ArchitectureVersion) -> None:
    assert_same(ramcip, ramcip)


def test_the_packed_project_is_the_same(ramcip: ArchitectureVersion, packed: dict[str, object], tmp_path: Path) -> None:
    (tmp_path / "packed.yaml").write_text(writer.write_yaml(packed), encoding="utf-8")
    assert_same(ramcip, read(tmp_path / "packed.yaml"))


def test_order_and_indentation_are_no_change(
    packed: dict[str, object], ramcip: ArchitectureVersion, tmp_path: Path
) -> None:
    shuffled = _shuffled(packed, random.Random(7))  # noqa: S311 - any order
    text = yaml.safe_dump(shuffled, sort_keys=False, indent=5, width=60, allow_unicode=True)
    (tmp_path / "robot.yaml").write_text(text, encoding="utf-8")
    assert_same(ramcip, read(tmp_path / "robot.yaml"))


_ORDERED = frozenset(
    {"implements", "chapters", "through", "steps", "parameters", "parameter_files", "definitions", "texts", "pictures"}
)


def _shuffled(value: object, chance: random.Random) -> object:
    """Change the order of all keys, and of the lists of which the order says nothing (the first component that a node
    implements gives it its owner).
    """
    if isinstance(value, dict):
        entries = list(value.items())
        chance.shuffle(entries)
        return {key: below if key in _ORDERED else _shuffled(below, chance) for key, below in entries}
    if isinstance(value, list):
        items = list(value)
        chance.shuffle(items)
        return items
    return value


def test_moving_elements_between_files_is_no_change(
    packed: dict[str, object], ramcip: ArchitectureVersion, tmp_path: Path
) -> None:
    """Each section, and of the groups each component, in a file of its own."""
    groups = packed["groups"]
    assert isinstance(groups, dict)
    rest = {key: value for key, value in packed.items() if key != "groups"}
    (tmp_path / "archgen.yaml").write_text(writer.write_yaml(rest), encoding="utf-8")
    for group, below in groups.items():
        for name, component in below["components"].items():
            piece = {"groups": {group: {"components": {name: component}}}}
            (tmp_path / f"{group}-{name}.yaml").write_text(writer.write_yaml(piece), encoding="utf-8")
        own = {"groups": {group: {key: value for key, value in below.items() if key != "components"}}}
        (tmp_path / f"{group}.yaml").write_text(writer.write_yaml(own), encoding="utf-8")
    assert_same(ramcip, read(tmp_path))


def test_comments_and_line_ends_are_no_change(ramcip: ArchitectureVersion, tmp_path: Path) -> None:
    target = tmp_path / "robot"
    shutil.copytree(RAMCIP, target, ignore=shutil.ignore_patterns("archgen-out"))
    for file in (*target.rglob("*.yaml"), *target.rglob("*.md"), *target.rglob("*.msg")):
        data = file.read_bytes()
        mark = b"# a comment\n" if file.suffix == ".yaml" else b""
        file.write_bytes(b"\xef\xbb\xbf" + (mark + data).replace(b"\n", b"\r\n"))
    assert_same(ramcip, read(target))


def test_a_project_without_a_name_is_the_same_in_another_folder(tmp_path: Path) -> None:
    for name in ("one", "two"):
        (tmp_path / name).mkdir()
        (tmp_path / name / "archgen.yaml").write_text("archgen: 1\nhosts: {pc: PC}\n", encoding="utf-8")
    assert_same(read(tmp_path / "one"), read(tmp_path / "two"))


SHORT = """\
groups:
  g:
    title: Group
    components:
      a: {title: A, outputs: {x: T}, timing: {period: 100 ms}}
      b: {title: B, inputs: {x: a.x, y: [a.x]}, performance: {accuracy: 90 %}}
types: {T: sensor_msgs/Image}
nodes:
  na: {implements: a, namespace: /ns, publishes: {x: topic}}
  nb: b
containers: {c: pc}
hosts: {pc: PC}
links: {l: [pc, pc2]}
"""
LONG = """\
groups:
  g:
    title: "Group"
    components:
      a:
        title: A
        outputs: {x: {type: T}}
      b:
        title: B
        inputs: {x: {from: [g.a.x]}, y: {from: g.a.x, optional: false}}
        performance: {overall: {accuracy: 90 %}}
types: {T: {message: sensor_msgs/msg/Image}}
nodes:
  na:
    implements: [g.a]
    namespace: ns
    kind: node
    publishes: {a.x: {topic: /ns/topic, qos: {profile: default}}}
    timing: {rate: 10 Hz}
  nb: {implements: [b], subscribes: {x: {}, y: {}}}
containers: {c: {host: pc}}
hosts: {pc: {title: PC}}
links: {l: {connects: [pc2, pc]}}
"""


def test_short_and_long_forms_are_the_same(tmp_path: Path) -> None:
    for name, text in (("short", SHORT), ("long", LONG)):
        (tmp_path / name).mkdir()
        (tmp_path / name / "robot.yaml").write_text(text, encoding="utf-8")
    one, other = (read(tmp_path / name / "robot.yaml") for name in ("short", "long"))
    assert_same(replace(one, findings=()), replace(other, findings=()))


Edit = Callable[[str], str]
EDITS: tuple[Edit, ...] = (
    lambda text: text.replace("camera", "kamera"),
    lambda text: text.replace("Colour image", "Kolor image"),
    lambda text: text.replace("cores: 6", "cores: 3"),
    lambda text: text.replace("period: 200 ms", "period: 100 ms"),
    lambda text: text.replace("robot_lan", "lan"),
    lambda text: text.replace("sensor_data", "default"),
    lambda text: text.replace("owner: certh", "owner: sssa"),
    lambda text: text.replace("semantic_map.rooms", "semantic_map"),
)


# Edits 2 and 8 change rates everywhere: both versions are analysed anew, for seconds.
@pytest.mark.parametrize(
    "number",
    try_some(
        [
            pytest.param(n, marks=pytest.mark.slow) if n in {2, 8} or n % 2 or n > len(EDITS) else n
            for n in range(len(EDITS) + 2)
        ],
        1,
    ),
)
def test_the_way_back_is_the_mirror_image(number: int, ramcip: ArchitectureVersion, tmp_path: Path) -> None:
    """Each edit alone, and some of them together."""
    chosen = EDITS[number : number + 1] or random.Random(number).sample(EDITS, 4)  # noqa: S311 - any four
    target = tmp_path / "robot"
    shutil.copytree(RAMCIP, target, ignore=shutil.ignore_patterns("archgen-out"))
    for file in target.rglob("*.yaml"):
        text = file.read_text(encoding="utf-8")
        for edit in chosen:
            text = edit(text)
        file.write_text(text, encoding="utf-8")
    other = read(target)
    there, back = compare_versions(ramcip, other), compare_versions(other, ramcip)
    assert there.changes
    assert _facts(there) == {_turned(fact) for fact in _facts(back)}
    assert (there.new_findings, there.cured_findings) == (back.cured_findings, back.new_findings)
    # A load or a chain that grows concerns those who use it, on the way back it is only less.
    assert {*there.concerned_owners, *_who_has_less(back)} == {*back.concerned_owners, *_who_has_less(there)}
    assert {(c.before, c.after) for c in there.chains} == {(c.after, c.before) for c in back.chains}
    assert_once(there)


def _who_has_less(found: Comparison) -> set[str]:
    """Give the partners of loads and chains that grew."""
    of_loads = {partner for load in found.loads for partner in load.concerned_partners}
    return of_loads | {partner for chain in found.chains for partner in chain.concerned_partners}


Fact = tuple[str, str, str, str | None, str, str, float]


def _facts(found: Comparison) -> set[Fact]:
    """Give what was told, with the names before and after, in no order; keys by the element's name before."""
    facts = set[Fact]()
    for change in _all(found.changes):
        if change.kind in {"renamed", "moved", "added", "removed"} and change.element_kind != "connection":
            was = change.old_id if change.kind in {"renamed", "moved"} else None
            facts.add((change.kind, change.element_kind, change.element_id, was, "", "", change.confidence))
        elif change.element_kind not in {"connection", "port"} and change.key != "qos":
            facts.add((change.kind, change.element_kind, "", change.key, str(change.before), str(change.after), 1.0))
    return facts


def _turned(fact: Fact) -> Fact:
    kind, sort, element, key, before, after, sure = fact
    turned = {"added": "removed", "removed": "added"}.get(kind, kind)
    if kind in {"renamed", "moved"}:
        return kind, sort, key or "", element, "", "", sure
    return turned, sort, element, key, after, before, sure


def _all(changes: tuple[Change, ...]) -> list[Change]:
    return [each for change in changes for each in (change, *_all(change.parts))]


def assert_once(found: Comparison) -> None:
    """Nothing is both renamed and removed or added, and nothing is told twice."""
    listed = [(c.kind, c.element_kind, c.element_id, c.key) for c in _all(found.changes)]
    assert len(listed) == len(set(listed))
    renamed = {(c.element_kind, name) for c in _all(found.changes) if c.old_id for name in (c.element_id, c.old_id)}
    whole = {
        (c.element_kind, c.element_id)
        for c in _all(found.changes)
        if c.kind in {"added", "removed"} and c.element_kind != "connection"
    }
    assert renamed.isdisjoint(whole)
