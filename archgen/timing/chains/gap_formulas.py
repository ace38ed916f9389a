"""How largest gaps and rates follow from what fires an activity, with the numbers: `41 ms + (3.9 ms - 900 us) = 44 ms`."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction

from archgen.timing.analysis import Analysis
from archgen.timing.chains.trigger_arrivals import TriggerArrivals
from archgen.timing.figures import figure_wording
from archgen.timing.figures.timing_values import TimingValue, UnknownCause
from archgen.timing.figures.value_arithmetic import is_known_bound
from archgen.timing.load.event_models import arriving_model, entering_model
from archgen.timing.load.propagation_state import PropagationState
from archgen.timing.system.timing_system import Activity, Arc


def list_gap_formulas(analysis: Analysis, name: str) -> Iterator[tuple[str, str]]:
    """Yield how the largest gap of an activity comes about: each formula, and what it is made of."""
    activity = analysis.system.activities[name]
    tick = analysis.system.tick
    if activity.period is not None and activity.jitter:
        total = _write(activity.period * tick + activity.jitter * tick)
        yield f"{_write(activity.period * tick)} + {_write(activity.jitter * tick)} = {total}", "period and jitter"
    if activity.behaviour != "event":
        return
    arrivals = TriggerArrivals(analysis)
    arcs = [
        arc
        for arc in analysis.system.arcs_into.get(name, ())
        if arc.role == "data"
        and arrivals.fires_reader(arc)
        and analysis.system.activities[arc.source].behaviour != "once"
    ]
    gaps = [_arriving_gap(analysis, arc) for arc in arcs]
    for arc, gap in zip(arcs, gaps, strict=True):
        formula = _write_arrival(analysis, arc, gap)
        if formula:
            yield formula
    known_gaps = [gap for gap in gaps if gap is not None]
    if len(known_gaps) == len(gaps) and known_gaps and activity.period is None:
        yield from _write_firing(analysis, activity, [arc.input for arc in arcs], known_gaps)


def list_lateness_formulas(analysis: Analysis, name: str) -> Iterator[tuple[str, str]]:
    """Yield how much later than regularly what fires an activity may come: the jitter that its windows count with."""
    state, arrivals = analysis.state, TriggerArrivals(analysis)
    for arc in analysis.system.arcs_into.get(name, ()) if state else ():
        model = arriving_model(state, arc) if state and arrivals.fires_reader(arc) else ()
        if state and not isinstance(model, UnknownCause) and len(model) == 1 and model[0].jitter:
            formula = _write_lateness(analysis, state, arc, model[0].jitter)
            if formula:
                yield formula, f"so much later than regularly events from {arc.source} may come"


def _write_lateness(analysis: Analysis, state: PropagationState, arc: Arc, jitter: int) -> str:
    """Return what makes a message late: the jitter of its event, the time until it is sent, the link."""
    source, tick = analysis.system.activities[arc.source], analysis.system.tick
    response, origin = state.responses[arc.source].value, state.event_models[arc.source]
    shortest = 0 if arc.role == "request" else source.bcet or 0
    ways = state.ways_to.get(arc.source, ()) if source.response is None else ()
    if len(ways) == 1 and len(ways[0].steps) > 1:
        response, origin = ways[0].delay, entering_model(state, ways[0])
        shortest += ways[0].best_before
    if response is None or isinstance(origin, UnknownCause) or len(origin) != 1 or arc.worst is None:
        return ""
    spans = ((origin[0].jitter, 0), (response, min(shortest, response)), (arc.worst, arc.best or 0))
    if sum(longest - least for longest, least in spans) != jitter:
        return ""
    parts = [
        _write(longest * tick) if not least else f"({_write(longest * tick)} - {_write(least * tick)})"
        for longest, least in spans
        if longest != least
    ]
    return f"{' + '.join(parts)} = {_write(jitter * tick)}"


def list_wait_formulas(analysis: Analysis, name: str, wait: Fraction) -> Iterator[tuple[str, str]]:
    """Yield how long a chain's step waits at an activity: its largest gap, or what its triggers let it wait."""
    activity, formulas = analysis.system.activities[name], list(list_gap_formulas(analysis, name))
    storing_wait = find_storing_part(analysis, name, wait)
    if storing_wait:
        yield from list_wait_formulas(analysis, name, wait - storing_wait)
        yield (
            f"waits {_write(wait - storing_wait)} + {_write(storing_wait)} = {_write(wait)}",
            "until it is activated, and until what it reads is stored",
        )
    elif analysis.paces[name].gap.value == wait:
        yield from ((f"gap {formula}", words) for formula, words in formulas)
    elif activity.behaviour == "event":
        # The last formula is that of its own gap; those before are what arrives.
        has_own = bool(formulas) and formulas[-1][0].endswith(
            f"= {_write(analysis.paces[name].gap.value or Fraction(0))}"
        )
        yield from ((f"gap {formula}", words) for formula, words in (formulas[:-1] if has_own else formulas))
        yield from _write_thinning(analysis, activity, wait)


