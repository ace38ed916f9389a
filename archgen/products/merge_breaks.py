"""What open branches break only together: each breaks nobody by itself, and whichever is merged second does."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from archgen.compare import Change, Comparison
from archgen.compare.matched_ids import MatchedIds
from archgen.merge.branch_merge import JointBreaks
from archgen.pipeline import CheckedProject
from archgen.products.break_findings import find_breaks
from archgen.products.compared_versions import ProjectVersion, compare_named_versions
from archgen.views.changes.partner_names import name_each, name_partners

_BreakIdentity = tuple[str, str, str, str, str | None]


def find_joint_breaks(
    base: CheckedProject, ours: CheckedProject, theirs: CheckedProject, merged: CheckedProject
) -> JointBreaks:
    """Compare each side with the merged project, and keep the breaks that the other side's change does not make alone.

    `base` is what both sides began with. What a side breaks by itself its own review tells.
    """
    # What could not be read may break anybody: nothing that is found without it is certain.
    if not merged.architecture.partners or any(each.reading_errors for each in (base, ours, theirs, merged)):
        return JointBreaks()
    after_ours, after_theirs = _compare(ours, merged), _compare(theirs, merged)
    by_theirs, by_ours = replace(after_ours, changes=()), replace(after_theirs, changes=())
    # Most merges break nobody: then nobody has to know what either side breaks alone.
    if _breaks_anybody(after_ours):
        known = _list_breaks(base, theirs, _compare(base, ours).matched_ids, after_theirs.matched_ids)
        by_theirs = _leave_out(after_ours, known)
    if _breaks_anybody(after_theirs):
        known = _list_breaks(base, ours, _compare(base, theirs).matched_ids, after_ours.matched_ids)
        by_ours = _leave_out(after_theirs, known)
    partners = {
        name
        for comparison in (by_theirs, by_ours)
        for change in comparison.changes
        for name in name_each(change.unheard_partners, name_partners(comparison))
    }
    return JointBreaks(find_breaks(by_theirs, merged), find_breaks(by_ours, merged), tuple(sorted(partners)))


def _compare(before: CheckedProject, after: CheckedProject) -> Comparison:
    return compare_named_versions(ProjectVersion("", before), ProjectVersion("", after))


def _breaks_anybody(comparison: Comparison) -> bool:
    return any(change.unheard_partners for change in comparison.changes)


def _list_breaks(
    base: CheckedProject, changed: CheckedProject, old_renames: MatchedIds, new_renames: MatchedIds
) -> frozenset[_BreakIdentity]:
    """Return what one side breaks by itself, under the ids that the other side gave to what was there and is there still."""
    return frozenset(
        identity
        for change in _compare(base, changed).changes
        for identity in _identify_breaks(change, old_renames if change.kind == "removed" else new_renames)
    )


def _leave_out(comparison: Comparison, known: frozenset[_BreakIdentity]) -> Comparison:
    no_renames = MatchedIds()
    changes = tuple(
        replace(
            change,
            breaks=tuple(
                each
                for each, identity in zip(change.breaks, _identify_breaks(change, no_renames), strict=True)
                if identity not in known
            ),
        )
        for change in comparison.changes
    )
    return replace(comparison, changes=changes)


def _identify_breaks(change: Change, renamed_ids: MatchedIds) -> Iterator[_BreakIdentity]:
    """Yield what tells each break of a change from others; its reason names who else is hit, which is no other break."""
    kind = "input" if change.element_kind == "connection" else change.element_kind
    element_id = renamed_ids.common_id(kind, change.element_id)
    for each in change.breaks:
        yield each.partner, each.category, kind, element_id, change.key
