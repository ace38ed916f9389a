"""Tables as teams have them become data: each table beside what was made of it and what was said."""

from __future__ import annotations

from typing import Any

import pytest

from archgen.pipeline import CheckedProject
from archgen.plugins.tables import imported_project, table_cells, table_import
from archgen.start import project_plan, start_answers


def read(text: str | bytes) -> table_import.TableImport:
    return table_import.import_tables([("t.csv", text.encode() if isinstance(text, str) else text)], "jazzy")


def groups(text: str | bytes) -> dict[str, Any]:
    return {name: group["components"] for name, group in read(text).data["groups"].items()}


def said(text: str | bytes) -> list[str]:
    return [
        f"{d.span.line}:{d.span.column} {d.severity} {d.rule}: {d.message} | {d.help}" for d in read(text).diagnostics
    ]


def made(imported: table_import.TableImport) -> CheckedProject:
    """Check the files that the data become."""
    given = start_answers.add_partners(start_answers.collect_answers("r"), imported.data.get("partners", {}))
    return project_plan.judge_files(project_plan.imported_files(given, imported.data), "r")


CONNECTIONS = """\
From component,Output,To component,Input,Type
Camera,Image,Object Recognition (3D),Picture,Colour image
Object Recognition (3D),,Planner,,Recognised objects
"""
COMPONENTS = """\
Group;Component;Description;Inputs;Outputs;Partner
Perception;Camera;Looks;none;Image: Colour image;Lab A
;Object Recognition (3D);Finds;Colour image;Recognised objects;Lab A
Planning;Planner;;Recognised objects;none;Lab B
"""


def test_a_row_for_each_connection() -> None:
    assert groups(CONNECTIONS) == {
        "unsorted": {
            "camera": {"functionality": None, "inputs": None, "outputs": {"image": "Colour image"}},
            "object_recognition_3d": {
                "title": "Object Recognition (3D)",
                "functionality": None,
                "inputs": {"picture": "camera.image"},
                "outputs": {"recognised_objects": "Recognised objects"},
            },
            "planner": {
                "functionality": None,
                "inputs": {"recognised_objects": "object_recognition_3d.recognised_objects"},
                "outputs": None,
            },
        }
    }
    assert said(CONNECTIONS) == [
        (
            "2:1 note wrong-value: 3 components stand in no group: look for `unsorted` | a column `Group` sorts them; or move "
            "them by hand"
        )
    ]


def test_a_row_for_each_component() -> None:
    assert groups(COMPONENTS) == {
        "perception": {
            "camera": {"functionality": "Looks", "inputs": {}, "outputs": {"image": "Colour image"}},
            "object_recognition_3d": {
                "title": "Object Recognition (3D)",
                "functionality": "Finds",
                "inputs": {"colour_image": "camera.image"},
                "outputs": {"recognised_objects": "Recognised objects"},
            },
        },
        "planning": {
            "planner": {
                "functionality": None,
                "inputs": {"recognised_objects": "object_recognition_3d.recognised_objects"},
                "outputs": {},
            }
        },
    }
    assert said(COMPONENTS) == []
    assert read(COMPONENTS).data["partners"] == {"lab_a": "Lab A", "lab_b": "Lab B"}
    assert read(COMPONENTS).data["groups"]["perception"]["owner"] == "lab_a"


def test_both_as_sections_or_with_a_column_kind() -> None:
    below = "Group,Component\nG,A\n,B\n\nFrom,To,Data\nA,B,Laser scan\n"
    beside = "Kind,Group,Component,From,To,Data\ncomponent,G,A,,,\nComponent,G,B,,,\nconnection,,,A,B,Laser scan\n"
    expected = {
        "g": {
            "a": {"functionality": None, "inputs": None, "outputs": {"laser_scan": "Laser scan"}},
            "b": {"functionality": None, "inputs": {"laser_scan": "a.laser_scan"}, "outputs": None},
        }
    }
    assert groups(below) == groups(beside) == expected
    assert said(below) == said(beside) == []


