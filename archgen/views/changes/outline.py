"""The outline of a comparison: breaking changes, pictures, changes by group, chains, findings."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from archgen.compare import Change, Comparison
from archgen.diagnostic import Diagnostic, Severity
from archgen.views import words
from archgen.views.changes import telling
from archgen.views.shapes import (
    Block,
    Bullets,
    Column,
    Figure,
    Graph,
    Inlines,
    Outline,
    Paragraph,
    Section,
    Table,
    Text,
)

_ERRORS = 8


@dataclass(frozen=True, slots=True)
class Told:
    """A comparison with the names of its versions, the errors of reading either of them, and its pictures."""

    found: Comparison
    before: str
    after: str
    broken: tuple[Sequence[Diagnostic], Sequence[Diagnostic]] = ((), ())
    graphs: tuple[Graph, ...] = ()


def outline(told: Told) -> Outline:
    """Return the outline of a comparison document."""
    found = told.found
    sections = (
        _breaking(found),
        _pictures(told),
        _changes(found),
        _chains(found),
        _new(found),
        _silenced(found),
        _cured(found),
    )
    return Outline(
        title=found.after.architecture.project.title,
        subtitle=f"What changed: {told.before} → {told.after}",
        facts=tuple(_facts(told)),
        notices=tuple(_notices(told)),
        sections=tuple(section for section in sections if section),
    )


def _facts(told: Told) -> Iterator[tuple[str, Inlines]]:
    found = told.found
    yield "From", words.text(Text(told.before, code=True))
    yield "To", words.text(Text(told.after, code=True))
    yield "Changes", words.text("none" if found.empty else telling.counted(found))
    losers = telling.broken(found.changes)
    if losers:
        yield "Breaks", words.text(_partners(found, losers))
    if found.owners:
        yield "Concerns", words.text(_partners(found, found.owners))


def _partners(found: Comparison, names: Sequence[str]) -> str:
    known = {**found.before.architecture.partners, **found.after.architecture.partners}
    return ", ".join(known[name].title if name in known else name for name in names)


def _notices(told: Told) -> Iterator[Paragraph]:
    for side, errors in zip((told.before, told.after), told.broken, strict=True):
        if errors:
            said = (
                f" could not be read as a whole ({words.plural(len(errors), 'error')}). What stands there is left out."
            )
            listed = [
                run
                for each in errors[:_ERRORS]
                for run in (Text(f"{each.span}: ", code=True, line_break=True), *telling.runs(each.message))
            ]
            more = [Text(f"and {len(errors) - _ERRORS} more", line_break=True)] if len(errors) > _ERRORS else []
            yield Paragraph((Text(side, code=True), Text(said), *listed, *more), "error")
    if told.found.empty:
        said = "No change breaks another partner." if told.found.narrowed else "No change of the architecture."
        yield Paragraph(words.text(said), "note")


def _breaking(found: Comparison) -> Section | None:
    breaking = [change for change in found.changes if change.breaks]
    if not breaking:
        return None
    blocks: list[Block] = []
    if found.failing:
        blocks.append(Paragraph(telling.runs(telling.REFUSED), "error"))
    blocks.append(Bullets(tuple(_broken(change, found) for change in breaking)))
    return Section("changes:breaking", "Breaking changes", tuple(blocks))


def _broken(change: Change, found: Comparison) -> Inlines:
    lines: list[Text] = []
    for why, partners in telling.reasons(change).items():
        names = ", ".join(sorted(set(partners)))
        lines += [Text(f"breaks {names}", strong=True, line_break=True), Text(": "), *telling.runs(why)]
    accepted = telling.accepted(change, found)
    return (*_change(change), *lines, *([Text(accepted, line_break=True)] if accepted else []))


def _pictures(told: Told) -> Section | None:
    figures = tuple(Figure(f"figure:{graph.id}", graph.id, graph.title, graph.alt) for graph in told.graphs)
    return Section("changes:pictures", "Pictures", figures) if figures else None


def _changes(found: Comparison) -> Section | None:
    # Breaking changes have a section of their own and are not repeated.
    others = [change for change in found.changes if not change.breaks]
    sections = tuple(
        Section(
            f"changes:{part.id or part.title}",
            part.title or part.id,
            (Bullets(tuple(_change(change) for change in part.changes)),),
        )
        for part in telling.parts(others, found)
    )
    title = "Other changes" if len(others) < len(found.changes) else "Changes"
    return Section("changes:all", title, sections=sections) if sections else None


def _change(change: Change) -> Inlines:
    return (telling.sign(change), Text(" "), *telling.runs(change.text))


def _chains(found: Comparison) -> Section | None:
    if not found.chains:
        return None
    rows = tuple(
        (
            words.text(Text(each.id, code=True)),
            *(words.text(telling.bound(side)) for side in (each.before, each.after)),
            words.text(telling.grown(each)),
            words.text(telling.deadline(each)),
            words.text(Text(telling.verdict(each), strong=True)),
        )
        for each in found.chains
    )
    columns = (
        Column("Chain", 1.6),
        *(Column(name, 1, "right") for name in ("Before", "After", "Difference", "Deadline")),
        Column("Verdict"),
    )
    table = Table("table:chains", "Bounds of chains", columns, rows)
    return Section("changes:chains", "Latency of chains", (table,))


def _new(found: Comparison) -> Section | None:
    return _findings("new", "New findings", "What archgen finds now, and did not before", found.new)


def _silenced(found: Comparison) -> Section | None:
    return _findings(
        "silenced",
        "Silenced findings",
        "What archgen found before, and a comment or a setting hides now",
        found.silenced,
    )


def _cured(found: Comparison) -> Section | None:
    return _findings("cured", "Cured findings", "What archgen found before, and does not any more", found.cured)


def _findings(name: str, title: str, caption: str, findings: Sequence[Diagnostic]) -> Section | None:
    if not findings:
        return None
    order = list(Severity)
    # Gravest first; the sort is stable, so that findings of one severity keep the order of the files.
    listed = sorted(findings, key=lambda each: -order.index(each.severity or Severity.ERROR))
    rows = tuple(
        (
            words.text(str(each.severity or Severity.ERROR)),
            words.text(Text(each.rule, code=True)),
            telling.runs(each.message),
            words.text(Text(str(each.span), code=True)) if each.span.file else (),
        )
        for each in listed
    )
    columns = (Column("Severity", 0.6), Column("Rule", 1), Column("What", 3), Column("Where", 1.4))
    return Section(f"changes:{name}", title, (Table(f"table:{name}", caption, columns, rows),))
