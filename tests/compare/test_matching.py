"""By which features elements of each kind are recognised, and how much each weighs."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen import pipeline
from archgen.compare.architecture_version import ArchitectureVersion
from archgen.compare.element_relations import ElementRelations
from archgen.compare.kinds import ELEMENT_KINDS
from archgen.compare.match_elements import match_elements
from archgen.model.architecture import Architecture

ROBOT = """\
partners: {certh: The CERTH}
use_cases: {U: {title: Use it, description: Often used}}
requirements: {R: {title: Require it, description: Needed here, use_cases: [U]}}
groups:
  g:
    title: Group
    description: Some parts
    owner: certh
    components:
      cam:
        {title: Cam, functionality: Sees, description: Well, role: source, owner: certh, requirements: [R], tags: [t],
         performance: {speed: {accuracy: 90 %, execution_time: 1 ms}},
         timing: {behaviour: periodic, rate: 10 Hz, wcet: 1 ms},
         outputs: {im: {type: T, description: A picture, external: on paper}}}
      eye: {inputs: {im: {from: cam.im, type: T, description: It}}}
types: {T: {message: own_msgs/msg/M, comment: Words here, size: 1 kB}, S: {request: T, response: T}}
ros: {definitions: {own_msgs/msg/M: "int8 a\\nint8 b"}}
nodes:
  n: {title: The node, description: Runs, implements: cam, package: p, executable: e, host: pc, parameters: {x: 1}, publishes: {im: /im}}
  k: {implements: eye, container: box}
hosts: {pc: {title: The PC, cores: 4, description: Big}, arm: }
containers: {box: {title: A box, host: pc, threads: 2}}
links: {lan: {title: A net, connects: [pc, arm], bandwidth: 1 Gbit/s, latency: {best: 1 ms, worst: 2 ms}}}
chains: {c: {title: A way, through: [cam, k], deadline: 1 s}}
views: {v: {title: A view, show: g}}
policies: {p: {title: A rule, forbid: {from: g.cam, to: g}}}
"""
EXPECTED = {
    "partner certh": ("name 2: ^c ce er h$ rt th", "title 2: certh the", "owns 4: g g.cam g.eye"),
    "group g": ("name 2: ^g g$", "title 2: group", "components 8: cam eye", "text 2: parts some", "owner 0.5: certh"),
    "component g.cam": (
        "name 2: ^c am ca m$", "title 2 generated: cam", "ports 4: T im >", "text 3: sees well", "near 3: g.eye", "nodes 3: n",
        "group 0.5: g", "owner 0.5: certh", "requirements 1: R", "performance 1: speed 90 % 1 ms",
        "timing 1: 1 ms 10 Hz periodic", "tags 0.5: t",
    ),
    "component g.eye": (
        "name 2: ^e e$ ey ye", "title 2 generated: eye", "ports 4: > im T", "text 3:", "near 3: g.cam", "nodes 3: k",
        "group 0.5: g", "owner 0.5: certh", "requirements 1:", "performance 1:", "timing 1:", "tags 0.5:",
    ),
    "output g.cam.im": ("name 2: ^i im m$", "type 4: T", "topics 3: /im", "text 1: a on paper picture", "readers 5: g.eye"),
    "input g.eye.im": ("name 2: ^i im m$", "type 4: T", "topics 3:", "text 1: it", "sources 5: g.cam.im"),
    "type T": (
        "name 2: ^t t$", "message 3: own_msgs/msg/M", "users 5: g.cam.im g.eye.im", "text 1: here words", "size 1: 1 kB", "inside 2:", "fields 3:",
    ),
    "type S": ("name 2: ^s s$", "message 3:", "users 5:", "text 1:", "size 1:", "inside 2: T", "fields 3:"),
    "message own_msgs/msg/M": ("name 2: ^m m$", "package 1: own_msgs/msg", "fields 5: a int8 b int8", "users 4: T"),
    "node n": (
        "name 2: ^n n$", "title 2: node the", "implements 4: g.cam", "package 2: p", "program 2: e", "ports 2: publishes im",
        "topics 1: /im", "place 1: pc", "parameters 1: x", "text 1: runs",
    ),
    "container box": ("name 2: ^b bo ox x$", "title 2: a box", "nodes 5: k", "host 1: pc", "threads 1: 2"),
    "host pc": ("name 2: ^p c$ pc", "title 2: pc the", "nodes 8: k n", "containers 2: box", "cores 1: 4", "text 1: big"),
    "link lan": ("name 2: ^l an la n$", "title 2: a net", "connects 4: arm pc", "figures 2: 1 Gbit/s best 1 ms worst 2 ms"),
    "chain c": ("name 2: ^c c$", "title 2: a way", "through 6: g.cam k", "deadline 1: 1 s"),
    "requirement R": ("name 1: ^r r$", "title 4: it require", "users 3: g.cam", "text 2: here needed"),
    "use_case U": ("name 1: ^u u$", "title 4: it use", "users 3: R", "text 2: often used"),
    "view v": ("name 2: ^v v$", "title 2: a view", "show 5: g"),
    "policy p": ("name 2: ^p p$", "title 2: a rule", "forbids 5: g.cam > g"),
}  # fmt: skip


@pytest.fixture(scope="module")
def architecture(tmp_path_factory: pytest.TempPathFactory) -> Architecture:
    file: Path = tmp_path_factory.mktemp("robot") / "robot.yaml"
    file.write_text(ROBOT, encoding="utf-8")
    return pipeline.check_project(file).architecture


@pytest.mark.parametrize("key", list(EXPECTED))
def test_features(architecture: Architecture, key: str) -> None:
    kind_name, element_id = key.split(" ")
    kind = ELEMENT_KINDS[kind_name]
    relations = ElementRelations(architecture, lambda _, name: name)
    assert kind.elements is not None
    element = kind.elements(ArchitectureVersion(architecture))[element_id]
    found = []
    for feature in kind.features:
        generated = " generated" if feature.is_generated and feature.is_generated(element) else ""
        marks = sorted(feature.marks(relations, element))
        found.append(f"{feature.name} {feature.weight:g}{generated}: {' '.join(marks)}".rstrip())
    assert sorted(found) == sorted(EXPECTED[key])


def test_an_id_that_another_element_has_taken_over_is_nobody_elses(tmp_path: Path) -> None:
    """The requirement that was R2 is gone: R2 is the text of R1 now."""
    versions = []
    for number, texts in enumerate(({"R1": "Sees the person.", "R2": "Grasps."}, {"R2": "Sees the person."})):
        file = tmp_path / f"{number}.yaml"
        sections = "".join(f"  {name}: {{description: {text}}}\n" for name, text in texts.items())
        file.write_text(f"requirements:\n{sections}", encoding="utf-8")
        versions.append(pipeline.check_project(file).architecture)
    matched = match_elements(*versions)
    assert {name: matched.find_new_id("requirement", name) for name in ("R1", "R2")} == {"R1": "R2", "R2": None}
