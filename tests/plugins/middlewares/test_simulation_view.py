"""The view `simulation`: classes, records, values, connections, and what is left out."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pytest

from archgen.pipeline import check_project
from archgen.plugins.middlewares.java_names import choose_java_spellings
from archgen.plugins.middlewares.simulation_view import make_view
from archgen.views.generation.generation_context import GenerationContext

PROJECT = """\
archgen: 1
project: {id: lab}
types:
  Heat: {fields: {value: {type: float64, default: 1.5, unit: K}, class: string, list: {type: "uint8[3]"}, more: {type: "Mode[<=4]"}, x: {type: int64, default: 7}}}
  Mode: {values: [IDLE, X]}
  Ask: {request: {why: string}, response: {ok: bool}}
  Text:
component_types:
  eye:
    functionality: Looks.
    inputs: {light: Text}
    outputs: {heat: Heat}
    parameters: {gain: {value: 2, type: float, range: [0, 5]}, words: {value: [a, b]}, none: {type: integer}, odd: {value: [1, a]}}
    timing: {rate: 3 Hz}
  head:
    functionality: Holds both.
    outputs: {heat: {from: left.heat}, spare: Text}
    components:
      left: {is: eye}
      judge: {functionality: Judges., inputs: {heat: [left.heat]}, outputs: {mode: Mode}}
groups:
  g:
    components:
      head: {is: head}
      other: {is: eye, parameters: {gain: 3.5, none: 4}, timing: {period: 10 ms}}
      brain: {functionality: Thinks., inputs: {any: [head.heat, lamp.mode], ask: desk.ask}, outputs: {}}
      lamp: {functionality: Shows., inputs: {}, outputs: {mode: Mode}}
      desk: {functionality: Answers., inputs: {}, outputs: {ask: Ask}}
      arm_1: {functionality: F, inputs: {}, outputs: {}}
      arm1: {functionality: F, inputs: {}, outputs: {}}
      sometimes: {functionality: F, inputs: {}, outputs: {o: Heat}, timing: {behaviour: periodic}}
