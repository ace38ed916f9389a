"""Simulation results for people: each figure beside its bound, and a mark wherever it exceeds the bound."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction
from textwrap import wrap

from archgen.simulation import simulation_assumptions
from archgen.simulation.chain_witnesses import bound_data_ages, bound_utilisation, upper_bound
from archgen.simulation.simulation_result import ObservedChain, SimulationResult, list_seen_shares
from archgen.timing.analysis import Analysis, ChainResult
from archgen.timing.chains.chain_verdicts import SeenVerdict
from archgen.timing.figures.timing_values import TimingValue

_MS = 10**6
_WIDTH = 110
_MAX_NAMES = 3
"""The most elements that a line names; `--format json` lists all."""
_SEEN_WORDS: Mapping[SeenVerdict, str] = {"kept": "kept", "late": "LATE", "too few": "too few"}
_NOTHING_RAN = (
    "Nothing ran: no element has a period or a rate, and so nothing begins. Write what is known, at the sources first:",
    "    timing: {period: 20 ms, wcet: 3 ms}",
    "`archgen timing` names what else is missing.",
)


def format_simulation(
    title: str, result: SimulationResult, analysis: Analysis, chains: Mapping[str, ChainResult]
) -> str:
    """Return the whole report as text."""
    lines = [
        title,
        "",
        f"Simulated {result.seconds} s from {_name_seeds(result)}: {result.events:,} events. What was seen is no bound: the worst",
        "case may be worse. Beside it stand the bounds of `archgen timing`, which the worst case cannot exceed.",
    ]
    if not any(observed.jobs for observed in result.activities.values()):
        return "\n".join([*lines[:2], *_NOTHING_RAN]) + "\n"
    lines += _chain_lines(result, analysis, chains)
    lines += _activity_lines(result, analysis)
    lines += _fusion_lines(result, analysis)
    lines += _freshness_lines(result, analysis)
    lines += _host_lines(result, analysis)
    lines += _drop_lines(result, analysis)
    lines += _assumption_lines(result, analysis)
    return "\n".join(lines) + "\n"


def _name_seeds(result: SimulationResult) -> str:
    if result.seeds > 1:
        return f"each of {result.seeds} seeds"
    return f"seed {result.first_seed}"


def _wrap_sentence(sentence: str) -> Iterator[str]:
    """Break a sentence into lines; all but the first are indented."""
    yield from wrap(sentence, _WIDTH, subsequent_indent="  ", break_long_words=False, break_on_hyphens=False)


def _format_row(name: str, *cells: str) -> str:
    return (f"  {_cut_name(name):36}" + "".join(f"{cell:>12}" for cell in cells)).rstrip()


def _cut_name(name: str) -> str:
    return name if len(name) <= 36 else f"{name[:35]}…"  # noqa: PLR2004 - the column's width


def _chain_lines(result: SimulationResult, analysis: Analysis, chains: Mapping[str, ChainResult]) -> Iterator[str]:
    if not result.chains:
        yield from ("", "No chain is written: `chains` says whose reaction times matter.")
        return
    age_bounds = bound_data_ages(analysis, chains)
    yield from ("", _format_row("Chains (ms)", "least", "median", "95 %", "largest", "bound", "deadline"))
    for key, observed in result.chains.items():
        deadline = upper_bound(chains[key].deadline)
        is_marked = _is_conditional_bound(observed, chains[key])
        figures = observed.bounded_figures if is_marked else observed.all_inputs
        for quantity, distribution, bound in (
            ("reaction", figures.reaction, chains[key].bound),
            ("age", figures.age, age_bounds[key]),
        ):
            cells = (
                (distribution.least, distribution.median, distribution.percentile_95, distribution.largest)
                if distribution
                else (None,) * 4
            )
            bound_cells = (_format_bound(bound, cells[-1]) + "*" * is_marked, _format_ms(deadline))
            yield _format_row(f"{key} {quantity}", *map(_format_ms, cells), *bound_cells)
    yield from _share_lines(result, chains)
    marked_chains = {
        key: observed for key, observed in result.chains.items() if _is_conditional_bound(observed, chains[key])
    }
    if marked_chains:
        yield from (
            "",
            "  * Only inputs that each element sends on as soon as it has worked on them, as the bound assumes. Over all inputs,",
            "    also those that wait until a later one is sent on, there is no bound:",
        )
        for key, observed in marked_chains.items():
            yield from _all_inputs_lines(key, observed, analysis)


def _share_lines(result: SimulationResult, chains: Mapping[str, ChainResult]) -> Iterator[str]:
    """Yield the deadlines of shares of the reactions beside what these took."""
    rows = [
        _format_row(f"{key}, {seen.share}", _format_ms(seen.limit), _format_ms(seen.seen), _SEEN_WORDS[seen.verdict])
        for key, observed in result.chains.items()
        for seen in list_seen_shares(observed, chains[key])
    ]
    if rows:
        yield from ("", _format_row("Shares of reactions (ms)", "deadline", "seen", "here"), *rows)
        yield "  Kept or late in these runs: how often what happens nobody knows of the robot, and nothing is proven."


def _is_conditional_bound(observed: ObservedChain, chain_result: ChainResult) -> bool:
    """Return whether the bound beside the figures does not hold for all inputs."""
    return observed.forwarded_inputs is not None and upper_bound(chain_result.bound) is not None


def _all_inputs_lines(chain_id: str, observed: ObservedChain, analysis: Analysis) -> Iterator[str]:
    input_count = observed.forwarded_inputs.input_count if observed.forwarded_inputs else 0
    reaction, age = (
        distribution.largest if distribution else None
        for distribution in (observed.all_inputs.reaction, observed.all_inputs.age)
    )
    overall = (
        f"over all, reaction up to {_format_ms(reaction)}, age up to {_format_ms(age)}"
        if reaction
        else "nothing came through"
    )
    yield f"    {chain_id}: {input_count:,} of {observed.all_inputs.input_count:,} inputs; {overall}"
    yield from (
        f"        {phrase}"
        for phrase in simulation_assumptions.list_selective_elements(analysis.system, observed.through)
    )


def _activity_lines(result: SimulationResult, analysis: Analysis) -> Iterator[str]:
    yield from ("", _format_row("Elements (ms)", "jobs/s", "response", "bound", "largest gap", "bound"))
    for key, observed in result.activities.items():
        if not observed.jobs:
            continue
        response, rates = analysis.responses.get(key), analysis.paces.get(key)
        yield _format_row(
            key,
            f"{float(observed.rate):.3f}",
            _format_ms(observed.worst_response),
            _format_bound(response.worst if response else None, observed.worst_response),
            _format_ms(observed.activation_gap),
            _format_bound(rates.gap if rates else None, observed.activation_gap),
        )
    idle = [key for key, observed in result.activities.items() if not observed.jobs]
    if idle:
        yield from _wrap_sentence(f"  Never ran: {', '.join(idle)}.")


def _fusion_lines(result: SimulationResult, analysis: Analysis) -> Iterator[str]:
    """Yield how old and how far apart in time the messages were that elements have matched."""
    fused = {key: observed for key, observed in result.activities.items() if observed.fused_age is not None}
    if fused:
        yield from ("", _format_row("Matched by time (ms)", "oldest", "apart", "within"))
    for key, observed in fused.items():
        within = analysis.system.activities[key].within or 0
        yield _format_row(
            key, *map(_format_ms, (observed.fused_age, observed.fused_spread, within * analysis.system.tick))
        )


def _freshness_lines(result: SimulationResult, analysis: Analysis) -> Iterator[str]:
    """Yield how old messages were when they were read, where a reader says how old they may be."""
    rows = [
        (f"{key} <- {port}", observed.read_ages.get(port), limit * analysis.system.tick)
        for key, observed in result.activities.items()
        for port, limit in analysis.system.activities[key].freshness.items()
    ]
    if rows:
        yield from ("", _format_row("Age of what was read (ms)", "oldest", "may be"))
    for name, age, limit in rows:
        yield _format_row(name, _format_ms(age), _format_ms(limit))


def _host_lines(result: SimulationResult, analysis: Analysis) -> Iterator[str]:
    if result.hosts:
        yield from ("", _format_row("Load (of all cores)", "mean", "busiest run", "long run"))
    for key, observed in result.hosts.items():
        yield _format_row(
            key,
            *(
                _format_share(share)
                for share in (observed.mean_load, observed.largest_load, bound_utilisation(analysis, key))
            ),
        )
    loads = ((observed.largest_load, bound_utilisation(analysis, key)) for key, observed in result.hosts.items())
    if any(limit is not None and observed > limit for observed, limit in loads):
        yield "  The long run's share is a bound in the long run only: in a short one each element may have a job more."
    if result.links:
        yield from ("", _format_row("Links (ms)", "load", "wait", "bound"))
    for key, link in result.links.items():
        load = analysis.links.get(key)
        yield _format_row(
            key,
            _format_share(link.share),
            _format_ms(link.wait),
            _format_bound(load.queueing if load else None, link.wait),
        )


def _drop_lines(result: SimulationResult, analysis: Analysis) -> Iterator[str]:
    """Yield the lines on lost samples, those that fire their reader first: overwriting sampled inputs is normal."""
    # Only an input that fires loses work when a sample is dropped.
    firing_drops = {
        key: count for key, count in result.drops.items() if key[1] in analysis.system.activities[key[0]].triggers
    }
    if firing_drops:
        yield from (
            "",
            f"  {'Samples that fired nothing: their queue was full, or a newer one came first':82}{'count':>10}",
        )
        yield from (
            f"  {f'{element} <- {topic}':82}{count:>10,}" for (element, _, topic), count in firing_drops.items()
        )
    overwritten = [
        f"{element} <- {topic}" for element, _, topic in result.drops if (element, _, topic) not in firing_drops
    ]
    if overwritten:
        yield from (
            "",
            f"Overwritten before their reader looked, as is usual where a reader does not wait for its input: {_join_first_names(overwritten)}.",
        )


def _assumption_lines(result: SimulationResult, analysis: Analysis) -> Iterator[str]:
    yield ""
    phrases = simulation_assumptions.find_simulated_contradictions(result, analysis)
    if phrases:
        yield "What contradicts itself; there a figure may exceed its bound (!):"
        yield from (f"  {phrase}" for phrase in phrases)
    yield from _wrap_sentence(
        f"Drawn at random: {'; '.join(simulation_assumptions.list_random_choices(analysis.system))}."
    )
    for default in simulation_assumptions.list_default_figures(analysis.system):
        yield from _wrap_sentence(
            f"Not written: {default.figure}, taken as {default.assumed_value}: {_join_first_names(default.element_ids)}."
        )
    # These two are listed above, among the figures that were filled in.
    unknown_figures = [
        phrase for phrase in result.unknown_figures if not phrase.startswith(("execution time of", "latency from"))
    ]
    if unknown_figures:
        yield from _wrap_sentence(f"Not known, so that nothing runs by it: {', '.join(unknown_figures)}.")
    yield "Not simulated, among others: preemption costs, interrupts, lost packets, callers that wait (docs/simulation.md)."


def _join_first_names(names: Sequence[str]) -> str:
    suffix = f" and {len(names) - _MAX_NAMES} more" if len(names) > _MAX_NAMES + 1 else ""
    return ", ".join(names[:_MAX_NAMES] if suffix else names) + suffix


def _format_ms(value: Fraction | None) -> str:
    return "-" if value is None else f"{float(value / _MS):.3f}"


def _format_bound(bound: TimingValue | None, observed: Fraction | None) -> str:
    """Format a bound, with a `!` if more than it was observed."""
    limit = upper_bound(bound)
    if limit is None:
        return "no bound"
    return _format_ms(limit) + ("!" if observed is not None and observed > limit else "")


def _format_share(value: Fraction | None) -> str:
    return "-" if value is None else f"{float(value * 100):.1f} %"
