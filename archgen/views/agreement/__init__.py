"""Interface agreements: what flows between two partners, as a document that both can sign."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from archgen.timing.system import activity_builder
from archgen.views.agreement.agreement_outline import AgreementContent, outline_agreement
from archgen.views.agreement.agreement_picture import draw_agreement
from archgen.views.agreement.interface_terms import gather_terms, plain_terms
from archgen.views.agreement.partner_interfaces import find_interfaces_between
from archgen.views.agreement.term_changes import AgreementChanges, InterfaceRecord, compare_revisions
from archgen.views.lookup import Lookup
from archgen.views.shapes import Graph, Outline, Paragraph

__all__ = ["PartnerAgreement", "find_interfaces_between", "make_agreement"]


@dataclass(frozen=True, slots=True)
class PartnerAgreement:
    """An agreement: its outline, its picture, the number of interfaces, and the changes (None: not asked for)."""

    outline: Outline
    graph: Graph
    interface_count: int
    changes: AgreementChanges | None


def make_agreement(  # noqa: PLR0913 - what a document is made of
    lookup: Lookup,
    first: str,
    second: str,
    *,
    revision: str = "",
    earlier_revision: tuple[str, Lookup] | None = None,
    notices: Sequence[Paragraph] = (),
) -> PartnerAgreement:
    """Make the agreement of two partners. `since` is the name of an earlier revision with its look-ups."""
    records = _record_interfaces(lookup, first, second)
    changes = (
        compare_revisions(earlier_revision[0], _record_interfaces(earlier_revision[1], first, second), records)
        if earlier_revision
        else None
    )
    graph = draw_agreement(
        lookup, f"interfaces/{first}-{second}", (first, second), [record.terms.interface for record in records]
    )
    earlier_lookup = earlier_revision[1] if earlier_revision else None
    content = AgreementContent(
        lookup, (first, second), records, graph, revision, changes, tuple(notices), earlier_lookup
    )
    return PartnerAgreement(outline_agreement(content), graph, len(records), changes)


def _record_interfaces(lookup: Lookup, first: str, second: str) -> tuple[InterfaceRecord, ...]:
    activity_names = activity_builder.name_activities(lookup.architecture)
    all_terms = [
        gather_terms(lookup, activity_names, interface) for interface in find_interfaces_between(lookup, first, second)
    ]
    return tuple(InterfaceRecord(interface, plain_terms(lookup, interface)) for interface in all_terms)
