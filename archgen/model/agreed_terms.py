"""What two partners agreed on beside the interfaces themselves, and what they signed: the section `agreements`.

Terms are written by hand, signatures by `archgen sign`.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping

from archgen.diagnostics import NO_SPAN, Span
from archgen.frozen import dataclass, field

SIGNATURE_FOLDER = "agreements"
RULES = 2
"""The rules by which versions of interfaces are told now; those of signatures that name none are 1."""
INTERFACE_TERMS: Mapping[str, str] = {
    "late": "When late or missing",
    "stamps": "Time stamps",
    "clock": "Clock",
    "start": "After power-up",
    "duties": "Duties of readers",
}
GENERAL_TERMS: Mapping[str, str] = {"notice": "Notice of changes", "validity": "Validity", "other": "Other terms"}


def signature_file(agreement_id: str) -> str:
    """Return the file in which an agreement has to stand for its signature to count, from the project's folder."""
    return f"{SIGNATURE_FOLDER}/{agreement_id}.yaml"


def is_signature_file(file: str) -> bool:
    """Whether a file is one in which partners record what they signed."""
    return file.startswith(f"{SIGNATURE_FOLDER}/") and file.count("/") == 1


def hash_text(content: object) -> str:
    """Return six hexadecimal digits of what is written as JSON."""
    return hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()[:6]


@dataclass(frozen=True, slots=True)
class Signature:
    """What was signed: by which rules versions were told, the tag and the commit, who signed for whom, and the versions.

    `terms` are six digits of what was agreed in words; `versions` are by giver, then by output or topic.
    """

    rules: int = 1
    tag: str | None = None
    revision: str | None = None
    terms: str | None = None
    by: Mapping[str, str] = field(default_factory=dict)
    versions: Mapping[str, Mapping[str, str]] = field(default_factory=dict)
    at: Span = field(default=NO_SPAN, compare=False, repr=False)
    places: Mapping[tuple[str, ...], Span] = field(default_factory=dict, compare=False, repr=False)
    """Where each key, and each version by giver and interface, is written."""

    @property
    def day(self) -> str:
        """Return the name that the tag has below the pair's: mostly the day."""
        return (self.tag or "").rpartition("/")[2]


@dataclass(frozen=True, slots=True)
class Agreement:
    """An agreement by the ids of its partners: `certh-sssa`."""

    id: str
    terms: Mapping[str, str] = field(default_factory=dict)
    interfaces: Mapping[str, Mapping[str, str]] = field(default_factory=dict)
    """Terms of single interfaces, by output or topic."""
    signed: Signature | None = None
    at: Span = field(default=NO_SPAN, compare=False, repr=False)

    @property
    def pair(self) -> tuple[str, str]:
        """Return the ids of both partners."""
        first, _, second = self.id.partition("-")
        return first, second

    @property
    def binding_signature(self) -> Signature | None:
        """Return what both partners signed, None where one of them did not."""
        signed = self.signed
        return signed if signed and all(partner in signed.by for partner in self.pair) else None

    def find_term(self, name: str, interface: str) -> str | None:
        """Return a term of an interface, or that of all interfaces."""
        return self.interfaces.get(interface, {}).get(name) or self.terms.get(name)

    def hash_terms(self) -> str:
        """Return six digits of all that is agreed in words; of line breaks nothing."""
        return hash_text([_collapse_texts(self.terms), {key: _collapse_texts(v) for key, v in self.interfaces.items()}])


def find_agreement(agreements: Mapping[str, Agreement], first: str, second: str) -> Agreement:
    """Return the agreement of two partners, in whichever order its id names them; an empty one where nothing is written."""
    names = f"{first}-{second}", f"{second}-{first}"
    return next((agreements[name] for name in names if name in agreements), Agreement(names[0]))


def _collapse_texts(texts: Mapping[str, str]) -> Mapping[str, str]:
    return {name: " ".join(text.split()) for name, text in texts.items()}
