"""The wording of a comparison that all formats share: signs, headings, what is only text, figures of chains."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Literal

from archgen.compare import ChainChange, Change, Comparison
from archgen.timing.analysis import ChainResult
from archgen.timing.sums import boundless
from archgen.timing.wording import duration
from archgen.views.shapes import Inlines, Text
from archgen.views.words import plural

SIGNS = {"added": "+", "removed": "\u2212", "changed": "~", "renamed": "→", "moved": "→"}
"""A sign for each kind of change, so that nothing depends on colour."""
_MARKS: dict[str, Literal["added", "removed", "changed"]] = {"added": "added", "removed": "removed"}
_SECTIONS = {
    "project": "Project",
    "chapter": "Chapters",
    "partner": "Partners",
    "use_case": "Use cases",
    "requirement": "Requirements",
    "type": "Types",
    "message": "Message definitions",
    "node": "Nodes",
    "port": "Nodes",
    "host": "Hosts",
    "container": "Containers",
    "link": "Links",
    "chain": "Chains",
    "policy": "Policies",
    "view": "Views",
}
"""The headings for changes outside of all groups, in the order of the document."""
_TEXT_SORTS = frozenset({"chapter", "view", "use_case"})
_TEXT_KEYS = frozenset(
    {"title", "description", "functionality", "comment", "tags", "layout", "colour", "text", "external"}
)
_TEXT_STARTS = ("urls.", "performance.")


@dataclass(frozen=True, slots=True)
class Part:
    """The changes below one heading. `group_id` is empty for changes outside of all groups."""

    id: str
    title: str
    changes: tuple[Change, ...]

    @property
    def heading(self) -> str:
        """Return the heading as one line of text."""
        return f"{self.id}: {self.title}" if self.id and self.title else self.title or self.id


def parts(changes: Iterable[Change], found: Comparison) -> Iterator[Part]:
    """Group changes by the group of their element, then those outside of all groups by kind."""
    groups = {**found.before.architecture.groups, **found.after.architecture.groups}
    held: dict[tuple[bool, str], list[Change]] = {}
    for change in changes:
        # Kinds without a heading are those inside of groups: their ids begin with the group's.
        name = _SECTIONS.get(change.sort)
        held.setdefault((name is not None, name or change.element.partition(".")[0]), []).append(change)
    for outside, name in sorted(key for key in held if not key[0]):
        yield Part(name, groups[name].title if name in groups else "", tuple(held[outside, name]))
    for name in dict.fromkeys(_SECTIONS.values()):
        if (True, name) in held:
            yield Part("", name, tuple(held[True, name]))


def textual(change: Change) -> bool:
    """Whether a change only concerns texts, pictures and addresses: nothing of the system itself."""
    if change.kind == "changed" and change.key:
        return change.sort in _TEXT_SORTS or change.key in _TEXT_KEYS or change.key.startswith(_TEXT_STARTS)
    return change.sort in _TEXT_SORTS


def summary(found: Comparison) -> str:
    """Count what changed, and name whom it concerns and breaks: `3 changes (1 added, 2 removed); concerns certh`."""
    concerns = f"; concerns {', '.join(found.owners)}" if found.owners else ""
    losers = broken(found.changes)
    return counted(found) + concerns + (f"; breaks {', '.join(losers)}" if losers else "")


def counted(found: Comparison) -> str:
    """Count changes and findings: `3 changes (1 added, 2 removed), 1 new finding`."""
    counts = by_kind(found.changes)
    words = [plural(len(found.changes), "change") + (f" ({counts})" if counts else "")]
    words += [plural(len(found.new), "new finding")] if found.new else []
    words += [plural(len(found.cured), "cured finding")] if found.cured else []
    words += [plural(len(found.silenced), "silenced finding")] if found.silenced else []
    return ", ".join(words)


def by_kind(changes: Iterable[Change]) -> str:
    """Count changes by kind: `1 added, 2 removed`."""
    kinds = Counter(str(change.kind) for change in changes)
    return ", ".join(f"{kinds[kind]} {kind}" for kind in SIGNS if kinds[kind])


def broken(changes: Iterable[Change]) -> tuple[str, ...]:
    """Return the partners for whom something breaks, sorted."""
    return tuple(sorted({partner for change in changes for partner in change.broken}))


REFUSED = "`review.breaking: error` refuses this: mend it, or agree on it and write the reason below `review: accepted:` at the element."
"""What to do about changes that the project's policy refuses."""


def reasons(change: Change) -> dict[str, list[str]]:
    """Return each reason why a change breaks somebody, with the partners it breaks."""
    found: dict[str, list[str]] = {}
    for each in change.breaks:
        found.setdefault(each.why, []).append(each.partner)
    return found


def accepted(change: Change, found: Comparison) -> str:
    """Describe why a breaking change is accepted, and whether the entry is older; empty if it is not."""
    if change.accepted is None:
        return ""
    older = found.before.architecture.review.accepted.get(change.element)
    # Old entries count, since many teams agree first; whoever reviews should see that this one was not written for the
    # change (docs/decisions/0007-breaking-changes.md).
    entry = " (by an entry that was there before)" if older and older.reason == change.accepted else ""
    return f"accepted{entry}: {change.accepted}"


def runs(text: str) -> Inlines:
    """Split a sentence into runs, with what is in backticks as code; a backtick without a second one is a backtick."""
    # Splitting with one capturing group alternates: odd pieces were in backticks.
    pieces = re.split(r"`([^`]*)`", text)
    return tuple(Text(piece, code=at % 2 == 1) for at, piece in enumerate(pieces) if piece)


def sign(change: Change) -> Text:
    """Return the sign of a change as a run."""
    return Text(SIGNS[change.kind], strong=True, change=_MARKS.get(change.kind, "changed"))


def bound(result: ChainResult | None) -> str:
    """Format how long a chain takes at most."""
    if result is None:
        return "not there"
    if boundless(result.bound):
        return "no bound"
    if result.bound.value is None:
        return "unknown"
    return ("" if result.bound.complete else "at least ") + duration(result.bound.value)


def grown(each: ChainChange) -> str:
    """Format by how much a bound grew or shrank; empty if that is unknown or nothing."""
    # The difference to an "at least" is no difference.
    old, new = (side.bound.value if side and side.bound.complete else None for side in (each.before, each.after))
    if old is None or new is None or old == new:
        return ""
    return f"{'+' if new > old else '-'}{duration(abs(new - old))}"


def deadline(each: ChainChange) -> str:
    """Format the deadline of the second version; if it changed, with the old one."""
    old, new = (_deadline(side) for side in (each.before, each.after))
    if each.before and each.after and old != new:
        return f"{old or 'none'} → {new or 'none'}"
    return new or old


def _deadline(result: ChainResult | None) -> str:
    return duration(result.deadline.value) if result and result.deadline and result.deadline.value else ""


def verdict(each: ChainChange) -> str:
    """Format whether the deadline is met, and whether it was before if that differs."""
    old, new = (
        side.verdict if side and side.deadline and side.deadline.value else "" for side in (each.before, each.after)
    )
    if not new:
        return ""
    return f"{new} (was {old})" if old and old != new else new
