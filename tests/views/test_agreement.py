"""Agreements: which interfaces two partners have, what is said of each, and what changed."""

from __future__ import annotations

import itertools
import re
from pathlib import Path

import pytest

from archgen import pipeline, resources
from archgen.link.interface_sources import load_interfaces
from archgen.model.partner_interfaces import find_all_interfaces, find_interfaces_between
from archgen.products.outline_markdown import render_outline_markdown
from archgen.views.agreement.message_fields import field_table, list_field_rows
from archgen.views.agreement.partner_agreement import PartnerAgreement, make_agreement
from archgen.views.shapes import Outline, Table
from tests.agreeing import DUO, checked, lines, section, text, view
from tests.judged_projects import judge_ramcip


def made(folder: Path, first: str = "north", second: str = "south", source: str = DUO) -> PartnerAgreement:
    return make_agreement(view(checked(folder, source)), first, second, revision="r1")


def changed(folder: Path, *edits: tuple[str, str]) -> PartnerAgreement:
    after = DUO
    for old, new in edits:
        assert old in after
        after = after.replace(old, new)
    earlier = view(checked(folder / "before"))
    return make_agreement(view(checked(folder / "after", after)), "north", "south", earlier_revision=("v1", earlier))


def keys(folder: Path, first: str, second: str, source: str = DUO) -> list[tuple[str, str, str]]:
    return [
        (each.key, *each.pair) for each in find_interfaces_between(checked(folder, source).architecture, first, second)
    ]


def test_both_directions_those_of_the_first_partner_first(tmp_path: Path) -> None:
    given = ("moving.planner.plan", "north", "south")
    taken = [("seeing.camera.image", "south", "north"), ("seeing.finder.objects", "south", "north")]
    assert keys(tmp_path, "north", "south") == [given, *taken]
    assert keys(tmp_path, "south", "north") == [*taken, given]


USE_CASES = """use_cases:
  UC-1:
    title: Tidying up
    actors: {cook: The cook}
    steps:
      - {from: cook, to: cook, say: waits}
      - {from: camera, to: finder, say: shows the table}
      - {from: finder, to: planner, say: tells what lies there}
      - {from: finder, to: planner.plan, say: asks for a way}
      - {from: planner, to: arm, say: moves it}
  UC-2: {title: Moving, steps: [{from: planner, to: arm}]}
"""


def test_the_steps_of_use_cases_that_cross_from_one_to_the_other(tmp_path: Path) -> None:
    project = checked(tmp_path, DUO.replace("groups:\n", f"{USE_CASES}groups:\n", 1))
    (table,) = [
        block
        for block in section(make_agreement(view(project), "north", "south").outline, "Use cases").blocks
        if isinstance(block, Table)
    ]
    assert table.caption == "Steps of Tidying up"
    assert [[text(cell) for cell in row][:5] for row in table.rows] == [
        ["3", "Finder", "Planner", "tells what lies there", "Found objects, Plan on request"],
        ["4", "Finder", "Planner", "asks for a way", "Plan on request"],
    ]
    outline = make_agreement(view(checked(tmp_path)), "north", "south").outline
    assert "Use cases" not in {each.title for each in outline.sections}
    # West's node moves the arm.
    west = section(make_agreement(view(project), "west", "north").outline, "Use cases")
    assert [block.caption for block in west.blocks if isinstance(block, Table)] == [
        "Steps of Tidying up",
        "Steps of Moving",
    ]


def test_what_of_one_waits_for_what_of_the_other_at_the_start(tmp_path: Path) -> None:
    source = DUO.replace(
        "planner_node: {implements: planner,", "planner_node: {implements: planner, start: {ready: 2 s},"
    )
    table = section(made(tmp_path, source=source).outline, "Start-up").blocks[1]
    assert isinstance(table, Table)
    assert [[text(cell) for cell in row][:5] for row in table.rows] == [
        ["finder_node", "South Vision", "planner_node", "North Robotics", "2 s have passed"],
        ["calibration", "North Robotics", "camera_driver", "South Vision", "it is started"],
    ]
    assert [text(row[5]) for row in table.rows] == ["calls moving.planner.plan", "reads seeing.camera.image"]
    assert "Start-up" not in {each.title for each in made(tmp_path / "plain").outline.sections}


