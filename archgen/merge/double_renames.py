"""Find elements that two branches call otherwise, each in its own way: git merges the lines, and there are two of them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from archgen.compare.architecture_version import ArchitectureVersion
from archgen.compare.kinds import ELEMENT_KINDS, MATCHING_ORDER
from archgen.compare.match_elements import match_elements
from archgen.diagnostics import NO_SPAN, Span
from archgen.frozen import NamedTuple
from archgen.model.architecture import Architecture


class DoubleRename(NamedTuple):
    """An element that both sides recognisably renamed or moved; `at` is where one of the two stands that were merged."""

    old_id: str
    our_id: str
    their_id: str
    at: Span


def find_double_renames(
    base: Architecture, ours: Architecture, theirs: Architecture, merged: Architecture
) -> Iterator[DoubleRename]:
    """Yield the elements of `base` of which the merged architecture has two, under the ids that both sides gave them."""
    candidates = []
    for kind in MATCHING_ORDER:
        old, our, their, both = (_list_elements(kind, each) for each in (base, ours, theirs, merged))
        our_new, their_new = ((each.keys() - old.keys()) & both.keys() for each in (our, their))
        if old.keys() - our.keys() - their.keys() and our_new - their_new and their_new - our_new:
            candidates.append((kind, both))
    # To recognise elements takes time, and two branches that rename something of one kind are rare.
    if not candidates:
        return
    our_ids, their_ids = match_elements(base, ours).new_ids, match_elements(base, theirs).new_ids
    told_places: list[tuple[str, str]] = []
    for kind, merged_elements in candidates:
        for old_id, our_id in our_ids.get(kind, {}).items():
            their_id = their_ids.get(kind, {}).get(old_id, old_id)
            is_double = old_id not in {our_id, their_id} and our_id != their_id
            # With a component both of its names have all ports: the component is told.
            is_inner = any(
                our_id.startswith(f"{our}.") and their_id.startswith(f"{their}.") for our, their in told_places
            )
            if is_double and not is_inner and {our_id, their_id} <= merged_elements.keys():
                told_places.append((our_id, their_id))
                yield DoubleRename(old_id, our_id, their_id, getattr(merged_elements[our_id], "at", NO_SPAN))


def _list_elements(kind: str, architecture: Architecture) -> Mapping[str, object]:
    list_elements = ELEMENT_KINDS[kind].elements
    return list_elements(ArchitectureVersion(architecture)) if list_elements else {}
