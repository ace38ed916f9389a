"""The requirements that earlier imports brought, found again by what the other tool calls them: it stands in their hints."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

from archgen.plugin.model import Requirement

HINTS_KEY = "reqif"


@dataclass(frozen=True, slots=True)
class KnownRequirements:
    """Ids of requirements by the identifiers of their objects, and by the ids of the other tool as it writes them."""

    by_identifier: Mapping[str, str] = field(default_factory=dict)
    by_foreign_id: Mapping[str, str] = field(default_factory=dict)

    def find(self, identifier: str, foreign_id: str) -> str | None:
        """Return the requirement of an object: its identifier stays the same when somebody numbers anew in the other tool."""
        return self.by_identifier.get(identifier) or self.by_foreign_id.get(foreign_id)


def find_known_requirements(requirements: Iterable[Requirement]) -> KnownRequirements:
    """Return what the hints of requirements say of other tools."""
    by_identifier: dict[str, str] = {}
    by_foreign_id: dict[str, str] = {}
    for requirement in requirements:
        hints = requirement.annotations.hints.get(HINTS_KEY)
        if not isinstance(hints, Mapping):
            continue
        for key, ids in (("identifier", by_identifier), ("id", by_foreign_id)):
            # Whoever writes `id: 12` by hand means the text.
            if (name := hints.get(key)) not in {None, ""}:
                ids.setdefault(str(name), requirement.id)
    return KnownRequirements(by_identifier, by_foreign_id)


def make_identity_hints(identifier: str, foreign_id: str, made_id: str) -> dict[str, dict[str, str]]:
    """Return the hints by which the next import finds a requirement, whatever it is called by then."""
    named = {"identifier": identifier, "id": foreign_id if foreign_id != made_id else ""}
    return {HINTS_KEY: {key: text for key, text in named.items() if text}}