def test_the_partner_of_a_node_answers_too(tmp_path: Path) -> None:
    """West's node implements north's arm: what runs between arm and planner is between west and north."""
    assert keys(tmp_path, "west", "north") == [
        ("moving.arm.joints", "west", "north"),
        ("moving.planner.commands", "north", "west"),
    ]
    joints = section(made(tmp_path, "west", "north").outline, "Arm · joints")
    assert "West Wheels implements Arm with the node arm_node, and answers for this interface too." in lines(
        joints.blocks
    )


def test_what_belongs_to_both_at_both_ends_is_not_between_them(tmp_path: Path) -> None:
    assert "moving.calibration.offset" not in {key for key, _, _ in keys(tmp_path, "north", "south")}
    alone = DUO.replace("watch: {owner: [north, south]", "watch: {owner: south")
    assert ("moving.calibration.offset", "north", "south") in keys(tmp_path, "north", "south", alone)
    said = lines(section(made(tmp_path, source=alone).outline, "Calibration · offset").blocks)
    assert "Calibration belongs to North Robotics, South Vision together: each answers for this interface." in said


def test_a_node_of_two_partners_components_makes_neither_answer_for_the_other(tmp_path: Path) -> None:
    shared = DUO.replace("planner_node: {implements: planner,", "planner_node: {implements: [planner, finder],")
    shared = shared.replace("implements: finder\n", "implements: finder\n    owner: south\n")
    assert ("seeing.camera.image", "south", "north") in keys(tmp_path, "north", "south", shared)
    found = find_interfaces_between(checked(tmp_path, shared).architecture, "north", "south")
    assert [port.id for each in found if each.key == "seeing.camera.image" for port in each.inputs] == [
        "moving.calibration.image"
    ]


def test_topics_without_a_connection_are_interfaces_too(tmp_path: Path) -> None:
    nodes = "  north_frames: {owner: north, publishes: {tf: {topic: /tf, message: tf2_msgs/msg/TFMessage}}}\n"
    nodes += "  south_frames: {owner: south, subscribes: {tf: {topic: /tf, message: tf2_msgs/msg/TFMessage}}}\n"
    source = DUO.replace("hosts: {pc", f"{nodes}hosts: {{pc")
    assert ("/tf", "north", "south") in keys(tmp_path, "north", "south", source)
    said = lines(section(made(tmp_path, source=source).outline, "/tf").blocks)
    assert said[1:3] == ["Topic: /tf", "Message: tf2_msgs/msg/TFMessage"]
    assert not any("type of what flows" in line for line in said), "the message says it"
    assert "publishes | North Robotics | north_frames | default (not written)" in said


def test_a_physical_flow_needs_no_message(tmp_path: Path) -> None:
    source = DUO.replace(
        "outputs: {joints: Joint states}", "outputs: {joints: Joint states, grip: {type: Force, medium: physical}}"
    )
    source = source.replace(
        "inputs: {image: camera.image, planner", "inputs: {felt: moving.arm.grip, image: camera.image, planner"
    )
    source = source.replace(", owner: west", "")
    assert lines(section(made(tmp_path, source=source).outline, "Arm · grip").blocks)[1:] == [
        "Kind: physical: neither message nor topic",
        "Type: Force",
        "Requirements: R-1 The arm grasps what lies on the table (Finder)",
        "gives | North Robotics | Arm · grip",
        "takes | South Vision | Finder · felt",
    ]


@pytest.mark.parametrize("name", ["example_ramcip", "duo"])
def test_all_interfaces_are_those_of_each_pair(tmp_path: Path, name: str) -> None:
    architecture = (
        checked(tmp_path) if name == "duo" else pipeline.check_project(resources.resource_path(name))
    ).architecture
    pairs = itertools.combinations(sorted(architecture.partners), 2)
    of_pairs = [each for pair in pairs for each in find_interfaces_between(architecture, *pair)]
    assert list(find_all_interfaces(architecture)) == of_pairs != []


