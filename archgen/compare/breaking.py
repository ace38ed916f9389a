"""Decide which changes break another partner, whom and why, and which of them the project accepts."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import replace

from archgen.compare.change import Break, ChainChange, Change, Comparison
from archgen.compare.losses.both import Both, Loss
from archgen.compare.losses.causes import Causes
from archgen.compare.losses.connections import connections
from archgen.compare.losses.definitions import redefined, retyped
from archgen.compare.losses.full import overloaded, saturated
from archgen.compare.losses.late import late
from archgen.compare.losses.quality import weaker
from archgen.compare.losses.served import unserved
from archgen.compare.losses.topics import renamed_topics
from archgen.compare.owners import owners
from archgen.compare.timed import Timed
from archgen.diagnostic import Severity
from archgen.model.review import Accepted, Review

_LOSSES = (connections, retyped, redefined, renamed_topics, weaker, unserved)
_STRICTNESS = (Severity.OFF, Severity.NOTE, Severity.WARNING, Severity.ERROR)


def severity(before: Review, after: Review) -> Severity:
    """Return the stricter policy of both versions, so that no branch weakens the policy it is judged by."""
    return max((each.breaking or Severity.WARNING for each in (before, after)), key=_STRICTNESS.index)


def breaking(both: Both, chains: Sequence[ChainChange], timed: Timed | None) -> tuple[Change, ...]:
    """Add to each change whom it breaks and whether that is accepted; breaking changes come first, accepted ones after
    the rest of them.
    """
    if not both.changes or not (both.before.partners or both.after.partners):
        return tuple(both.changes)
    # An inner dict instead of a list: two finders may report the same loss of the same partner, and the order must
    # stay.
    found: dict[int, dict[Break, None]] = defaultdict(dict)
    for loss in _losses(both, chains, timed):
        found[loss.change][Break(loss.partner, loss.why)] = None
    # Only the second version's agreements count, although the stricter policy of both does: an acceptance belongs into
    # the branch that it is about (docs/decisions/0007-breaking-changes.md).
    accepted = both.after.review.accepted
    changes = [
        replace(change, breaks=tuple(found[place]), accepted=_reason(change, accepted.get(change.element)))
        if place in found
        else change
        for place, change in enumerate(both.changes)
    ]
    # The sort is stable: within each class the order of `change_order` remains.
    return tuple(sorted(changes, key=lambda change: (not change.breaks, change.accepted is not None)))


def _losses(both: Both, chains: Sequence[ChainChange], timed: Timed | None) -> Iterator[Loss]:
    for find in _LOSSES:
        yield from find(both)
    if timed:
        causes = Causes(both, timed)
        yield from late(both, chains, causes)
        yield from overloaded(both, causes)
        yield from saturated(both, causes)


def _reason(change: Change, entry: Accepted | None) -> str | None:
    return entry.reason if entry and entry.key in {None, change.key} else None


def idle(changes: Sequence[Change], review: Review) -> tuple[Accepted, ...]:
    """Return the accepted entries that name no breaking change."""
    every = review.accepted.values()
    return tuple(e for e in every if not any(c.breaks and c.element == e.element and _reason(c, e) for c in changes))


def only(found: Comparison) -> Comparison:
    """Keep only the changes that break somebody, without other changes, chains and findings."""
    changes = tuple(change for change in found.changes if change.breaks)
    concerned = owners(changes, found.told)
    return replace(found, changes=changes, new=(), cured=(), silenced=(), chains=(), owners=concerned, narrowed=True)
