"""Selectors: each form, each key, and where they are wrong."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from archgen.model.architecture import Architecture
from archgen.model.selector_evaluation import evaluate_selector
from archgen.model.selector_keys import matches_wildcard
from tests.selector_cases import (
    COMPOSED_FINDINGS,
    COMPOSED_ROBOT,
    FINDINGS,
    FOUND_NOTHING,
    ROBOT,
    SELECTED,
    SELECTED_NODES,
    WRONG,
)

Derived = Callable[[str], Architecture]


def names(derived: Derived, text: str) -> str:
    """Give the selected components by their names, in order."""
    architecture = derived(ROBOT)
    selection, problems = evaluate_selector(text, architecture, FINDINGS)
    assert problems == ()
    return " ".join(
        c.name if c.group != "driving" else f"d.{c.name}"
        for c in architecture.components.values()
        if c.id in selection.components
    )


@pytest.mark.parametrize(
    ("text", "selected"),
    SELECTED,
)
def test_what_is_selected(derived: Derived, text: str, selected: str) -> None:
    assert names(derived, text) == selected


@pytest.mark.parametrize(
    ("text", "nodes"),
    SELECTED_NODES,
)
def test_which_nodes_are_selected(derived: Derived, text: str, nodes: list[str]) -> None:
    selection, problems = evaluate_selector(text, derived(ROBOT))
    assert problems == ()
    assert sorted(selection.nodes) == nodes


@pytest.mark.parametrize(
    ("text", "selected"),
    [
        # About an output of the right arm: all that is inside.
        (
            "finding:unread-output",
            ["body.right.hand", "body.right.hand.finger", "body.right.joint", "body.right.planner"],
        ),
        # About what is not designed yet of the left hand: that alone.
        ("finding:unfed-output", ["body.left.hand"]),
    ],
)
def test_findings_about_composed_components_select_what_they_are_about(
    derived: Derived, text: str, selected: list[str]
) -> None:
    selection, problems = evaluate_selector(text, derived(COMPOSED_ROBOT), COMPOSED_FINDINGS)
    assert problems == ()
    assert sorted(selection.components) == selected


@pytest.mark.parametrize(
    ("text", "problem"),
    WRONG,
)
def test_what_is_wrong(derived: Derived, text: str, problem: str) -> None:
    selection, problems = evaluate_selector(text, derived(ROBOT))
    (only,) = problems
    assert only.severity == "error"
    assert f"{only.start}-{only.end} {only.message} | {only.help}".startswith(problem)
    assert selection.components == selection.nodes == frozenset()


@pytest.mark.parametrize(
    ("text", "message"),
    FOUND_NOTHING,
)
def test_what_selects_nothing_is_a_warning(derived: Derived, text: str, message: str) -> None:
    selection, (only,) = evaluate_selector(text, derived(ROBOT))
    assert (only.severity, f"{only.start}-{only.end} {only.message}") == ("warning", message)
    assert selection.components == {"sensing.lidar"}


@pytest.mark.parametrize(
    ("pattern", "text", "fits"),
    [
        ("a", "a", True),
        ("a", "ab", False),
        ("a*", "ab", True),
        ("*b", "ab", True),
        ("a*a", "a", False),
        ("*b*d*", "abcde", True),
        ("*d*b*", "abcde", False),
        ("a*b*a", "aba", True),
        ("*a" * 50 + "b", "a" * 2000, False),
    ],
)
def test_wildcards(pattern: str, text: str, fits: bool) -> None:  # noqa: FBT001
    assert matches_wildcard(pattern, text) is fits
