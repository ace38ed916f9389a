"""Cards: what `archgen show` tells of an element of each kind."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen.pipeline import check_project
from archgen.views.elements.annotation_facts import ElementCard, drop_empty_lists, format_fact, known_facts
from archgen.views.elements.element_card import (
    make_component_card,
    make_generic_card,
    make_group_card,
    make_node_card,
    make_port_card,
    make_topic_card,
    make_use_case_card,
)
from archgen.views.lookup import Lookup, make_lookup

ROBOT = """\
archgen: 1
partners: {lab: {title: Laboratory, contact: a@b.c}}
groups:
  g:
    title: Group
    owner: lab
    components:
      cam: {title: Camera, role: source, outputs: {image: {type: sensor_msgs/msg/Image, deprecated: {until: 2030-01-01}}}}
      look: {inputs: {image: cam.image, order: {type: std_msgs/msg/String, external: A guest}}}
nodes: {n: {implements: cam, package: p, executable: e, host: pc}}
hosts: {pc: {cores: 4}}
use_cases: {fetch: {title: Fetch, actors: {user: A user}}}
"""


@pytest.fixture
def lookup(tmp_path: Path) -> Lookup:
    """Look up the elements of the robot."""
    (tmp_path / "archgen.yaml").write_text(ROBOT, encoding="utf-8")
    checked_project = check_project(tmp_path)
    assert not checked_project.has_errors, checked_project.findings
    return make_lookup(checked_project.architecture, checked_project.findings)


def told(card: ElementCard) -> dict[str, object]:
    """Return the facts and lists of a card by name."""
    return {"title": card.title, **dict(card.facts), **dict(card.lists)}


def test_a_value_stands_on_one_line() -> None:
    assert [format_fact(each) for each in (None, ("a", 2), "two\n  lines", 3)] == ["", "a, 2", "two lines", "3"]


def test_what_says_nothing_is_left_out() -> None:
    assert known_facts([("owner", "lab"), ("tags", "")]) == (("owner", "lab"),)
    assert list(drop_empty_lists(("steps", ()), ("nodes", ("n",)))) == [("nodes", ("n",))]


def test_a_group_names_its_components(lookup: Lookup) -> None:
    card = told(make_group_card(lookup, lookup.architecture.groups["g"]))
    assert card == {"title": "Group", "owner": "lab", "components": ("cam: Camera", "look: Look")}


def test_a_component_tells_who_reads_it_and_what_runs_it(lookup: Lookup) -> None:
    card = told(make_component_card(lookup, lookup.architecture.components["g.cam"]))
    assert (card["group"], card["owner"], card["role"], card["functionality"]) == ("g", "lab", "source", "?")
    assert card["outputs"] == ("image (sensor_msgs/msg/Image) (deprecated) -> g.look.image",)
    assert card["nodes"] == ("n (archgen.yaml:10:9)",)


def test_an_input_tells_where_its_data_comes_from(lookup: Lookup) -> None:
    card = told(make_port_card(lookup, lookup.architecture.inputs["g.look.image"]))
    assert card["sources"] == ("g.cam.image (sensor_msgs/msg/Image)",)
    assert "message" not in card
    order = told(make_port_card(lookup, lookup.architecture.inputs["g.look.order"]))
    assert order["sources"] == ("outside: A guest",)
    reader = told(make_component_card(lookup, lookup.architecture.components["g.look"]))
    assert reader["inputs"] == (
        "image <- g.cam.image (sensor_msgs/msg/Image)",
        "order (std_msgs/msg/String) <- outside: A guest",
    )


def test_a_node_and_its_topic_name_each_other(lookup: Lookup) -> None:
    node = told(make_node_card(lookup, lookup.architecture.nodes["n"]))
    assert (node["ROS name"], node["host"], node["package"]) == ("/n", "pc", "p")
    (topic,) = (each for each in lookup.architecture.topics.values() if each.writers)
    assert node["topics, services and actions"] == (
        f"publishes {topic.name} (sensor_msgs/msg/Image); default: reliable, depth 10",
    )
    card = make_topic_card(lookup, topic)
    assert card.kind == "topic"
    assert [line.partition(" ")[0] for line in told(card)["from"]] == ["n"]  # type: ignore[attr-defined]


def test_other_kinds_tell_their_fields_and_users(lookup: Lookup) -> None:
    host = told(make_generic_card(lookup, "host", "pc"))
    assert (host["cores"], host["nodes"]) == ("4", ("n",))
    partner = told(make_generic_card(lookup, "partner", "lab"))
    assert (partner["title"], partner["contact"], partner["groups"]) == ("Laboratory", "a@b.c", ("g",))
    use_case = told(make_use_case_card(lookup, lookup.architecture.use_cases["fetch"]))
    assert use_case["actors"] == "user (A user)"


def test_a_component_says_in_what_state_its_requirements_are(tmp_path: Path) -> None:
    text = ROBOT.replace("role: source,", "role: source, requirements: [R-1, sees well],")
    (tmp_path / "archgen.yaml").write_text(f"{text}requirements: {{R-1: {{title: It sees}}}}\n", encoding="utf-8")
    architecture = check_project(tmp_path).architecture
    card = make_component_card(make_lookup(architecture), architecture.components["g.cam"])
    assert told(card)["requirements"] == "R-1 (met); sees well"
