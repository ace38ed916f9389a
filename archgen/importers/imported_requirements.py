"""What a reader of another tool's requirements returns: requirements as data of the language, and what became of each object."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field
from typing import Any, Literal


@dataclass(frozen=True, slots=True)
class ObjectAccount:
    """What became of an object of the file: taken as `id`, left out on purpose, or not taken, and why."""

    fate: Literal["taken", "left out", "not taken"]
    name: str
    place: str
    id: str = ""
    reason: str = ""


@dataclass(slots=True)
class ImportedRequirements:
    """Requirements and use cases as data of the language by id, and the accounts of all objects, attributes, relations."""

    requirements: dict[str, dict[str, Any]] = field(default_factory=dict)
    use_cases: dict[str, dict[str, Any]] = field(default_factory=dict)
    accounts: list[ObjectAccount] = field(default_factory=list)
    unread_attributes: Counter[str] = field(default_factory=Counter)
    """How many objects have each attribute that is not taken."""
    unread_relations: Counter[str] = field(default_factory=Counter)
    closing_relations: tuple[tuple[str, str], ...] = ()
    """What is not taken, as (part, parent), since it would make a requirement a part of itself."""
