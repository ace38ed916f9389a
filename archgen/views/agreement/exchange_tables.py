"""Tables of what two partners give each other: what is promised beside what is derived, and what is open with who writes it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence

from archgen.diagnostics import join_words
from archgen.frozen import dataclass
from archgen.grouping import group_pairs
from archgen.model.latest_result import remember_latest
from archgen.model.partner_interfaces import PartnerPair, components_at_ends, find_all_interfaces
from archgen.timing.system import activity_builder
from archgen.views import inline_text
from archgen.views.agreement.interface_terms import InterfaceTerms, describe_open_term, gather_terms
from archgen.views.agreement.promise_rows import QOS_OFFERED, RATE, PromiseRow, TermName, join_figures
from archgen.views.element_references import message_link
from archgen.views.graphs.element_boxes import join_owner_titles
from archgen.views.lookup import Lookup
from archgen.views.shapes import Column, Inlines, Status, Table, Text, drop_empty_columns, make_columns


@dataclass(frozen=True, slots=True)
class PartnerExchange:
    """What two partners give each other. `pair` has them in the order in which the project declares them."""

    pair: PartnerPair
    interfaces: tuple[InterfaceTerms, ...]
    open_count: int
    """How many points the two have still to settle."""

    def list_given(self, giver: str) -> tuple[InterfaceTerms, ...]:
        """Return what one of the two gives the other."""
        return tuple(terms for terms in self.interfaces if terms.interface.pair[0] == giver)


@remember_latest
def gather_exchanges(lookup: Lookup) -> tuple[PartnerExchange, ...]:
    """Return the exchanges between all partners that have interfaces with shown components or nodes, as declared."""
    activity_names = activity_builder.name_activities(lookup.architecture)
    positions: Mapping[str, int] = {partner: at for at, partner in enumerate(lookup.architecture.partners)}
    interfaces_by_pair: dict[PartnerPair, list[InterfaceTerms]] = {}
    for interface in find_all_interfaces(lookup.architecture):
        ends = components_at_ends(lookup.architecture, interface)
        endpoints = (*interface.giver_endpoints, *interface.taker_endpoints)
        if any(lookup.scope.shows_component(component.id) for end in ends for component in end) or any(
            lookup.scope.shows_node(endpoint.node) for endpoint in endpoints if not any(ends)
        ):
            first, second = sorted(interface.pair, key=lambda partner: positions.get(partner, len(positions)))
            terms = gather_terms(lookup, activity_names, interface)
            interfaces_by_pair.setdefault((first, second), []).append(terms)
    pairs = sorted(
        interfaces_by_pair, key=lambda pair: tuple(positions.get(partner, len(positions)) for partner in pair)
    )
    return tuple(
        # Counted once: each page on a partner and each page on a pair shows it.
        PartnerExchange(pair, tuple(all_terms), sum(len(terms.open_points) for terms in all_terms))
        for pair in pairs
        for all_terms in (interfaces_by_pair[pair],)
    )


def list_unsettled(lookup: Lookup, component_ids: Iterable[str]) -> Mapping[str, Inlines]:
    """Return by partner, in words, which terms of what components give him and take from him are still open."""
    index = _index_open_terms(lookup)
    words = group_pairs(pair for each in component_ids for pair in index.get(each, ()))
    return {partner: (Text(f" · {'; '.join(dict.fromkeys(all_words))}"),) for partner, all_words in words.items()}


@remember_latest
def _index_open_terms(lookup: Lookup) -> Mapping[str, Sequence[tuple[str, str]]]:
    """Return by component the other partners of its interfaces with open terms, each with a phrase about these."""
    return group_pairs(
        (component.id, (other, f"{verb} {join_words(terms.open_terms)} of {terms.title}"))
        for exchange in gather_exchanges(lookup)
        for terms in exchange.interfaces
        if exchange.open_count and terms.open_names
        for verb, end, other in zip(
            ("it owes", "it is owed"),
            components_at_ends(lookup.architecture, terms.interface),
            reversed(terms.interface.pair),
            strict=True,
        )
        for component in end
    )


PACE_TERMS = (RATE.key, "response")
QOS_TERMS = (QOS_OFFERED.key,)
_NOT_PROMISED: Inlines = (Text("not promised", muted=True),)


def interface_reference(terms: InterfaceTerms) -> str:
    """Return the anchor of an interface's page: one output may be given to several partners, so both are in it."""
    interface = terms.interface
    return f"interface:{interface.key}:{interface.pair[0]}:{interface.pair[1]}"


