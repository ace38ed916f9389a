"""How a project reviews changes: the branch to compare with, the severity of breaking changes, accepted changes."""

from __future__ import annotations

from dataclasses import dataclass, field

from archgen.diagnostics.diagnostic import Severity
from archgen.diagnostics.source_span import NO_SPAN, Span

AGREEMENT_FOLDER, AGREEMENT_SUFFIX = "review", ".yaml"


def agreement_file(partner_id: str) -> str:
    """Return the file in which a partner says what it agrees on, from the project's folder."""
    return f"{AGREEMENT_FOLDER}/{partner_id}{AGREEMENT_SUFFIX}"


def is_agreement_file(file: str) -> bool:
    """Whether a file is one in which a partner says what it agrees on."""
    folder, _, name = file.rpartition("/")
    return folder == AGREEMENT_FOLDER and name.endswith(AGREEMENT_SUFFIX)


@dataclass(frozen=True, slots=True)
class AcceptedChange:
    """A breaking change that was agreed on: the element as the diff names it, what of it changed, and the reason.

    Without a `key` it excuses nothing, since it would excuse whatever happens to the element later.
    """

    element: str
    reason: str
    key: str | None = None
    at: Span = field(default=NO_SPAN, compare=False, repr=False)

    @property
    def partner(self) -> str | None:
        """Return the partner in whose own file the entry stands, None if it stands in any other file."""
        if not is_agreement_file(self.at.file):
            return None
        return self.at.file.removeprefix(f"{AGREEMENT_FOLDER}/").removesuffix(AGREEMENT_SUFFIX)


@dataclass(frozen=True, slots=True)
class ReviewSettings:
    """The section `review`. `main` is the branch that changes are compared with, None to ask git.

    `breaking` is the severity of a change that breaks another partner's part, None if not written. `backends` are the
    project's own backends that may run in the review of a pull request.
    """

    main: str | None = None
    breaking: Severity | None = None
    accepted: tuple[AcceptedChange, ...] = ()
    backends: tuple[str, ...] = ()
