"""The explorer's page without scripts: what flows from one group to another, each type once."""

from __future__ import annotations

from collections.abc import Callable

from archgen.model.architecture import Architecture
from archgen.views.lookup import make_lookup
from archgen.views.pages.explorer_page import make_explorer_blocks
from archgen.views.shapes import Inlines, Paragraph, Table

Derived = Callable[[str], Architecture]
ROBOT = """\
archgen: 1
groups:
  sense:
    title: Sensing
    components:
      eye: {outputs: {OUTPUTS}}
      ear: {inputs: {seen: eye.o0}, outputs: {sound: Noise}}
  act: {title: Acting, components: {arm: {inputs: {INPUTS}}}}
"""


def plain(inlines: Inlines) -> str:
    return "".join(part.text for part in inlines)


def make_robot(count: int) -> str:
    """Return a robot with so many flows from its eye to its arm, of a type each, one from its ear, and one inside."""
    outputs = ", ".join(f"o{number}: T{number}" for number in range(count))
    inputs = ", ".join(["i: ear.sound", *(f"i{number}: eye.o{number}" for number in range(count))])
    return ROBOT.replace("OUTPUTS", outputs).replace("INPUTS", inputs)


def test_flows_are_counted_from_group_to_group_and_of_many_types_the_first_are_named(derived: Derived) -> None:
    words, table = make_explorer_blocks(make_lookup(derived(make_robot(7))), ())
    assert isinstance(words, Paragraph)
    assert plain(words.inlines).endswith("Single ports stand in the table of all connections.")
    assert isinstance(table, Table)
    assert [[plain(cell) for cell in row] for row in table.rows] == [
        ["Sensing", "itself", "1", "T0"],
        ["Sensing", "Acting", "8", "Noise, T0, T1, T2, T3, T4 and 2 more"],
    ]
    assert [[each.ref for each in row[0]] for row in table.rows] == [["group:sense"], ["group:sense"]]


def test_where_nothing_flows_there_is_no_table(derived: Derived) -> None:
    alone = "archgen: 1\ngroups: {g: {components: {a: {outputs: {o: T}}}}}\n"
    (words,) = make_explorer_blocks(make_lookup(derived(alone)), ())
    assert isinstance(words, Paragraph)
