"""What is different in the variants of a project, and what a change breaks in them beside what it breaks in the project itself."""

from __future__ import annotations

from archgen.compare import Change, Comparison
from archgen.compare.breaking_changes import sort_breaks_first
from archgen.compare.comparison import PartnerBreak
from archgen.diagnostics import Severity, join_words
from archgen.frozen import replace

_ChangeIdentity = tuple[str, str, str, str | None, str | None, str]


def add_variant_breaks(comparison: Comparison, variant_comparisons: dict[str, Comparison]) -> Comparison:
    """Return the comparison of a project with what its change breaks in variants only.

    `variant_comparisons` are those of the variants, by id, each between the same two versions.
    """
    if comparison.policy.gravest is Severity.OFF:
        return comparison
    base_changes = {_identify_change(change): change for change in comparison.changes}
    broken_changes: dict[_ChangeIdentity, Change] = {}
    holders: dict[tuple[_ChangeIdentity, PartnerBreak], list[str]] = {}
    for name, variant_comparison in variant_comparisons.items():
        for change in variant_comparison.changes:
            identity = _identify_change(change)
            known_losses = (
                set(map(_identify_loss, base_changes[identity].breaks)) if identity in base_changes else set()
            )
            for each in change.breaks:
                if _identify_loss(each) not in known_losses:
                    broken_changes.setdefault(identity, change)
                    holders.setdefault((identity, each), []).append(name)
    if not broken_changes:
        return comparison
    losses = {
        identity: tuple((each, tuple(names)) for (holder, each), names in holders.items() if holder == identity)
        for identity in broken_changes
    }
    changes = [
        _add_losses(change, broken_changes[identity], losses[identity]) if identity in losses else change
        for identity, change in base_changes.items()
    ]
    changes += (
        _tell_variant_change(change, losses[identity])
        for identity, change in broken_changes.items()
        if identity not in base_changes
    )
    idle_everywhere = [set(each.idle_acceptances) for each in variant_comparisons.values()]
    return replace(
        comparison,
        changes=sort_breaks_first(changes, comparison.policy),
        idle_acceptances=tuple(
            entry for entry in comparison.idle_acceptances if all(entry in idle for idle in idle_everywhere)
        ),
        concerned_owners=tuple(
            sorted({*comparison.concerned_owners, *(partner_break.partner for _, partner_break in holders)})
        ),
    )


def _identify_change(change: Change) -> _ChangeIdentity:
    """Return what tells a change from others, in whichever variant it is seen."""
    return change.kind, change.element_kind, change.element_id, change.old_id, change.key, repr(change.after)


def _identify_loss(partner_break: PartnerBreak) -> tuple[str, str]:
    # Reasons may differ in figures and in who else is hit: a partner loses the same once.
    return partner_break.partner, partner_break.category


def _add_losses(change: Change, in_variant: Change, losses: tuple[tuple[PartnerBreak, tuple[str, ...]], ...]) -> Change:
    """Return a change of the project itself that breaks more in variants: each loss says in which."""
    told_losses = (
        replace(each, reason=f"{each.reason}, {_phrase_variants(names)}", variants=names) for each, names in losses
    )
    claims = in_variant.claims if not change.breaks else tuple(e for e in change.claims if e in in_variant.claims)
    return replace(change, breaks=(*change.breaks, *told_losses), claims=claims)


def _tell_variant_change(change: Change, losses: tuple[tuple[PartnerBreak, tuple[str, ...]], ...]) -> Change:
    """Return a change that there is in variants only; it says in which."""
    names = tuple(dict.fromkeys(name for _, holders in losses for name in holders))
    told_losses = tuple(replace(each, variants=holders) for each, holders in losses)
    return replace(change, breaks=told_losses, text=f"{_phrase_variants(names)}: {change.text}", variants=names)


def _phrase_variants(names: tuple[str, ...]) -> str:
    return f"in the variant{'s' if len(names) > 1 else ''} {join_words([f'`{name}`' for name in names])}"
