"""Which findings are new, cured, or only hidden."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from archgen.compare.compare_versions import judge_findings
from archgen.compare.matched_ids import MatchedIds
from archgen.diagnostics.diagnostic import Diagnostic, Severity
from archgen.diagnostics.source_span import NO_SPAN


def read_findings(text: str) -> tuple[Diagnostic, ...]:
    """Read `rule element, !rule element`; `!` is an error."""
    findings = []
    for entry in filter(None, text.split(", ")):
        rule, name = entry.removeprefix("!").split(" ")
        severity = Severity.ERROR if entry.startswith("!") else Severity.WARNING
        findings.append(Diagnostic(rule, f"something about `{name}`", NO_SPAN, severity, element=name))
    return tuple(findings)


def read_version(findings: str, hidden: str = "", waiting: str = "", unread: str = "") -> Any:  # noqa: ANN401
    """Return a version with findings, those hidden in it, rules that wait, and keys that could not be read."""
    return SimpleNamespace(
        findings=read_findings(findings),
        silenced_findings=read_findings(hidden),
        waiting_rules=frozenset(waiting.split()),
        architecture=SimpleNamespace(unread_keys=frozenset(unread.split())),
    )


def judge(before: Any, after: Any, matched: MatchedIds | None = None) -> str:  # noqa: ANN401
    """Return `new / cured / silenced`."""
    judged = judge_findings(before, after, matched or MatchedIds())
    return " / ".join(", ".join(f"{each.rule} {each.message.split('`')[1]}" for each in part) for part in judged)


@pytest.mark.parametrize(
    ("before", "after", "expected"),
    [
        (read_version("r a"), read_version("r a"), " /  / "),
        (read_version(""), read_version("r a"), "r a /  / "),
        (read_version("r a"), read_version(""), " / r a / "),
        (read_version("r a, r b"), read_version("r b, r c"), "r c / r a / "),
        (read_version("r a, r a"), read_version("r a"), " / r a / "),
        (read_version("r a"), read_version("", hidden="r a"), " /  / r a"),
        (read_version("r a, r a"), read_version("", hidden="r a"), " / r a / r a"),
        # What was not judged before is new only as an error.
        (read_version("", unread="x"), read_version("r a, !s a"), "s a /  / "),
        (read_version("", waiting="x"), read_version("r a, !s a"), "s a /  / "),
        (read_version("", waiting="x", unread="x"), read_version("r a, !s a"), "s a /  / "),
        # What is not judged now is not cured.
        (read_version("r a, s a"), read_version("", waiting="r"), " / s a / "),
    ],
)
def test_a_finding_is_new_or_cured_or_hidden(before: Any, after: Any, expected: str) -> None:  # noqa: ANN401
    assert judge(before, after) == expected


def test_a_finding_of_a_renamed_element_is_the_same() -> None:
    matched = MatchedIds()
    matched.add_pair("node", "a", "b")
    assert judge(read_version("r a"), read_version("r b"), matched) == " /  / "