def test_every_connection_between_owners_is_in_their_agreement() -> None:
    found = view(judge_ramcip())
    architecture, partners = found.architecture, sorted(found.architecture.partners)
    agreed = {
        (each.key, port.id): each.pair
        for at, first in enumerate(partners)
        for second in partners[at + 1 :]
        for each in find_interfaces_between(architecture, first, second)
        for port in each.inputs
    }
    for edge in architecture.edges:
        giver = architecture.components[architecture.outputs[edge.output].component].owner
        taker = architecture.components[architecture.inputs[edge.input].component].owner
        assert agreed.pop((edge.output, edge.input), None) == (None if giver == taker else (giver, taker))
    assert agreed == {}


def test_what_an_interface_says(tmp_path: Path) -> None:
    said = lines(section(made(tmp_path).outline, "Finder · objects").blocks)
    assert re.fullmatch("Version: [0-9a-f]{6}", said[0])
    assert said[1:] == [
        "Topic: /objects",
        "Type: Found objects",
        "Message: geometry_msgs/msg/PoseArray",
        "When late or missing: nothing is promised for this case",
        "Time stamps: nothing is said of whether header.stamp is of measuring or of sending",
        "Clock: The clock of Pc, on which both sides run.",
        "After power-up: nothing is said of it",
        "Duties of readers: nothing is said of it",
        "Requirements: R-1 The arm grasps what lies on the table (Finder, Planner)",
        "Rate | nothing | 30 Hz · 33.333 ms, event-driven, follows from the rate of camera_driver",
        "Largest gap | nothing | 56.334 ms, follows from when finder_node is activated and how long it takes",
        "Size | 12 kB | ",
        "Traffic | nothing | 360 kB/s, follows from rate and size",
        "QoS offered | default: reliable, depth 10 | ",
        "publishes | South Vision | Finder · objects | finder_node\non Pc | default: reliable, depth 10",
        "reads | North Robotics | Planner · objects | planner_node\non Pc | default (not written)",
        "header | std_msgs/msg/Header",
        "header.stamp | builtin_interfaces/msg/Time",
        "header.frame_id | string",
        "poses | geometry_msgs/msg/Pose[]",
        "poses[].position | geometry_msgs/msg/Point",
        "poses[].orientation | geometry_msgs/msg/Quaternion",
        "See And Move | 300 ms | 66.334 ms | met",
    ]


def test_a_service_runs_from_its_server_and_says_how_soon_it_answers(tmp_path: Path) -> None:
    found = made(tmp_path)
    said = lines(section(found.outline, "Planner · plan").blocks)
    assert said[1:4] == [
        "Service: /moving/planner/plan",
        "Type: Plan on request",
        "Message: example_interfaces/srv/Trigger",
    ]
    assert "Answers within | nothing | 10 ms, follows from the load of its host" in said
    assert "Open points: The fields of the message are not stated here: its definition is not at hand." in said
    assert not any(line.startswith("See And Move") for line in said), "the chain goes by the topic"
    arrow = next(each for each in found.graph.arrows if each.style == "service")
    assert (arrow.tail, arrow.head) == ("seeing.finder", ">moving.planner"), "drawn from client to server"


def test_the_fields_of_a_service_and_those_that_are_used_again(tmp_path: Path) -> None:
    source = DUO.replace("example_interfaces/srv/Trigger", "std_srvs/srv/SetBool").replace(
        "ros: {distro: jazzy}",
        'ros: {distro: jazzy, definitions: {std_srvs/srv/SetBool: "bool data\\n---\\nbool success\\nstring message"}}',
    )
    source = source.replace(
        "Found objects: {message: geometry_msgs/msg/PoseArray", "Found objects: {message: sensor_msgs/msg/Image"
    )
    outline = made(tmp_path, source=source).outline
    said = lines(section(outline, "Planner · plan").blocks)
    assert said[-3:] == ["request | data | bool", "answer | success | bool", "answer | message | string"]
    again = lines(section(outline, "Finder · objects").blocks)
    assert "The fields of sensor_msgs/msg/Image stand at the first interface that carries it." in again


