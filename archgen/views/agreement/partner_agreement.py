"""Make the agreement of two partners: its outline, its picture, and what has changed since an earlier revision."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from typing import Literal

from archgen.compare.match_elements import match_elements
from archgen.compare.matched_ids import MatchedIds
from archgen.diagnostics import fit_lines
from archgen.frozen import dataclass, replace
from archgen.model.agreed_terms import GENERAL_TERMS, RULES, find_agreement
from archgen.model.partner_interfaces import PartnerInterface, PartnerPair, components_at_ends, find_interfaces_between
from archgen.timing.chains.measured_comparison import Observation
from archgen.timing.system import activity_builder
from archgen.views.agreement.agreement_content import AgreementContent
from archgen.views.agreement.agreement_outline import outline_agreement
from archgen.views.agreement.general_sections import BudgetFinder, find_crossing_budgets
from archgen.views.agreement.interface_record import InterfaceKey, InterfaceRecord, SignatureRecord, SignedTag
from archgen.views.agreement.interface_terms import InterfaceTerms, gather_terms, interface_title
from archgen.views.agreement.output_promises import find_unproven_words, list_counted_ports
from archgen.views.agreement.plain_terms import list_contradictions, list_plain_terms
from archgen.views.agreement.promise_rows import add_measured
from archgen.views.agreement.term_changes import AgreementChanges, compare_revisions
from archgen.views.elements import element_names
from archgen.views.graphs import element_boxes
from archgen.views.graphs.drawn_level import FlowStyle
from archgen.views.graphs.element_boxes import join_owner_titles
from archgen.views.graphs.graph_folding import add_legend_keys, fold_graph
from archgen.views.inline_text import count_noun
from archgen.views.lookup import Lookup
from archgen.views.picture_shapes import Arrow, Box, Cluster, Graph
from archgen.views.shapes import Outline, Paragraph

PictureSide = Literal["left", "right"]
_PARTNER_HUES = (1, 4)
"""Hue numbers of both partners; every box also names its partner or is in the frame that does."""
_MAX_LABELS = 3


@dataclass(frozen=True, slots=True)
class _DrawnFlow:
    """One interface between two boxes, as drawn: a service or action runs from its client to its server."""

    interface: PartnerInterface
    tail: str
    head: str
    sentence: str


def _draw_agreement(lookup: Lookup, name: str, pair: tuple[str, str], interfaces: Sequence[PartnerInterface]) -> Graph:
    """Draw what flows between two partners, and nothing else."""
    first, second = pair
    placed_flows = [_place_flow(flow, first) for interface in interfaces for flow in _list_flows(lookup, interface)]
    boxes_by_end = {
        box_id: _draw_box(lookup, box_id, pair) for _, tail, head in placed_flows for box_id in (tail, head)
    }
    titles = join_owner_titles(lookup, [first]), join_owner_titles(lookup, [second])
    graph = Graph(
        name,
        f"What flows between {titles[0]} and {titles[1]}",
        "group",
        tuple(boxes_by_end.values()),
        tuple(_draw_arrows(placed_flows)),
        (Cluster(second, titles[1], colour=_PARTNER_HUES[1]),),
        direction="left-right",
        legend_colours=tuple(zip(_PARTNER_HUES, titles, strict=True)),
        alt=_alternative_text(lookup, pair, interfaces),
        asked=len(placed_flows),
        kind="agreement",
    )
    return fold_graph(add_legend_keys(graph))


def _list_flows(lookup: Lookup, interface: PartnerInterface) -> Iterator[_DrawnFlow]:
    giving_components, taking_components = components_at_ends(lookup.architecture, interface)
    tail_ids = [component.id for component in giving_components] or [
        f"node {endpoint.node}" for endpoint in interface.giver_endpoints[:1]
    ]
    head_ids = [component.id for component in taking_components] or [
        f"node {endpoint.node}" for endpoint in interface.taker_endpoints[:1]
    ]
    calls = interface.flow in {"service", "action"}
    for giver_id in tail_ids:
        for taker_id in head_ids:
            tail, head = (taker_id, giver_id) if calls else (giver_id, taker_id)
            yield _DrawnFlow(interface, tail, head, interface_title(lookup, interface))


def _place_flow(flow: _DrawnFlow, first: str) -> tuple[_DrawnFlow, str, str]:
    """Return a flow with its boxes: the first partner's on the left where it begins, on the right where it ends."""
    calls = flow.interface.flow in {"service", "action"}
    begins = (flow.interface.pair[0] == first) is not calls
    # "<" and ">" in a box's id put the first partner's component on the left, the right, or both: `_draw_box` reads
    # them.
    return (flow, f"<{flow.tail}", flow.head) if begins else (flow, flow.tail, f">{flow.head}")


def _draw_box(lookup: Lookup, box_id: str, pair: tuple[str, str]) -> Box:
    side: PictureSide | None = {"<": "left", ">": "right"}.get(box_id[0])  # type: ignore[assignment]
    element_id = box_id.removeprefix("<").removeprefix(">")
    partner_index = 0 if side else 1
    cluster = None if side else pair[1]
    if element_id.startswith("node "):
        box = element_boxes.node_box(lookup, lookup.architecture.nodes[element_id.removeprefix("node ")])
    else:
        component = lookup.architecture.components[element_id]
        place = (
            join_owner_titles(lookup, component.owners) if side else lookup.architecture.groups[component.group].title
        )
        line = " · ".join(filter(None, (place, element_names.join_surrounding_titles(lookup, component))))
        box = element_boxes.component_box(lookup, component, lines=(line,))
    return replace(box, id=box_id, colour=_PARTNER_HUES[partner_index], cluster=cluster, side=side)


def _draw_arrows(placed_flows: Sequence[tuple[_DrawnFlow, str, str]]) -> Iterator[Arrow]:
    """Yield one arrow for all flows between two boxes in one direction."""
    bundles: dict[tuple[str, str, FlowStyle], list[_DrawnFlow]] = {}
    for flow, tail, head in placed_flows:
        kind = flow.interface.flow
        style: FlowStyle = "data" if kind == "topic" else kind
        bundles.setdefault((tail, head, style), []).append(flow)
    for (tail, head, style), flows in bundles.items():
        type_names = list(dict.fromkeys(flow.interface.type or flow.interface.key for flow in flows))
        sentences = tuple(flow.sentence for flow in flows)
        yield Arrow(
            f"{tail}>{head}:{style}",
            tail,
            head,
            "\n".join(fit_lines(type_names, _MAX_LABELS, "and {} more types")),
            style=style,
            count=len(flows),
            flows=sentences,
            ref=flows[0].interface.anchor if len(flows) == 1 else None,
        )


def _alternative_text(lookup: Lookup, pair: tuple[str, str], interfaces: Sequence[PartnerInterface]) -> str:
    sentences = []
    for giver, taker in (pair, pair[::-1]):
        interface_titles = [
            interface_title(lookup, interface) for interface in interfaces if interface.pair[0] == giver
        ]
        if interface_titles:
            direction_phrase = f"{join_owner_titles(lookup, [giver])} to {join_owner_titles(lookup, [taker])}"
            sentences.append(
                f"{count_noun(len(interface_titles), 'interface')} from {direction_phrase}: {', '.join(interface_titles)}."
            )
    return " ".join(sentences)


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
    graph = _draw_agreement(
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
