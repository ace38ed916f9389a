"""Changes as a reviewer counts them: what one edit brought about is one item, told in one sentence.

The changes themselves stay as they are: programs read them, and what is accepted names them.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Literal

from archgen.compare.comparison import Change, ChangeKind, Comparison, PartnerBreak
from archgen.compare.kinds import ELEMENT_KINDS
from archgen.compare.reshaped_components import find_reshapings
from archgen.compare.reshaping import Reshaping
from archgen.compare.sentence_words import tick_names
from archgen.diagnostics.common_wording import join_words

EditKind = Literal[ChangeKind, "split", "merged", "copied"]
_NUMBERED_KINDS = frozenset({"requirement", "use_case"})
_MAX_PAIRS = 6
"""How many old and new ids one sentence names."""
_SURE_CONFIDENCE = 0.85


@dataclass(frozen=True, slots=True)
class Edit:
    """One edit with all changes that it brought about, and the element that it is shown with."""

    kind: EditKind
    element_kind: str
    element_id: str
    text: str
    changes: tuple[Change, ...]
    confidence: float = 1.0
    """How sure it is that the changes are one edit."""
    related_ids: tuple[str, ...] = ()
    """What a component was split into, what was merged into it, or what it is a copy of."""

    @property
    def breaks(self) -> tuple[PartnerBreak, ...]:
        """Return the losses of partners, each once."""
        return tuple(dict.fromkeys(each for change in self.changes for each in change.breaks))

    @property
    def broken_partners(self) -> tuple[str, ...]:
        """Return the partners who lose something, sorted."""
        return tuple(sorted({each.partner for each in self.breaks}))


def list_edits(comparison: Comparison) -> tuple[Edit, ...]:
    """Return the edits behind the changes of a comparison, in the order of the first change of each."""
    positions = {id(change): position for position, change in enumerate(comparison.changes)}
    left_changes = list(comparison.changes)
    edits: list[Edit] = []
    for edit in _find_joint_edits(comparison, left_changes):
        edits.append(edit)
        folded_ids = set(map(id, edit.changes))
        left_changes[:] = (change for change in left_changes if id(change) not in folded_ids)
    edits += (
        Edit(change.kind, change.element_kind, change.element_id, change.text, (change,), change.confidence)
        for change in left_changes
    )
    return tuple(sorted(edits, key=lambda edit: min(positions[id(change)] for change in edit.changes)))


def _find_joint_edits(comparison: Comparison, left_changes: Sequence[Change]) -> Iterator[Edit]:
    """Yield the edits of several changes. `left_changes` are those of no edit so far: the caller takes them out."""
    for reshaping in find_reshapings(comparison):
        members = tuple(change for change in left_changes if reshaping.brought_about(change))
        if members:
            yield _join_reshaping(reshaping, members)
    yield from _exchanged_ids(left_changes)
    yield from _other_numbers(left_changes)
    yield from _new_titles(left_changes)
    yield from _keys_of_one_element(left_changes)


def _join_reshaping(reshaping: Reshaping, members: tuple[Change, ...]) -> Edit:
    confidence = reshaping.confidence
    note = "" if confidence >= _SURE_CONFIDENCE else f" (recognised with {round(confidence * 100)} % confidence)"
    text = reshaping.text + note
    if reshaping.kind == "copied":
        sentence, _, effects = members[0].text.partition("; ")
        text = "; ".join(filter(None, (f"{sentence}, {text}", effects)))
    return Edit(reshaping.kind, "component", reshaping.component_id, text, members, confidence, reshaping.related_ids)


def _exchanged_ids(changes: Iterable[Change]) -> Iterator[Edit]:
    """Yield the pairs of components that have each other's ids now."""
    renames = {
        (change.old_id or "", change.element_id): change for change in changes if _is_rename(change, {"component"})
    }
    for (old_id, new_id), change in renames.items():
        other_change = renames.get((new_id, old_id))
        if other_change and old_id < new_id:
            effects = [each.text.partition("; ")[2] for each in (change, other_change)]
            text = "; ".join(
                filter(None, (f"components {tick_names((old_id, new_id))} have exchanged their ids", *effects))
            )
            yield Edit("renamed", "component", new_id, text, (change, other_change), change.confidence)


def _other_numbers(changes: Iterable[Change]) -> Iterator[Edit]:
    """Yield the requirements, and the use cases, that only got other ids."""
    for kind in ("use_case", "requirement"):
        renames = [change for change in changes if _is_rename(change, {kind}) and change.confidence >= _SURE_CONFIDENCE]
        if len(renames) > 1:
            pairs = [f"`{change.old_id}` → `{change.element_id}`" for change in renames]
            surplus = len(pairs) - _MAX_PAIRS
            shown_pairs = pairs if surplus <= 0 else [*pairs[:_MAX_PAIRS], f"{surplus} more"]
            text = f"{len(renames)} {ELEMENT_KINDS[kind].kind_word}s got other ids: {join_words(shown_pairs)}"
            confidence = min(change.confidence for change in renames)
            yield Edit("renamed", kind, renames[0].element_id, text, tuple(renames), confidence)


def _is_rename(change: Change, kinds: Iterable[str]) -> bool:
    return change.kind in {"renamed", "moved"} and change.element_kind in kinds


def _new_titles(changes: Iterable[Change]) -> Iterator[Edit]:
    """Yield the renames of elements that got another title with their id."""
    titles = {(each.element_kind, each.element_id): each for each in changes if each.key == "title"}
    for change in list(changes):
        title_change = titles.get((change.element_kind, change.element_id))
        if title_change and change.kind in {"renamed", "moved"}:
            sentence, separator, effects = change.text.partition("; ")
            title = title_change.text.partition(": ")[2]
            text = f"{sentence}, {title}{separator}{effects}"
            yield Edit(
                change.kind, change.element_kind, change.element_id, text, (change, title_change), change.confidence
            )


def _keys_of_one_element(changes: Iterable[Change]) -> Iterator[Edit]:
    """Yield the changed keys of one element that say how its timing is other than before, or that have one effect."""
    by_cause: dict[object, list[Change]] = {}
    for change in changes:
        if change.kind == "changed" and change.key and ": " in change.text:
            section = "timing" if change.key.startswith("timing.") else "" if change.breaks else change.key
            losses = frozenset((each.partner, each.reason) for each in change.breaks)
            by_cause.setdefault((change.element_kind, change.element_id, section, losses), []).append(change)
    for members in by_cause.values():
        subject = members[0].text.partition(": ")[0]
        if len(members) > 1 and all(change.text.startswith(f"{subject}: ") for change in members):
            text = f"{subject}: {join_words([change.text.removeprefix(f'{subject}: ') for change in members])}"
            first = members[0]
            yield Edit("changed", first.element_kind, first.element_id, text, tuple(members))
