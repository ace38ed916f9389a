"""Differences that the project accepts: they are no findings, and are found where they are there no longer."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence

from archgen.conformance.conformance_rules import RULE_NAMES
from archgen.diagnostics import Diagnostic, did_you_mean
from archgen.model.project_settings import AcceptedDifference

_ALSO_SETTABLE = RULE_NAMES - {"stale-acceptance", "stale-import"}


def apply_acceptances(
    findings: Sequence[Diagnostic],
    accepted: Iterable[AcceptedDifference],
    was_compared: Callable[[str], bool],
    has_tag: Callable[[str], bool],
) -> tuple[list[Diagnostic], int]:
    """Return the findings without accepted ones and with those about acceptances, and how many were accepted.

    `was_compared` is whether something was seen of an element, so that a difference that is not found is gone; `has_tag` is
    whether the repository has a tag.
    """
    found = {(each.element, each.rule) for each in findings}
    expected: set[tuple[str | None, str]] = set()
    about_acceptances: list[Diagnostic] = []
    for acceptance in accepted:
        expected |= {(acceptance.element, rule) for rule in acceptance.rules}
        about_acceptances += _judge_acceptance(acceptance, found, was_compared, has_tag)
    kept = [each for each in findings if (each.element, each.rule) not in expected]
    return [*kept, *about_acceptances], len(findings) - len(kept)


def _judge_acceptance(
    acceptance: AcceptedDifference,
    found: set[tuple[str | None, str]],
    was_compared: Callable[[str], bool],
    has_tag: Callable[[str], bool],
) -> Iterator[Diagnostic]:
    def report(message: str, help_line: str) -> Diagnostic:
        return Diagnostic("stale-acceptance", message, acceptance.at, help=help_line, element=acceptance.element)

    for rule in acceptance.rules:
        if rule not in _ALSO_SETTABLE:
            guess = did_you_mean(rule, _ALSO_SETTABLE) or f"rules are {', '.join(sorted(_ALSO_SETTABLE))}"
            yield report(f"no rule `{rule}` compares a robot with the design: nothing is accepted", guess)
        elif (acceptance.element, rule) not in found and was_compared(acceptance.element):
            yield report(f"`{acceptance.element}` has no `{rule}` any more: nothing is left to accept", "take this out")
    if acceptance.until is not None and has_tag(acceptance.until):
        message = (
            f"the difference at `{acceptance.element}` was accepted until `{acceptance.until}`, which is there by now"
        )
        yield report(message, "mend it, or accept it until a later tag, with the reason")