def test_open_points(tmp_path: Path) -> None:
    source = DUO.replace("qos: {reliability: reliable}}}", "qos: {reliability: best_effort}}}")
    source = source.replace(
        "trigger: [objects]}, host: pc}",
        "trigger: [objects]}, host: pc, subscribes: {objects: {qos: {reliability: reliable}}}}",
    )
    outline = made(tmp_path, source=source).outline
    clash = "planner_node asks for reliable delivery, and finder_node offers best effort only: nothing arrives."
    assert f"Open points: {clash}" in lines(section(outline, "Finder · objects").blocks)
    points = lines(section(outline, "Open points").blocks)
    no_definition = "The fields of the message are not stated here: its definition is not at hand."
    assert points == [f"Planner · plan | {no_definition}", f"Finder · objects | {clash}"]
    assert [text(row[-1]) for row in _table(outline, "At a glance").rows] == [
        "definition of the message",
        "",
        "1 contradiction",
    ]


def test_what_is_open_at_many_interfaces_is_one_row_behind_the_others(tmp_path: Path) -> None:
    source = DUO.replace(", qos: sensor_data", "").replace(", qos: {reliability: reliable}", "")
    names = ("info", "calibration", "depth", "grey")
    outputs = ", ".join(f"{name}: sensor_msgs/msg/CameraInfo" for name in names)
    inputs = ", ".join(f"{name}: camera.{name}" for name in names)
    source = source.replace("info: sensor_msgs/msg/CameraInfo", outputs).replace(
        "joints: arm.joints}", f"joints: arm.joints, {inputs}}}"
    )
    records = made(tmp_path, source=source).outline
    rows = [[text(cell) for cell in row] for row in _table(records, "Open points").rows]
    (shared,) = [row for row in rows if row[1] == "The size of a message is not known."]
    assert re.match(r"\d of \d interfaces\nCamera · info, Camera · calibration, ", shared[0])
    assert shared in rows[-2:]
    assert sum("The size of a message" in row[1] for row in rows) == 1
    assert rows[0][0] == "Planner · plan"


def test_the_project_s_own_business_is_no_part_of_an_agreement(tmp_path: Path) -> None:
    """Findings (a requirement that nobody declared, an output that nobody reads) concern neither of the two."""
    source = DUO.replace(
        "        requirements: [R-1]\n        inputs: {objects", "        requirements: [R-9]\n        inputs: {objects"
    )
    assert source != DUO
    project = checked(tmp_path, source)
    assert {finding.rule for finding in project.findings} >= {"unknown-requirement", "unread-output"}
    agreement = make_agreement(view(project), "north", "south", revision="r1")
    words = render_outline_markdown(agreement.outline, (agreement.graph,))
    for rule in ("unknown-requirement", "unread-output", "archgen.yaml", "warning", "finding"):
        assert rule not in words


def test_the_document_has_partners_and_a_place_to_sign(tmp_path: Path) -> None:
    outline = made(tmp_path).outline
    assert (outline.title, outline.subtitle) == ("North Robotics and South Vision", "Interface agreement")
    facts = {name: text(value) for name, value in outline.facts}
    assert facts == {
        "Between": "North Robotics, ada@north.example\nSouth Vision",
        "Project": "Duo Arm",
        "Project version": "0.3",
        "Revision": "r1",
        "ROS distribution": "jazzy",
    }
    signed = lines(section(outline, "Signatures").blocks)
    assert signed[0] == "The partners agree on the interfaces of Duo Arm as this document states them, at revision r1."
    assert [line.split(" | ")[0] for line in signed[1:]] == ["North Robotics", "South Vision"]


