"""Say of each finding in which variants it holds: one that holds in all of them, and in the project itself, is told once."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace

from archgen.diagnostics.common_wording import join_words
from archgen.diagnostics.diagnostic import Diagnostic
from archgen.model.variant import BASE_NAME

UNUSED_RULES = frozenset(
    {
        "uncovered-requirement",
        "unread-input",
        "unread-output",
        "unused-ignore",
        "unused-node",
        "unused-parameter-file",
        "unused-type",
    }
)
"""Rules that report what nothing needs: what the project itself or one of its variants needs, something needs."""
MISSING_RULES = frozenset(
    {
        "absent-core",
        "disconnected-component",
        "empty-reference",
        "half-written",
        "missing-detail",
        "unaccounted-topic",
        "unfed-input",
        "unfed-output",
        "unjustified-component",
        "unjustified-node",
        "unlinked-hosts",
        "unmapped-component",
        "unmapped-type",
        "unnamed-source",
        "unpublished-frame",
        "unpublished-output",
        "unset-parameter",
        "unsubscribed-input",
    }
)
"""Rules that report what is not written: what every variant writes is not missing in the project itself."""


def join_findings(findings_by_variant: Mapping[str, Sequence[Diagnostic]]) -> tuple[Diagnostic, ...]:
    """Return the findings of a project and its variants, by name, each once and with the variants in which it holds.

    What is missing in the project itself and given by every variant is not missing; what one of them needs is not
    unused.
    """
    names = tuple(findings_by_variant)
    holding: dict[Diagnostic, list[str]] = {}
    for name, findings in findings_by_variant.items():
        for finding in findings:
            holders = holding.setdefault(replace(finding, labels=(), help=None), [])
            if not holders or holders[-1] != name:
                holders.append(name)
    joined: dict[Diagnostic, Diagnostic] = {}
    for findings in findings_by_variant.values():
        for finding in findings:
            identity = replace(finding, labels=(), help=None)
            if identity not in joined and not _is_explained(finding, holding[identity], names):
                holders = holding[identity]
                joined[identity] = replace(finding, variants=() if len(holders) == len(names) else tuple(holders))
    return tuple(sorted(joined.values(), key=lambda each: each.sort_key))


def _is_explained(finding: Diagnostic, holders: Sequence[str], names: Sequence[str]) -> bool:
    """Whether what a finding says is right in each variant by itself, and not of the project with all of them."""
    if len(names) == 1 or len(holders) == len(names):
        return False
    if finding.rule in UNUSED_RULES:
        return True
    return finding.rule in MISSING_RULES and BASE_NAME in names and list(holders) == [BASE_NAME]


def phrase_variants(finding: Diagnostic) -> str:
    """Return in which variants a finding holds, in words; empty where it holds in all."""
    if not finding.variants:
        return ""
    quoted_names = [f"`{name}`" for name in finding.variants if name != BASE_NAME]
    plural = "s" if len(quoted_names) > 1 else ""
    variant_phrase = f"in the variant{plural} {join_words(quoted_names, 'and')}" if quoted_names else ""
    if BASE_NAME not in finding.variants:
        return variant_phrase
    return f"without a variant, and {variant_phrase}" if variant_phrase else "only without a variant"


def list_variant_names(findings: Iterable[Diagnostic]) -> tuple[str, ...]:
    """Return the variants that some findings name, in order of first mention."""
    return tuple(dict.fromkeys(name for finding in findings for name in finding.variants))
