"""Whose element an edit changes: a reviewer sees that a branch reaches into what belongs to another partner."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import replace

from archgen.compare import Change, Comparison
from archgen.compare.edits import Edit
from archgen.compare.key_phrases import shorten_text
from archgen.views.changes.partner_names import name_each

_TITLE = re.compile(r" \([^()`]*\)")
"""What stands behind an id whose element has another title."""
_LIST_OF_NAMES = re.compile(r",? (?:and )?`")


def name_owner(edit: Edit, comparison: Comparison, partner_names: Mapping[str, str], known_owner: str = "") -> Edit:
    """Return an edit that says whose element it changes, unless that is known from its heading, or there is only one
    partner.
    """
    if edit.element_kind == "component_type" and all(each.element_kind != "component_type" for each in edit.changes):
        return edit  # of a selection only what follows the type: whose that is, the sentence says itself
    owners = [_find_owner(change, comparison) for change in edit.changes]
    owner = owners[0] if len(set(owners)) == 1 else None
    if not owner or len(partner_names) < 2 or owner == known_owner:  # noqa: PLR2004 - with one partner nothing is foreign
        return edit
    names = dict.fromkeys([edit.element_id, *(change.old_id for change in edit.changes if change.old_id)])
    places = [(edit.text.find(ticked), len(ticked)) for ticked in (f"`{shorten_text(name)}`" for name in names)]
    start, length = min(((place, size) for place, size in places if place >= 0), default=(0, 0))
    title = _TITLE.match(edit.text, start + length)
    end = title.end() if title else start + length
    head, tail = edit.text[:end], edit.text[end:]
    if not length or _LIST_OF_NAMES.match(tail):
        return edit
    return replace(edit, text=f"{head} of {name_each([owner], partner_names)[0]}{tail}")


def find_group_owner(group_id: str, comparison: Comparison) -> str:
    """Return who owned a group before the change, or owns it if it is new; empty for nobody."""
    versions = comparison.versions
    common_id = group_id
    if ("group", group_id) not in versions.elements_after:
        common_id = comparison.matched_ids.common_id("group", group_id)
    element = versions.elements_before.get(("group", common_id)) or versions.elements_after.get(("group", common_id))
    return (element.owner if element else None) or ""


def _find_owner(change: Change, comparison: Comparison) -> str | None:
    """Return who owned an element before the change, or owns it if it is new; None where the sentence says it anyway."""
    if change.element_kind == "partner" or change.key == "owner":
        return None
    kind = "input" if change.element_kind == "connection" else change.element_kind
    common_id = change.element_id
    if change.kind == "removed":
        common_id = comparison.matched_ids.common_id(kind, change.element_id)
    versions = comparison.versions
    element = versions.elements_before.get((kind, common_id)) or versions.elements_after.get((kind, common_id))
    return element.owner if element else None
