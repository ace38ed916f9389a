"""Cards, pages, plans and the record tell domain, clock, state and overrides of a node where they are no default."""

from __future__ import annotations

from pathlib import Path

from archgen.bringup.start_plan import make_start_plan
from archgen.cli.show_command import format_card
from archgen.views.elements.element_card import make_card
from archgen.views.elements.implementation_level import make_node_blocks
from archgen.views.pages.host_pages import make_host_pages
from archgen.views.records.resolved_record import make_record
from archgen.views.shapes import Facts
from tests.agreeing import checked, text, view

ROBOT = """\
archgen: 1
ros: {distro: jazzy, parameters: {use_sim_time: true}, environment: {RMW: x}}
groups: {g: {components: {a: {outputs: {o: std_msgs/msg/Bool}}, b: {inputs: {i: a.o}}}}}
nodes:
  a:
    implements: a
    status: existing
    package: p
    executable: e
    host: pc
    publishes: {o: /safety}
    kind: lifecycle
    start: {state: inactive}
    parameters: {qos_overrides: {/safety: {publisher: {reliability: best_effort}}}}
  b: {implements: b, container: box, parameters: {use_sim_time: "$(var sim)"}, subscribes: {i: {qos: {reliability: reliable}}}}
hosts: {pc: {environment: {ROS_DOMAIN_ID: "42"}}}
containers: {box: pc}
"""


def test_the_card_of_a_node(tmp_path: Path) -> None:
    lookup = view(checked(tmp_path, ROBOT))
    lines = [line.strip() for line in format_card(make_card(lookup, "node", "a"), None).splitlines()]
    assert [line for line in lines if line.startswith(("domain:", "clock:", "state:", "publishes"))] == [
        "domain:         42, by ROS_DOMAIN_ID=42 (archgen.yaml:16)",
        "clock:          simulated, by use_sim_time: true (archgen.yaml:2)",
        "state:          inactive, by state: inactive (archgen.yaml:13)",
        (
            "publishes /safety (std_msgs/msg/Bool); default: best effort, depth 10, overridden, if its program allows that, by "
            "qos_overrides./safety.publisher.reliability (archgen.yaml:14)"
        ),
    ]
    assert "clock:          unknown: use_sim_time: $(var sim) (archgen.yaml:15)" in format_card(
        make_card(lookup, "node", "b"), None
    )


def test_the_pages_of_a_node_and_a_host(tmp_path: Path) -> None:
    lookup = view(checked(tmp_path, ROBOT))
    (facts,) = (each for each in make_node_blocks(lookup, lookup.architecture.nodes["a"]) if isinstance(each, Facts))
    shown = {title: text(value) for title, value in facts.rows}
    assert [shown[title] for title in ("Domain", "Clock", "State")] == [
        "42, by ROS_DOMAIN_ID=42 (archgen.yaml:16)",
        "simulated, by use_sim_time: true (archgen.yaml:2)",
        "inactive, by state: inactive (archgen.yaml:13)",
    ]
    section = next(iter(make_host_pages(lookup, tuple))).section
    (host_facts,) = (each for each in section.blocks if isinstance(each, Facts))
    assert {title: text(value) for title, value in host_facts.rows}["Environment"] == "ROS_DOMAIN_ID=42"


def test_what_is_started_has_the_variables_of_project_and_host(tmp_path: Path) -> None:
    plan = make_start_plan(checked(tmp_path, ROBOT).architecture)
    variables = {"RMW": "x", "ROS_DOMAIN_ID": "42"}
    assert {step.id: dict(step.environment) for step in plan.steps} == {"a": variables, "box": variables, "b": {}}


def test_the_record(tmp_path: Path) -> None:
    record = make_record(view(checked(tmp_path, ROBOT)))
    (first,) = record["nodes"]["a"]["endpoints"]
    (second,) = record["nodes"]["b"]["endpoints"]
    assert {key: first[key] for key in ("qos_override", "domain", "clock", "runs")} == {
        "qos_override": "unknown",
        "domain": 42,
        "clock": "simulated",
        "runs": "inactive",
    }
    assert (first["qos"]["reliability"], first["qos_if_ignored"]["reliability"]) == ("best_effort", "reliable")
    assert first["from"]["qos.reliability"] == {
        "by": "written",
        "rule": "qos_overrides./safety.publisher.reliability",
        "at": "archgen.yaml:14:69",
    }
    assert second["unknown"] == ["clock"]
    assert "clock" not in second
    assert record["project"]["environment"] == {"RMW": "x"}


def test_the_page_of_a_node_names_the_requirements_of_its_components(tmp_path: Path) -> None:
    lookup = view(
        checked(
            tmp_path,
            "requirements: {R-1: It stops, R-2: It goes}\n"
            "groups: {g: {components: {a: {role: sink, requirements: [R-1, It is quiet.]}, "
            "b: {role: sink, requirements: [R-1, R-2]}, c: {role: sink}}}}\n"
            "nodes: {n: {implements: [a, b]}, m: {implements: c}}\n",
        )
    )
    shown = {}
    for node in lookup.architecture.nodes.values():
        (facts,) = (each for each in make_node_blocks(lookup, node) if isinstance(each, Facts))
        shown[node.id] = {title: text(value) for title, value in facts.rows}.get("Requirements")
    assert shown == {"n": "R-1 It stops met, R-2 It goes met", "m": None}
