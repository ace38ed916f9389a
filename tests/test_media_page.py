"""The page of media, and the drone: what is no ROS is checked, listed, timed and drawn without a message."""

from __future__ import annotations

import re

import pytest

from archgen.diagnostics.diagnostic import Severity
from archgen.views.graphs.component_graph import draw_component
from archgen.views.lookup import make_lookup
from archgen.views.tables.element_rows import list_element_rows
from tests.judged_projects import check_text, judge_shipped
from tests.running import ROOT

PAGE = (ROOT / "docs" / "media.md").read_text(encoding="utf-8")
EXAMPLES = re.findall(r"^```yaml\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL)


@pytest.mark.parametrize("example", EXAMPLES)
def test_nothing_is_wrong_in_an_example(example: str) -> None:
    findings = check_text(example)
    kept = [each for each in findings if each.effective_severity > Severity.NOTE]
    assert [f"{each.span.line} {each.rule}: {each.message}" for each in kept] == []


def test_the_drone_is_clean_and_says_what_is_no_ros() -> None:
    checked = judge_shipped(ROOT / "examples" / "drone")
    assert [finding.message for finding in checked.findings] == []
    architecture = checked.architecture
    assert sorted(architecture.channels) == [
        "mavlink flight.autopilot.state",
        "mavlink flight.mavlink_bridge.setpoint",
        "memory counting.decoder.labels",
        "mqtt drones/1/command",
        "mqtt drones/1/progress",
        "rest GET /aisles (service)",
        "rest POST /aisles/{aisle}/stock",
    ]
    lookup = make_lookup(architecture)
    columns, rows = list_element_rows(lookup, "connections")
    media = {row[columns.index("input")]: row[columns.index("medium")] for row in rows}
    assert media["counting.mission.aisles"] == "rest"
    assert media["flight.guidance.path"] == "digital"
    picture = draw_component(lookup, "counting.mission")
    drawn = {arrow.label for arrow in picture.arrows if arrow.medium}
    assert drawn == {"Aisles to count\n(REST)", "Command\n(MQTT)", "Progress\n(MQTT)"}
    assert "medium" in picture.legend
