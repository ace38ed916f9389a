"""Who owns what: elements and files of each partner, and what nobody owns."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from archgen.model.architecture import Architecture, Partner

Places = Mapping[tuple[str, str], tuple[str, ...]]
"""Files of each element, by sort (`group`, `component`, `node`) and complete id."""
SORTS = ("group", "component", "node")


@dataclass(frozen=True, slots=True)
class Owned:
    """What a partner owns: ids by sort, and the files in which they stand."""

    partner: Partner | None
    elements: Mapping[str, tuple[str, ...]]
    files: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Ownership:
    """All partners with what they own, what nobody does, and the owners of every file (empty where there is none)."""

    partners: tuple[Owned, ...]
    nobody: Owned
    files: Mapping[str, tuple[Partner, ...]]


def ownership(architecture: Architecture, places: Places, files: tuple[str, ...]) -> Ownership:
    """Sort out who owns what; a file whose elements belong to several partners is theirs together. Planned nodes that
    nobody wrote are left out.
    """
    owners = {
        **{("group", each.id): each.owners for each in architecture.groups.values()},
        **{("component", each.id): each.owners for each in architecture.components.values()},
        **{("node", each.id): each.owners for each in architecture.nodes.values() if each.written},
    }
    found: dict[str, set[str]] = {file: set() for file in files}
    for element, mine in owners.items():
        for file in places.get(element, ()):
            found.setdefault(file, set()).update(mine)
    partners = architecture.partners
    of_file = {file: tuple(partners[name] for name in partners if name in mine) for file, mine in found.items()}
    made = []
    for partner in partners.values():
        held = {key for key, mine in owners.items() if partner.id in mine}
        made.append(Owned(partner, _by_sort(owners, held), tuple(f for f, by in of_file.items() if partner in by)))
    free = {key for key, mine in owners.items() if not mine}
    nobody = Owned(None, _by_sort(owners, free), tuple(file for file, by in of_file.items() if not by))
    return Ownership(tuple(made), nobody, of_file)


def _by_sort(order: Mapping[tuple[str, str], object], held: set[tuple[str, str]]) -> dict[str, tuple[str, ...]]:
    return {sort: tuple(name for each, name in order if each == sort and (each, name) in held) for sort in SORTS}
