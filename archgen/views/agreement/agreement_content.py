"""What an agreement is made of, as its chapters read it, and what was signed of it before."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field

from archgen.frozen import dataclass
from archgen.model.agreed_terms import RULES
from archgen.timing.search.chain_budgets import SharedBudget
from archgen.views import inline_text
from archgen.views.agreement.term_changes import AgreementChanges, InterfaceKey, InterfaceRecord
from archgen.views.graphs.element_boxes import join_owner_titles
from archgen.views.lookup import Lookup
from archgen.views.picture_shapes import Graph
from archgen.views.shapes import Column, Inlines, Paragraph, Table, Text


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
    columns = (
        Column("Recorded as", 1.4),
        Column("On", 0.6),
        Column("By", 0.8),
        Column("Commit", 0.6),
        Column("Words", 1.4),
    )
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


@dataclass(frozen=True, slots=True)
class AgreementContent:
    """What an agreement is made of. `earlier_lookup` is None unless changes are asked for; `notices` come first."""

    lookup: Lookup
    pair: tuple[str, str]
    records: tuple[InterfaceRecord, ...]
    graph: Graph
    revision: str = ""
    changes: AgreementChanges | None = None
    notices: tuple[Paragraph, ...] = ()
    earlier_lookup: Lookup | None = None
    """Look-ups of the architecture at the earlier revision."""
    issue_date: str = ""
    budgets: Mapping[str, SharedBudget] = field(default_factory=dict)
    """What the elements of the chains between the two may take, by chain."""
    signatures: SignatureRecord = field(default_factory=SignatureRecord)
    signers: Mapping[str, str] = field(default_factory=dict)
    """Who signs this document for which partner."""
    standing: tuple[str, ...] = ()
    """The variants that are laid over the project as it is shown."""
    variant_changes: Mapping[str, AgreementChanges] = field(default_factory=dict)
    """What is otherwise in each variant, by its id."""

    @property
    def pair_titles(self) -> tuple[str, str]:
        """Return the titles of both partners."""
        return join_owner_titles(self.lookup, self.pair[:1]), join_owner_titles(self.lookup, self.pair[1:])
