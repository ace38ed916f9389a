"""What is no ROS, beside topics: in pictures, tables, lists, the search, the explorer and the record."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen.model.port_media import key_of_carrier, label_of_carrier
from archgen.pipeline import check_project
from archgen.views.elements.element_card import make_card
from archgen.views.elements.element_names import find_elements
from archgen.views.explorer.map_shapes import make_flow_tables
from archgen.views.graphs.implementation_graph import draw_implementation, draw_ros_graph
from archgen.views.lookup import Lookup, make_lookup
from archgen.views.pages.context_pages import make_topic_pages, make_topic_tables
from archgen.views.pages.host_pages import make_host_pages
from archgen.views.records.resolved_record import make_record
from archgen.views.search import make_channel_entries
from archgen.views.shapes import Facts, Inlines, Table
from archgen.views.tables.element_rows import list_element_rows

ROBOT = """
archgen: 1
groups:
  air:
    components:
      drone: {outputs: {pose: {type: Pose, medium: mqtt}, image: Picture}}
      motors: {inputs: {speed: {type: Speed, medium: can, external: The battery}}}
  ground:
    components:
      screen: {inputs: {pose: drone.pose, image: drone.image}}
      depot: {outputs: {orders: {type: Order, medium: rest}}}
      planner: {inputs: {orders: depot.orders}}
types: {Order: {request: Query, response: Orders}, Picture: sensor_msgs/msg/Image, Pose: {size: 100 B}}
hosts: {pc: {cores: 4}}
links: {bus: {connects: [pc, motors], protocol: EtherCAT}}
nodes:
  drone: {implements: drone, host: pc, publishes: {pose: {topic: fleet/pose}}}
  screen: {implements: screen, host: pc}
