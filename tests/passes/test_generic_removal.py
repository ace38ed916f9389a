"""Generic types taken away: what names them, in selectors and operations too, names what was made for them."""

from __future__ import annotations

from pathlib import Path

import yaml

from archgen.pipeline import CheckedProject, check_project, transform_project
from tests.passes.same_meaning import pack, write_project

ROBOT = """\
component_types:
  filter:
    generic: [T]
    functionality: Smooths.
    inputs: {request: T}
    operations: {ask: {request: {past: "T[]", gain: float64}, response: T}, get: Box<T>}
groups: {g: {components: {a: {is: filter<Pose>, title: A}, b: {is: filter<Box<Pose>>}}}}
types: {Pose: geometry_msgs/msg/Pose, Box: {generic: [T], fields: {x: "T[]"}}}
"""


def test_selectors_name_the_types_that_were_made(tmp_path: Path) -> None:
    views = (
        "views: {v: 'is:filter+1 -tag:old', w: 'is:\"filter<Box<Pose>>\"', x: 'is:*ter', y: 'is:f*', z: 'type:Box<Pose>'}\n"
        "policies: {p: {forbid: {from: 'is:filter<Pose>', to: b}}}\n"
    )
    checked = write_project(tmp_path, ROBOT + views)
    transformed = transform_project(checked, ["remove_generics"])
    data = yaml.safe_load(pack(transformed))
    both = "is:filter_of_pose is:filter_of_box_of_pose"
    assert {name: view["show"] for name, view in data["views"].items()} == {
        "v": f"{both.replace(' ', '+1 ')}+1 -tag:old",
        "w": "is:filter_of_box_of_pose",
        "x": both,
        "y": "is:f*",
        "z": 'type:"Box of Pose"',
    }
    assert data["policies"]["p"]["forbid"] == {"from": "is:filter_of_pose", "to": "b"}
    selector_findings = [each.message for each in checked.findings if each.rule == "wrong-selector"]
    assert [each.message for each in transformed.findings if each.rule == "wrong-selector"] == selector_findings
    _read_again(transformed, tmp_path)


def test_operations_of_generic_types_are_bound_and_named_plainly(tmp_path: Path) -> None:
    checked = write_project(tmp_path, ROBOT)
    asked = checked.architecture.components["g.b"].operations["ask"]
    assert (asked.request, asked.response) == ({"past": "Box<Pose>[]", "gain": "float64"}, "Box<Pose>")
    assert checked.architecture.components["g.a"].operations["get"].response == "Box<Pose>"
    operations = transform_project(checked, ["remove_generics"]).architecture.components["g.b"].operations
    assert operations["ask"].request == {"past": "Box of Pose[]", "gain": "float64"}
    assert operations["get"].response == "Box of Box of Pose"


def test_names_of_types_that_are_no_ids_give_ids(tmp_path: Path) -> None:
    long_name = " ".join(["word"] * 20)
    checked = write_project(
        tmp_path,
        "component_types: {filter: {generic: [T], inputs: {q: T}}}\n"
        f"groups: {{g: {{components: {{a: {{is: filter<Höhe>}}, b: {{is: filter<{long_name} a>}}, c: {{is: filter<{long_name} b>}}}}}}}}\n"
        f"types: {{Höhe: std_msgs/msg/Float32, {long_name} a: std_msgs/msg/Int8, {long_name} b: std_msgs/msg/Int8}}\n",
    )
    transformed = transform_project(checked, ["remove_generics"])
    names = list(yaml.safe_load(pack(transformed))["component_types"])
    assert names[0] == "filter_of_hoehe"
    assert len(set(names)) == 3
    assert max(map(len, names)) <= 64
    _read_again(transformed, tmp_path)


def _read_again(transformed: CheckedProject, folder: Path) -> None:
    """Read what was made: nothing in it is wrong, and it packs the same. What is found once at a type is not asked for."""
    file = folder / "packed" / "made.yaml"
    file.parent.mkdir()
    file.write_text(pack(transformed), encoding="utf-8")
    again = check_project(file)
    assert [each for each in again.findings if str(each.severity) == "error"] == []
    assert pack(again) == pack(transformed)