EYES = """\
archgen: 1
partners: {north: North, south: South}
component_types: {eye: {components: {finder: {outputs: {places: std_msgs/msg/Empty}}}, outputs: {places: {from: finder.places}}}}
groups:
  seeing: {owner: south, components: {left: {is: eye}, right: {is: eye}}}
  moving: {owner: north, components: {arm: {inputs: {places: [left.places, right.places]}}}}
nodes: {arm: arm, left: left.finder, right: right.finder}
"""


def test_what_stands_in_two_instances_is_told_by_them(tmp_path: Path) -> None:
    agreement = made(tmp_path, source=EYES)
    titles = [each.title for each in section(agreement.outline, "From South to North").sections]
    assert titles == ["Left · Finder · places", "Right · Finder · places"]
    ends = lines(section(agreement.outline, "Left · Finder · places").blocks)
    assert "publishes | South | Left · Finder · places | left | default (not written)" in ends
    assert {(box.title, box.lines) for box in agreement.graph.boxes} == {
        ("Finder", ("Seeing · Left",)),
        ("Finder", ("Seeing · Right",)),
        ("Arm", ("North",)),
    }


def test_nothing_changed(tmp_path: Path) -> None:
    moved = DUO.replace("  seeing:\n    owner: south\n", "  seeing: # moved\n\n    owner: south\n")
    assert moved != DUO
    found = make_agreement(
        view(checked(tmp_path / "b", moved)), "north", "south", earlier_revision=("v1", view(checked(tmp_path / "a")))
    )
    assert found.changes is not None
    assert not found.changes.has_changes
    assert text(found.outline.notices[0].inlines) == "Nothing between the two has changed since v1."


def test_what_changed_stands_side_by_side(tmp_path: Path) -> None:
    found = changed(tmp_path, ("rate: 30 Hz", "rate: 25 Hz"), ("deadline: 300 ms", "deadline: 60 ms"))
    said = lines(section(found.outline, "Finder · objects").blocks)
    assert said[:4] == [
        "Rate (expected) | ~ changed | 30 Hz · 33.333 ms, event-driven | 25 Hz · 40 ms, event-driven",
        "Largest gap (expected) | ~ changed | 56.334 ms | 63 ms",
        "Traffic (expected) | ~ changed | 360 kB/s | 300 kB/s",
        "Deadline of See And Move | ~ changed | 300 ms | 60 ms, missed",
    ]
    assert said[4] == "Chain See And Move (expected) | ~ changed | 66.334 ms; met | 73 ms; missed"
    log = _table(found.outline, "Changes since v1")
    assert [text(row[1]) for row in log.rows] == [
        "~ changed: rate, largest gap, traffic",
        "~ changed: rate, largest gap, traffic, chains",
    ]
    camera_step, objects_step = (text(row[2]) for row in log.rows)
    assert re.fullmatch("[0-9a-f]{6} → [0-9a-f]{6}", camera_step), "its rate is promised"
    assert objects_step.endswith(", as before"), "that its rate follows from the camera's nobody promises"


def test_added_and_removed(tmp_path: Path) -> None:
    found = changed(
        tmp_path,
        (", planner: moving.planner.plan", ""),
        ("{image: camera.image}, outputs: {offset", "{info: camera.info}, outputs: {offset"),
    )
    log = _table(found.outline, "Changes since v1")
    assert [(text(row[0]), text(row[1])) for row in log.rows] == [
        ("Camera · info", "+ added"),
        ("Finder · objects", "~ changed: chains"),
        ("Planner · plan", "\u2212 removed"),
        ("Camera · image", "\u2212 removed"),
    ]
    assert text(found.outline.notices[0].inlines) == "Interfaces since v1: 1 added, 1 changed, 2 removed."
    gone = section(found.outline, "Removed").sections[0]
    assert lines(gone.blocks)[0] == "\u2212 removed"
    assert lines(gone.blocks)[2] == "Service: /moving/planner/plan"
    assert {run.change for row in log.rows for run in row[1]} >= {"added", "removed"}


