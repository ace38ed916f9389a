"""Make the agreement of two partners: its outline, its picture, and what has changed since an earlier revision."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence

from archgen.compare.match_elements import match_elements
from archgen.compare.matched_ids import MatchedIds
from archgen.frozen import dataclass, replace
from archgen.model.agreed_terms import GENERAL_TERMS, RULES, find_agreement
from archgen.model.partner_interfaces import PartnerPair, find_interfaces_between
from archgen.timing.chains.measured_comparison import Observation
from archgen.timing.system import activity_builder
from archgen.views.agreement.agreement_content import AgreementContent
from archgen.views.agreement.agreement_outline import outline_agreement
from archgen.views.agreement.agreement_picture import draw_agreement
from archgen.views.agreement.budget_section import BudgetFinder, find_crossing_budgets
from archgen.views.agreement.interface_record import InterfaceKey, InterfaceRecord
from archgen.views.agreement.interface_terms import InterfaceTerms, gather_terms
from archgen.views.agreement.measured_rows import add_measured
from archgen.views.agreement.output_promises import find_unproven_words, list_counted_ports
from archgen.views.agreement.plain_terms import list_contradictions, list_plain_terms
from archgen.views.agreement.signature_record import SignatureRecord, SignedTag
from archgen.views.agreement.term_changes import AgreementChanges, compare_revisions
from archgen.views.graph_shapes import Graph
from archgen.views.lookup import Lookup
from archgen.views.shapes import Outline, Paragraph


@dataclass(frozen=True, slots=True)
class PartnerAgreement:
    """An agreement: its outline, its picture, the number of interfaces, the changes (None: not asked for), its content."""

    outline: Outline
    graph: Graph
    interface_count: int
    changes: AgreementChanges | None
    content: AgreementContent


def make_agreement(  # noqa: PLR0913 - what a document is made of
    lookup: Lookup,
    first: str,
    second: str,
    *,
    revision: str = "",
    earlier_revision: tuple[str, Lookup] | None = None,
    issue_date: str = "",
    signed_tags: Sequence[SignedTag] = (),
    signed_revision: tuple[str, Lookup] | None = None,
    signed_rules: int = RULES,
    notices: Sequence[Paragraph] = (),
    find_budget: BudgetFinder | None = None,
    observations: Sequence[Observation] = (),
    signers: Mapping[str, str] | None = None,
    standing: tuple[str, ...] = (),
    variants: Mapping[str, Lookup] | None = None,
) -> PartnerAgreement:
    """Make the agreement of two partners.

    `earlier_revision`, with which it is compared, and `signed_revision`, whose versions of interfaces it tells, are the
    names of revisions with their look-ups. `find_budget` is asked for each chain between the two. `observations` are
    shown beside what is promised. `signers` are the names of those
    who sign, by partner. `standing` are the variants that are laid over what `lookup` shows, `variants` the
    look-ups of the project in each of its others.
    """
    records = record_interfaces(lookup, (first, second))
    rules = signed_rules if signed_revision == earlier_revision else RULES
    changes = _compare_with(earlier_revision, lookup, (first, second), records, rules) if earlier_revision else None
    signatures = SignatureRecord(tuple(signed_tags))
    if signed_revision:
        # Asked for both, they are one comparison.
        signed_changes = (
            changes
            if changes and signed_revision == earlier_revision
            else _compare_with(signed_revision, lookup, (first, second), records, signed_rules)
        )
        versions = signed_changes.earlier_versions
        signatures = replace(signatures, revision=signed_revision[0], versions=versions, rules=signed_rules)
    if observations:
        records = tuple(_add_measured(lookup, record, observations) for record in records)
    graph = draw_agreement(
        lookup, f"interfaces/{first}-{second}", (first, second), [record.terms.interface for record in records]
    )
    earlier_lookup = earlier_revision[1] if earlier_revision else None
    content = AgreementContent(
        lookup,
        (first, second),
        records,
        graph,
        revision,
        changes,
        tuple(notices),
        earlier_lookup,
        issue_date,
        find_crossing_budgets(records, find_budget) if find_budget else {},
        signatures,
        signers or {},
        standing,
        {name: compare_lookups(("", lookup), each, (first, second)) for name, each in (variants or {}).items()},
    )
    return PartnerAgreement(outline_agreement(content), graph, len(records), changes, content)


def compare_lookups(earlier_revision: tuple[str, Lookup], lookup: Lookup, pair: PartnerPair) -> AgreementChanges:
    """Compare what is between two partners, by their later ids, with what was at an earlier revision."""
    return _compare_with(earlier_revision, lookup, pair, record_interfaces(lookup, pair))


def _add_measured(lookup: Lookup, record: InterfaceRecord, observations: Sequence[Observation]) -> InterfaceRecord:
    """Return an interface with what was measured of it, which binds nobody and is compared with nothing."""
    names, terms = activity_builder.name_activities(lookup.architecture), record.terms
    rows = add_measured(lookup, names, terms.interface, terms.promise_rows, observations)
    return replace(record, terms=replace(terms, promise_rows=rows))


def _compare_with(
    earlier_revision: tuple[str, Lookup],
    lookup: Lookup,
    pair: PartnerPair,
    records: Sequence[InterfaceRecord],
    rules: int = RULES,
) -> AgreementChanges:
    """Compare with an earlier revision, in which the partners may have had other ids."""
    name, earlier_lookup = earlier_revision
    matched_ids = match_elements(earlier_lookup.architecture, lookup.architecture)
    old_partners = matched_ids.old_ids.get("partner", {})
    old_pair = old_partners.get(pair[0], pair[0]), old_partners.get(pair[1], pair[1])
    old_records = record_interfaces(earlier_lookup, old_pair, matched_ids)
    known = frozenset(activity_builder.name_activities(earlier_lookup.architecture).values())
    changes = compare_revisions(
        name,
        [_add_unproven(earlier_lookup, record, known, matched_ids) for record in old_records],
        [_add_unproven(lookup, record, known, MatchedIds()) for record in records],
        matched_ids,
        rules,
    )
    old_terms = find_agreement(earlier_lookup.architecture.agreements, *old_pair).terms
    terms = find_agreement(lookup.architecture.agreements, *pair).terms
    words = tuple(title for key, title in GENERAL_TERMS.items() if old_terms.get(key) != terms.get(key))
    return replace(changes, changed_words=words)


def _add_unproven(
    lookup: Lookup, record: InterfaceRecord, known: Collection[str], matched_ids: MatchedIds
) -> InterfaceRecord:
    """Return an interface with what is not shown to be kept any more: that is no more as signed than what is broken."""
    interface = record.terms.interface
    ports = list_counted_ports(lookup, interface)
    unproven = list_contradictions(find_unproven_words(lookup, interface, ports, known), "Open promise", matched_ids)
    return replace(record, plain_terms={**unproven, **record.plain_terms})


def record_interfaces(
    lookup: Lookup, pair: PartnerPair, matched_ids: MatchedIds | None = None
) -> tuple[InterfaceRecord, ...]:
    """Return the interfaces between two partners, by the ids of a later revision where these are given."""
    matched_ids = matched_ids or MatchedIds()
    activity_names = activity_builder.name_activities(lookup.architecture)
    all_terms = [
        gather_terms(lookup, activity_names, interface)
        for interface in find_interfaces_between(lookup.architecture, *pair)
    ]
    return tuple(
        InterfaceRecord(terms, _interface_key(terms, matched_ids), list_plain_terms(lookup, terms, matched_ids))
        for terms in all_terms
    )


def _interface_key(interface_terms: InterfaceTerms, matched_ids: MatchedIds) -> InterfaceKey:
    interface = interface_terms.interface
    giver, taker = interface.pair
    key = matched_ids.common_id("output", interface.key) if interface.output else interface.key
    return key, (matched_ids.common_id("partner", giver), matched_ids.common_id("partner", taker))
