"""An interface of one revision, as it is shown and compared, and what was signed of it before."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from archgen.frozen import dataclass, field
from archgen.model.agreed_terms import RULES
from archgen.model.partner_interfaces import PartnerPair
from archgen.views import inline_text
from archgen.views.agreement.interface_terms import InterfaceTerms
from archgen.views.shapes import Inlines, Table, Text, make_columns

if TYPE_CHECKING:  # not for each site: comparisons are large, and most are compared with nothing
    from archgen.views.agreement.plain_terms import PlainTerm

InterfaceKey = tuple[str, PartnerPair]
"""What identifies an interface: what flows, and between whom, by the ids of the later revision."""


@dataclass(frozen=True, slots=True)
class InterfaceRecord:
    """An interface of one revision with its terms as plain text. `key` has the ids of the later revision."""

    terms: InterfaceTerms
    key: InterfaceKey
    plain_terms: Mapping[str, PlainTerm]


@dataclass(frozen=True, slots=True)
class SignedTag:
    """A tag that records a signature: its name, the day and the words of whoever set it, and the commit it stands at."""

    name: str
    date: str
    tagger: str
    subject: str
    commit: str


@dataclass(frozen=True, slots=True)
class SignatureRecord:
    """The tags, newest first, and what stood in the last signed agreement.

    `revision` is empty where nothing was signed, or what was signed could not be read; `versions` are by the ids of now.
    """

    tags: tuple[SignedTag, ...] = ()
    revision: str = ""
    versions: Mapping[InterfaceKey, str] = field(default_factory=dict)
    rules: int = RULES
    """By which rules these were told."""

    def describe_version(self, record: InterfaceRecord) -> str:
        """Return the version of an interface with what was signed of it: `3fa9c1, as signed at v2 (1a2b3c4)`."""
        version = record.terms.version
        if not self.revision:
            return version
        signed_version = self.versions.get(record.key)
        if signed_version is None:
            return f"{version}, new since what was signed at {self.revision}"
        if signed_version == record.terms.find_version(self.rules):
            former = f" ({signed_version} by the rules of then)" if signed_version != version else ""
            return f"{version}, as signed at {self.revision}{former}"
        return f"{version}, changed since {self.revision}, where it was {signed_version}"


def write_signature_table(tags: tuple[SignedTag, ...]) -> Table:
    """List the signatures that the repository records, newest first."""
    columns = make_columns(("Recorded as", 1.4), ("On", 0.6), ("By", 0.8), ("Commit", 0.6), ("Words", 1.4))
    rows = tuple(
        (
            inline_text.to_inlines(Text(tag.name, code=True)),
            _text_cell(tag.date),
            _text_cell(tag.tagger),
            inline_text.to_inlines(Text(tag.commit, code=True)),
            _text_cell(tag.subject),
        )
        for tag in tags
    )
    return Table("table:signed", "What was signed before", columns, rows, numbered=False)


def _text_cell(text: str) -> Inlines:
    return inline_text.to_inlines(text) if text else ()
