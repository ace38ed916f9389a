"""How a project reviews changes: the branch to compare with, the severity of breaking changes, accepted changes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from archgen.diagnostics.diagnostic import Severity
from archgen.diagnostics.source_span import NO_SPAN, Span


@dataclass(frozen=True, slots=True)
class AcceptedChange:
    """A breaking change that was agreed on: the element as the diff names it, and the reason.

    `key` limits the acceptance to one key of the element; None accepts all changes of it.
    """

    element: str
    reason: str
    key: str | None = None
    at: Span = field(default=NO_SPAN, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class ReviewSettings:
    """The section `review`. `main` is the branch that changes are compared with, None to ask git.

    `breaking` is the severity of a change that breaks another partner's part, None if not written. `backends` are the
    project's own backends that may run in the review of a pull request.
    """

    main: str | None = None
    breaking: Severity | None = None
    accepted: Mapping[str, AcceptedChange] = field(default_factory=dict)
    backends: tuple[str, ...] = ()
