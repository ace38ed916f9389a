"""What an agreement is made of, as its chapters read it, and what was signed of it before."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from archgen.frozen import dataclass, field
from archgen.model.architecture import Architecture
from archgen.timing.search.chain_budgets import SharedBudget
from archgen.views.agreement.interface_record import InterfaceRecord, SignatureRecord
from archgen.views.agreement.term_changes import AgreementChanges, mark_changed_names
from archgen.views.graphs.element_boxes import join_owner_titles
from archgen.views.lookup import Lookup
from archgen.views.picture_shapes import Graph
from archgen.views.shapes import Paragraph, Text


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

    def mark_changes(self, list_terms: Callable[[Architecture], Mapping[str, object]]) -> dict[str, Text]:
        """Return what happened to each name since the earlier revision; nothing where no changes are asked for."""
        if self.changes is None or self.earlier_lookup is None:
            return {}
        return mark_changed_names(list_terms(self.lookup.architecture), list_terms(self.earlier_lookup.architecture))
