"""Ownership: the elements and files of each partner, and those without an owner."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from archgen.model.architecture import Architecture, Partner

Places = Mapping[tuple[str, str], tuple[str, ...]]
"""Files of each element, by kind (`group`, `component`, `node`) and full id."""
SORTS = ("group", "component", "node")
"""Kinds of element that have owners."""


@dataclass(frozen=True, slots=True)
class Owned:
    """What one partner owns: element ids by kind, and the files that define them.

    `partner` is None for what has no owner.
    """

    partner: Partner | None
    elements: Mapping[str, tuple[str, ...]]
    files: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Ownership:
    """What each partner owns, what nobody owns, and the owners of each file (empty for a file without owner)."""

    partners: tuple[Owned, ...]
    nobody: Owned
    files: Mapping[str, tuple[Partner, ...]]


def ownership(architecture: Architecture, places: Places, files: tuple[str, ...]) -> Ownership:
    """Find out who owns which elements and files.

    A file that defines elements of several partners belongs to all of them. Planned nodes that no file defines are left
    out.
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
    # Owners in the order in which partners are declared, whatever the order of the elements.
    of_file = {file: tuple(partners[name] for name in partners if name in mine) for file, mine in found.items()}
    made = []
    for partner in partners.values():
        held = {key for key, mine in owners.items() if partner.id in mine}
        made.append(Owned(partner, _by_sort(owners, held), tuple(f for f, by in of_file.items() if partner in by)))
    free = {key for key, mine in owners.items() if not mine}
    nobody = Owned(None, _by_sort(owners, free), tuple(file for file, by in of_file.items() if not by))
    return Ownership(tuple(made), nobody, of_file)


def _by_sort(order: Mapping[tuple[str, str], object], held: set[tuple[str, str]]) -> dict[str, tuple[str, ...]]:
    """Return the chosen ids by kind, in the order of the elements."""
    return {sort: tuple(name for each, name in order if each == sort and (each, name) in held) for sort in SORTS}
