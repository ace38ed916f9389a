"""One side of a comparison."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from archgen.diagnostic import Diagnostic
from archgen.model.architecture import Architecture


@dataclass(frozen=True, slots=True)
class Version:
    """One side. `rules` are the project's settings of rules, `chapters` its texts by path in the report's `order`.

    `defaults` are the id and the title that the project has where it does not say so: the names of folders and files.
    """

    architecture: Architecture
    findings: tuple[Diagnostic, ...] = ()
    rules: Mapping[str, str] = field(default_factory=dict)
    chapters: Mapping[str, str] = field(default_factory=dict)
    order: tuple[str, ...] = ()
    defaults: tuple[str, str] = ("", "")
