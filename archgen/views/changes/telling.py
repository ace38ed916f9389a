"""How a comparison is told, in every format: signs, headings, what weighs most, the figures of chains."""

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
"""What happened, by a sign: colour is never needed to tell it."""
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
"""The headings of what stands in no group, in their order."""
_TEXT_SORTS = frozenset({"chapter", "view", "use_case"})
_TEXT_KEYS = frozenset(
    {"title", "description", "functionality", "comment", "tags", "layout", "colour", "text", "external"}
)
_TEXT_STARTS = ("urls.", "performance.")


@dataclass(frozen=True, slots=True)
class Part:
    """The changes below one heading. `id` is the group's, empty for what stands in no group."""

    id: str
    title: str
    changes: tuple[Change, ...]

    @property
    def heading(self) -> str:
        """Name it in a line of text."""
        return f"{self.id}: {self.title}" if self.id and self.title else self.title or self.id


def parts(changes: Iterable[Change], found: Comparison) -> Iterator[Part]:
    """Put changes of a comparison under the group that they stand in, then those that stand in none by sort."""
    groups = {**found.before.architecture.groups, **found.after.architecture.groups}
    held: dict[tuple[bool, str], list[Change]] = {}
    for change in changes:
        name = _SECTIONS.get(change.sort)
        held.setdefault((name is not None, name or change.element.partition(".")[0]), []).append(change)
    for outside, name in sorted(key for key in held if not key[0]):
        yield Part(name, groups[name].title if name in groups else "", tuple(held[outside, name]))
    for name in dict.fromkeys(_SECTIONS.values()):
        if (True, name) in held:
            yield Part("", name, tuple(held[True, name]))


def textual(change: Change) -> bool:
    """Say whether a change only concerns texts, pictures and addresses: nothing of the system itself."""
    if change.kind == "changed" and change.key:
        return change.sort in _TEXT_SORTS or change.key in _TEXT_KEYS or change.key.startswith(_TEXT_STARTS)
    return change.sort in _TEXT_SORTS


def summary(found: Comparison) -> str:
    """Count what changed, and name whom it concerns and breaks: `3 changes (1 added, 2 removed); concerns certh`."""
    concerns = f"; concerns {', '.join(found.owners)}" if found.owners else ""
    losers = broken(found.changes)
    return counted(found) + concerns + (f"; breaks {', '.join(losers)}" if losers else "")


def counted(found: Comparison) -> str:
    """Count what changed."""
    counts = by_kind(found.changes)
    words = [plural(len(found.changes), "change") + (f" ({counts})" if counts else "")]
    words += [plural(len(found.new), "new finding")] if found.new else []
    words += [plural(len(found.cured), "cured finding")] if found.cured else []
    words += [plural(len(found.silenced), "silenced finding")] if found.silenced else []
    return ", ".join(words)


def by_kind(changes: Iterable[Change]) -> str:
    """Count changes by what happened: `1 added, 2 removed`."""
    kinds = Counter(str(change.kind) for change in changes)
    return ", ".join(f"{kinds[kind]} {kind}" for kind in SIGNS if kinds[kind])


def broken(changes: Iterable[Change]) -> tuple[str, ...]:
    """Name the partners for whom something breaks."""
    return tuple(sorted({partner for change in changes for partner in change.broken}))


REFUSED = "`review.breaking: error` refuses this: mend it, or agree on it and write the reason below `review: accepted:` at the element."
"""What to do about changes that the project's policy does not let pass."""


def reasons(change: Change) -> dict[str, list[str]]:
    """Give each reason why a change breaks somebody, with the partners whom it breaks."""
    found: dict[str, list[str]] = {}
    for each in change.breaks:
        found.setdefault(each.why, []).append(each.partner)
    return found


def accepted(change: Change, found: Comparison) -> str:
    """Say why a breaking change is accepted, and whether that was written for another change; empty where it is not."""
    if change.accepted is None:
        return ""
    older = found.before.architecture.review.accepted.get(change.element)
    entry = " (by an entry that was there before)" if older and older.reason == change.accepted else ""
    return f"accepted{entry}: {change.accepted}"


def runs(text: str) -> Inlines:
    """Give a sentence with what stands in backticks as code; a backtick without its second one is a backtick."""
    pieces = re.split(r"`([^`]*)`", text)
    return tuple(Text(piece, code=at % 2 == 1) for at, piece in enumerate(pieces) if piece)


def sign(change: Change) -> Text:
    """Give the sign of a change."""
    return Text(SIGNS[change.kind], strong=True, change=_MARKS.get(change.kind, "changed"))


def bound(result: ChainResult | None) -> str:
    """Say how long a chain takes at most."""
    if result is None:
        return "not there"
    if boundless(result.bound):
        return "no bound"
    if result.bound.value is None:
        return "unknown"
    return ("" if result.bound.complete else "at least ") + duration(result.bound.value)


def grown(each: ChainChange) -> str:
    """Say by how much a bound grew or shrank; empty where that is not known or nothing."""
    old, new = (side.bound.value if side and side.bound.complete else None for side in (each.before, each.after))
    if old is None or new is None or old == new:
        return ""
    return f"{'+' if new > old else '-'}{duration(abs(new - old))}"


def deadline(each: ChainChange) -> str:
    """Give the deadline that counts now; where it changed, the one before too."""
    old, new = (_deadline(side) for side in (each.before, each.after))
    if each.before and each.after and old != new:
        return f"{old or 'none'} → {new or 'none'}"
    return new or old


def _deadline(result: ChainResult | None) -> str:
    return duration(result.deadline.value) if result and result.deadline and result.deadline.value else ""


def verdict(each: ChainChange) -> str:
    """Say whether the deadline is met, and whether it was before where that is another thing."""
    old, new = (
        side.verdict if side and side.deadline and side.deadline.value else "" for side in (each.before, each.after)
    )
    if not new:
        return ""
    return f"{new} (was {old})" if old and old != new else new
