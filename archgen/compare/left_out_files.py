"""Files that a project no longer reads though they are still there: one edit of `archgen.yaml` takes all in them away."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Sequence

from archgen.compare.comparison import Change, Comparison
from archgen.compare.key_phrases import tick_names
from archgen.compare.kinds import ELEMENT_KINDS
from archgen.diagnostics.common_wording import join_words
from archgen.frozen import dataclass

_MAX_FILES = 4
"""How many files one sentence names; the rest is counted."""
_INTERFACE_ENDINGS = (".msg", ".srv", ".action")


@dataclass(frozen=True, slots=True)
class LeftOutFiles:
    """What a setting no longer names: the sentence about it, and the removals that follow from it."""

    text: str
    removals: tuple[Change, ...]


def find_left_out(comparison: Comparison, changes: Sequence[Change]) -> Iterator[LeftOutFiles]:
    """Yield for each setting what it left out; nothing where only a file was left out from which nothing is gone."""
    elements = comparison.versions.elements_before.values()
    file_of_element = {(element.kind, element.own_id): element.file for element in elements}
    for setting in ("sources", "ros.interfaces"):
        files = [
            file
            for file in comparison.left_out_files
            if ("ros.interfaces" if file.endswith(_INTERFACE_ENDINGS) else "sources") == setting
        ]
        removals = tuple(
            change
            for change in changes
            if change.kind == "removed"
            and (
                file_of_element.get((change.element_kind, change.element_id)) in files
                or (
                    change.element_kind == "message"
                    and any(_defines_message(file, change.element_id) for file in files)
                )
            )
        )
        if removals:
            counts = _count_elements(removals)
            is_one = len(removals) == 1
            text = f"`{setting}` no longer names {tick_names(files, _MAX_FILES)}: {counts} {'is' if is_one else 'are'} not read any more"
            yield LeftOutFiles(text, removals)


def _defines_message(file: str, message: str) -> bool:
    """Whether a file is that of a message `package/msg/Name`: the package may be named elsewhere."""
    stem, _, ending = file.rpartition(".")
    return message.split("/")[1:] == [ending, stem.rpartition("/")[2]]


def _count_elements(removals: Iterable[Change]) -> str:
    """Count what is not read any more: `6 nodes and 1 chain`."""
    kinds = Counter(change.element_kind for change in removals)
    phrases = [f"{count} {ELEMENT_KINDS[kind].element_word}{'s' if count > 1 else ''}" for kind, count in kinds.items()]
    return join_words(phrases)


def find_affected_names(comparison: Comparison, removals: Iterable[Change]) -> frozenset[str]:
    """Return the ids of what is not read any more, and of the components that it was for."""
    removed_keys = {(change.element_kind, change.element_id) for change in removals}
    names = {name for _, name in removed_keys}
    for element in comparison.versions.elements_before.values():
        if (element.kind, element.own_id) in removed_keys:
            names.update(element.component_refs)
    return frozenset(names)