def test_a_new_name_on_the_same_topic_is_a_change(tmp_path: Path) -> None:
    found = changed(
        tmp_path,
        ("finder:\n", "searcher:\n"),
        ("finder.objects", "searcher.objects"),
        ("implements: finder", "implements: searcher"),
        ("through: [camera, finder", "through: [camera, searcher"),
    )
    assert found.changes is not None
    assert (found.changes.added_keys, found.changes.removed_records) == (frozenset(), ())
    assert "Title | ~ changed | Finder · objects | Searcher · objects" in lines(
        section(found.outline, "Searcher · objects").blocks
    )


def test_a_reader_more_and_a_field_less(tmp_path: Path) -> None:
    found = changed(
        tmp_path,
        ("inputs: {offset: calibration.offset}", "inputs: {offset: calibration.offset, image: camera.image}"),
        ("Colour image: {message: sensor_msgs/msg/Image", "Colour image: {message: sensor_msgs/msg/CompressedImage"),
    )
    said = lines(section(found.outline, "Camera · image").blocks)
    assert "Watch · image | + added |  | reads; North Robotics, South Vision" in said
    assert "Field width | \u2212 removed | uint32 | " in said
    assert "Field format | + added |  | string" in said


def _table(outline: Outline, title: str) -> Table:
    table = section(outline, title).blocks[0]
    assert isinstance(table, Table)
    return table


@pytest.mark.parametrize(("first", "second"), [("certh", "sssa"), ("accrea", "tum"), ("forth", "certh")])
def test_the_case_study_s_pictures_account_for_all_that_flows(first: str, second: str) -> None:
    found = view(judge_ramcip())
    made_of = make_agreement(found, first, second)
    assert made_of.graph.asked == sum(arrow.count for arrow in made_of.graph.arrows)
    assert {box.id for box in made_of.graph.boxes} >= {end for a in made_of.graph.arrows for end in (a.tail, a.head)}
    listed = [each for each in made_of.outline.sections if each.anchor.startswith("way:")]
    assert sum(len(each.sections) for each in listed) == made_of.interface_count > 0


def test_what_fields_and_constants_mean_is_a_part_of_the_agreement() -> None:
    rows = list_field_rows(
        load_interfaces(
            "jazzy",
            [
                ("m/own_msgs/srv/Measure.srv", "# In radians.\nfloat64 angle 0.5\n---\nState state\n"),
                ("m/own_msgs/msg/State.msg", "uint8 LOST=0  # nothing was seen\nuint8 what\n"),
            ],
            {},
        )[0],
        "own_msgs/srv/Measure",
    )
    assert rows is not None
    assert [f"{row.path}: {row.terms}" for row in rows] == [
        "request.angle: float64 = 0.5: In radians.",
        "answer.state: own_msgs/msg/State",
        "answer.state.what: uint8",
        "answer.state.LOST: uint8 = 0: nothing was seen",
    ]
    table = field_table("own_msgs/srv/Measure", rows)
    assert [column.title for column in table.columns] == ["Part", "Field", "Type", "Meaning"]
    assert [" | ".join("".join(run.text for run in cell) for cell in row) for row in table.rows] == [
        "request | angle | float64 = 0.5 | In radians.",
        "answer | state | own_msgs/msg/State | ",
        "answer | state.what | uint8 | ",
        "answer | state.LOST | uint8 = 0 | nothing was seen",
    ]


def test_requirements_that_only_a_chain_serves_are_behind_its_interfaces(tmp_path: Path) -> None:
    source = DUO.replace("requirements: [R-1]}}", "requirements: [R-1, R-7]}}")
    source = source.replace("on the table}", "on the table, R-7: Quick}")
    assert source.count("R-7") == 2
    said = {
        title: [line for line in lines(section(made(tmp_path, source=source).outline, title).blocks) if "R-7" in line]
        for title in ("Finder · objects", "Planner · plan")
    }
    (line,) = said["Finder · objects"]
    assert line.splitlines() == [
        "Requirements: R-1 The arm grasps what lies on the table (Finder, Planner)",
        "R-7 Quick (the chain See And Move)",
    ]
    assert said["Planner · plan"] == []
