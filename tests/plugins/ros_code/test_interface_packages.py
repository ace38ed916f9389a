"""The view `interfaces`: packages in order, spellings of both generations of ROS, and what nobody can generate."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pytest

from archgen.findings.rule_pages import read_rule_page
from archgen.model.known_interfaces import Interface, InterfaceConstant, InterfaceField
from archgen.pipeline import check_project
from archgen.plugins.ros_code.interface_packages import (
    list_missing_words,
    list_used_packages,
    make_view,
    record_definition,
)
from archgen.plugins.ros_code.package_facts import record_package_facts
from archgen.views.generation.architecture_needs import GENERATION_RULES, find_unmet_needs
from archgen.views.generation.generation_context import GeneratedView, GenerationContext

PORTS = (
    "groups: {g: {components: {a: {functionality: A., outputs: {o: %s}}, b: {functionality: B., inputs: {i: a.o}}}}}\n"
)


def context(tmp_path: Path, text: str, **options: Any) -> GenerationContext:  # noqa: ANN401 - of the context
    path = tmp_path / "p.yaml"
    path.write_text(f"archgen: 1\nproject: {{id: bot, title: Bot}}\n{text}")
    return GenerationContext(check_project(path).architecture, **options)


def spelled(view: GeneratedView) -> Mapping[str, list[str]]:
    return {
        f"{file['package']}/{file['path']}": [
            f"{field['spelling']} {field['name']} {field['default']} # {field['comment']}".strip(" #")
            for part in file["parts"]
            for field in part["fields"]
        ]
        for file in view.data["files"]
    }


TYPES = """\
types:
  Outer: {message: a_msgs/msg/Outer, fields: {inner: Inner, stamp: time, modes: "Mode[]", at: geometry_msgs/Pose}}
  Inner: {message: b_msgs/msg/Inner, fields: {x: {type: float64, unit: m, comment: "how\\nfar"}, n: "int32[3]"}}
  Mode: {message: c_msgs/msg/Mode, values: [IDLE, RUN]}
  Go: {request: {where: Outer}, response: {ok: bool}}
  Trip: {request: Outer, response: {ok: bool}, feedback: {left: float32}}
