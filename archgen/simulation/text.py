"""Simulation results for people: each figure beside its bound, and a mark wherever it exceeds the bound."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction
from textwrap import wrap

from archgen.simulation import taken
from archgen.simulation.compared import ages, known, utilisation
from archgen.simulation.result import ChainSeen, Result
from archgen.timing.analysis import Analysis, ChainResult
from archgen.timing.value import Value

_MS = 10**6
_WIDTH = 110
_NAMED = 3
"""The most elements that a line names; `--format json` lists all."""
_NOTHING_RAN = (
    "Nothing ran: no element has a period or a rate, and so nothing begins. Write what is known, at the sources first:",
    "    timing: {period: 20 ms, wcet: 3 ms}",
    "`archgen timing` names what else is missing.",
)


def text(title: str, result: Result, analysis: Analysis, chains: Mapping[str, ChainResult]) -> str:
    """Return the whole report as text."""
    lines = [
        title,
        "",
        f"Simulated {result.seconds} s from each of {result.seeds} seeds: {result.events:,} events. What was seen is no bound: the worst",
        "case may be worse. Beside it stand the bounds of `archgen timing`, which the worst case cannot exceed.",
    ]
    if not any(seen.jobs for seen in result.activities.values()):
        return "\n".join([*lines[:2], *_NOTHING_RAN]) + "\n"
    lines += _chains(result, analysis, chains)
    lines += _activities(result, analysis)
    lines += _hosts(result, analysis)
    lines += _drops(result, analysis)
    lines += _taken(result, analysis)
    return "\n".join(lines) + "\n"


def _wrapped(words: str) -> Iterator[str]:
    """Break a sentence into lines; all but the first are indented."""
    yield from wrap(words, _WIDTH, subsequent_indent="  ", break_long_words=False, break_on_hyphens=False)


def _row(name: str, *cells: str) -> str:
    return (f"  {_cut(name):36}" + "".join(f"{cell:>12}" for cell in cells)).rstrip()


def _cut(name: str) -> str:
    return name if len(name) <= 36 else f"{name[:35]}…"  # noqa: PLR2004 - the column's width


def _chains(result: Result, analysis: Analysis, chains: Mapping[str, ChainResult]) -> Iterator[str]:
    if not result.chains:
        yield from ("", "No chain is written: `chains` says whose reaction times matter.")
        return
    oldest = ages(analysis, chains)
    yield from ("", _row("Chains (ms)", "least", "median", "95 %", "largest", "bound", "deadline"))
    for key, seen in result.chains.items():
        deadline = known(chains[key].deadline)
        marked = _is_marked(seen, chains[key])
        best = seen.comparable if marked else seen.every
        for what, spread, bound in (("reaction", best.reaction, chains[key].bound), ("age", best.age, oldest[key])):
            figures = (spread.least, spread.median, spread.most_of_it, spread.largest) if spread else (None,) * 4
            ends = (_cell(bound, figures[-1]) + "*" * marked, _figure(deadline))
            yield _row(f"{key} {what}", *map(_figure, figures), *ends)
    several = {key: seen for key, seen in result.chains.items() if _is_marked(seen, chains[key])}
    if several:
        yield from (
            "",
            "  * Only inputs that each element sends on as soon as it has worked on them, as the bound assumes. Over all inputs,",
            "    also those that wait until a later one is sent on, there is no bound:",
        )
        for key, seen in several.items():
            yield from _all_inputs(key, seen, analysis)


def _is_marked(seen: ChainSeen, chain: ChainResult) -> bool:
    """Return whether the bound beside the figures does not hold for all inputs."""
    return seen.passing is not None and known(chain.bound) is not None


def _all_inputs(key: str, seen: ChainSeen, analysis: Analysis) -> Iterator[str]:
    counted = seen.passing.inputs if seen.passing else 0
    reaction, age = (spread.largest if spread else None for spread in (seen.every.reaction, seen.every.age))
    over_all = (
        f"over all, reaction up to {_figure(reaction)}, age up to {_figure(age)}"
        if reaction
        else "nothing came through"
    )
    yield f"    {key}: {counted:,} of {seen.every.inputs:,} inputs; {over_all}"
    yield from (f"        {said}" for said in taken.choosy(analysis.system, seen.through))


def _activities(result: Result, analysis: Analysis) -> Iterator[str]:
    yield from ("", _row("Elements (ms)", "jobs/s", "response", "bound", "largest gap", "bound"))
    for key, seen in result.activities.items():
        if not seen.jobs:
            continue
        response, pace = analysis.responses.get(key), analysis.paces.get(key)
        yield _row(
            key,
            f"{float(seen.rate):.3f}",
            _figure(seen.worst),
            _cell(response.worst if response else None, seen.worst),
            _figure(seen.activation_gap),
            _cell(pace.gap if pace else None, seen.activation_gap),
        )
    idle = [key for key, seen in result.activities.items() if not seen.jobs]
    if idle:
        yield from _wrapped(f"  Never ran: {', '.join(idle)}.")


def _hosts(result: Result, analysis: Analysis) -> Iterator[str]:
    if result.hosts:
        yield from ("", _row("Load (of all cores)", "mean", "busiest run", "long run"))
    for key, seen in result.hosts.items():
        yield _row(key, *(_share(share) for share in (seen.mean, seen.largest, utilisation(analysis, key))))
    loads = ((seen.largest, utilisation(analysis, key)) for key, seen in result.hosts.items())
    if any(limit is not None and seen > limit for seen, limit in loads):
        yield "  The long run's share is a bound in the long run only: in a short one each element may have a job more."
    if result.links:
        yield from ("", _row("Links (ms)", "load", "wait", "bound"))
    for key, link in result.links.items():
        load = analysis.links.get(key)
        yield _row(key, _share(link.share), _figure(link.wait), _cell(load.queueing if load else None, link.wait))


def _drops(result: Result, analysis: Analysis) -> Iterator[str]:
    """Yield the lines on lost samples, those that fire their reader first: overwriting sampled inputs is normal."""
    # Only an input that fires loses work when a sample is dropped.
    fires = {key: count for key, count in result.drops.items() if key[1] in analysis.system.activities[key[0]].triggers}
    if fires:
        yield from (
            "",
            f"  {'Samples that fired nothing: their queue was full, or a newer one came first':82}{'count':>10}",
        )
        yield from (f"  {f'{element} <- {topic}':82}{count:>10,}" for (element, _, topic), count in fires.items())
    rest = [f"{element} <- {topic}" for element, _, topic in result.drops if (element, _, topic) not in fires]
    if rest:
        yield from (
            "",
            f"Overwritten before their reader looked, as is usual where a reader does not wait for its input: {_names(rest)}.",
        )


def _taken(result: Result, analysis: Analysis) -> Iterator[str]:
    yield ""
    contradictions = taken.contradictions(result, analysis)
    if contradictions:
        yield "What contradicts itself; there a figure may exceed its bound (!):"
        yield from (f"  {said}" for said in contradictions)
    yield from _wrapped(f"Drawn at random: {'; '.join(taken.drawn(analysis.system))}.")
    for default in taken.defaults(analysis.system):
        yield from _wrapped(f"Not written: {default.figure}, taken as {default.taken}: {_names(default.of)}.")
    # These two are listed above, among the figures that were filled in.
    others = [said for said in result.unknown if not said.startswith(("execution time of", "latency from"))]
    if others:
        yield from _wrapped(f"Not known, so that nothing runs by it: {', '.join(others)}.")
    yield "Not simulated, among others: preemption costs, interrupts, lost packets, callers that wait (docs/simulation.md)."


def _names(names: Sequence[str]) -> str:
    more = f" and {len(names) - _NAMED} more" if len(names) > _NAMED + 1 else ""
    return ", ".join(names[:_NAMED] if more else names) + more


def _figure(value: Fraction | None) -> str:
    return "-" if value is None else f"{float(value / _MS):.3f}"


def _cell(bound: Value | None, seen: Fraction | None) -> str:
    """Format a bound, with a `!` if more than it was observed."""
    limit = known(bound)
    if limit is None:
        return "no bound"
    return _figure(limit) + ("!" if seen is not None and seen > limit else "")


def _share(value: Fraction | None) -> str:
    return "-" if value is None else f"{float(value * 100):.1f} %"
