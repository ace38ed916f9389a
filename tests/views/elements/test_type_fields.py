"""Fields of types are shown in the project's words, and their messages in those of ROS."""

from __future__ import annotations

import pytest

from archgen import pipeline
from archgen.views.elements import type_fields
from archgen.views.elements.element_card import make_card
from archgen.views.lookup import Lookup, make_lookup
from archgen.views.pages.message_pages import MessagePages
from archgen.views.records.resolved_record import make_record, write_record
from archgen.views.search import make_message_entries
from archgen.views.shapes import Facts, Table
from archgen.views.tables import functional_tables

ROBOT = """\
archgen: 1
project: {id: robot}
ros: {distro: jazzy}
groups: {g: {components: {a: {outputs: {pose: Robot pose, mode: Mode, box: Box<Mode>, fetch: Fetch}}}}}
types:
  Robot pose:
    fields:
      place: "Place[]"
      point: geometry_msgs/Point
      heading: {type: float64, default: 0.5, unit: rad, comment: Left is positive.}
      corners: {type: "int8[2]", default: [1, 2]}
    constants: {MAX: {type: uint8, value: 32, comment: All.}}
  Place: {fields: {x: float64}}
  Mode: {values: [IDLE, RUN]}
  Box: {generic: [T], fields: {content: T}}
  Fetch: {request: {what: string}, response: {found: bool}, feedback: {share: float32}}
"""


@pytest.fixture(scope="module")
def lookup(tmp_path_factory: pytest.TempPathFactory) -> Lookup:
    file = tmp_path_factory.mktemp("robot") / "robot.yaml"
    file.write_text(ROBOT, encoding="utf-8")
    return make_lookup(pipeline.check_project(file).architecture)


def plain(cells: object) -> list[list[str]]:
    return [["".join(part.text for part in cell) for cell in row] for row in cells]  # type: ignore[attr-defined]


def test_fields_and_constants_as_tables(lookup: Lookup) -> None:
    architecture = lookup.architecture
    fields, constants = type_fields.make_field_tables(architecture, architecture.types["Robot pose"])
    assert [column.title for column in fields.columns] == ["Field", "Type", "Default", "Unit", "Meaning"]
    assert plain(fields.rows) == [
        ["place", "Place[]", "", "", ""],
        ["point", "geometry_msgs/msg/Point", "", "", ""],
        ["heading", "float64", "0.5", "rad", "Left is positive."],
        ["corners", "int8[2]", "[1, 2]", "", ""],
    ]
    assert [part.ref for part in fields.rows[0][1]] == ["type:Place", None]
    assert plain(constants.rows) == [["MAX", "32", "uint8", "All."]]
    parts = list(type_fields.make_field_tables(architecture, architecture.types["Fetch"]))
    assert [part.caption for part in parts] == ["Request: fields", "Answer: fields", "Feedback: fields"]


def test_cards_and_lists(lookup: Lookup) -> None:
    card = make_card(lookup, "type", "Robot pose")
    assert dict(card.lists)["fields"] == (
        "place: Place[]",
        "point: geometry_msgs/Point",
        "heading: float64 = 0.5 [rad] Left is positive.",
        "corners: int8[2] = [1, 2]",
        "MAX: uint8 = 32 All.",
    )
    assert dict(make_card(lookup, "type", "Mode").facts)["values"] == "IDLE, RUN"
    assert dict(make_card(lookup, "type", "Fetch").lists)["fields"][0] == "request.what: string"
    types = lookup.architecture.types
    assert [functional_tables.describe_mapping(types[name]) for name in ("Mode", "Box", "Box<Mode>")] == [
        "one of IDLE, RUN",
        "generic in T",
        "",
    ]


def test_sizes_follow_from_fields(lookup: Lookup) -> None:
    types = lookup.architecture.types
    assert [lookup.format_size(types[name]) for name in ("Mode", "Box<Mode>", "Place", "Robot pose")] == [
        *("5 B (computed)", "5 B (computed)", "12 B (computed)", ""),
    ]


def test_message_pages_and_search_know_them(lookup: Lookup) -> None:
    pages = MessagePages(lookup, lookup.architecture.types.values(), ())
    page = next(page for page in pages.make_pages() if page.anchor == "message:robot_msgs/msg/RobotPose")
    facts = next(block for block in page.section.blocks if isinstance(block, Facts))
    assert "".join(part.text for part in dict(facts.rows)["Definition"]) == "by the fields of the type Robot pose"
    tables = [block for block in page.section.blocks if isinstance(block, Table)]
    assert plain(tables[0].rows)[0][:2] == ["place", "robot_msgs/msg/Place[]"]
    titles = {entry.title for entry in make_message_entries(lookup)}
    assert {"robot_msgs/msg/RobotPose", "RobotPose · heading", "Mode · RUN"} <= titles


def test_the_record_has_both_words(lookup: Lookup) -> None:
    types = make_record(lookup)["types"]
    assert isinstance(types, dict)
    assert types["Robot pose"]["fields"][0] == {
        "name": "place",
        "type": "Place[]",
        "ros_type": "robot_msgs/msg/Place[]",
    }
    assert types["Fetch"]["part_fields"]["request"] == [{"name": "what", "type": "string", "ros_type": "string"}]
    assert (types["Mode"]["values"], types["Box"]["generic"]) == (["IDLE", "RUN"], ["T"])
    assert write_record("type", lookup.architecture.types["Box"], lookup) == {
        "generic": ["T"],
        "fields": [{"name": "content", "type": "T"}],
    }
