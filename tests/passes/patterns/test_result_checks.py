"""What rules write is held against the language; what no file may hold is told, and nothing is written."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen.passes.patterns.pattern_registry import check_result, find_known_passes
from archgen.pipeline import CheckedProject, check_project, transform_project
from tests.passes.patterns.transforming import data_of, pass_of, said, transform, tree_of
from tests.passes.same_meaning import pack, write_project

ROBOT = "groups: {g: {components: {a: {title: A, outputs: {p: Pose}}}}}\ntypes: {Pose: geometry_msgs/msg/Pose}\n"


def _run_pass(folder: Path, edit: str) -> tuple[CheckedProject, CheckedProject]:
    (folder / "passes").mkdir()
    (folder / "passes" / "own.yaml").write_text(
        "title: Tried here\nrules:\n  - find: {components: {$c: {outputs: {p: {type: Pose}}}}}\n"
        f"    unless: {{components: {{$c: {{description: done}}}}}}\n    {edit}\n",
        encoding="utf-8",
    )
    checked = write_project(folder, ROBOT)
    return checked, transform_project(checked, ["own"], find_known_passes(checked.loaded_project).passes)


@pytest.mark.parametrize(
    ("edit", "message"),
    [
        ("set: {components: {$c: {role: nonsense, description: done}}}", "`role` cannot be `nonsense`"),
        ("set: {components: {$c: {title: [a, b], description: done}}}", "`title` is a list, but must be text"),
        ("set: {components: {$c: {node: {foo: 3}, description: done}}}", "a node of a component has no key `foo`"),
        (
            "set: {components: {$c: {operations: {Bad Name: Pose}, description: done}}}",
            "`Bad Name` cannot be an id",
        ),
        (
            "add: {components: {$c: {description: done}, g.new: {outputs: {Bad Name: Pose}}}}",
            "`Bad Name` cannot be an id",
        ),
    ],
)
def test_what_no_file_may_hold_is_told_and_not_written(edit: str, message: str, tmp_path: Path) -> None:
    checked, transformed = _run_pass(tmp_path, edit)
    (found,) = [each for each in transformed.findings if each.rule == "wrong-pass"]
    assert found.message == f"the pass `own` writes what no file may hold: {message}"
    assert found.span.file == "passes/own.yaml"
    assert [label.span.file for label in found.labels] == ["archgen.yaml"]
    assert transformed.architecture.components == checked.architecture.components


def test_what_may_stand_in_a_file_is_written(tmp_path: Path) -> None:
    _, transformed = _run_pass(tmp_path, "set: {components: {$c: {role: source, description: done}}}")
    assert [each for each in transformed.findings if each.rule == "wrong-pass"] == []
    assert transformed.architecture.components["g.a"].role == "source"
    file = tmp_path / "packed" / "made.yaml"
    file.parent.mkdir()
    file.write_text(pack(transformed), encoding="utf-8")
    assert [each for each in check_project(file).findings if str(each.severity) == "error"] == []


@pytest.mark.parametrize("name", ["a" * 65, "self", "Upper"])
def test_names_that_are_no_ids_are_refused(name: str, tmp_path: Path) -> None:
    port = "{find: {components: {g.a: {title: A}}}, add: {components: {g.a: {outputs: {%s: Pose}}}}}"
    component = "{find: {components: {g.a: {title: A}}}, add: {components: {g.%s: {title: B}}}}"
    for rule in (port, component):
        (line,) = said(ROBOT, f"- {rule % name}", tmp_path)
        assert f"`{name}` is no id" in line


def test_keys_that_come_to_nothing_are_refused(tmp_path: Path) -> None:
    rule = "- {find: {components: {g.a: {title: A}}}, let: {$x: snake('-')}, set: {components: {g.a: {properties: {$x: 1}}}}}"
    assert said(ROBOT, rule, tmp_path) == ["3: a key is empty"]


def test_all_that_names_a_type_is_bound_by_specialise(tmp_path: Path) -> None:
    data, findings = transform(
        "component_types:\n  filter:\n    generic: [T]\n"
        '    operations: {ask: {request: {past: "T[]"}, response: T}, get: T}\n'
        "groups: {g: {components: {a: {is: filter<Pose>}}}}\n"
        'types: {Pose: geometry_msgs/msg/Pose, Box: {generic: [T], fields: {x: "T[]", y: "T[<=3]", z: "Pair<T, A>"}},\n'
        "  Ask: {generic: [T], request: T, response: {x: T}}}\n",
        """
        - find: {components: {filter: {generic: [$n]}}}
          unless: {components: {made: }}
          let: {$made: "specialise(filter, $n=Pose)"}
          add: {components: {made: $made}}
        - find: {types: {$t: {generic: [$n]}}}
          let: {$new: "${t} of Pose", $made: "specialise($t, $n=Pose)"}
          unless: {types: {$new: }}
          add: {types: {$new: $made}}
        """,
        tmp_path,
    )
    assert findings == ()
    assert isinstance(types := data["types"], dict)
    assert types["Box of Pose"] == data_of(
        'fields: {x: {type: "Pose[]"}, y: {type: "Pose[<=3]"}, z: {type: "Pair<Pose, A>"}}'
    )
    assert types["Ask of Pose"] == data_of("{request: Pose, response: {x: {type: Pose}}}")
    assert isinstance(component_types := data["component_types"], dict)
    assert component_types["made"]["operations"] == data_of(
        '{ask: {request: {past: "Pose[]"}, response: Pose}, get: {response: Pose}}'
    )


def test_what_was_wrong_before_is_not_the_passs(tmp_path: Path) -> None:
    made_by = pass_of("- {find: {components: {$c: }}, drop: {components: {$c: }}}")
    before, after = tree_of(ROBOT, tmp_path), tree_of(ROBOT, tmp_path)
    component = ("groups", "g", "components", "a")
    for tree in (before, after):
        tree.set((*component, "role"), "nonsense", component)
    assert list(check_result(made_by, before.root, after.root)) == []
    after.set((*component, "status"), "nonsense", component)
    (found,) = check_result(made_by, before.root, after.root)
    assert found.message == "the pass `tried` writes what no file may hold: `status` cannot be `nonsense`"
    assert after.get_text((*component, "status")) == "nonsense"
