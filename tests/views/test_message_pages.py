"""The pages of messages: fields, constants, comments, who sends and reads them; each mention of a message leads there."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen.pipeline import check_project
from archgen.views.lookup import Lookup, collect_messages, make_lookup
from archgen.views.pages import message_pages
from archgen.views.pages.message_pages import MessagePages
from archgen.views.shapes import Facts, Inlines, Page, Paragraph, Table

ROBOT = """\
ros: {distro: jazzy, interfaces: ["msgs/**/*.msg", "msgs/**/*.srv"]}
partners: {p: {title: Partner P}}
types: {Fall: my_msgs/msg/Fall, Unknown: other_msgs/msg/Odd, Ask: my_msgs/srv/Ask}
groups:
  g:
    components:
      eye: {title: Eye, owner: p, outputs: {o: Fall, u: Unknown}}
      brain: {title: Brain, inputs: {i: eye.o}}
nodes:
  eye: {implements: eye}
  brain: {implements: brain}
"""
FALL = """\
# Somebody lies on the floor.

uint8 SLIP=1  # on something wet
uint8 FAINT=2
std_msgs/Header header
geometry_msgs/Point[] points  # of the body
uint8 kind 1
"""
ASK = "string words\n---\nbool heard\n"


@pytest.fixture
def lookup(tmp_path: Path) -> Lookup:
    """Check the robot with its two interface files."""
    (tmp_path / "robot.yaml").write_text(ROBOT, encoding="utf-8")
    for name, text in {"msg/Fall.msg": FALL, "srv/Ask.srv": ASK}.items():
        (tmp_path / "msgs" / "my_msgs" / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / "msgs" / "my_msgs" / name).write_text(text, encoding="utf-8")
    checked = check_project(tmp_path / "robot.yaml")
    return make_lookup(checked.architecture, checked.findings)


def make_messages(lookup: Lookup) -> MessagePages:
    architecture = lookup.architecture
    return MessagePages(lookup, architecture.types.values(), architecture.topics.values())


def page_of(lookup: Lookup, message: str) -> Page:
    return next(page for page in make_messages(lookup).make_pages() if page.anchor == f"message:{message}")


def read(cell: Inlines) -> str:
    return "".join(("\n" if run.line_break else "") + run.text for run in cell)


def rows_of(page: Page, name: str) -> list[list[str]]:
    (table,) = (b for b in page.section.blocks if isinstance(b, Table) and b.anchor.startswith(f"table:{name}/"))
    return [[read(cell) for cell in row] for row in table.rows]


def test_fields_and_constants_stand_with_what_the_definition_says_of_them(lookup: Lookup) -> None:
    page = page_of(lookup, "my_msgs/msg/Fall")
    assert page.title == "Fall"
    assert page.lead == "Message · my_msgs"
    assert rows_of(page, "fields") == [
        ["header", "std_msgs/msg/Header", "", ""],
        ["points", "geometry_msgs/msg/Point[]", "", "of the body"],
        ["kind", "uint8", "1", ""],
    ]
    assert rows_of(page, "constants") == [["SLIP", "1", "uint8", "on something wet"], ["FAINT", "2", "uint8", ""]]
    assert "Somebody lies on the floor." in [read(b.inlines) for b in page.section.blocks if isinstance(b, Paragraph)]


def test_who_sends_and_who_reads_it_is_named(lookup: Lookup) -> None:
    page = page_of(lookup, "my_msgs/msg/Fall")
    assert rows_of(page, "carriers") == [["/g/eye/o", "eye", "brain"]]
    assert rows_of(page, "ports") == [["Eye · o", "Partner P", "Fall", "Brain · i"]]


def test_what_a_message_contains_has_a_page_that_leads_back(lookup: Lookup) -> None:
    (facts,) = (b for b in page_of(lookup, "geometry_msgs/msg/Point").section.blocks if isinstance(b, Facts))
    assert ("Part of", "my_msgs/msg/Fall") in [(name, read(value)) for name, value in facts.rows]


def test_parts_of_a_service_have_tables_of_their_own(lookup: Lookup) -> None:
    tables = [b for b in page_of(lookup, "my_msgs/srv/Ask").section.blocks if isinstance(b, Table)]
    assert [table.caption for table in tables] == ["Request: fields", "Answer: fields"]


def test_a_message_without_definition_says_what_to_do(lookup: Lookup) -> None:
    (facts,) = (b for b in page_of(lookup, "other_msgs/msg/Odd").section.blocks if isinstance(b, Facts))
    assert "ros.interfaces" in {name: read(value) for name, value in facts.rows}["Definition"]


def test_the_list_names_each_message_once_with_its_users(lookup: Lookup) -> None:
    table = make_messages(lookup).make_list()
    assert table is not None
    listed = {read(row[0]): [read(cell) for cell in row[1:]] for row in table.rows}
    assert listed["my_msgs/msg/Fall"][:2] == ["message", "3"]
    assert listed["my_msgs/msg/Fall"][-2:] == ["Fall", "/g/eye/o"]
    assert list(listed) == sorted(listed)


def test_messages_inside_of_messages_are_used_where_these_are(lookup: Lookup) -> None:
    architecture = lookup.architecture
    users = collect_messages(architecture, [architecture.types["Fall"]], ())
    assert users["builtin_interfaces/msg/Time"] == ("type:Fall",)
    assert set(users) == {
        "my_msgs/msg/Fall",
        "std_msgs/msg/Header",
        "builtin_interfaces/msg/Time",
        "geometry_msgs/msg/Point",
    }


def test_of_many_topics_the_list_names_the_first_and_leads_to_all(
    lookup: Lookup, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(message_pages, "_MAX_NAMED_TOPICS", 0)
    table = make_messages(lookup).make_list()
    assert table is not None
    (cell,) = (row[-1] for row in table.rows if read(row[0]) == "my_msgs/msg/Fall")
    assert [(run.text, run.ref, run.code) for run in cell] == [("1 more", "message:my_msgs/msg/Fall", False)]
