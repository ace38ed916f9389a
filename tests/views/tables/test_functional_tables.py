"""Groups, connections and chains as tables, and findings beside them."""

from __future__ import annotations

from dataclasses import replace

import pytest

from archgen import pipeline
from archgen.diagnostics.diagnostic import Severity
from archgen.pipeline import CheckedProject
from archgen.views import inline_text
from archgen.views.elements.functional_level import describe_purpose
from archgen.views.lookup import Lookup, make_lookup
from archgen.views.shapes import Table
from archgen.views.tables import finding_tables, functional_tables

ROBOT = """\
archgen: 1
project: {id: robot}
partners: {lab: }
groups:
  seeing:
    owner: lab
    description: Sees. Then it says so.
    components:
      camera: {outputs: {image: Image}}
      lamp: {outputs: {light: {external: A lamp shines., medium: physical, type: Light}}}
      eye: {inputs: {image: camera.image, light: lamp.light}, outputs: {place: Place}}
  idle: {}
chains: {look: {through: [camera, eye.place], deadline: 100 ms}}
types: {Image: sensor_msgs/msg/Image}
views: {light: {show: lamp eye}, nodes: {show: lamp eye, level: implementation}, alone: {show: camera}}
"""


@pytest.fixture(scope="module")
def checked(tmp_path_factory: pytest.TempPathFactory) -> CheckedProject:
    file = tmp_path_factory.mktemp("robot") / "robot.yaml"
    file.write_text(ROBOT, encoding="utf-8")
    return pipeline.check_project(file)


@pytest.fixture(scope="module")
def lookup(checked: CheckedProject) -> Lookup:
    return make_lookup(checked.architecture)


def read_cells(table: Table | None) -> list[list[str]]:
    assert table is not None
    return [["".join(part.text for part in cell) for cell in row] for row in table.rows]


def test_groups_with_owner_size_and_purpose(lookup: Lookup) -> None:
    assert read_cells(functional_tables.make_group_table(lookup)) == [
        ["Seeing", "Lab", "3", "Sees."],
        ["Idle", "not known yet", "0", "not known yet"],
    ]


def test_a_connection_over_no_message_names_its_medium(lookup: Lookup) -> None:
    table = functional_tables.make_connection_table(lookup, functional_tables.shown_connections(lookup))
    assert read_cells(table) == [
        ["Eye · image", "Camera · image", "Image", "sensor_msgs/msg/Image", "1"],
        ["Eye · light", "Lamp · light", "Light", "physical", "1"],
    ]


def test_of_a_view_what_flows_between_its_components_is_listed(lookup: Lookup) -> None:
    tables = {
        name: list(map(read_cells, functional_tables.make_view_table(lookup, view)))
        for name, view in lookup.architecture.views.items()
    }
    assert tables == {"light": [[["Eye · light", "Lamp · light", "Light", "physical", "1"]]], "nodes": [], "alone": []}


def test_a_chain_leads_through_components_and_outputs(lookup: Lookup) -> None:
    table = functional_tables.make_chain_table(lookup, lookup.architecture.chains.values())
    assert table is not None
    assert read_cells(table) == [["Look", "Camera → Eye · place", "100 ms", ""]]
    assert table.row_anchors == ("chain:look",)


def test_without_rows_there_is_no_table(lookup: Lookup) -> None:
    assert functional_tables.make_chain_table(lookup, ()) is None
    assert functional_tables.make_connection_table(lookup, ()) is None
    assert finding_tables.make_finding_table(lookup, ()) is None


def test_findings_are_listed_gravest_first(checked: CheckedProject, lookup: Lookup) -> None:
    gravest = replace(checked.findings[0], severity=Severity.ERROR, message="the last is first")
    rows = read_cells(finding_tables.make_finding_table(lookup, [*checked.findings, gravest]))
    assert [row[0] for row in rows] == ["error", *["warning"] * 4, *["note"] * 3]
    assert rows[0][1].startswith("the last is first")
    assert [row[2:] for row in rows if row[4] == "unmapped-type"] == [["Lab", "robot.yaml:11", "unmapped-type"]]


def test_a_rule_with_a_state_of_its_own_shows_it(checked: CheckedProject) -> None:
    chips = {each.rule: finding_tables.finding_chip(each)[0] for each in checked.findings}
    assert {rule: (chip.text, chip.status) for rule, chip in chips.items()} == {
        "unmapped-component": ("warning", "warning"),
        "unmapped-type": ("warning", "warning"),
        "unread-output": ("unread", "warning"),
        "missing-detail": ("note", "note"),
    }


def test_findings_are_counted_in_words(checked: CheckedProject) -> None:
    assert finding_tables.describe_severities(checked.findings) == "4 warnings and 3 notes"
    assert finding_tables.describe_severities([]) == "nothing"


def test_a_purpose_is_the_first_sentence_with_its_marked_words_set() -> None:
    runs = describe_purpose("Takes *no* for an answer\nin `act`. It waits 0.5 s.")
    assert [(run.text, run.emphasis, run.code) for run in runs] == [
        ("Takes ", False, False),
        ("no", True, False),
        (" for an answer in ", False, False),
        ("act", False, True),
        (".", False, False),
    ]
    assert sum(len(run.text) for run in describe_purpose("word " * 500)) <= 300  # in a row of a table
    runs = describe_purpose("Turns the readings into three things:\n\n- one")
    assert "".join(run.text for run in runs) == "Turns the readings into three things…", "it ended in a colon"
    assert inline_text.strip_marks("Takes *no* for **an** `answer`") == "Takes no for an answer"
