"""Timing for people: a summary for the terminal, chains term by term, ways between two elements."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from fractions import Fraction

from archgen.findings.escape import visible, width
from archgen.timing import wording
from archgen.timing.analysis import Analysis, ChainResult, HostLoad, Term
from archgen.timing.chains import Found
from archgen.timing.rounds import Round
from archgen.timing.value import Value
from archgen.timing.why import behaviour

_SIGNS = {"met": "met", "missed": "MISSED", "open": "open"}
Row = Sequence[str]


def summary(analysis: Analysis, chains: Mapping[str, ChainResult], loops: Iterable[Round]) -> Iterator[str]:
    """Yield the whole picture: chains first, then hosts, links, services, elements, loops."""
    yield from _section("Chains: largest reaction time (= largest data age)", _chain_rows(chains.values()))
    yield from _section("Hosts", _host_rows(analysis))
    yield from _section("Links", _link_rows(analysis))
    yield from _section(
        "Services and actions: longest time from a call until it is worked off", _service_rows(analysis)
    )
    yield from _section("Elements", _element_rows(analysis))
    yield from _section("Loops: latency of one round", _loop_rows(loops))
    yield from _faults(analysis)


def _section(title: str, rows: Iterable[Row]) -> Iterator[str]:
    made = list(rows)
    if made:
        yield title
        yield from table(made)
        yield ""


def _chain_rows(chains: Iterable[ChainResult]) -> Iterator[Row]:
    for result in chains:
        deadline = f"deadline {figure(result.deadline)}" if result.deadline else "no deadline"
        yield result.id, figure(result.bound), deadline, _SIGNS[result.verdict] if result.deadline else "", gaps(result)


def _host_rows(analysis: Analysis) -> Iterator[Row]:
    for name, load in analysis.hosts.items():
        cores = f"{load.cores} core{'s' if load.cores != 1 else ''}"
        used = f"load {figure(load.utilisation, wording.share)}"
        yield name, cores, used, load.verdict, without(load.utilisation) or _bounds(load)


def _bounds(load: HostLoad) -> str:
    """Return the utilisation bounds of Liu and Layland, on one core."""
    by_rate, by_deadline = load.rate_monotonic_bound.value, load.earliest_deadline_bound.value
    if by_rate is None or by_deadline is None or len(load.parts) < 2:  # noqa: PLR2004 - one alone needs no order
        return ""
    # Rounded down: a displayed bound that is a little too high would promise too much.
    rounded_down = Fraction(by_rate * 1000 // 1, 1000)
    return f"priorities by rate are sure to do up to {wording.share(rounded_down)}, deadlines up to {wording.share(by_deadline)}"


def _link_rows(analysis: Analysis) -> Iterator[Row]:
    for name, load in analysis.links.items():
        traffic = figure(load.traffic, lambda count: f"{wording.size(count)}/s")
        share = f"{figure(load.share, wording.share)} of it" if load.share.value is not None else "share unknown"
        yield name, traffic, share, without(load.traffic)


def _service_rows(analysis: Analysis) -> Iterator[Row]:
    for name, load in analysis.services.items():
        many = len(load.callers)
        yield name, f"{many} caller{'s' if many != 1 else ''}", figure(load.worst), without(load.worst)


def _element_rows(analysis: Analysis) -> Iterator[Row]:
    for name in analysis.system.activities:
        pace, response = analysis.paces[name], analysis.responses[name]
        how = behaviour(analysis.system.activities[name], pace)
        rate, gap = figure(pace.rate, wording.rate), figure(pace.gap)
        yield name, how, rate, f"gap {gap}", f"response {figure(response.worst)} ({response.tier})"


def _loop_rows(loops: Iterable[Round]) -> Iterator[Row]:
    for each in loops:
        steps = len(each.through) - 1
        part = f"one round of {each.members} elements that feed one another" if each.members > steps else ""
        yield " > ".join(each.through), figure(each.latency), part or without(each.latency)


def _faults(analysis: Analysis) -> Iterator[str]:
    for ring in analysis.endless:
        yield f"endless: every event circulates for ever in {' > '.join(ring)}"
    for ring in analysis.deadlocked:
        yield f"deadlock: each waits for the other in {' > '.join(ring)}"
    if analysis.diverged:
        yield f"diverged: no bound was found for {wording.listed(analysis.diverged)}"


def chain(result: ChainResult, age: Value, published: tuple[Fraction, Fraction] | None = None) -> Iterator[str]:
    """Yield a chain term by term, with the reason and the place of each; `age` is its largest data age."""
    yield f"{result.id}: {' > '.join(result.through)}"
    if result.terms:
        yield from table(_term_rows(result.terms))
        yield ""
    rows: list[Row] = [("largest reaction time = largest data age", figure(result.bound), gaps(result))]
    if age != result.bound:
        rows = [("largest reaction time, from the event on", figure(result.bound), gaps(result))]
        rows.append(("largest data age, until the next event's comes", figure(age), without(age)))
    rows += [
        ("reduced reaction time (from the first sample on)", figure(result.reduced_reaction)),
        ("reduced data age (when the last element sends)", figure(result.reduced_age)),
        ("best case", figure(result.best)),
    ]
    if published:
        rows.append(("with priorities and implicit communication (Duerr): reaction", wording.duration(published[0])))
        rows.append(("    reduced data age", wording.duration(published[1])))
    if result.deadline:
        rows.append(("deadline", figure(result.deadline), _SIGNS[result.verdict]))
    yield from table(rows)
    for assumption in result.bound.assumptions if result.terms else ():
        yield f"  assumes: {assumption}"


def _term_rows(terms: Iterable[Term]) -> Iterator[Row]:
    yield "element", "link", "waits", "response", "why"
    for term in terms:
        place = f" ({term.at})" if term.at.file else ""
        link = figure(term.link) if term.link.value != 0 else "-"
        yield term.activity, link, figure(term.sampling), figure(term.response), f"{term.why}{place}"


def ways(source: str, target: str, count: int, worst: Iterable[Found], best: Iterable[Found]) -> Iterator[str]:
    """Yield the ways between two elements."""
    yield f"{source} to {target}: {count} way{'s' if count != 1 else ''}"
    if not count:
        yield "  nothing that leaves the first reaches the second; ask the other way round?"
    for title, found in (("worst", worst), ("best case", best)):
        for at, way in enumerate(found, 1):
            yield f"  {title} {at}: {figure(way.bound)}   {' > '.join(way.through)}"
            if not way.bound.complete:
                yield f"      no bound: {without(way.bound)}"


def gaps(result: ChainResult) -> str:
    """Return what a chain's bound lacks: `no bound: execution time of x, y unknown`; empty where it lacks nothing."""
    if result.bound.complete:
        return ""
    said = []
    links = {name for term in result.terms for name in term.link.missing}
    for what, values in (
        ("period or rate", [term.sampling for term in result.terms]),
        ("execution time", [term.response for term in result.terms]),
        ("latency", [term.link for term in result.terms]),
    ):
        lacking = dict.fromkeys(name for value in values for name in value.missing if not value.complete)
        # An unknown latency makes the waiting time unknown as well: it is named once, as a latency.
        names = tuple(name for name in lacking if what != "period or rate" or name not in links)
        if names:
            said.append(f"{what} of {wording.listed(names)} unknown")
    named = {name for term in result.terms for v in (term.sampling, term.response, term.link) for name in v.missing}
    # The bound is the maximum over all ways, the terms are those of one of them.
    elsewhere = tuple(name for name in result.bound.missing if name not in named)
    if elsewhere and result.terms:
        said.append(f"on other ways, figures of {wording.listed(elsewhere)} unknown")
    said += [text for text in result.bound.assumptions if not result.terms or text == "diverged"]
    return f"{_basis(result)}no bound: {'; '.join(said)}" if said else "no bound"


