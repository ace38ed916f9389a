"""Tests of the trace between requirements and components."""

from __future__ import annotations

from collections.abc import Callable

from archgen.analyses.requirement_tracing import uncovered_requirement, unjustified_component, unknown_requirement

Found = Callable[..., list[str]]

_TEXT = """
    requirement R-1
    requirement R-2
    component a.one requirements=R-1,R-22
    component a.two requirements="Quiet at night"
    component a.three requirements=
    component a.four
"""


def test_an_undeclared_requirement_is_unknown_and_free_text_is_not(found: Found) -> None:
    assert found(unknown_requirement, _TEXT) == ["3: no requirement `R-22` is declared"]


def test_a_requirement_that_nobody_serves_is_uncovered(found: Found) -> None:
    text = f"{_TEXT}\nrequirement S-100"
    assert found(uncovered_requirement, text) == ["8: no component and no chain serves the requirement `S-100`"]


def test_a_slip_in_an_id_leaves_no_requirement_uncovered(found: Found) -> None:
    assert found(uncovered_requirement, "requirement Q-10\ncomponent a.one requirements=Q-1O") == []


def test_a_component_without_requirement_is_unjustified_once_there_are_any(found: Found) -> None:
    assert found(unjustified_component, _TEXT) == [
        "5: `a.three` serves no requirement",
        "6: `a.four` serves no requirement",
    ]
    assert found(unjustified_component, "component a.four") == []


def test_the_help_guesses_the_requirement(sketch: Callable[..., object]) -> None:
    (diagnostic,) = unknown_requirement(sketch(_TEXT))  # type: ignore[arg-type]
    assert diagnostic.help == "did you mean `R-2`?"
