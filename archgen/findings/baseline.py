"""A baseline: which findings it knows, which of its entries are cured, and how it is written."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING

from archgen.emit import yaml
from archgen.identity import identity

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

    from archgen.diagnostic import Diagnostic, Rule
    from archgen.identity import Known

_HEADER = """\
# Findings that this project knows of: `archgen check --baseline` keeps them quiet, and only new ones count.
# Written by `archgen check --update-baseline`, which also settles conflicts in it: it writes the file anew.
"""


def divide(
    findings: Iterable[Diagnostic], known: Iterable[Known], rules: Mapping[str, Rule]
) -> tuple[tuple[Diagnostic, ...], tuple[Diagnostic, ...], tuple[Known, ...]]:
    """Return the findings that are new, those that are known, and the entries that are cured, with how many of each.

    Read and link errors are always new: nobody knows what is behind them.
    """
    known = tuple(known)
    left = Counter[object]()
    for entry in known:
        left[entry.identity] += entry.times
    new, old = [], []
    for finding in findings:
        # Identity leaves out lines and parts of the message (docs/decisions/0005-known-findings.md).
        key = identity(finding)
        # Counted, not just looked up: a second finding alike is new.
        if left[key] > 0 and not rules[finding.rule].fixed:
            left[key] -= 1
            old.append(finding)
        else:
            new.append(finding)
    cured = []
    for entry in reversed(known):  # of several alike the last ones go
        gone = min(entry.times, left[entry.identity])
        left[entry.identity] -= gone
        if gone:
            cured.append(entry._replace(times=gone))
    return tuple(new), tuple(old), tuple(reversed(cured))


def write(findings: Iterable[Diagnostic], rules: Mapping[str, Rule]) -> str:
    """Return the text of a baseline that knows these findings, sorted, without those that no baseline may know."""
    # Sorted by content and not by place: moving lines does not change the file.
    counts = Counter((d.rule, d.element or "", d.message) for d in findings if not rules[d.rule].fixed)
    if not counts:
        return f"{_HEADER}archgen_baseline: 1\nfindings: []\n"
    lines = (line for what, count in sorted(counts.items()) for line in _entry(*what, count))
    return "\n".join((f"{_HEADER}archgen_baseline: 1\nfindings:", *lines, ""))


def _entry(rule: str, element: str, message: str, count: int) -> Iterator[str]:
    """Yield the lines of one entry; empty keys are left out, so that a diff shows what matters."""
    yield f"  - rule: {yaml.scalar(rule)}"
    if element:
        yield f"    element: {yaml.scalar(element)}"
    yield f"    message: {yaml.scalar(message)}"
    if count > 1:
        yield f"    count: {count}"
