"""The wording of a comparison that all formats share: signs, headings of groups, what is only text."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import Literal

from archgen.compare import Change, Comparison
from archgen.compare.edits import Edit, EditKind
from archgen.compare.kinds import ELEMENT_KINDS, Effect, find_effect
from archgen.diagnostics.natural_order import order_naturally
from archgen.frozen import dataclass
from archgen.views.changes.breaking_items import find_group_owner, name_owner
from archgen.views.changes.named_elements import name_each
from archgen.views.shapes import Inlines, Text

CHANGE_SIGNS = {
    **dict.fromkeys(("renamed", "moved", "split", "merged"), "→"),
    **dict.fromkeys(("added", "copied"), "+"),
    "removed": "\u2212",
    "changed": "~",
}
"""A sign for each kind of change, so that nothing depends on colour."""
BREAK_SIGN = "!"
"""The sign of what breaks another partner, in pictures."""
_CHANGE_MARKS: dict[str, Literal["added", "removed", "changed"]] = {
    "added": "added",
    "copied": "added",
    "removed": "removed",
}


@dataclass(frozen=True, slots=True)
class ChangeGroup:
    """The changes below one heading. `group_id` is empty for changes outside of all groups, `owner` where nobody owns
    the group, or all belongs to one partner.
    """

    group_id: str
    title: str
    changes: tuple[Edit, ...]
    owner: str = ""

    @property
    def heading(self) -> str:
        """Return the heading as one line of text."""
        name = f"{self.group_id}: {self.title}" if self.group_id and self.title else self.title or self.group_id
        return f"{name} ({self.owner})" if self.owner else name


def group_changes(
    changes: Iterable[Edit], comparison: Comparison, partner_names: Mapping[str, str]
) -> Iterator[ChangeGroup]:
    """Group changes by the group of their element, then those outside of all groups by kind."""
    groups = {**comparison.before.architecture.groups, **comparison.after.architecture.groups}
    changes_by_heading: dict[tuple[bool, str], list[Edit]] = {}
    for change in changes:
        # Kinds without a heading are those inside of groups: their ids begin with the group's.
        heading_name = ELEMENT_KINDS[change.element_kind].heading
        changes_by_heading.setdefault(
            (heading_name is not None, heading_name or change.element_id.partition(".")[0]), []
        ).append(change)
    for is_ungrouped, heading_name in sorted(
        (key for key in changes_by_heading if not key[0]), key=lambda each: order_naturally(each[1])
    ):
        group_owner = find_group_owner(heading_name, comparison)
        yield ChangeGroup(
            heading_name,
            groups[heading_name].title if heading_name in groups else "",
            tuple(
                name_owner(edit, comparison, partner_names, group_owner)
                for edit in changes_by_heading[is_ungrouped, heading_name]
            ),
            # With one partner nobody asks.
            name_each([group_owner], partner_names)[0] if group_owner and len(partner_names) > 1 else "",
        )
    for heading_name in dict.fromkeys(kind.heading for kind in ELEMENT_KINDS.values() if kind.heading):
        if (True, heading_name) in changes_by_heading:
            edits = changes_by_heading[True, heading_name]
            yield ChangeGroup("", heading_name, tuple(name_owner(edit, comparison, partner_names) for edit in edits))


def is_textual(change: Change) -> bool:
    """Whether a change only concerns texts, pictures and addresses: nothing of the system itself."""
    return find_effect(change.element_kind, change.key) is Effect.TEXT


def count_by_kind(changes: Iterable[Edit]) -> str:
    """Count changes by kind: `1 added, 2 removed`."""
    kinds = Counter(str(change.kind) for change in changes)
    return ", ".join(f"{kinds[kind]} {kind}" for kind in CHANGE_SIGNS if kinds[kind])


def text_runs(
    text: str, titles: Mapping[str, str] | None = None, find_reference: Callable[[str], str | None] = lambda _id: None
) -> Inlines:
    """Split a sentence into runs, with what is in backticks as code; a backtick without a second one is a backtick.

    With `titles`, elements are called by them, each a link to what `find_reference` returns for its id.
    """
    # Splitting with one capturing group alternates: odd pieces were in backticks.
    pieces = re.split(r"`([^`]*)`", text)
    return tuple(
        _name_run(piece, titles or {}, find_reference) if index % 2 else Text(piece)
        for index, piece in enumerate(pieces)
        if piece
    )


def _name_run(name: str, titles: Mapping[str, str], find_reference: Callable[[str], str | None]) -> Text:
    return Text(titles[name], ref=find_reference(name), emphasis=True) if name in titles else Text(name, code=True)


def choose_mark(kind: EditKind) -> Literal["added", "removed", "changed"]:
    """Return the mark by which emitters colour a kind of change."""
    return _CHANGE_MARKS.get(kind, "changed")