@pytest.mark.parametrize("mark", [",", ";", "\t", "|"])
@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "cp1252"])
@pytest.mark.parametrize("ending", ["\n", "\r\n"])
def test_separators_encodings_and_line_ends(mark: str, encoding: str, ending: str) -> None:
    text = COMPONENTS.replace("Looks", '"Sieht, ""schräg""; a|b\t."').replace(";", mark) if mark == ";" else ""
    text = text or COMPONENTS.replace(";", mark).replace("Looks", '"Sieht, ""schräg""; a|b\t."')
    text = text.replace("\n", ending)
    found = read(text.encode(encoding))
    camera = found.data["groups"]["perception"]["components"]["camera"]
    assert camera["functionality"].startswith('Sieht, "schräg"')
    expected = ["the table is not UTF-8 and was read as Windows-1252"] if encoding == "cp1252" else []
    assert [d.message for d in found.diagnostics] == expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("Group,Component\nG,A B\nG,a-b\n", []),
        (
            "Group,Component\nG,A (b)\nG,A b\n",
            [
                "3:3 note wrong-value: `A b` would be `a_b` like another component, and became `a_b_2` | rename one of them if you like"
            ],
        ),
        (
            "Group,Component,Costs\nG,A,3 EUR\n",
            [
                (
                    '1:17 warning unknown-key: the column `Costs` is not known: the cell below it was not taken | --map "Costs=MEANING" takes it; '
                    "a MEANING is one of: kind, group, component, id, title, functionality, description, owner, role, input, output, from, to, "
                    "from_group, to_group, signal, type, message, node, package, topic, rate, period, requirement, status"
                )
            ],
        ),
        (
            "Group,Component,Rate\nG,A,fast\n",
            [
                "2:5 warning wrong-value: `fast` is no rate and no period, and was not taken | write a number and a unit, such as 10 Hz or 100 ms"
            ],
        ),
        (
            "Group,Component,Description\nG,A,=cmd|' /C calc'!A0\n",
            [
                "2:5 warning wrong-value: `=cmd|' /C calc'!A0` is a formula and was not taken | export the table's values"
            ],
        ),
        (
            "Group,Component\nG,Planner\n\nFrom,To,Type\nPlaner,Planner,Pose\n",
            [
                (
                    "5:1 warning unknown-reference: no row declares the component `Planer`: it was added to the group `unsorted` | "
                    "did you mean `Planner`? or add a row for it"
                ),
                "5:1 note wrong-value: 1 component stands in no group: look for `unsorted` | a column `Group` sorts them; or move them by hand",
            ],
        ),
        (
            "Group,Component,Type,Message,Topic,From,To\nG,A,,,,,\nG,B,,,,,\n,,Scan,nav2_msgs/Costmp,/a b,A,B\n",
            [
                "4:8 warning unknown-message: jazzy has no message `nav2_msgs/msg/Costmp`: it was not taken | did you mean `nav2_msgs/msg/Costmap`?",
                "4:25 warning wrong-value: `/a b` is no topic's name and was not taken | write /camera/image",
            ],
        ),
        (
            "Group,Component,Output\nG,A,Pose\nG,B,Pose\n\nGroup,Component,Input\nG,C,Pose\n",
            [
                (
                    "6:5 warning ambiguous-reference: `Pose` comes from several components (`g.a.pose`, `g.b.pose`): the input has no "
                    "source yet | write `Pose from NAME`"
                )
            ],
        ),
        (
            "My robot\nGroup,Component\nG,A\n",
            [
                "1:1 warning wrong-value: `My robot` stands above the headings and was not taken | if it matters, put it below known headings"
            ],
        ),
        (
            'Group,Component\nG,"A\n',
            [
                '2:3 warning syntax-error: this quotation mark is never closed | write `""` for a quotation mark in a text'
            ],
        ),
    ],
)
def test_what_is_said(text: str, expected: list[str]) -> None:
    assert said(text) == expected
    assert read(text).data["groups"]


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (b"", "no row names a component"),
        (b"Group,Component\n", "no row names a component"),
        (b"a,b,c\n1,2,3\n", "no row has headings that archgen knows; the first rows are: `a | b | c`, `1 | 2 | 3`"),
        (b"PK\x03\x04 workbook", "this file cannot be read: the file is damaged (File is not a zip file)"),
        (b"\xd0\xcf\x11\xe0 workbook", "this is a workbook or document of the old form, or one with a password"),
        (b"Group,Component\nG,A\0\n", "the table holds NUL characters"),
        (b"Group,Component\n" + b"," * 1_000_000, "the table has more than 200 columns"),
        (b"Group,Component\n" + b"G,A\n" * 50_001, "the table has more than 100,000 cells"),
        (b"x" * (table_cells.MAX_BYTES + 1), "the table is larger than 8 MiB"),
    ],
)
def test_tables_of_which_nothing_is_taken(data: bytes, message: str) -> None:
    found = read(data)
    assert found.data == {}
    assert [(d.severity, d.message) for d in found.diagnostics if d.severity == "error"] == [("error", message)]


def test_what_a_spreadsheet_says_of_the_low_level() -> None:
    text = (
        "Group,Component,Node,Package,Outputs,Topic,Rate [Hz],Requirement,Role\n"
        'G,Lidar,urg,urg_node,Laser scan,/scan,"12,5",R-1; R-2,Sensor\n'
        "G,Map,,,,,,Keeps a map of every room,\n"
    )
    found = read(text).data
    assert found["nodes"] == {
        "urg": {"implements": "g.lidar", "package": "urg_node", "publishes": {"laser_scan": "/scan"}}
    }
    assert found["requirements"] == {"R-1": None, "R-2": None}
    lidar = found["groups"]["g"]["components"]["lidar"]
    assert (lidar["timing"], lidar["role"], lidar["requirements"]) == ({"rate": "12.5 Hz"}, "source", ["R-1", "R-2"])
    assert found["groups"]["g"]["components"]["map"]["requirements"] == ["Keeps a map of every room"]
    assert [d for d in made(read(text)).findings if d.severity == "error"] == []


def test_a_type_has_one_message() -> None:
    text = "From,To,Type,Message\nA,B,Scan,sensor_msgs/LaserScan\nA,C,Scan,sensor_msgs::msg::PointCloud2\n"
    assert read(text).data["types"] == {"Scan": "sensor_msgs/msg/LaserScan"}
    assert said(text)[-1] == (
        "3:10 warning conflicting-values: `Scan` is carried by `sensor_msgs/msg/LaserScan` already: `sensor_msgs::msg::PointCloud2` was not taken | "
        "give one of the two another type"
    )


def test_lists_in_cells_are_taken_as_far_as_the_budget_goes(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(imported_project, "MAX_LISTED", 3)
    text = 'Group,Component,Inputs\na,b,"x; y"\na,c,"x; y; z"\na,d,"x; y"\n'
    inputs = {name: list((each or {}).get("inputs") or ()) for name, each in groups(text)["a"].items()}
    assert inputs == {"b": ["x", "y"], "c": ["x"], "d": []}
    assert sum("too-large" in each and each.startswith("3:") for each in said(text)) == 1
