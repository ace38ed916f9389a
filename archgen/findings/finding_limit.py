"""Keep the number of findings readable: of each rule so many, the rest counted."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace
from typing import TYPE_CHECKING

from archgen.analyses import NO_LONGER_LOOKED_FOR

if TYPE_CHECKING:
    from collections.abc import Sequence

    from archgen.diagnostics.diagnostic import Diagnostic

MAX_FINDINGS_PER_RULE = 1_000
"""Nobody reads more, and a stranger's 50 kB of policies can make 300,000 findings of 300 bytes each."""


def limit_findings(findings: Sequence[Diagnostic]) -> tuple[Diagnostic, ...]:
    """Return the first findings of each rule, in their order; one more says how many of the rule are left out.

    That one stands where the first finding that is left out would, and keeps its severity.
    """
    totals = Counter(finding.rule for finding in findings)
    bounded_rules = {finding.rule for finding in findings if finding.message == NO_LONGER_LOOKED_FOR}
    if all(total <= MAX_FINDINGS_PER_RULE for total in totals.values()):
        return tuple(findings)
    seen = Counter[str]()
    kept: list[Diagnostic] = []
    for finding in findings:
        seen[finding.rule] += 1
        if seen[finding.rule] <= MAX_FINDINGS_PER_RULE:
            kept.append(finding)
        elif seen[finding.rule] == MAX_FINDINGS_PER_RULE + 1:
            left_out = totals[finding.rule] - MAX_FINDINGS_PER_RULE
            at_least = "at least " if finding.rule in bounded_rules else ""
            message = f"{at_least}{left_out:,} more findings of this rule, from here on, are left out"
            kept.append(
                replace(finding, message=message, labels=(), help="mend some of the others first", element=None)
            )
    return tuple(kept)
