"""The section of one interface: what it is, what is promised and expected of it, ends, fields, chains, open points."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import TYPE_CHECKING

from archgen.bringup.plan_shapes import StartStep
from archgen.diagnostics import join_words
from archgen.frozen import dataclass, field
from archgen.model.agreed_terms import INTERFACE_TERMS
from archgen.model.node import Endpoint
from archgen.model.partner_interfaces import PartnerInterface, list_givers
from archgen.views import inline_text, start_phrases
from archgen.views.agreement import message_fields
from archgen.views.agreement.interface_record import InterfaceRecord, SignatureRecord
from archgen.views.agreement.interface_terms import InterfaceEnd, InterfaceTerms
from archgen.views.agreement.promise_rows import write_promise_table
from archgen.views.element_references import message_link
from archgen.views.elements.element_names import join_surrounding_titles
from archgen.views.graphs.element_boxes import join_owner_titles
from archgen.views.lookup import Lookup
from archgen.views.shapes import (
    Block,
    Column,
    Facts,
    Inlines,
    Paragraph,
    Section,
    Table,
    Text,
    make_columns,
    show_facts,
)
from archgen.views.shapes import drop_empty_columns as tidy
from archgen.views.timing import timing_tables

if TYPE_CHECKING:
    from archgen.views.agreement.term_changes import AgreementChanges, TermChange

_STAMP_TYPES = {"builtin_interfaces/msg/Time": "", "time": "", "std_msgs/msg/Header": ".stamp"}
"""Types of fields that are time stamps, or hold one."""
_NOTHING = "nothing is said of it"


@dataclass(frozen=True, slots=True)
class WordRow:
    """A term in words: what partners wrote, what follows from the model, and what is not said, each empty where it is not so."""

    key: str
    title: str
    written: str = ""
    derived: tuple[str, ...] = ()
    unsaid: str = ""

    @property
    def inlines(self) -> Inlines:
        """Return it as lines, what is not said muted."""
        lines = [inline_text.message_to_inlines(each) for each in (self.written, *self.derived) if each]
        return inline_text.join_lines([*lines, (Text(self.unsaid, muted=True),) if self.unsaid else ()])


def list_word_rows(lookup: Lookup, terms: InterfaceTerms, steps: Mapping[str, StartStep] | None) -> Iterator[WordRow]:
    """Yield the terms of an interface in words. Without the steps of the start-up only late data, and what is written."""
    interface, duties = terms.interface, terms.missing_data_duties
    is_message = interface.flow != "physical" and not interface.medium
    found: dict[str, tuple[tuple[str, ...], str]] = {}
    if interface.flow != "physical":
        found["late"] = (duties, "" if duties else "nothing is promised for this case")
    if steps is not None and is_message:
        found |= {
            "stamps": _describe_stamps(lookup, interface),
            "clock": _describe_clock(lookup, interface, is_agreed="clock" in terms.agreed),
            "start": (tuple(_describe_starts(interface, lookup, steps)), _NOTHING),
            "duties": (tuple(_describe_freshness(lookup, interface)), _NOTHING),
        }
    for key, title in INTERFACE_TERMS.items():
        written, (derived, unsaid) = terms.agreed.get(key, ""), found.get(key, ((), ""))
        if written or derived or unsaid:
            is_silent = unsaid and not written and (key == "clock" or not derived)
            yield WordRow(key, title, written, derived, unsaid if is_silent else "")


def _describe_stamps(lookup: Lookup, interface: PartnerInterface) -> tuple[tuple[str, ...], str]:
    definition = lookup.architecture.interfaces.definitions.get(interface.message or "")
    if definition is None:
        return (), _NOTHING
    names = [
        f"{field.name}{_STAMP_TYPES[field.type]}"
        for part in definition.parts
        for field in part
        if field.type in _STAMP_TYPES
    ]
    if not names:
        return ("The message holds no time stamp.",), ""
    return (), f"nothing is said of whether {join_words(names)} is of measuring or of sending"


def _describe_clock(lookup: Lookup, interface: PartnerInterface, *, is_agreed: bool) -> tuple[tuple[str, ...], str]:
    endpoints = _list_ends(lookup, interface)
    nodes_by_clock: dict[str | None, dict[str, None]] = {}
    for endpoint in endpoints:
        nodes_by_clock.setdefault(endpoint.clock, {})[endpoint.node] = None
    if set(nodes_by_clock) - {"system"}:
        words = {
            "system": "the clock of its computer",
            "simulated": "simulated time (`/clock`)",
            None: "a clock that is not known",
        }
        return tuple(
            f"{join_words([f'`{node}`' for node in nodes])}: {words[clock]}." for clock, nodes in nodes_by_clock.items()
        ), ""
    architecture = lookup.architecture
    hosts = dict.fromkeys(architecture.nodes[endpoint.node].host for endpoint in endpoints)
    titles = [architecture.hosts[host].title for host in hosts if host]
    if not endpoints or None in hosts:
        return (), "which computers the ends run on is not decided, and nothing is said of their clocks"
    if len(titles) == 1:
        return (f"The clock of {titles[0]}, on which both sides run.",), ""
    unsaid = "" if is_agreed else "nothing is said of how far they may differ"
    return (f"The clocks of {join_words(titles)}.",), unsaid


def _describe_starts(interface: PartnerInterface, lookup: Lookup, steps: Mapping[str, StartStep]) -> Iterator[str]:
    """Yield for each giving node what it is started after, and what shows that it is up."""
    for node in dict.fromkeys(endpoint.node for endpoint in list_givers(lookup.architecture, interface)):
        step = steps.get(node)
        if step is None:
            continue
        awaited = join_words([f"`{each.awaited}`" for each in start_phrases.name_waits(step)])
        ready = start_phrases.describe_ready(step)
        parts = [f"is started after {awaited}"] if awaited else []
        parts += [f"is up when {ready}"] if ready else []
        if parts:
            yield f"`{node}` {' and '.join(parts)}."


def _describe_freshness(lookup: Lookup, interface: PartnerInterface) -> Iterator[str]:
    for port in interface.inputs:
        if port.freshness:
            title = lookup.architecture.components[port.component].title
            yield f"{title} uses nothing older than {port.freshness} as `{port.name}`."


def _list_ends(lookup: Lookup, interface: PartnerInterface) -> list[Endpoint]:
    ends: Iterable[Endpoint] = (*list_givers(lookup.architecture, interface), *interface.taker_endpoints)
    return [endpoint for endpoint in ends if lookup.architecture.nodes[endpoint.node].written]


_MAX_VALUE_LENGTH = 400
"""Maximal number of characters of a value in a table of changes."""


@dataclass(frozen=True, slots=True)
class SectionWriter:
    """Writes sections. The fields of a message are at its first interface, later ones refer to it."""

    lookup: Lookup
    changes: AgreementChanges | None = None
    signatures: SignatureRecord = field(default_factory=SignatureRecord)
    anchors_by_message: dict[str, str] = field(default_factory=dict)
    start_steps: Mapping[str, StartStep] | None = None
    """The steps of the start-up, in an agreement: it also tells what nobody says."""

    def write_section(
        self, record: InterfaceRecord, anchor: str, mark: Inlines, first_facts: Iterable[tuple[str, Inlines]] = ()
    ) -> Section:
        """Return the section of one interface; `first_facts` are above all others."""
        interface_terms = record.terms
        blocks = [
            *self._change_blocks(record, mark),
            Facts(
                (
                    *first_facts,
                    ("Version", inline_text.to_inlines(self.signatures.describe_version(record))),
                    *show_facts(interface_terms.facts).rows,
                    *self._further_facts(interface_terms),
                )
            ),
            *self._promise_tables(interface_terms),
            self._ends_table(interface_terms),
            *(Paragraph(inline_text.to_inlines(sentence), "note") for sentence in interface_terms.shared_notes),
            *self._field_blocks(interface_terms, anchor),
            *self._chain_tables(interface_terms),
        ]
        return Section(anchor, interface_terms.title, tuple(blocks))

    def write_removed(self, record: InterfaceRecord, anchor: str) -> Section:
        """Return the section of a removed interface, as it was."""
        from archgen.views.agreement.term_changes import write_signed_kind

        removed_notice = Paragraph(inline_text.to_inlines(write_signed_kind("removed")), "error")
        interface_terms = record.terms
        version = ("Version", inline_text.to_inlines(interface_terms.version))
        facts = Facts((version, *show_facts(interface_terms.facts).rows))
        blocks: list[Block] = [
            removed_notice,
            facts,
            *self._promise_tables(interface_terms),
            self._ends_table(interface_terms),
        ]
        return Section(anchor, interface_terms.title, tuple(blocks))

    def _further_facts(self, interface_terms: InterfaceTerms) -> Iterator[tuple[str, Inlines]]:
        """Yield what is agreed in words, the requirements behind the interface, and its open points."""
        for row in list_word_rows(self.lookup, interface_terms, self.start_steps):
            yield row.title, row.inlines
        points = map(inline_text.message_to_inlines, interface_terms.open_points)
        if interface_terms.requirements:
            yield "Requirements", inline_text.join_lines(interface_terms.requirements)
        if interface_terms.open_points:
            yield "Open points", inline_text.join_lines(points)

    def _change_blocks(self, record: InterfaceRecord, mark: Inlines) -> Iterator[Block]:
        """Yield what happened to the interface since the earlier revision, old beside new."""
        if not self.changes or not mark:
            return
        change_kind = self.changes.change_kind(record.key)
        since_run = Text(f" since {self.changes.earlier_revision}")
        rows = tuple(_change_row(change) for change in self.changes.terms_of(record.key))
        if not rows:
            yield Paragraph((mark[0], since_run), "note" if change_kind == "added" else "warning")
        else:
            columns = make_columns(
                ("Term", 0.9), ("Change", 0.6), (f"At {self.changes.earlier_revision}", 1.3), ("Now", 1.3)
            )
            interface = record.terms.interface
            yield Table(
                f"table:changes/{interface.key}/{interface.pair[0]}",
                f"{record.terms.title}: what changed",
                columns,
                rows,
                numbered=False,
            )

    def _promise_tables(self, interface_terms: InterfaceTerms) -> Iterator[Table]:
        if interface_terms.promise_rows:
            giver = interface_terms.interface.pair[0]
            yield write_promise_table(
                f"table:promises/{interface_terms.interface.key}/{giver}",
                f"{interface_terms.title}: what is promised, and what is expected",
                join_owner_titles(self.lookup, [giver]),
                interface_terms.promise_rows,
            )

    def _ends_table(self, interface_terms: InterfaceTerms) -> Table:
        undecided = (
            ()
            if interface_terms.interface.flow == "physical"
            else inline_text.to_inlines(Text("not decided yet", muted=True))
        )
        rows = tuple(self._end_row(interface_end, undecided) for interface_end in interface_terms.ends)
        columns = make_columns(("Side", 0.7), ("Partner", 0.9), ("Component · port", 1.5), ("Node", 1.2), ("QoS", 1.3))
        name = f"table:ends/{interface_terms.interface.key}/{interface_terms.interface.pair[0]}"
        return tidy(Table(name, f"{interface_terms.title}: who gives and who takes", columns, rows, numbered=False))

    def _end_row(self, end: InterfaceEnd, undecided: Inlines) -> tuple[Inlines, ...]:
        component: Inlines = ()
        if end.component:
            place = join_surrounding_titles(self.lookup, end.component)
            component = (*((Text(f"{place} · "),) if place else ()), inline_text.component_link(end.component))
        port = inline_text.to_inlines(" · ", Text(end.port, code=True)) if end.port else ()
        return (
            inline_text.to_inlines(Text(end.role, strong=not end.is_taker)),
            inline_text.owner_links(self.lookup.architecture, end.owners)
            if end.owners
            else inline_text.to_inlines(Text("nobody", muted=True)),
            (*component, *port),
            self._node_runs(end.node) if end.node else undecided,
            inline_text.to_inlines(end.qos),
        )

    def _node_runs(self, name: str) -> Inlines:
        node = self.lookup.architecture.nodes[name]
        host = self.lookup.architecture.hosts.get(node.host or "")
        details = " · ".join(part for part in (node.status or "", f"on {host.title}" if host else "") if part)
        return inline_text.join_lines(
            [
                (inline_text.node_link(node),),
                *([inline_text.to_inlines(Text(details, muted=True))] if details else []),
            ]
        )

    def _field_blocks(self, interface_terms: InterfaceTerms, anchor: str) -> Iterator[Block]:
        message = interface_terms.interface.message
        if message is None:
            return
        if message in self.anchors_by_message:
            first_link = Text("the first interface that carries it", ref=self.anchors_by_message[message])
            yield Paragraph(
                inline_text.to_inlines("The fields of ", message_link(message), " stand at ", first_link, ".")
            )
            return
        # The writer is stateful: sections must be written in the order of the document.
        self.anchors_by_message[message] = anchor
        if interface_terms.field_rows:
            yield message_fields.field_table(message, interface_terms.field_rows)
        elif interface_terms.field_rows is not None:
            # That a definition is missing is one of the open points.
            yield Paragraph(inline_text.to_inlines(message_link(message), " has no fields."))

    def _chain_tables(self, interface_terms: InterfaceTerms) -> Iterator[Block]:
        rows = tuple(
            (
                inline_text.to_inlines(Text(self.lookup.architecture.chains[chain.id].title, ref=f"chain:{chain.id}")),
                timing_tables.deadline_cell(chain),
                timing_tables.duration_cell(chain.bound),
                inline_text.to_inlines(Text(chain.verdict, strong=chain.verdict != "met")) if chain.deadline else (),
            )
            for chain in interface_terms.chains
        )
        if rows:
            columns = make_columns(
                ("Chain that passes through it", 1.8),
                ("Deadline", 0.8, "right"),
                ("Expected at the latest", 1, "right"),
            )
            name = f"table:through/{interface_terms.interface.key}/{interface_terms.interface.pair[0]}"
            caption = f"{interface_terms.title}: chains that pass through it"
            yield tidy(Table(name, caption, (*columns, Column("Verdict", 0.7)), rows, numbered=False))


def _change_row(change: TermChange) -> tuple[Inlines, ...]:
    from archgen.views.agreement.term_changes import write_signed_kind

    return (
        inline_text.to_inlines(change.name),
        inline_text.to_inlines(write_signed_kind(change.kind)),
        inline_text.to_inlines(_shorten_value(change.before)) if change.before is not None else (),
        inline_text.to_inlines(_shorten_value(change.after)) if change.after is not None else (),
    )


def _shorten_value(text: str) -> str:
    """Shorten a long value, with the number of omitted characters."""
    return (
        text
        if len(text) <= _MAX_VALUE_LENGTH
        else f"{text[:_MAX_VALUE_LENGTH]} … ({len(text) - _MAX_VALUE_LENGTH} more characters)"
    )
