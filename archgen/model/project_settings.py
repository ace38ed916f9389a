"""What a project sets for verbs: how changes are reviewed, against which robot it is held, what is generated."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from typing import Literal

from archgen.diagnostics import NO_SPAN, Severity, Span
from archgen.frozen import dataclass, field, fields


@dataclass(frozen=True, slots=True)
class GenerateSettings:
    """The section `generate`. `into` is relative to the project's folder; of each backend its options, as texts."""

    into: str | None = None
    backends: Mapping[str, Mapping[str, str]] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class AcceptedDifference:
    """What the rules may find at an element, by the id that findings name, and why; `until` is the tag that ends it."""

    element: str
    rules: tuple[str, ...]
    reason: str
    until: str | None = None
    at: Span = field(default=NO_SPAN, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class ConformSettings:
    """The section `conform`. Paths in `against` are relative to the project's folder; `*` in `ignore` is any characters."""

    against: tuple[str, ...] = ()
    launch: tuple[str, ...] = ()
    ignore: tuple[str, ...] = ()
    accepted: tuple[AcceptedDifference, ...] = ()


AGREEMENT_FOLDER, AGREEMENT_SUFFIX = "review", ".yaml"
BreakCategory = Literal["wire", "promise", "meaning", "source", "foreign", "agreement"]
"""What a partner loses: what programs send each other, what was promised of it, what it means, or only the ids and files
that its own files name; `foreign` is what somebody else edits of its elements, `agreement` what it signed."""
BREAK_CATEGORIES: tuple[BreakCategory, ...] = ("wire", "promise", "meaning", "source", "foreign", "agreement")


def agreement_file(partner_id: str) -> str:
    """Return the file in which a partner says what it agrees on, from the project's folder."""
    return f"{AGREEMENT_FOLDER}/{partner_id}{AGREEMENT_SUFFIX}"


def is_agreement_file(file: str) -> bool:
    """Whether a file is one in which a partner says what it agrees on."""
    folder, _, name = file.rpartition("/")
    return folder == AGREEMENT_FOLDER and name.endswith(AGREEMENT_SUFFIX)


@dataclass(frozen=True, slots=True)
class BreakPolicy:
    """How serious it is to break a partner, for each category; the defaults are those of a project that says nothing."""

    wire: Severity = Severity.WARNING
    promise: Severity = Severity.WARNING
    meaning: Severity = Severity.WARNING
    source: Severity = Severity.NOTE
    foreign: Severity = Severity.OFF
    agreement: Severity = Severity.WARNING

    @classmethod
    def from_severity(cls, severity: Severity) -> BreakPolicy:
        """Return what a single severity means: texts and ids count no more than they do by default, nor do foreign edits.

        Files that say `error` may be older than these categories: no job may turn red over a text because of them.
        """
        return cls(severity, severity, min(severity, cls().meaning), min(severity, cls().source), agreement=severity)

    @property
    def gravest(self) -> Severity:
        """Return the severity of the category that counts most."""
        return max(self.severity_of(category) for category in BREAK_CATEGORIES)

    def severity_of(self, category: BreakCategory) -> Severity:
        """Return how serious a loss of a category is."""
        severity: Severity = getattr(self, category)
        return severity

    def combine_stricter(self, other: BreakPolicy) -> BreakPolicy:
        """Return the stricter severity of both policies for each category."""
        return BreakPolicy(*(max(getattr(self, each.name), getattr(other, each.name)) for each in fields(self)))

    def __str__(self) -> str:
        """Return the policy as files write it, in the shorter form where that says the same."""
        if self == BreakPolicy.from_severity(self.wire):
            return str(self.wire)
        severities = {category: self.severity_of(category) for category in BREAK_CATEGORIES}
        # Which is what it is where nobody writes it, as in all projects that are older.
        told = [f"{name}: {each}" for name, each in severities.items() if (name, each) != ("foreign", Severity.OFF)]
        return f"{{{', '.join(told)}}}"


@dataclass(frozen=True, slots=True)
class AcceptedChange:
    """A breaking change that was agreed on: the element as the diff names it, what of it changed, and the reason.

    Without a `key` it excuses nothing, since it would excuse whatever happens to the element later. `was` is the hash of
    the change that was agreed on (`archgen.compare.agreements`).
    """

    element: str
    reason: str
    key: str | None = None
    at: Span = field(default=NO_SPAN, compare=False, repr=False)
    was: str | None = None

    @property
    def partner(self) -> str | None:
        """Return the partner in whose own file the entry stands, None if it stands in any other file."""
        if not is_agreement_file(self.at.file):
            return None
        return self.at.file.removeprefix(f"{AGREEMENT_FOLDER}/").removesuffix(AGREEMENT_SUFFIX)


@dataclass(frozen=True, slots=True)
class ReviewSettings:
    """The section `review`. `main` is the branch that changes are compared with, None to ask git.

    `breaking` is the severity of a change that breaks another partner's part, by category, None if not written.
    `guards_margins`: promises have a severity of their own, so that a promise breaks as soon as it is weaker. `backends` and
    `passes` are the project's own that may run in the review of a pull request.
    """

    main: str | None = None
    breaking: BreakPolicy | None = None
    guards_margins: bool = False
    accepted: tuple[AcceptedChange, ...] = ()
    backends: tuple[str, ...] = ()
    passes: tuple[str, ...] = ()
    noise: Fraction = Fraction(2, 100)
    """The share by which a figure has to move to be told in a line of its own; judgements know no such share."""