"""


def view(folder: Path, text: str = PROJECT, **options: str) -> tuple[Mapping[str, Any], list[str]]:
    path = folder / "p.yaml"
    path.write_text(text, "utf-8")
    made = make_view(GenerationContext(check_project(path).architecture, options=options))
    return made.data, [each.message for each in made.findings]


def test_classes_assemblies_and_connections(tmp_path: Path) -> None:
    data, findings = view(tmp_path)
    assert {each["class_name"]: each["components"] for each in data["classes"]} == {
        "Eye": ["g.head.left", "g.other"],
        "HeadJudge": ["g.head.judge"],
        # What nobody inside of it carries yet.
        "HeadRest": ["g.head"],
        "Brain": ["g.brain"],
        "Lamp": ["g.lamp"],
        "Desk": ["g.desk"],
        "Arm1": ["g.arm_1"],
        "Sometimes": ["g.sometimes"],
    }
    assert [(each["class_name"], [part["java_name"] for part in each["parts"]]) for each in data["assemblies"]] == [
        ("GGroup", ["head", "other", "brain", "lamp", "desk", "arm1", "sometimes"]),
        ("Head", ["left", "judge", "rest"]),
    ]
    assert [(each["java_source"], each["python_reader"]) for each in data["assemblies"][0]["connections"]] == [
        ("head.left.heat", "brain.any"),
        ("lamp.mode", "brain.any"),
        ("desk.ask", "brain.ask"),
    ]
    assert data["connections"] == [
        "g.head.left.heat -> g.head.judge.heat",
        "g.head.left.heat -> g.brain.any",
        "g.lamp.mode -> g.brain.any",
        "g.desk.ask -> g.brain.ask",
    ]
    ports = {
        port["name"]: [each["java"] for each in port["types"]] for each in data["classes"] for port in each["inputs"]
    }
    assert ports == {"light": ["String"], "heat": ["Heat"], "any": ["Object"]}
    (desk,) = (each for each in data["classes"] if each["class_name"] == "Desk")
    assert [[each["java"] for each in port["types"]] for port in desk["servers"]] == [["AskRequest", "AskResponse"]]
    assert findings == [
        "`g.arm_1` and `g.arm1` give the same class `g.Arm1`",
        "the parameter `odd` of `g.head.left` is left out: it is no boolean, number of 64 bits, text, or list of one of these",
        "`g.sometimes` is periodic, and nobody says how often: in the simulation it is never active",
    ]


def test_records(tmp_path: Path) -> None:
    data, _ = view(tmp_path)
    records = {each["class_name"]: each for each in data["data"]}
    assert set(records) == {"Heat", "Mode", "AskRequest", "AskResponse"}
    assert [(each["java_name"], each["type"]["java"], each["default"]) for each in records["Heat"]["fields"]] == [
        ("value", "double", 1.5),
        ("class_", "String", None),
        ("list", "List<Long>", None),
        ("more", "List<Mode>", None),
        ("x", "long", 7),
    ]
    sizes = [(each["type"]["least"], each["type"]["most"]) for each in records["Heat"]["fields"]]
    assert sizes == [(0, None), (0, None), (3, 3), (0, 4), (0, None)]
    assert [(each["name"], each["value"]) for each in records["Mode"]["constants"]] == [("IDLE", 0), ("X", 1)]


def test_values_and_timing_of_each_instance(tmp_path: Path) -> None:
    data, _ = view(tmp_path)
    parts = {part["id"]: part for each in data["assemblies"] for part in each["parts"] if not part["is_assembly"]}
    found = {
        name: [(each["name"], each["java"], each["value"], each["is_given"]) for each in parts[name]["settings"]]
        for name in ("g.head.left", "g.other")
    }
    assert found == {
        "g.head.left": [
            ("gain", "double", 2.0, True),
            ("words", "List<String>", ["a", "b"], True),
            ("none", "Optional<Long>", None, False),
        ],
        "g.other": [
            ("gain", "double", 3.5, True),
            ("words", "List<String>", ["a", "b"], True),
            ("none", "Optional<Long>", 4, True),
        ],
    }
    timings = {name: (part["timing"]["mode"], part["timing"]["period_ns"]) for name, part in parts.items()}
    assert timings["g.head.left"] == ("periodic", 333333333)
    assert timings["g.other"] == ("periodic", 10_000_000)
    assert timings["g.brain"] == ("any", 0)
    assert timings["g.desk"] == ("never", 0)


def test_the_package_of_java(tmp_path: Path) -> None:
    assert view(tmp_path)[0]["java_package"] == "lab"
    assert view(tmp_path, package="org.example.new")[0]["java_package"] == "org.example.new_"
    assert view(tmp_path, PROJECT.replace("id: lab", "id: archgen"))[0]["java_package"] == "archgen_"
    for odd in ("Org.x", "a..b", "java.lang", "a; class X {}"):
        assert view(tmp_path, package=odd)[0]["java_package"] == "lab"


def test_classes_of_one_name_are_written_in_full() -> None:
    names = {"one": "a.b.Pose", "two": "a.c.Pose", "own": "a.d.Point", "text": "a.e.List", "plain": "a.f.Twist"}
    assert choose_java_spellings(names, "a.d", ["Robot"]) == {
        "one": "a.b.Pose",
        "two": "a.c.Pose",
        "own": "Point",
        "text": "a.e.List",
        "plain": "Twist",
    }


@pytest.mark.parametrize(("distro", "default"), [("jazzy", 1.0), ("noetic", None)])
def test_a_rotation_of_ros_2_begins_as_none(tmp_path: Path, distro: str, default: float | None) -> None:
    text = f"""
archgen: 1
ros: {{distro: {distro}}}
groups: {{g: {{components: {{a: {{outputs: {{turn: geometry_msgs/msg/Quaternion}}}}, b: {{inputs: {{turn: a.turn}}}}}}}}}}
"""
    data, _ = view(tmp_path, text)
    (record,) = [each for each in data["data"] if each["message"] == "geometry_msgs/msg/Quaternion"]
    assert {each["name"]: each["default"] for each in record["fields"]} == {
        "x": None,
        "y": None,
        "z": None,
        "w": default,
    }