def find_storing_part(analysis: Analysis, name: str, wait: Fraction) -> Fraction:
    """Return how much of a step's wait is that for being stored: 0 where the step does not wait for that."""
    gap = TriggerArrivals(analysis).activation_gap(name).value
    storing_wait = analysis.storing_waits[name].value if name in analysis.storing_waits else None
    return storing_wait if gap is not None and storing_wait and gap + storing_wait == wait else Fraction(0)


def _write_thinning(analysis: Analysis, activity: Activity, wait: Fraction) -> Iterator[tuple[str, str]]:
    """Yield how long `every`, `throttle` and `jitter` let a trigger wait, where that is the whole wait."""
    arrivals, tick = TriggerArrivals(analysis), analysis.system.tick
    gap, closest = arrivals.firing_gap(activity).value, arrivals.min_trigger_gap(activity).value or Fraction(0)
    if gap is None:
        return
    count = activity.every if activity.throttle else activity.every - 1
    parts, value, words = [], gap * count, []
    if count:
        parts.append(_write(gap) if count == 1 else f"{count} x {_write(gap)}")
        words.append(f"up to {count} more trigger{'s' if count > 1 else ''}, {_write(gap)} apart at most")
    for ticks, word in ((activity.throttle, "throttle"), (activity.jitter, "jitter")):
        if ticks:
            value += ticks * tick
            parts.append(_write(ticks * tick))
            words.append(f"{word} {parts[-1]}")
    formula = " + ".join(parts)
    if activity.throttle and closest:
        value -= closest
        formula += f" - {_write(closest)}"
        words.append(f"what waits came {_write(closest)} after the last firing at least")
    if value == wait and words:
        yield f"waits {formula} = {_write(wait)}", "; ".join(words)


def _arriving_gap(analysis: Analysis, arc: Arc) -> Fraction | None:
    pace = analysis.outputs.get((arc.source, arc.output))
    if pace is None or pace.gap.value is None or not is_known_bound(pace.gap) or arc.worst is None:
        return None
    return pace.gap.value + (arc.worst - (arc.best or 0)) * analysis.system.tick


def _write_arrival(analysis: Analysis, arc: Arc, total: Fraction | None) -> tuple[str, str] | None:
    """Return the gap of what an arc brings: the source's gap, R - B, and what the link adds."""
    source_gap, response = analysis.paces[arc.source].gap.value, analysis.responses[arc.source].worst.value
    promised = analysis.system.activities[arc.source].max_gaps.get(arc.output)
    if total is None or source_gap is None or response is None or arc.worst is None:
        return None
    tick = analysis.system.tick
    best = analysis.responses[arc.source].best.value or Fraction(0)
    link_spread = (arc.worst - (arc.best or 0)) * tick
    parts, words, value = [_write(source_gap)], [f"the largest gap of {arc.source}"], source_gap
    if promised is not None and promised * tick + link_spread == total:
        parts, words, value = [_write(promised * tick)], [f"{arc.source} promises it (max_gap)"], promised * tick
    elif response != best:
        parts.append(f"({_write(response)} - {_write(best)})")
        words.append("its response less its best case (R - B)")
        value += response - best
    if link_spread:
        parts.append(f"({_write(arc.worst * tick)} - {_write((arc.best or 0) * tick)})")
        words.append(f"what {arc.link} adds")
        value += link_spread
    if value != total or (len(parts) == 1 and promised is None):
        return None
    return f"{' + '.join(parts)} = {_write(total)}", ", ".join(words)


def _write_firing(
    analysis: Analysis, activity: Activity, keys: list[str], gaps: list[Fraction]
) -> Iterator[tuple[str, str]]:
    """Yield how the gap of an activity follows from those of what arrives."""
    by_key: dict[str, list[Fraction]] = {}
    for key, gap in zip(keys, gaps, strict=True):
        by_key.setdefault(key, []).append(gap)
    smallest = [min(key_gaps) for key_gaps in by_key.values()]
    waits_for_all = activity.mode == "all" and len(smallest) > 1
    value = max(smallest) if waits_for_all else min(gaps)
    formula = _write(value)
    words = [] if len(gaps) == 1 else ["the largest counts" if waits_for_all else "the smallest counts"]
    if len(gaps) > 1:
        shown = smallest if waits_for_all else gaps
        formula = f"{'max' if waits_for_all else 'min'}({', '.join(map(_write, shown))})"
    if activity.every > 1:
        value, formula = value * activity.every, f"{activity.every} x {formula}"
        words.append(f"one in {activity.every} fires it")
    tick = analysis.system.tick
    for ticks, word in ((activity.throttle, "throttle"), (activity.jitter, "jitter")):
        if ticks:
            value, formula = value + ticks * tick, f"{formula} + {_write(ticks * tick)}"
            words.append(f"{word} {_write(ticks * tick)}")
    if analysis.paces[activity.id].gap.value == value and words:
        yield f"{formula} = {_write(value)}", "; ".join(words)


def multiply_rate(rate: TimingValue, factor: str, product: str) -> str:
    """Write a product with a rate: `20 Hz x 22 ms = 44 %`; the product alone where the rate is not known."""
    if rate.value is None:
        return product
    return f"{figure_wording.format_rate(rate.value)} x {factor} = {product}"


def _write(nanoseconds: Fraction) -> str:
    return figure_wording.format_duration(nanoseconds)
