"""One side of a comparison."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from archgen.diagnostic import Diagnostic
from archgen.model.architecture import Architecture


@dataclass(frozen=True, slots=True)
class Version:
    """One side. `rules` are the project's settings of rules, `chapters` its texts by path in the report's `order`.

    `unnamed` are `id` and `title` where the project does not say them: then they are made from the name of a folder or file.
    """

    architecture: Architecture
    findings: tuple[Diagnostic, ...] = ()
    rules: Mapping[str, str] = field(default_factory=dict)
    chapters: Mapping[str, str] = field(default_factory=dict)
    order: tuple[str, ...] = ()
    silenced: tuple[Diagnostic, ...] = ()
    """What a comment or a setting keeps out of the findings."""
    unnamed: frozenset[str] = frozenset()
