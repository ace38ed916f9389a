"""The outline of an agreement: the partners, all interfaces at a glance and in detail, open points, signatures."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from archgen.model.architecture import Partner
from archgen.views import tables, words
from archgen.views.agreement.changes import SIGNS, Changes, Held
from archgen.views.agreement.interfaces import Interface
from archgen.views.agreement.sections import Writing
from archgen.views.agreement.terms import Terms, partners
from archgen.views.index import Index
from archgen.views.shapes import (
    Block,
    Column,
    Figure,
    Graph,
    Inlines,
    Outline,
    Paragraph,
    Section,
    Table,
    Text,
    without_empty_columns,
)

_READING = (
    "An element whose owner nobody wrote has that of its group or component, a node those of its components. Where an element "
    "belongs to several partners, or a component to one and its node to another, each of them answers for its interfaces, and "
    "the interface says so. What belongs to both partners at both ends is theirs together and not listed."
)


@dataclass(frozen=True, slots=True)
class Agreement:
    """What an agreement is made of. `earlier_lookup` is None unless changes are asked for; `notices` come first."""

    view: Index
    pair: tuple[str, str]
    held: tuple[Held, ...]
    graph: Graph
    revision: str = ""
    changes: Changes | None = None
    notices: tuple[Paragraph, ...] = ()
    before: Index | None = None
    """Look-ups of the architecture at the earlier revision."""

    @property
    def titles(self) -> tuple[str, str]:
        """Return the titles of both partners."""
        return partners(self.view, self.pair[:1]), partners(self.view, self.pair[1:])


def document(of: Agreement) -> Outline:
    """Return the outline of an agreement."""
    first, second = of.titles
    # One writer for both directions: it remembers which messages' fields are already in the document.
    writing = Writing(of.view, of.changes)
    ways = (of.pair, of.pair[::-1])
    return Outline(
        title=f"{first} and {second}",
        subtitle="Interface agreement",
        facts=tuple(_facts(of)),
        notices=(*of.notices, *_changed_notice(of)),
        sections=(
            _parties(of),
            _summary(of),
            *(section for way in ways for section in _way(of, writing, way)),
            *_removed(of),
            _open_points(of),
            _signatures(of),
        ),
    )


def _facts(of: Agreement) -> Iterator[tuple[str, Inlines]]:
    project = of.view.architecture.project
    yield "Between", words.lines(_party(of.view.architecture.partners[each]) for each in of.pair)
    yield "Project", words.text(project.title)
    if project.version:
        yield "Version", words.text(project.version)
    if of.revision:
        yield "Revision", words.text(of.revision)
    if of.changes:
        yield "Changes since", words.text(of.changes.since)
    if of.view.architecture.distro:
        yield "ROS distribution", words.text(of.view.architecture.distro)


def _party(partner: Partner) -> Inlines:
    return words.text(Text(partner.title, strong=True), *([f", {partner.contact}"] if partner.contact else []))


def _changed_notice(of: Agreement) -> tuple[Paragraph, ...]:
    if of.changes is None:
        return ()
    if not of.changes.some:
        return (Paragraph(words.text(f"Nothing between the two has changed since {of.changes.since}."), "note"),)
    counts = {
        "added": len(of.changes.added),
        "changed": len(of.changes.changed or {}),
        "removed": len(of.changes.removed),
    }
    said = ", ".join(f"{count} {kind}" for kind, count in counts.items() if count)
    return (Paragraph(words.text(f"Interfaces since {of.changes.since}: {said}."), "note"),)


def _parties(of: Agreement) -> Section:
    columns = (Column("Partner", 0.9), Column("Who it is", 1.6), Column("Contact", 1.1), Column("Gives", 0.5, "right"))
    rows = []
    for each in of.pair:
        partner = of.view.architecture.partners[each]
        gives = sum(held.terms.interface.pair[0] == each for held in of.held)
        rows.append(
            (
                words.text(Text(partner.title, strong=True)),
                words.text(" ".join((partner.description or "").split())),
                words.text(partner.contact) if partner.contact else (),
                words.text(words.plural(gives, "interface")),
            )
        )
    table = without_empty_columns(Table("table:parties", "The partners", columns, tuple(rows), numbered=False))
    drawing = Figure(f"figure:{of.graph.id}", of.graph.id, of.graph.title, of.graph.alt)
    return Section("page:parties", "Partners and scope", (table, Paragraph(words.text(_READING)), drawing))


def _summary(of: Agreement) -> Section:
    """List all interfaces, including removed ones."""
    rows = [_row(of, held) for held in of.held]
    rows += [_gone(of, held) for held in (of.changes.removed if of.changes else ())]
    columns = (
        Column("Interface", 1.6),
        Column("Change", 1.1),
        Column("From", 0.8),
        Column("What flows", 1.7),
        Column("Rate", 0.95),
        Column("Still open", 1),
    )
    table = without_empty_columns(Table("table:interfaces", "All interfaces", columns, tuple(rows)))
    given = {held.terms.interface.pair for held in of.held}
    quiet = (
        Paragraph(words.text(f"Nothing flows from {partners(of.view, way[:1])} to {partners(of.view, way[1:])}."))
        for way in (of.pair, of.pair[::-1])
        if way not in given
    )
    return Section("page:summary", "At a glance", (*([table] if rows else []), *quiet))


def _row(of: Agreement, held: Held) -> tuple[Inlines, ...]:
    found = held.terms
    return (
        words.text(Text(found.title, ref=found.interface.anchor)),
        mark(of.changes, held),
        words.text(partners(of.view, found.interface.pair[:1])),
        carried(found.interface),
        _rate(found),
        opened(found.missing, len(found.points)),
    )


def _rate(found: Terms) -> Inlines:
    """Return how often it flows, or within what it is answered, without the origin of the figure."""
    for name, value in found.facts:
        if name.startswith("Rate"):
            return value[:1]
        if name.startswith("Answers within") and not value[0].muted:
            return words.text("answered within ", value[0])
    return ()


def _gone(of: Agreement, held: Held) -> tuple[Inlines, ...]:
    found = held.terms
    return (
        words.text(Text(found.title, ref=f"removed:{found.interface.anchor}")),
        words.text(Text(SIGNS["removed"], change="removed")),
        words.text(partners(of.view, found.interface.pair[:1])),
        carried(found.interface),
        (),
        (),
    )


def carried(interface: Interface) -> Inlines:
    """Return what flows in a few words: the type, and the message that carries it."""
    said = [words.text(interface.type)] if interface.type and interface.type != interface.message else []
    said += [words.text(Text(interface.message, code=True))] if interface.message else []
    return words.lines(said) or words.text(interface.flow)


def opened(missing: Sequence[str], points: int) -> Inlines:
    """Return what is still to be settled: the unknown terms, and the number of findings."""
    said = [", ".join(missing)] if missing else []
    said += [words.plural(points, "finding")] if points else []
    return words.text("; ".join(said)) if said else ()


def mark(changes: Changes | None, held: Held) -> Inlines:
    """Return the change of an interface as sign and word, with the kinds of terms that changed."""
    kind = changes.mark(held.key) if changes else ""
    if not changes or not kind:
        return ()
    names = ", ".join(dict.fromkeys(each.sort for each in changes.of(held.key)))
    return words.text(Text(SIGNS[kind], change=kind), *([f": {names}"] if names else []))


def _way(of: Agreement, writing: Writing, way: tuple[str, ...]) -> Iterator[Section]:
    giver, taker = (partners(of.view, [each]) for each in way)
    mine = [held for held in of.held if held.terms.interface.pair == way]
    if mine:
        sections = tuple(writing.section(held, held.terms.interface.anchor, mark(of.changes, held)) for held in mine)
        name = f"From {giver} to {taker}"
        lead = Paragraph(words.text(f"{giver} gives, {taker} takes: {words.plural(len(mine), 'interface')}."))
        yield Section(f"way:{way[0]}", name, (lead,), sections)


def _removed(of: Agreement) -> Iterator[Section]:
    if of.changes and of.changes.removed and of.before:
        # Removed interfaces are described by the architecture that had them.
        writing = Writing(of.before)
        lead = Paragraph(words.text(f"These stood in the agreement at {of.changes.since}, and are gone."), "warning")
        sections = tuple(writing.removed(held, f"removed:{held.terms.interface.anchor}") for held in of.changes.removed)
        yield Section("page:removed", "Removed", (lead,), sections)


def _open_points(of: Agreement) -> Section:
    """List what is not settled, and every finding at either end."""
    missing = [(held.terms, held.terms.missing) for held in of.held if held.terms.missing]
    rows = tuple(
        (words.text(Text(found.title, ref=found.interface.anchor)), words.text(", ".join(names)))
        for found, names in missing
    )
    blocks: list[Block] = []
    if rows:
        columns = (Column("Interface"), Column("Not settled yet", 1.4))
        blocks.append(Table("table:missing", "Terms that are not settled yet", columns, rows))
    own = list(dict.fromkeys(point for held in of.held for point in held.terms.points))
    ends = {end.component.id for held in of.held for end in held.terms.ends if end.component}
    ends |= {end.node for held in of.held for end in held.terms.ends if end.node}
    near = [finding for finding in of.view.findings if finding.element in ends and finding not in own]
    listed = (tables.open_points(own, "table:points"), tables.open_points(near, "table:near"))
    for table, caption in zip(listed, ("Findings on the interfaces", "Other findings at their ends"), strict=True):
        if table:
            blocks.append(Table(table.anchor, caption, table.columns, table.rows))
    if not blocks:
        blocks.append(
            Paragraph(words.text("Nothing is open: every term is settled, and archgen finds nothing at either end."))
        )
    return Section("page:open", "Open points", tuple(blocks))


def _signatures(of: Agreement) -> Section:
    revision = f", at revision {of.revision}" if of.revision else ""
    title = of.view.architecture.project.title
    lead = Paragraph(
        words.text(f"The partners agree on the interfaces of {title} as this document states them{revision}.")
    )
    blank = words.lines([words.text("\u00a0")] * 3)
    rows = tuple((words.text(title), blank, blank, blank) for title in of.titles)
    columns = (Column("Partner", 1.2), Column("Name", 1.3), Column("Date", 0.8), Column("Signature", 1.5))
    table = Table("table:signatures", "Signatures", columns, rows, numbered=False)
    return Section("page:signatures", "Signatures", (lead, table))