def _basis(result: ChainResult) -> str:
    if result.bound.value is None:
        return ""
    parts = [value for term in result.terms for value in (term.response, term.link)]
    return "(what is known) " if any(value.value for value in parts) else "(periods only) "


def without(value: Value) -> str:
    """Return which elements' figures a value lacks."""
    return f"unknown: {wording.listed(value.missing)}" if value.missing and not value.complete else ""


def figure(value: Value | None, write: Callable[[Fraction], str] = wording.duration) -> str:
    """Format a value: `202 ms`, `>= 468 ms`, `unknown`, `unbounded (overload)`."""
    if value is None:
        return ""
    if value.value is None:
        why = wording.reason(value)
        return f"unbounded ({why})" if why == "overload" else why
    mark = "" if value.complete else {"at least": ">= ", "at most": "<= "}.get(value.side, ">= ")
    return mark + write(value.value)


def table(rows: Iterable[Row]) -> Iterator[str]:
    """Yield rows in aligned columns; the last cell of a row needs no width."""
    # Made visible before it is measured: replacements may have another width.
    made = [[visible(cell) for cell in row] for row in rows]
    columns = max((len(row) for row in made), default=0)
    widths = [max((width(row[at]) for row in made if at < len(row) - 1), default=0) for at in range(columns)]
    for row in made:
        cells = [cell + " " * (widths[at] - width(cell)) for at, cell in enumerate(row[:-1])]
        yield ("  " + "  ".join([*cells, row[-1]])).rstrip()
