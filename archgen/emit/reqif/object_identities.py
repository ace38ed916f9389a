"""What requirements are called in a file: what comes from another tool has the identifier and the id that it has there."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence

from archgen.views.requirement_exchange import ExchangedRequirement

_OWN_BEGINNINGS = (
    *("usecase-", "verification-", "datatype-", "type-", "attribute-", "word-", "relation-", "specification-"),
    *("place-", "header-"),
)
"""How the identifiers begin that archgen gives to anything but requirements."""
_IDENTIFIER = re.compile(r"[A-Za-z_][A-Za-z0-9_.-]{0,499}")


def assign_identifiers(requirements: Sequence[ExchangedRequirement]) -> Mapping[str, str]:
    """Return the identifiers of the objects of requirements, by the requirements' ids; no two are the same.

    One of another tool is kept where it can be one, and where nothing else in the file has it.
    """
    own_identifiers = {each.id: f"requirement-{each.id}" for each in requirements}
    used = set(own_identifiers.values())
    identifiers: dict[str, str] = {}
    for each in requirements:
        foreign = each.foreign_identifier
        is_kept = _IDENTIFIER.fullmatch(foreign) and not foreign.startswith(_OWN_BEGINNINGS) and foreign not in used
        identifiers[each.id] = foreign if is_kept else own_identifiers[each.id]
        used.add(identifiers[each.id])
    return identifiers