"""


@pytest.fixture
def lookup(tmp_path: Path) -> Lookup:
    (tmp_path / "robot.yaml").write_text(ROBOT, encoding="utf-8")
    checked = check_project(tmp_path / "robot.yaml")
    return make_lookup(checked.architecture, checked.findings)


def text(inlines: Inlines) -> str:
    return "".join(each.text for each in inlines)


def test_the_picture_of_an_implementation_has_a_box_for_each_channel(lookup: Lookup) -> None:
    graph = draw_implementation(lookup, "air.drone")
    boxes = {box.title: (box.lines, box.ref) for box in graph.boxes if box.id.startswith("topic ")}
    assert boxes == {
        "/air/drone/image": (("sensor_msgs/msg/Image",), "topic:/air/drone/image"),
        "fleet/pose": (("Pose", "(MQTT)"), "channel:mqtt fleet/pose"),
    }
    media = {(arrow.tail, arrow.head): arrow.medium for arrow in graph.arrows if arrow.medium}
    assert media == {("drone", "topic mqtt fleet/pose"): "MQTT", ("topic mqtt fleet/pose", ">screen"): "MQTT"}
    assert "medium" in graph.legend


def test_a_call_has_a_box_of_its_own(lookup: Lookup) -> None:
    graph = draw_implementation(lookup, "ground.planner")
    assert [(box.title, box.style) for box in graph.boxes if box.id.startswith("topic ")] == [
        ("ground.depot.orders", "service")
    ]
    (channel,) = (each for each in lookup.architecture.channels.values() if each.flow == "service")
    assert key_of_carrier(channel.readers[0]) == "rest ground.depot.orders (service)"
    assert label_of_carrier(channel) == "ground.depot.orders (REST)"


def test_arrows_between_nodes_say_their_medium(lookup: Lookup) -> None:
    arrows = {(arrow.tail, arrow.head, arrow.label) for arrow in draw_ros_graph(lookup).arrows}
    assert arrows == {("air", "ground", ""), ("air", "ground", "(MQTT)"), ("planner", "depot", "(REST)")}


def test_tables_and_lists_name_them_behind_the_topics(lookup: Lookup) -> None:
    tables = {table.caption: [tuple(map(text, row)) for row in table.rows] for table in make_topic_tables(lookup)}
    assert tables == {
        "Topics": [("/air/drone/image", "sensor_msgs/msg/Image", "drone", "screen")],
        "Over other media than ROS": [
            ("fleet/pose (MQTT)", "Pose", "drone", "screen"),
            ("ground.depot.orders (REST)", "Order", "depot", "planner"),
        ],
    }
    columns, rows = list_element_rows(lookup, "topics")
    assert (columns[0], columns[-1]) == ("name", "medium")
    assert [(row[0], row[-1]) for row in rows] == [
        ("/air/drone/image", "digital"),
        ("fleet/pose", "mqtt"),
        ("ground.depot.orders", "rest"),
    ]


def test_the_card_of_a_node_lists_what_it_uses(lookup: Lookup) -> None:
    assert find_elements(lookup, "drone")
    lists = dict(make_card(lookup, "node", "drone").lists)
    assert set(lists["topics, services and actions"]) == {
        "publishes /air/drone/image (sensor_msgs/msg/Image); default: reliable, depth 10",
        "publishes fleet/pose (MQTT: Pose)",
    }


def test_the_search_finds_them_by_name_and_medium(lookup: Lookup) -> None:
    assert [(each.title, each.line, each.keys) for each in make_channel_entries(lookup)] == [
        ("fleet/pose", "MQTT · Pose · from drone", ("mqtt",)),
        ("ground.depot.orders", "REST · Order · from depot", ("rest",)),
    ]


def test_the_explorer_has_their_medium_with_flows_and_links(lookup: Lookup) -> None:
    components = {name: number for number, name in enumerate(lookup.architecture.components)}
    nodes = {name: number for number, name in enumerate(lookup.architecture.nodes)}
    tables = make_flow_tables(lookup, components, nodes, ())
    assert [row[3:] for row in tables["flows"]] == [("MQTT",), (), ("REST",)]
    assert [row[1:] for row in tables["topics"]] == [
        ("/air/drone/image", "topic"),
        ("fleet/pose", "topic", "MQTT"),
        ("ground.depot.orders", "service", "REST"),
    ]
    assert len(tables["links"]) == len(tables["topics"])


def test_the_record_gives_them_apart_from_topics(lookup: Lookup) -> None:
    record = make_record(lookup)
    assert [each["name"] for each in record["topics"]] == ["/air/drone/image"]
    assert [(each["name"], each["medium"], each["writers"]) for each in record["channels"]] == [
        ("fleet/pose", "mqtt", ["drone"]),
        ("ground.depot.orders", "rest", ["depot"]),
    ]
    assert [each["name"] for each in record["nodes"]["drone"]["endpoints"]] == ["/air/drone/image"]


def test_the_page_of_a_host_names_links_and_devices(lookup: Lookup) -> None:
    (page,) = make_host_pages(lookup, tuple)
    facts = {
        name: text(value) for block in page.section.blocks if isinstance(block, Facts) for name, value in block.rows
    }
    assert (facts["Links"], facts["Devices"]) == ("Bus (EtherCAT)", "Motors (on Bus)")


def test_each_has_a_page_that_is_linked_and_a_card(lookup: Lookup) -> None:
    pages = {page.anchor: page for page in make_topic_pages(lookup) if page.kind == "channels"}
    assert list(pages) == ["channel:mqtt fleet/pose", "channel:rest ground.depot.orders (service)"]
    page = pages["channel:mqtt fleet/pose"]
    assert (page.title, page.lead, page.path) == ("fleet/pose", "Data over MQTT", "channels/mqtt-fleet-pose.html")
    facts, senders, readers = page.section.blocks
    assert isinstance(facts, Facts)
    assert isinstance(senders, Table)
    assert isinstance(readers, Table)
    assert [(name, text(value)) for name, value in facts.rows] == [
        ("Medium", "MQTT"),
        ("Type", "Pose"),
        ("Size", "100 B"),
        ("Hosts", "Pc"),
    ]
    assert [[text(cell) for cell in row] for block in (senders, readers) for row in block.rows] == [
        ["drone", "Drone", "pose"],
        ["screen", "Screen", "pose"],
    ]
    (table,) = (each for each in make_topic_tables(lookup) if each.anchor == "table:channels")
    assert {run.ref for row in table.rows for run in row[0] if run.ref} == set(pages)
    assert {entry.refs[0] for entry in make_channel_entries(lookup)} == set(pages)
    assert find_elements(lookup, "fleet/pose") == [("channel", "fleet/pose")]
    card = make_card(lookup, "channel", "fleet/pose")
    assert (dict(card.facts)["medium"], card.lists) == ("MQTT", (("from", ("drone",)), ("to", ("screen",))))
    # What nobody named is called after its output, and shown as that.
    assert [kind for kind, _ in find_elements(lookup, "ground.depot.orders")] == ["output"]
