"""The end of a long list of findings: how many of each rule, so that nobody counts them on the screen."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from archgen.diagnostics.diagnostic import Diagnostic

LONG_LIST = 20
"""Beyond so many findings, about three screens, a table says how many there are of each rule."""
WAITING_SENTENCE = "timing, views and unused elements are judged once these errors are gone"


def render_rule_table(findings: Sequence[Diagnostic]) -> Iterator[str]:
    """Yield the lines of a table of the rules of many findings, the gravest and most frequent first; few yield none."""
    if len(findings) <= LONG_LIST:
        return
    from archgen.emit.terminal.list_formats import format_columns

    # Rules that a project or a finding gives several severities have a row for each of them.
    counts = Counter((finding.rule, finding.effective_severity) for finding in findings)
    ordered_counts = sorted(counts.items(), key=lambda item: (-item[0][1].rank, -item[1], item[0][0]))
    rows = [(rule, str(severity), str(count)) for (rule, severity), count in ordered_counts]
    yield from format_columns(("rule", "severity", "findings"), rows).splitlines()
    yield ""
    yield "`archgen explain RULE` says what a rule asks for, and why"
