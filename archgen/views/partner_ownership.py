"""Ownership: the elements and files of each partner, and those without an owner."""

from __future__ import annotations

from collections.abc import Mapping

from archgen.frozen import dataclass
from archgen.model.architecture import Architecture, Partner
from archgen.model.element_ids import ElementFiles

OWNED_KINDS = ("group", "component", "node")
"""Kinds of element that have owners."""


@dataclass(frozen=True, slots=True)
class OwnershipShare:
    """What one partner owns: element ids by kind, and the files that define them.

    `partner` is None for what has no owner.
    """

    partner: Partner | None
    elements: Mapping[str, tuple[str, ...]]
    files: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Ownership:
    """What each partner owns, what nobody owns, and the owners of each file (empty for a file without owner).

    `shared_files` hold no elements, and all partners answer for them: messages and libraries.
    """

    partners: tuple[OwnershipShare, ...]
    nobody: OwnershipShare
    files: Mapping[str, tuple[Partner, ...]]
    shared_files: tuple[str, ...] = ()


def assign_ownership(architecture: Architecture, element_files: ElementFiles, files: tuple[str, ...]) -> Ownership:
    """Find out who owns which elements and files.

    A file that defines elements of several partners belongs to all of them. Planned nodes that no file defines are left
    out.
    """
    owners = {
        **{("group", item.id): item.owners for item in architecture.groups.values()},
        **{("component", item.id): item.owners for item in architecture.components.values()},
        **{("node", item.id): item.owners for item in architecture.nodes.values() if item.written},
    }
    owners_by_file: dict[str, set[str]] = {file: set() for file in files}
    for element, owner_ids in owners.items():
        for file in element_files.get(element, ()):
            owners_by_file.setdefault(file, set()).update(owner_ids)
    partners = architecture.partners
    # Owners in the order in which partners are declared, whatever the order of the elements.
    partners_by_file = {
        file: tuple(partners[name] for name in partners if name in owner_ids)
        for file, owner_ids in owners_by_file.items()
    }
    shares = []
    for partner in partners.values():
        owned_keys = {key for key, owner_ids in owners.items() if partner.id in owner_ids}
        shares.append(
            OwnershipShare(
                partner,
                _ids_by_kind(owners, owned_keys),
                tuple(f for f, file_partners in partners_by_file.items() if partner in file_partners),
            )
        )
    unowned_keys = {key for key, owner_ids in owners.items() if not owner_ids}
    nobody = OwnershipShare(
        None,
        _ids_by_kind(owners, unowned_keys),
        tuple(file for file, file_partners in partners_by_file.items() if not file_partners),
    )
    return Ownership(tuple(shares), nobody, partners_by_file)


def _ids_by_kind(
    element_keys: Mapping[tuple[str, str], object], chosen_keys: set[tuple[str, str]]
) -> dict[str, tuple[str, ...]]:
    """Return the chosen ids by kind, in the order of the elements."""
    return {
        kind: tuple(
            name for element_kind, name in element_keys if element_kind == kind and (element_kind, name) in chosen_keys
        )
        for kind in OWNED_KINDS
    }
