"""New components that are copies of one that was there, and how many are looked at."""

from __future__ import annotations

import pytest

from archgen.compare.element_relations import ElementRelations
from archgen.compare.matched_ids import MatchedIds
from archgen.compare.reshaping import find_copies
from tests.compare.conftest import Compared

HEAD = "groups:\n  g:\n    components:\n"
EYE = "      eye: {functionality: Sees all there is, outputs: {x: T, y: U}}\n"


def list_copies(compared: Compared, added: str) -> list[str]:
    """Return `copy of original confidence` of all components that are new."""
    comparison = compared(HEAD + EYE, HEAD + EYE + added)
    architecture = comparison.after.architecture
    ids = [name for name in architecture.components if name != "g.eye"]
    copies = find_copies(ids, comparison.versions, ElementRelations(architecture, MatchedIds().common_id))
    return [f"{each.component_id} {each.text} {each.confidence}" for each in copies]


@pytest.mark.parametrize(
    ("added", "expected"),
    [
        (
            "      ear: {functionality: Sees all there is, outputs: {x: T, y: U}}\n",
            ["g.ear a copy of `g.eye` 0.88"],
        ),
        ("      ear: {functionality: Hears, outputs: {x: T, y: U}}\n", []),
        ("      ear: {functionality: Sees all there is, outputs: {x: T}}\n", []),
        ("", []),
    ],
)
def test_a_copy_has_the_same_ports_and_nearly_all_else(compared: Compared, added: str, expected: list[str]) -> None:
    assert list_copies(compared, added) == expected


@pytest.mark.parametrize(("count", "found"), [(20, 20), (21, 0)])
def test_where_a_project_is_built_up_nothing_is_a_copy(compared: Compared, count: int, found: int) -> None:
    added = "".join(
        f"      e{number}: {{functionality: Sees all there is, outputs: {{x: T, y: U}}}}\n" for number in range(count)
    )
    assert len(list_copies(compared, added)) == found
