"""Verdicts on timing: how an architecture does in a few sentences, what is late and why, and a table of all chains."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction

from archgen.timing.analysis import ChainResult
from archgen.timing.value import Value
from archgen.views import charts, figures, loads, timing, words
from archgen.views.index import Index
from archgen.views.shapes import Block, Bullets, Column, Inlines, Paragraph, Table, Text
from archgen.views.timed import Timed


def summary(timed: Timed) -> Paragraph:
    """Summarize in a few sentences how many rates are known and how many chains meet their deadlines."""
    found = timed.analysis.paces.values()
    # What runs on demand or once has no rate by nature, so it is not counted as a gap.
    known = sum(pace.rate.value is not None or pace.behaviour in {"on_demand", "once"} for pace in found)
    said = [f"Of {words.plural(len(found), 'activity')}, {known} have a known rate or run on demand or once."]
    if timed.chains:
        verdicts = ["without a deadline" if _free(result) else result.verdict for result in timed.chains]
        counts = [(name, verdicts.count(name)) for name in ("met", "missed", "open", "without a deadline")]
        told = ", ".join(f"{count} {name}" for name, count in counts if count)
        said.append(f"Of {words.plural(len(timed.chains), 'chain')} of effect: {told}.")
    said.append("All bounds are safe for the figures written; what they rest on beside them stands with each.")
    return Paragraph(words.text(" ".join(said)))


def _free(result: ChainResult) -> bool:
    """Whether a chain is open only because it has no deadline."""
    return result.deadline is None and result.bound.complete and result.bound.value is not None


def late(view: Index, timed: Timed) -> Iterator[Block]:
    """List chains that miss their deadline or have no bound, then overloaded hosts, with the reasons."""
    chains = [
        (Text(view.architecture.chains[result.id].title, ref=f"chain:{result.id}"), charts.verdict(result, timed))
        # Certain misses come before what may be late.
        for verdict in ("missed", "open")
        for result in timed.chains
        if result.verdict == verdict and not _free(result) and result.id in view.architecture.chains
    ]
    hosts = [
        (Text(view.architecture.hosts[name].title, ref=f"host:{name}"), loads.load_verdict(load))
        for name, load in timed.analysis.hosts.items()
        if load.verdict == "overload"
    ]
    if chains or hosts:
        yield Bullets(tuple(words.text(who, f". {said}") for who, said in (*chains, *hosts)))


def troubles(timed: Timed) -> Iterator[Block]:
    """List rings of triggers that never end or never start, and activities for which no bound was found."""
    found = timed.analysis
    kinds = (
        ("An event that enters circulates for ever among", found.endless),
        ("Each waits for the other, and none ever starts:", found.deadlocked),
        # Single activities, wrapped so that they are printed like the rings.
        ("No bound was found, since each step made the next one larger:", tuple((name,) for name in found.diverged)),
    )
    for lead, rings in kinds:
        if rings:
            yield Paragraph(words.text(lead), "error")
            yield Bullets(tuple(words.joined((timing.named(timed, name) for name in ring), " → ") for ring in rings))


def chains(view: Index, timed: Timed) -> Table | None:
    """List chains with bound, best case, largest step and verdict."""
    rows = tuple(
        (
            words.text(Text(view.architecture.chains[result.id].title, ref=f"chain:{result.id}")),
            timing.figure(figures.duration(result.bound)),
            timing.figure(figures.least(result.best)),
            _largest(timed, result),
            timing.figure(figures.duration(result.deadline)) if result.deadline else (),
            words.text(Text(result.verdict, strong=result.verdict != "met")),
            words.text(figures.missing(result.bound, timed.analysis, 3)),
        )
        for result in timed.chains
        if result.id in view.architecture.chains
    )
    columns = (
        Column("Chain", 1.6),
        Column("At the latest", 0.9, "right"),
        Column("At the earliest", 0.9, "right"),
        Column("Largest step", 1.5),
        Column("Deadline", 0.8, "right"),
        Column("Verdict", 0.7),
        Column("Missing", 1.6),
    )
    # The same anchor as `make_chain_table`, which this table replaces; only one of them is ever in a document.
    return timing.tidy(Table("table:chains", "Chains of effect: bounds and deadlines", columns, rows)) if rows else None


def _largest(timed: Timed, result: ChainResult) -> Inlines:
    """Name the step with the largest part of a chain's bound: the first one to look at."""
    sums = [(charts.known(term), term.activity) for term in result.terms]
    most = max((value for value, _ in sums), default=Fraction(0))
    if not most:
        return ()
    # Of equal steps the first one in the chain.
    name = next(name for value, name in sums if value == most)
    return words.text(*timing.named(timed, name), f" {figures.duration(Value(most))}")
