"""How a project judges changes: against which branch, how much a broken partner matters, what was agreed."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from archgen.diagnostic import Severity
from archgen.source import NOWHERE, Span


@dataclass(frozen=True, slots=True)
class Accepted:
    """A breaking change that was agreed: the element as the diff names it, why, and which key where only that one is meant."""

    element: str
    reason: str
    key: str | None = None
    at: Span = field(default=NOWHERE, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Review:
    """The section `review`. `main` is the branch that changes are compared with, None where git tells.

    `breaking` is how much a change matters that breaks another partner's part, None where nobody says. `backends` are the
    project's own backends that may run in the review of a pull request.
    """

    main: str | None = None
    breaking: Severity | None = None
    accepted: Mapping[str, Accepted] = field(default_factory=dict)
    backends: tuple[str, ...] = ()