"""


@pytest.mark.parametrize("distro", ["jazzy", "noetic"])
def test_packages_stand_behind_those_that_they_use(tmp_path: Path, distro: str) -> None:
    view = make_view(context(tmp_path, f"ros: {{distro: {distro}}}\n{TYPES}{PORTS % 'Outer'}"))
    assert view.findings == ()
    assert [(each["name"], each["own_dependencies"]) for each in view.data["packages"]] == [
        ("b_msgs", []),
        ("c_msgs", []),
        ("a_msgs", ["b_msgs", "c_msgs"]),
        ("bot_msgs", ["a_msgs", "b_msgs", "c_msgs"]),
    ]
    times = ["builtin_interfaces"] if distro == "jazzy" else []
    assert view.data["packages"][2]["dependencies"] == ["b_msgs", *times, "c_msgs", "geometry_msgs"]


def test_a_circle_of_packages_is_told(tmp_path: Path) -> None:
    types = TYPES.replace("c_msgs/msg/Mode", "bot_msgs/msg/Mode")
    view = make_view(context(tmp_path, types + PORTS % "Outer"))
    assert [found.message for found in view.findings] == [
        "the packages `a_msgs` and `bot_msgs` hold messages of each other, so that none can be built first: they are not generated"
    ]
    assert [each["name"] for each in view.data["packages"]] == ["b_msgs"]


def test_both_spellings(tmp_path: Path) -> None:
    bounded = (
        "types: {T: {fields: {s: {type: 'string<=5', default: x}, l: 'int8[<=3]', t: time, d: 'duration[]'}}}\n"
        + PORTS % "T"
    )
    assert spelled(make_view(context(tmp_path, bounded))) == {
        "bot_msgs/msg/T.msg": [
            'string<=5 s "x"',
            "int8[<=3] l",
            "builtin_interfaces/Time t",
            "builtin_interfaces/Duration[] d",
        ]
    }
    assert spelled(make_view(context(tmp_path, bounded, options={"ros": "1"}))) == {
        "bot_msgs/msg/T.msg": [
            'string s  # at most 5 characters; "x" unless set',
            "int8[] l  # at most 3 of them",
            "time t",
            "duration[] d",
        ]
    }
    packages = make_view(context(tmp_path, bounded, options={"ros": "1"})).data["packages"]
    assert [package["dependencies"] for package in packages] == [[]]


def test_comments_say_unit_and_meaning(tmp_path: Path) -> None:
    files = spelled(make_view(context(tmp_path, TYPES + PORTS % "Outer")))
    assert files["b_msgs/msg/Inner.msg"] == ["float64 x  # [m] how far", "int32[3] n"]
    assert files["bot_msgs/action/Trip.action"][-1] == "float32 left"


def test_what_nobody_can_generate_leaves_the_rest(tmp_path: Path) -> None:
    types = "types: {Known: {fields: {x: int8}}, Told: {comment: nothing more}}\n"
    ports = "groups: {g: {components: {a: {functionality: A., outputs: {o: Known, p: Told, q: Never}}}}}\n"
    view = make_view(context(tmp_path, types + ports))
    assert [(str(found.span), found.element, found.message) for found in view.findings] == [
        ("p.yaml:3:37", "Told", "nobody can generate the type `Told`: it has no message and no fields"),
        ("p.yaml:4:79", "Never", "nobody can generate the type `Never`: it has no message and no fields"),
    ]
    assert list(spelled(view)) == ["bot_msgs/msg/Known.msg"]


def test_a_message_that_holds_what_cannot_be_written_goes_too(tmp_path: Path) -> None:
    types = "types: {A: {fields: {b: B}}, B: {fields: {w: wstring}}, C: {fields: {x: int8}}}\n"
    view = make_view(context(tmp_path, types + PORTS % "A", options={"ros": "1"}))
    assert [found.message for found in view.findings] == [
        "`bot_msgs/msg/B` is not generated: ROS 1 has no `wstring`, which `w` is",
        "`bot_msgs/msg/A` is not generated: `bot_msgs/msg/B`, which it holds, is left out",
    ]
    assert list(spelled(view)) == ["bot_msgs/msg/C.msg"]


def test_words_of_languages_are_no_names(tmp_path: Path) -> None:
    types = "types: {None: {message: m/msg/None, fields: {x: int8}}, A: {fields: {namespace: int8}}, B: {fields: {lambda: int8}}, C: {fields: {x: int8}}}\n"
    view = make_view(context(tmp_path, types + PORTS % "A"))
    assert [found.message for found in view.findings] == [
        "`bot_msgs/msg/A` is not generated: its field `namespace` is a word of C++",
        "`bot_msgs/msg/B` is not generated: its field `lambda` is a word of Python",
        "`m/msg/None` is not generated: its name is a word of Python",
    ]
    assert list(spelled(view)) == ["bot_msgs/msg/C.msg"]


def test_a_package_that_exists_is_left_alone(tmp_path: Path) -> None:
    types = "types: {A: {message: x_msgs/msg/A, status: existing, fields: {x: int8}}, B: {message: x_msgs/msg/B, fields: {x: int8}}}\n"
    view = make_view(context(tmp_path, types + PORTS % "A"))
    assert view.data["packages"] == []
    assert [found.message for found in view.findings] == [
        "`x_msgs/msg/B` is not generated: the package `x_msgs` exists already"
    ]


def test_a_part_gets_whole_packages(tmp_path: Path) -> None:
    types = "types: {A: {message: a_msgs/msg/A, fields: {b: B}}, A2: {message: a_msgs/msg/A2, fields: {x: int8}}, B: {message: b_msgs/msg/B, fields: {x: int8}}, C: {message: c_msgs/msg/C, fields: {x: int8}}}\n"
    ports = "groups: {g: {components: {a: {functionality: A., outputs: {o: A}}, c: {functionality: C., outputs: {o: C}}}}}\n"
    part = context(tmp_path, types + ports, components=frozenset({"g.a"}), nodes=frozenset())
    assert sorted(spelled(make_view(part))) == ["a_msgs/msg/A.msg", "a_msgs/msg/A2.msg", "b_msgs/msg/B.msg"]


def test_a_host_gets_what_its_nodes_use(tmp_path: Path) -> None:
    types = "types: {A: {message: a_msgs/msg/A, fields: {x: int8}}, C: {message: c_msgs/msg/C, fields: {x: int8}}}\n"
    ports = "groups: {g: {components: {a: {functionality: A., outputs: {o: A}}, c: {functionality: C., outputs: {o: C}}}}}\n"
    nodes = "hosts: {pc: {}, arm: {}}\nnodes: {a: {implements: a, host: pc}, c: {implements: c, host: arm}}\n"
    part = context(tmp_path, types + ports + nodes, host="arm")
    assert list(part.wanted_nodes) == ["c"]
    assert list(part.wanted_components) == ["g.c"]
    assert list(spelled(make_view(part))) == ["c_msgs/msg/C.msg"]


def test_generic_types_are_made_plain(tmp_path: Path) -> None:
    types = "types: {Pose: geometry_msgs/Pose, Envelope: {generic: [T], fields: {sender: string, payload: T}}}\n"
    view = make_view(context(tmp_path, types + PORTS % "'Envelope<Pose>'"))
    assert spelled(view) == {"bot_msgs/msg/EnvelopePose.msg": ["string sender", "geometry_msgs/Pose payload"]}
    assert view.findings == ()


def test_constants_of_both_generations() -> None:
    constant = InterfaceConstant("NAME", "string", '"a # b"', "why")
    definition = Interface("p/msg/M", ((),), ((constant,),), "what\nit is")
    for ros, value, comment, remark in ((1, "a # b", "", "why"), (2, '"a # b"', "why", "")):
        record: Any = record_definition(definition, None, ros)
        assert record["parts"][0]["constants"] == [
            {"name": "NAME", "type": "string", "value": value, "comment": comment, "remark": remark}
        ]
        assert (record["comment"], record["place"]) == ("what\nit is", "")
    assert list_used_packages([definition], "p", 2) == []
    unknown = Interface("p/msg/M", ((InterfaceField("x", "Strange"),),))
    assert list(list_missing_words(unknown, 2)) == ["nobody says what `Strange` is, which `x` holds"]


def test_facts_of_packages(tmp_path: Path) -> None:
    plain = record_package_facts(context(tmp_path, ""))
    assert plain == {
        "version": "0.0.0",
        "title": "Bot",
        "maintainer": "Bot",
        "maintainer_email": "todo@todo.todo",
        "license": "TODO: License declaration",
    }
    partners = "partners: {x: {title: X Ltd., contact: 'Ann <ann@x.example>'}}\n"
    facts = record_package_facts(context(tmp_path, partners, options={"license": "MIT"}))
    assert (facts["maintainer"], facts["maintainer_email"], facts["license"]) == ("X Ltd.", "ann@x.example", "MIT")


def test_the_examples_of_the_rules(tmp_path: Path) -> None:
    for rule in GENERATION_RULES:
        page = read_rule_page(rule)
        found = []
        for number, example in enumerate((page.bad, page.good)):
            (tmp_path / str(number)).mkdir(exist_ok=True)
            made = context(tmp_path / str(number), example)
            found.append([*make_view(made).findings, *find_unmet_needs(made, ("one_source",))])
        assert [[each.rule for each in findings] for findings in found] == [[rule.name], []]
