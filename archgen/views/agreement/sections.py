"""The section of one interface: terms, ends, fields of the message, chains, requirements, open points."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

from archgen.views import figures, words
from archgen.views.agreement import messages
from archgen.views.agreement.changes import SIGNS, Change, Changes, Held
from archgen.views.agreement.terms import End, Terms, partners
from archgen.views.index import Index
from archgen.views.shapes import Block, Column, Facts, Inlines, Paragraph, Section, Table, Text
from archgen.views.shapes import without_empty_columns as tidy

_CUT = 400
"""Maximal number of characters of a value in a table of changes."""


@dataclass(frozen=True, slots=True)
class Writing:
    """Writes sections. The fields of a message are at its first interface, later ones refer to it."""

    view: Index
    changes: Changes | None = None
    written: dict[str, str] = field(default_factory=dict)

    def section(self, held: Held, anchor: str, mark: Inlines) -> Section:
        """Return the section of one interface."""
        found = held.terms
        blocks = [
            *self._changed(held, mark),
            Facts((*found.facts, *_rest(found))),
            self._ends(found),
            *(Paragraph(words.text(said), "note") for said in found.shared),
            *self._fields(found, anchor),
            *self._chains(found),
        ]
        return Section(anchor, found.title, tuple(blocks))

    def removed(self, held: Held, anchor: str) -> Section:
        """Return the section of a removed interface, as it was."""
        gone = Paragraph(words.text(Text(SIGNS["removed"], change="removed")), "error")
        return Section(anchor, held.terms.title, (gone, Facts(held.terms.facts), self._ends(held.terms)))

    def _changed(self, held: Held, mark: Inlines) -> Iterator[Block]:
        """Yield what happened to the interface since the earlier revision, old beside new."""
        if not self.changes or not mark:
            return
        kind = self.changes.mark(held.key)
        since = Text(f" since {self.changes.since}")
        yield Paragraph((mark[0], since), "note" if kind == "added" else "warning")
        rows = tuple(_change(change) for change in self.changes.of(held.key))
        if rows:
            columns = (Column("Term", 0.9), Column("Change", 0.6), Column("Was", 1.3), Column("Is now", 1.3))
            name = held.terms.interface
            yield Table(f"table:changes/{name.key}/{name.pair[0]}", f"{held.terms.title}: what changed", columns, rows)

    def _ends(self, found: Terms) -> Table:
        undecided = () if found.interface.flow == "physical" else words.text(Text("not decided yet", muted=True))
        rows = tuple(self._end(end, undecided) for end in found.ends)
        columns = (
            Column("Side", 0.7),
            Column("Partner", 0.9),
            Column("Component · port", 1.5),
            Column("Node", 1.2),
            Column("QoS", 1.3),
        )
        name = f"table:ends/{found.interface.key}/{found.interface.pair[0]}"
        return tidy(Table(name, f"{found.title}: who gives and who takes", columns, rows))

    def _end(self, end: End, undecided: Inlines) -> tuple[Inlines, ...]:
        component = words.text(end.component.title) if end.component else ()
        port = words.text(" · ", Text(end.port, code=True)) if end.port else ()
        return (
            words.text(Text(end.role, strong=not end.taker)),
            words.text(partners(self.view, end.owners)) if end.owners else words.text(Text("nobody", muted=True)),
            (*component, *port),
            self._node(end.node) if end.node else undecided,
            words.text(end.qos) if end.qos else (),
        )

    def _node(self, name: str) -> Inlines:
        node = self.view.architecture.nodes[name]
        host = self.view.architecture.hosts.get(node.host or "")
        rest = " · ".join(part for part in (node.status or "", f"on {host.title}" if host else "") if part)
        return words.lines([words.text(Text(name, code=True)), *([words.text(Text(rest, muted=True))] if rest else [])])

    def _fields(self, found: Terms, anchor: str) -> Iterator[Block]:
        message = found.interface.message
        if message is None:
            return
        if message in self.written:
            first = Text("the first interface that carries it", ref=self.written[message])
            yield Paragraph(words.text("The fields of ", Text(message, code=True), " stand at ", first, "."))
            return
        # The writer is stateful: sections must be written in the order of the document.
        self.written[message] = anchor
        if found.rows:
            yield messages.table(message, found.rows)
        else:
            said = "has no fields." if found.rows is not None else "is not held: its fields cannot be shown."
            lead = "" if found.rows is not None else "The definition of "
            yield Paragraph(words.text(lead, Text(message, code=True), f" {said}"))

    def _chains(self, found: Terms) -> Iterator[Block]:
        rows = tuple(
            (
                words.text(self.view.architecture.chains[chain.id].title),
                words.text(figures.duration(chain.bound)),
                words.text(figures.duration(chain.deadline)) if chain.deadline else (),
                words.text(Text(chain.verdict, strong=chain.verdict != "met")),
            )
            for chain in found.chains
        )
        if rows:
            columns = (Column("Chain", 1.8), Column("At the latest", 0.9, "right"), Column("Deadline", 0.8, "right"))
            name = f"table:through/{found.interface.key}/{found.interface.pair[0]}"
            caption = f"{found.title}: chains that pass through it"
            yield tidy(Table(name, caption, (*columns, Column("Verdict", 0.7)), rows))


def _change(change: Change) -> tuple[Inlines, ...]:
    return (
        words.text(change.name),
        words.text(Text(SIGNS[change.kind], change=change.kind)),
        words.text(cut(change.before)) if change.before is not None else (),
        words.text(cut(change.after)) if change.after is not None else (),
    )


def cut(text: str) -> str:
    """Shorten a long value, with the number of omitted characters."""
    return text if len(text) <= _CUT else f"{text[:_CUT]} … ({len(text) - _CUT} more characters)"


def _rest(found: Terms) -> Iterator[tuple[str, Inlines]]:
    """Yield the requirements behind the interface, and its open points."""
    if found.requirements:
        yield "Requirements", words.lines(found.requirements)
    if found.points:
        yield "Open points", words.lines(words.spoken(f"{point.severity}: {point.message}") for point in found.points)