def interface_link(terms: InterfaceTerms) -> Text:
    """Link to an interface's page, by what flows."""
    return Text(terms.interface.type or terms.title, ref=interface_reference(terms))


def make_given_table(lookup: Lookup, anchor: str, caption: str, interfaces: Sequence[InterfaceTerms]) -> Table:
    """List what one partner gives another: what is promised of it, what is derived, and what is still open."""
    rows = tuple(_given_row(lookup, terms) for terms in interfaces)
    columns = make_columns(
        ("What flows", 1.7),
        ("Message, topic", 1.6),
        ("Promised", 0.8, "right"),
        ("Derived", 0.8, "right"),
        ("QoS promised", 0.9),
        ("Size", 0.6, "right"),
        ("Traffic", 0.7, "right"),
        ("Still open", 0.9),
    )
    return drop_empty_columns(Table(anchor, caption, columns, rows))


def _given_row(lookup: Lookup, terms: InterfaceTerms) -> tuple[Inlines, ...]:
    pace, qos = _find_row(terms, PACE_TERMS), _find_row(terms, QOS_TERMS)
    size, traffic = _find_row(terms, ("size",)), _find_row(terms, ("traffic",))
    return (
        inline_text.join_lines([(interface_link(terms),), *_end_lines(lookup, terms)]),
        _carrier_cell(terms),
        (_shorten_figure(pace.promised) or _NOT_PROMISED) if pace else (),
        _shorten_figure(pace.expected) if pace else (),
        (_shorten_figure(qos.promised) or _NOT_PROMISED) if qos else (),
        _shorten_figure(size.promised or size.expected) if size else (),
        _shorten_figure(traffic.expected) if traffic else (),
        inline_text.join_inlines(((chip,) for chip in _list_chips(terms)), " "),
    )


def _find_row(terms: InterfaceTerms, keys: tuple[str, ...]) -> PromiseRow | None:
    """Return the row of a term; of several (one for each node that gives) the first with a figure."""
    rows = [row for row in terms.promise_rows if row.name.key in keys]
    return next((row for row in rows if row.promised or row.expected), rows[0] if rows else None)


def _shorten_figure(runs: Inlines) -> Inlines:
    """Return a figure alone, without what it follows from and the gap behind it: these stand on the interface's page."""
    if not runs:
        return ()
    figure = join_figures(runs).partition(" · ")[0]
    return (Text(figure.replace("at most ", "<= ").replace("at least ", ">= "), sort_number=runs[0].sort_number),)


def _end_lines(lookup: Lookup, terms: InterfaceTerms) -> Iterator[Inlines]:
    """Yield the line below what flows: from which component to which."""
    ends = components_at_ends(lookup.architecture, terms.interface)
    sides = [
        inline_text.join_inlines((inline_text.component_link(component),) for component in components)
        for components in ends
    ]
    if all(sides):
        yield (*sides[0], Text(" → "), *sides[1])


def _carrier_cell(terms: InterfaceTerms) -> Inlines:
    interface = terms.interface
    if interface.flow == "physical":
        return inline_text.to_inlines(Text("physical", muted=True))
    if interface.medium:
        return inline_text.to_inlines(interface.medium)
    lines = [(message_link(interface.message),)] if interface.message else [inline_text.UNKNOWN_INLINES]
    lines += [(inline_text.topic_link(name),) for name in interface.topic_names]
    return inline_text.join_lines(lines)


def _list_chips(terms: InterfaceTerms) -> Iterator[Text]:
    for name in terms.open_names:
        yield _make_chip(shorten_name(name), "open")[0]
    if terms.contradictions:
        yield Text(inline_text.count_noun(len(terms.contradictions), "contradiction"), status="error")
    if terms.late_chains:
        yield Text(inline_text.count_noun(len(terms.late_chains), "late chain"), status="not proven")


