"""Describe that an element changed hands: whose it is now, and who reads it and so has another counterpart."""

from __future__ import annotations

from archgen.compare.comparison import Change
from archgen.compare.kinds import ELEMENT_KINDS
from archgen.compare.partner_titles import name_partner
from archgen.compare.sentence_words import tick_names
from archgen.compare.version_pair import VersionPair


def describe_new_owner(change: Change, versions: VersionPair) -> str:
    """Return the sentence on another owner; empty for any other change."""
    if change.key != "owner":
        return ""
    kind_word = "" if "." in change.element_id else f"{ELEMENT_KINDS[change.element_kind].kind_word} "
    new_owner, old_owner = (
        name_partner(str(owner), versions.partner_names) if owner else "nobody"
        for owner in (change.after, change.before)
    )
    sentence = f"{kind_word}{tick_names([change.element_id])} belongs to {new_owner} now, not to {old_owner}"
    readers = _find_outer_readers(change, versions)
    return f"{sentence}; read by {tick_names(readers)}" if readers else sentence


def _find_outer_readers(change: Change, versions: VersionPair) -> list[str]:
    """Return the inputs outside of an element that read an output inside of it."""
    element = versions.elements_after.get((change.element_kind, change.element_id))
    holders = element.component_refs if element and change.element_kind == "node" else (change.element_id,)
    prefixes = tuple(f"{holder}." for holder in holders)
    return sorted(
        {
            reader
            for output, readers in versions.connections_after.readers_by_output.items()
            if prefixes and output.startswith(prefixes)
            for reader in readers
            if not reader.startswith(prefixes)
        }
    )
