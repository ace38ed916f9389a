"""Say of each finding in which variants it holds: one that holds in all of them, and in the project itself, is told once."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence

from archgen.diagnostics import Diagnostic, Span, join_words
from archgen.frozen import replace
from archgen.model.variant import BASE_NAME

UNUSED_RULES = frozenset(
    {
        *("uncovered-requirement", "unread-input", "unread-output", "unused-ignore", "unused-node"),
        *("unused-parameter-file", "unused-type"),
    }
)
"""Rules that report what nothing needs: what the project itself or one of its variants needs, something needs."""
MISSING_RULES = frozenset(
    {
        *("absent-core", "borrowed-call", "borrowed-message", "disconnected-component", "empty-reference"),
        *("half-written", "missing-detail", "unaccounted-topic", "unfed-input", "unfed-output"),
        *("unjustified-component", "unjustified-node", "unlinked-hosts", "unmapped-component", "unmapped-type"),
        *("unnamed-source", "unpublished-frame", "unpublished-output", "unset-parameter", "unsubscribed-input"),
    }
)
"""Rules that report what is not written: what every variant writes is not missing in the project itself."""
_ABSENCE_RULES = frozenset({"unknown-reference", "unknown-requirement"})
"""Rules about names that nothing has: what the project itself has, a variant has taken away."""
_ABSENCE_HELP = "it is not there in this variant: drop what names it, or write in `changes` what is there instead"


def join_findings(
    findings_by_variant: Mapping[str, Sequence[Diagnostic]],
    waiting_rules: Mapping[str, frozenset[str]],
    variant_places: Collection[Span],
) -> tuple[Diagnostic, ...]:
    """Return the findings of a project and its variants, by name, each once and with the variants in which it holds.

    A rule that waits in a variant says nothing of it: what it finds in the project itself counts as found there. What
    is missing in the project itself and given by every variant is not missing; what one of them needs is not unused.
    `variant_places` are those of all names and values that the variants write.
    """
    names = tuple(findings_by_variant)
    holding: dict[Diagnostic, list[str]] = {}
    # The first of each: what others say of it besides is the same.
    told: list[tuple[Diagnostic, list[str]]] = []
    for name, findings in findings_by_variant.items():
        for finding in findings:
            holders = holding.setdefault(replace(finding, labels=(), help=None), [])
            if not holders:
                told.append((finding, holders))
            if not holders or holders[-1] != name:
                holders.append(name)
    for finding, holders in told:
        if holders[0] == BASE_NAME:
            holders += [name for name in names if finding.rule in waiting_rules[name] and name not in holders]
            holders.sort(key=names.index)
    joined = [
        finding if len(holders) == len(names) else _name_variants(finding, holders, names, variant_places)
        for finding, holders in told
        if not _is_explained(finding, holders, names)
    ]
    return tuple(sorted(joined, key=lambda each: each.sort_key))


def _is_explained(finding: Diagnostic, holders: Sequence[str], names: Sequence[str]) -> bool:
    """Whether what a finding says is right in each variant by itself, and not of the project with all of them."""
    if len(names) == 1 or len(holders) == len(names):
        return False
    if finding.rule in UNUSED_RULES:
        return True
    return finding.rule in MISSING_RULES and BASE_NAME in names and list(holders) == [BASE_NAME]


def _name_variants(
    finding: Diagnostic, holders: Sequence[str], names: Sequence[str], variant_places: Collection[Span]
) -> Diagnostic:
    """Return a finding with the variants in which it holds; one that does not hold in the project itself says it."""
    absent_names = tuple(name for name in names if name not in holders and name != BASE_NAME)
    message, help_line = finding.message, finding.help
    if finding.rule in _ABSENCE_RULES and BASE_NAME not in holders:
        # What the project itself writes is right there: no slip, and nothing that is still to be declared.
        help_line = help_line if help_line and finding.span in variant_places else _ABSENCE_HELP
    if BASE_NAME not in holders:
        # In the message, by which findings are told apart: a baseline knows one of a variant as such.
        message = f"{message} (in {_phrase_holders(holders, absent_names)})"
    return replace(finding, message=message, help=help_line, variants=tuple(holders), absent_variants=absent_names)


def _phrase_holders(holders: Sequence[str], absent_names: Sequence[str]) -> str:
    """Return the variants in which something holds, in words: by those in which it does not, where that is shorter."""
    if len(holders) > 1 and not absent_names:
        return "every variant"
    if len(holders) > 2 * len(absent_names):
        return (
            f"every variant but {_tick_names(absent_names)}" if absent_names else f"the variant {_tick_names(holders)}"
        )
    return f"the variant{'s' if len(holders) > 1 else ''} {_tick_names(holders)}"


def _tick_names(names: Sequence[str]) -> str:
    return join_words([f"`{name}`" for name in names], "and")


def phrase_absence(finding: Diagnostic) -> str:
    """Return where a finding of the project itself holds, in words; empty where that is everywhere, or in its message."""
    if BASE_NAME not in finding.variants:
        return ""
    holders = [name for name in finding.variants if name != BASE_NAME]
    if not holders:
        return "it holds in no variant"
    absent_names = finding.absent_variants
    if absent_names and len(holders) > len(absent_names):
        return f"it does not hold in the variant{'s' if len(absent_names) > 1 else ''} {_tick_names(absent_names)}"
    return f"of the variants it holds in {_tick_names(holders)}{' only' if len(holders) == 1 else ''}"
