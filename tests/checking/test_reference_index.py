"""Where elements are declared and named: paths, ids, types, selectors, in variants and inside of component types."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen.checking.reference_index import ReferenceIndex, index_references
from archgen.pipeline import VersionCache, check_project

PROJECT = """\
archgen: 1
partners: {lab: Lab, shop: Shop}
hosts: {pc: PC}
component_types:
  arm:
    inputs: {goal: {type: Goal}}
    outputs: {state: {from: joint.angle}}
    components:
      joint:
        inputs: {target: {from: self.goal}}
        outputs: {angle: {type: Angle}}
groups:
  body:
    owner: lab
    components:
      left: {is: arm, inputs: {goal: {from: plan}}}
      right: {is: arm, inputs: {goal: {from: planner.plan}}}
      left.joint: {requirements: [R-1]}
      planner: {inputs: {state: {from: left}}, outputs: {plan: {type: Goal}}}
requirements: {R-1: Move}
types: {Goal: {fields: {at: Pair<Angle>}}, Pair: {generic: [T], fields: {a: T}}, Angle: {fields: {a: float64}}}
nodes:
  brain: {implements: planner, host: pc, publishes: {plan: {topic: /plan}}}
views: {some: {show: "body.planner+ owner:lab -right"}}
variants:
  one:
    without: right
    changes: {nodes: {brain: {subscribes: {state: /state}}}, groups: {body: {owner: shop}}}
"""


def index(folder: Path, text: str = PROJECT, cache: VersionCache | None = None) -> ReferenceIndex:
    """Write a project of one file, and return its index."""
    _write(folder, text)
    cache = cache or VersionCache()
    cache.part_memory.heard = []
    checked_project = check_project(folder, cache)
    assert not checked_project.structural_errors, checked_project.structural_errors
    return index_references(checked_project, cache.part_memory.heard)


@pytest.mark.parametrize(
    ("kind", "element_id", "places"),
    [
        ("component", "body.planner", "planner 19:7!, planner 23:23, body.planner 24:23"),
        ("output", "body.planner.plan", "plan 16:45, planner.plan 17:46, plan 19:58!, plan 23:54"),
        ("input", "body.planner.state", "state 19:26!, state 28:44"),
        ("component", "body.left.joint", "joint 9:7!, left.joint 18:7!"),
        ("component", "body.right.joint", "joint 9:7!, left.joint 18:7!"),
        ("output", "<arm>.joint.angle", "joint.angle 7:29, angle 11:19!"),
        ("input", "body.left.goal", "goal 6:14!, goal 10:38, goal 16:32!, goal 17:33!"),
        ("type", "Angle", "Angle 11:33, Angle 21:34, Angle 21:82!"),
        ("component_type", "arm", "arm 5:3!, arm 16:18, arm 17:19"),
        ("partner", "lab", "lab 2:12!, lab 14:12, lab 24:43"),
        ("node", "brain", "brain 23:3!, brain 28:23!"),
        ("host", "pc", "pc 3:9!, pc 23:38"),
        ("requirement", "R-1", "R-1 18:35, R-1 20:16!"),
        ("group", "body", "body 13:3!, body 28:71!"),
        ("component", "body.right", "right 17:7!, right 24:48, right 27:14"),
    ],
)
def test_an_element_is_found_wherever_it_is_declared_and_named(
    tmp_path: Path, kind: str, element_id: str, places: str
) -> None:
    names = index(tmp_path).list_names(kind, element_id)
    marks = [f"{each.text} {each.span.line}:{each.span.column}{'!' if each.is_declaration else ''}" for each in names]
    assert ", ".join(marks) == places


def test_what_replaces_the_deprecated_and_values_of_selectors_are_found(tmp_path: Path) -> None:
    text = """\
archgen: 1
partners: {own: Own}
component_types:
  arm: {deprecated: {use: limb}, outputs: {a: {type: T, deprecated: {use: b}}, b: {type: U}}}
  limb: {outputs: {b: {type: U}}}
groups: {g: {owner: own, components: {x: {is: arm}, y: {outputs: {c: {type: T, deprecated: {use: g.x.b}}}}}}}
types: {T: {message: std_msgs/msg/Empty, deprecated: {use: U}}, U: {message: std_msgs/msg/Bool}}
views: {v: {show: "owner:own"}}
"""
    found = index(tmp_path, text)
    columns = {
        element: [each.span.column for each in found.list_names(*element) if not each.is_declaration]
        for element in (("component_type", "limb"), ("output", "g.x.b"), ("type", "U"), ("partner", "own"))
    }
    assert columns == {
        ("component_type", "limb"): [27],
        ("output", "g.x.b"): [75, 98],
        ("type", "U"): [90, 30, 60],
        ("partner", "own"): [21, 26],
    }


def test_a_name_at_a_place_is_found(tmp_path: Path) -> None:
    found = index(tmp_path).find_at("archgen.yaml", 23, 25)
    assert [(each.kind, each.id, each.text) for each in found] == [("component", "body.planner", "planner")]
    assert index(tmp_path).find_at("archgen.yaml", 400, 1) == []


def test_what_a_short_form_makes_is_known_not_to_be_written(tmp_path: Path) -> None:
    text = (
        "archgen: 1\ngroups: {g: {components: {c: {outputs: [Laser pose]}}}}\ntypes: {Laser pose: {message: a/msg/B}}\n"
    )
    (name,) = index(tmp_path, text).list_names("output", "g.c.laser_pose")
    assert (name.text, name.is_exact) == ("Laser pose", False)


def test_what_was_taken_over_from_the_version_before_is_heard_again(tmp_path: Path) -> None:
    text = (
        "archgen: 1\ngroups: {g: {components: {c: {outputs: {o: T}}, d: {inputs: {i: {from: c.o}}}}}}\nnodes: {n: c}\n"
    )
    cache = VersionCache()
    check_project(_write(tmp_path, text), cache)
    first = index(tmp_path, text, cache)
    assert index(tmp_path, text, cache).names == first.names
    assert index(tmp_path, text).names == first.names
    assert [each.text for each in first.list_names("component", "g.c")] == ["c", "c"]
    assert [number for _, number in first.list_names_through("component", "g.c")] == [0, 0, 0]


def _write(folder: Path, text: str) -> Path:
    (folder / "archgen.yaml").write_text(text, encoding="utf-8")
    return folder


def test_instances_that_multiply_share_the_list_of_their_ids(tmp_path: Path) -> None:
    inner = "components: {a: {is: %s}, b: {is: %s}, c: {is: %s}, d: {is: %s}}"
    types = "".join(f"  t{n}: {{{inner.replace('%s', f't{n - 1}')}}}\n" for n in range(1, 5))
    text = f"archgen: 1\ncomponent_types:\n  t0: {{outputs: {{o: T}}}}\n{types}groups: {{g: {{components: {{x: {{is: t4}}}}}}}}\n"
    found = index(tmp_path, text)
    # Of a part of `t1`: in all instances of `t1` below `g.x`, and in those of the four types.
    assert len(found.list_ids("component", "g.x.a.b.c.d")) == 4**3 + 4**3 + 4**2 + 4 + 1
    assert len({id(ids) for ids in found.aliases.values()}) == 4 * 4 + 1
