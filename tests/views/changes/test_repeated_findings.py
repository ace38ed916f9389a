"""A finding that says the same as a break is shown with it, and not once more."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen import pipeline
from archgen.compare import Comparison
from archgen.compare.compare_versions import compare_versions
from archgen.products.compared_versions import make_comparison_input
from archgen.views.changes.breaking_items import find_repeated_findings
from archgen.views.changes.comparison_document import describe_comparison

ROBOT = """\
partners: {vega: Vega, orsa: Orsa}
groups:
  eyes: {owner: vega, components: {finder: {outputs: {people: People}}}}
  legs: {owner: orsa, components: {driver: {inputs: {people: finder.people}}, brake: {inputs: {people: finder.people}}}}
types: {People: geometry_msgs/msg/PoseArray}
nodes:
  finder: {implements: finder, publishes: {people: /people}}
  driver: {implements: driver}
  brake: {implements: brake, subscribes: {people: {qos: {reliability: best_effort}}}}
"""


def compare(folder: Path, after: str, before: str = ROBOT) -> Comparison:
    """Compare a robot with another text."""
    file = folder / "robot.yaml"
    sides = []
    for text in (before, after):
        file.write_text(text, encoding="utf-8")
        sides.append(make_comparison_input(pipeline.check_project(file)))
    return compare_versions(*sides)


def test_a_quality_of_service_that_breaks_is_found_once(tmp_path: Path) -> None:
    after = ROBOT.replace("people: /people", "people: {topic: /people, qos: {reliability: best_effort}}")
    comparison = compare(tmp_path, after)
    assert [(finding.rule, change.key) for finding, change in find_repeated_findings(comparison).items()] == [
        ("incompatible-qos", "qos")
    ]
    document = describe_comparison(comparison, "a", "b")
    assert [item.agreements for item in document.breaking_changes] == [
        ("found as `incompatible-qos` at `robot.yaml:8:3`",)
    ]
    assert document.finding_groups == ()


def test_an_input_without_a_source_is_found_once(tmp_path: Path) -> None:
    after = ROBOT.replace("outputs: {people: People}", "outputs: {}").replace(
        "publishes: {people: /people}", "package: p"
    )
    after = after.replace("driver: {inputs: {people: finder.people}}", "driver: {inputs: {people: {type: People}}}")
    after = after.replace("brake: {inputs: {people: finder.people}}", "brake: {}").replace(
        "brake, subscribes: {people: {qos: {reliability: best_effort}}}", "brake"
    )
    findings = find_repeated_findings(compare(tmp_path, after))
    assert [finding.rule for finding in findings] == ["unfed-input"]


def test_a_finding_of_something_else_stays(tmp_path: Path) -> None:
    after = ROBOT.replace("people: /people", "people: {topic: /people, qos: {reliability: best_effort}}")
    after = after.replace("brake: {inputs", "brake: {outputs: {dust: Dust}, inputs")
    groups = describe_comparison(compare(tmp_path, after), "a", "b").finding_groups
    assert "unread-output" in [finding.rule for group in groups for finding in group.findings]


BUSY = """\
partners: {vega: Vega, orsa: Orsa}
types: {People: {message: geometry_msgs/msg/PoseArray, size: 1 kB}}
groups:
  eyes: {owner: vega, components: {finder: {outputs: {people: People}}}}
  legs: {owner: orsa, components: {driver: {inputs: {people: finder.people}}, brake: {}}}
hosts: {pc: {cores: 1}, base: {cores: 1}}
links: {lan: {connects: [pc, base], bandwidth: 1 Mbit/s}}
nodes:
  finder: {implements: finder, host: pc, timing: {rate: 10 Hz, wcet: 5 ms}}
  brake: {implements: brake, host: pc, timing: {rate: 10 Hz, wcet: 5 ms}}
  driver: {implements: driver, host: base, timing: {rate: 10 Hz, wcet: 5 ms}}
"""


@pytest.mark.parametrize(
    ("old", "new", "rule"),
    [
        ("finder, host: pc, timing: {rate: 10 Hz, wcet: 5 ms}", "finder, host: pc, timing: {rate: 10 Hz, wcet: 99 ms}", "overloaded-host"),
        ("size: 1 kB", "size: 50 kB", "saturated-link"),
    ],
)  # fmt: skip
def test_what_has_too_much_to_do_is_found_once(tmp_path: Path, old: str, new: str, rule: str) -> None:
    comparison = compare(tmp_path, BUSY.replace(old, new), BUSY)
    assert rule in [finding.rule for finding in comparison.new_findings]
    assert [finding.rule for finding in find_repeated_findings(comparison)] == [rule]


@pytest.mark.parametrize(
    ("words", "rule"),
    [
        ("start: {environment: {ROS_DOMAIN_ID: '42'}}", "two-domains"),
        ("parameters: {use_sim_time: true}", "two-clocks"),
        ("remaps: {/people: /faces}", "remapped-away"),
    ],
)
def test_what_parts_two_ends_is_found_once(tmp_path: Path, words: str, rule: str) -> None:
    before = ROBOT.replace("brake: {inputs: {people: finder.people}}", "brake: {}").replace(
        "brake, subscribes: {people: {qos: {reliability: best_effort}}}", "brake"
    )
    before = before.replace(
        "driver: {implements: driver}", "driver: {implements: driver, subscribes: {people: /people}}"
    )
    after = before.replace("finder: {implements: finder,", f"finder: {{implements: finder, {words},")
    comparison = compare(tmp_path, after, before)
    assert rule in [finding.rule for finding in comparison.new_findings]
    assert [finding.rule for finding in find_repeated_findings(comparison)] == [rule]
