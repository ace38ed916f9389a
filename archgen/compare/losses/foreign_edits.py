"""Edits of what belongs to somebody else: who changes written values of a partner's elements without standing for it.

The element's owner counts, whatever file it stands in, and what is written, not what follows from it: a reference that
goes with a rename, an instance that changes with its type, a connection that nobody wrote.
"""

from __future__ import annotations

from collections.abc import Iterator

from archgen.compare.agreements import find_partner_id
from archgen.compare.comparison import Change
from archgen.compare.losses.change_context import ChangeContext, PartnerLoss
from archgen.compare.matched_ids import MatchedIds
from archgen.compare.version_pair import ElementKey
from archgen.diagnostics import Severity, join_words
from archgen.frozen import NamedTuple
from archgen.model.architecture import Architecture
from archgen.model.project_settings import agreement_file

_AGREEMENT_KEYS = "review.accepted."


class _OwnedEdit(NamedTuple):
    """What an edit changes of one element: who owned it before, the one who answers for it first; nobody's: nobody."""

    change_index: int
    owners: tuple[str, ...]


def find_foreign_edits(context: ChangeContext) -> Iterator[PartnerLoss]:
    """Find the edits of elements of partners for whom their author does not stand.

    Where all that is changed belongs to one partner, and nobody can say who did it, that is a warning.
    """
    if context.followers is None or context.facts.is_decided:
        return
    edits = list(_list_edits(context))
    standing = {
        owner: context.facts.stands_for(find_partner_id(owner, context.matched_ids), context.before.partners)
        for owner in sorted({owner for edit in edits for owner in edit.owners})
    }
    everywhere = set(standing).intersection(*(edit.owners for edit in edits))
    losses: dict[PartnerLoss, None] = {}
    for edit in edits:
        if edit.owners and not any(standing[owner] for owner in edit.owners):
            may_be_own = any(standing[owner] is None for owner in everywhere.intersection(edit.owners))
            partner = _choose_partner(edit, context)
            reason = _describe_reason(partner, context, may_be_own=may_be_own)
            severity = Severity.WARNING if may_be_own else Severity.ERROR
            losses[PartnerLoss(edit.change_index, partner, reason, "foreign", at_most=severity)] = None
    yield from losses


def _describe_reason(partner: str, context: ChangeContext, *, may_be_own: bool) -> str:
    name = context.name_partner(partner)
    lead = f"edits what belongs to {name}"
    if may_be_own:
        return f"{lead}, and nobody can say whether the author stands for {name}"
    people = sorted({min(author) for author in context.facts.requesters or context.facts.authors if author})
    return f"{lead}, for whom {join_words([f'`{each}`' for each in people]) or 'the author'} does not stand"


def _choose_partner(edit: _OwnedEdit, context: ChangeContext) -> str:
    """Return the owner who said something of an edit, else the first one: one of several suffices."""
    change = context.changes[edit.change_index]
    files = {entry.at.file for entry in context.after.review.accepted if entry.element == change.element_id}
    speakers = [each for each in edit.owners if agreement_file(find_partner_id(each, context.matched_ids)) in files]
    return (speakers or edit.owners)[0]


def _list_edits(context: ChangeContext) -> Iterator[_OwnedEdit]:
    """Yield what is edited of each element that was there before; what is new in nobody's is no edit."""
    for index, change in enumerate(context.changes):
        if id(change) in (context.followers or ()) or (change.key or "").startswith(_AGREEMENT_KEYS):
            continue
        if change.element_kind == "connection":
            if _is_written(change, context):
                yield _OwnedEdit(index, _list_owners(("input", context.common_id(change)), context))
            continue
        for each in context.walk_change(change):
            if each.element_kind != "connection":
                for key in _find_edited(each, context):
                    owners = _list_owners(key, context)
                    if owners or each.kind != "added":
                        yield _OwnedEdit(index, owners)


def _find_edited(change: Change, context: ChangeContext) -> Iterator[ElementKey]:
    """Yield the elements that a change edits: itself, and in which something new stands, or something moved."""
    key = (change.element_kind, context.common_id(change))
    is_new = key not in context.versions.elements_before
    if not is_new:
        yield key
    element = context.versions.elements_after.get(key)
    # A port of which a node said nothing before is new, too.
    if element and (is_new or change.kind == "moved"):
        holders = [element.parent_key] if element.parent_key else []
        if element.kind == "node":
            holders += (("component", each) for each in element.component_refs)
        yield from (each for each in holders if each in context.versions.elements_before)


def _list_owners(key: ElementKey, context: ChangeContext) -> tuple[str, ...]:
    """Return who owned an element before the change, first who answers for it; of what is in another element, the owners
    of that, and of a node those of its components.
    """
    elements = context.versions.elements_before
    element = elements.get(key)
    if element and element.kind == "message" and element.file:
        # Its fields stand at a type, and belong to who owns that.
        types = [key for key, each in elements.items() if key[0] == "type" and each.values.get("message") == element.id]
        return tuple(owner for each in types for owner in _list_owners(each, context))
    if element is None or not element.owner:
        return ()
    co_owners = element.values.get("co_owners")
    owners = [element.owner, *(sorted(co_owners) if isinstance(co_owners, frozenset) else ())]
    holders = [element.parent_key] if element.kind in {"input", "output", "port"} else []
    holders += (("component", each) for each in element.component_refs if element.kind == "node")
    for holder in holders:
        holder_owners = _list_owners(holder, context) if holder else ()
        # A node may belong to somebody else than its component.
        owners += holder_owners if element.owner in holder_owners else ()
    return tuple(dict.fromkeys(owners))


def _is_written(change: Change, context: ChangeContext) -> bool:
    """Whether somebody wrote another source of an input, and not only what lives on elsewhere under its new name."""
    input_id = context.common_id(change)
    before = _list_written_sources(context.before, context.old_id("input", input_id), context.matched_ids)
    after = _list_written_sources(context.after, input_id, MatchedIds())
    return {context.output_heirs.get(each, each) for each in before} != after


def _list_written_sources(architecture: Architecture, input_id: str, matched_ids: MatchedIds) -> set[str]:
    """Return what an input names as its sources, by common ids."""
    port = architecture.inputs.get(input_id)
    return {
        matched_ids.common_id(connection.kind, connection.target)
        for connection in (port.connections if port else ())
        if not connection.is_made
    }
