"""Single cells of a table, as teams write them."""

from __future__ import annotations

import pytest

from archgen.diagnostics.source_span import NO_SPAN
from archgen.plugins.tables import cell_values
from archgen.plugins.tables.imported_project import ImportedProject
from archgen.plugins.tables.table_cells import TableCell


@pytest.fixture
def project() -> ImportedProject:
    return ImportedProject()


def _cell(text: str) -> TableCell:
    return TableCell(text, NO_SPAN)


@pytest.mark.parametrize(
    ("text", "unit", "timing"),
    [
        ("10", "Hz", {"rate": "10 Hz"}),
        ("10", "ms", {"period": "10 ms"}),
        ("0,5 Hz", "", {"rate": "0.5 Hz"}),
        ("30 fps", "", {"rate": "30 Hz"}),
        ("2 kHz", "ms", {"rate": "2 kHz"}),
        ("10", "", None),
        ("0 Hz", "", None),
        ("-1 Hz", "", None),
        ("about 10 Hz", "", None),
        ("10 Hz or so", "", None),
    ],
)
def test_a_rate_or_a_period(project: ImportedProject, text: str, unit: str, timing: dict[str, str] | None) -> None:
    assert cell_values.read_timing(project, _cell(text), unit) == timing
    assert [d.message for d in project.diagnostics] == (
        [] if timing else [f"`{text}` is no rate and no period, and was not taken"]
    )


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("sensor_msgs/LaserScan", "sensor_msgs/msg/LaserScan"),
        ("sensor_msgs::msg::LaserScan", "sensor_msgs/msg/LaserScan"),
        ("sensor_msgs.msg.LaserScan", "sensor_msgs/msg/LaserScan"),
        ("LaserScan", None),
    ],
)
def test_a_message_in_the_spelling_of_any_language(project: ImportedProject, text: str, message: str | None) -> None:
    assert cell_values.read_message_cell(project, _cell(text)) == message
    assert len(project.diagnostics) == (message is None)


@pytest.mark.parametrize(("text", "formula"), [("=A1", True), ("A1", False), (" =A1", False)])
def test_a_formula_is_not_taken(project: ImportedProject, text: str, formula: bool) -> None:  # noqa: FBT001
    assert cell_values.reject_formula(project, _cell(text)) is formula
    assert not cell_values.reject_formula(project, None)
    assert len(project.diagnostics) == formula


@pytest.mark.parametrize("text", ["/camera/image", "image", "~/image", "~image"])
def test_topics(project: ImportedProject, text: str) -> None:
    assert cell_values.read_topic(project, _cell(text)) == text


@pytest.mark.parametrize("text", ["/camera image", "/", "3d", "/a//b", "a/"])
def test_what_is_no_topic_is_reported(project: ImportedProject, text: str) -> None:
    assert cell_values.read_topic(project, _cell(text)) is None
    assert [d.rule for d in project.diagnostics] == ["wrong-value"]


@pytest.mark.parametrize(("text", "package"), [("my_robot", "my_robot"), ("MyRobot", None), ("my-robot", None)])
def test_packages(project: ImportedProject, text: str, package: str | None) -> None:
    assert cell_values.read_package(project, _cell(text)) == package


@pytest.mark.parametrize(
    ("text", "items"),
    [
        ("a, b", ["a", "b"]),
        ("a, b; c", ["a, b", "c"]),
        ("a, b\nc", ["a, b", "c"]),
        ("image (left, right), scan", ["image (left, right)", "scan"]),
        ("- a\n• b\n\n* c", ["a", "b", "c"]),
        ("  a   b ,, ", ["a b"]),
    ],
)
def test_a_list_is_split_at_the_strongest_mark(text: str, items: list[str]) -> None:
    assert cell_values.split_cell_list(_cell(text)) == items


@pytest.mark.parametrize(
    ("text", "requirements", "declared"),
    [
        ("R-1, R-2", ["R-1", "R-2"], ["R-1", "R-2"]),
        ("R-1/R-2", ["R-1", "R-2"], ["R-1", "R-2"]),
        ("It sees, and it hears", ["It sees, and it hears"], []),
        ("It sees; it hears", ["It sees", "it hears"], []),
        ("R-1; it hears", ["R-1", "it hears"], ["R-1"]),
        ("1.2; it hears", ["Requirement 1.2", "it hears"], []),
    ],
)
def test_requirements_are_ids_or_sentences(
    project: ImportedProject, text: str, requirements: list[str], declared: list[str]
) -> None:
    assert cell_values.read_requirements(project, _cell(text)) == requirements
    assert list(project.requirements) == declared


def test_a_type_may_be_long_but_not_too_long(project: ImportedProject) -> None:
    assert cell_values.read_type_name(project, _cell("x" * 200)) == "x" * 200
    assert cell_values.read_type_name(project, _cell("x" * 201)) is None
    assert [d.message for d in project.diagnostics] == [
        f"a type's name has at most 200 characters: `{'x' * 39}…` was not taken"
    ]