def make_point_table(lookup: Lookup, anchor: str, exchange: PartnerExchange) -> Table | None:
    """List what two partners have still to settle, the gravest first, each with the interfaces and who writes it."""
    rows = tuple(_list_point_rows(lookup, exchange))
    columns = (Column("State", 0.6), Column("Still to be settled", 2.6), Column("Who writes it", 1))
    return Table(anchor, "Open points between the two", columns, rows) if rows else None


def _list_point_rows(lookup: Lookup, exchange: PartnerExchange) -> Iterator[tuple[Inlines, ...]]:
    both = inline_text.join_inlines(
        (inline_text.partner_link(lookup.architecture, partner) for partner in exchange.pair), " and "
    )
    for chip, sentence, link in list_grave_points(exchange):
        yield chip, inline_text.join_lines([sentence, link]), both
    for name, interfaces in group_open_terms(exchange.interfaces).items():
        links = inline_text.join_inlines((interface_link(terms),) for terms in interfaces)
        point = inline_text.join_lines([inline_text.message_to_inlines(describe_open_term(name)), links])
        yield _make_chip(shorten_name(name), "open"), point, _count_writers(lookup, interfaces)


def list_grave_points(exchange: PartnerExchange) -> Iterator[tuple[Inlines, Inlines, Inlines]]:
    """Yield a chip, the words and an interface of each contradiction and each late chain between two partners."""
    for status, word, sentences in (
        ("error", "contradiction", {s: t for t in exchange.interfaces for s in t.contradictions}),
        ("not proven", "late chain", {s: t for t in exchange.interfaces for s in t.late_chains}),
    ):
        for sentence, terms in sentences.items():
            # One chain may pass over several interfaces: it is late once.
            yield _make_chip(word, status), inline_text.message_to_inlines(sentence), (interface_link(terms),)  # type: ignore[arg-type]


def shorten_name(name: TermName) -> str:
    """Return the name of a term as it stands in a chip."""
    return "QoS" if name == QOS_OFFERED else name.words


def _make_chip(word: str, status: Status) -> Inlines:
    return (Text(word, status=status),)


def group_open_terms(interfaces: Iterable[InterfaceTerms]) -> Mapping[TermName, list[InterfaceTerms]]:
    """Return the open terms by name, that of most interfaces first."""
    grouped = group_pairs((name, terms) for terms in interfaces for name in terms.open_names)
    return dict(sorted(grouped.items(), key=lambda entry: -len(entry[1])))


def _count_writers(lookup: Lookup, interfaces: Sequence[InterfaceTerms]) -> Inlines:
    """Return who states the terms of these interfaces, with how many are theirs: who gives something says what it is."""
    counts: dict[str, int] = {}
    for terms in interfaces:
        giver = terms.interface.pair[0]
        counts[giver] = counts.get(giver, 0) + 1
    return inline_text.join_lines(
        (*inline_text.partner_link(lookup.architecture, giver), Text(f": {count}")) for giver, count in counts.items()
    )


def count_promised(interfaces: Iterable[InterfaceTerms], keys: tuple[str, ...]) -> tuple[int, int]:
    """Return of how many interfaces a term is promised, and how many have such a term."""
    rows = [row for terms in interfaces if (row := _find_row(terms, keys))]
    return sum(1 for row in rows if row.promised), len(rows)


def pair_title(lookup: Lookup, pair: Sequence[str]) -> str:
    """Return the titles of two partners: `CERTH-ITI and FORTH-ICS`."""
    return " and ".join(join_owner_titles(lookup, [partner]) for partner in pair)


def list_open_words(terms: Iterable[InterfaceTerms]) -> Inlines:
    """Return which terms are open, and whether a chain is late or somebody contradicts."""
    names = dict.fromkeys(shorten_name(name) for each in terms for name in each.open_names)
    late = any(each.late_chains for each in terms)
    broken = any(each.contradictions for each in terms)
    runs: list[Text] = [Text(", ".join(names), status="open")] if names else []
    runs += [Text("late chain", status="not proven", line_break=bool(runs))] if late else []
    runs += [Text("contradiction", status="error", line_break=bool(runs))] if broken else []
    return tuple(runs)
