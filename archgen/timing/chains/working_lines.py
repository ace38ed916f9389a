"""The workings of responses and links as sentences: each term with its factors, so that all can be followed by hand.

Largest gaps and rates follow from what fires an activity, with the numbers: `41 ms + (3.9 ms - 900 us) = 44 ms`.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from fractions import Fraction

from archgen.diagnostics.source_span import NO_SPAN, Span
from archgen.frozen import NamedTuple, dataclass
from archgen.timing.analysis import Analysis
from archgen.timing.chains.trigger_arrivals import TriggerArrivals
from archgen.timing.figures import figure_wording
from archgen.timing.figures.timing_values import TimingValue, UnknownCause, is_known_bound
from archgen.timing.load.event_models import arriving_model, entering_model
from archgen.timing.load.propagation_state import PropagationState
from archgen.timing.load.work_terms import ANY_AMOUNT, FigureWorking, ThreadShare, WorkTerm
from archgen.timing.rates.link_traffic import LinkWorking
from archgen.timing.system.timing_system import Activity, Arc


class ReasonLine(NamedTuple):
    """One step of the reasoning; deeper lines support the one above them."""

    depth: int
    text: str
    at: Span = NO_SPAN


@dataclass(frozen=True, slots=True)
class WorkingLines:
    """Writes workings; durations in them are in ticks of `tick` ns."""

    tick: Fraction

    def _write(self, ticks: int | Fraction) -> str:
        return figure_wording.format_duration(ticks * self.tick)

    def explain_response(self, working: FigureWorking, depth: int) -> Iterator[ReasonLine]:
        """Yield how a response, or the time of a run, comes about."""
        if working.addends:
            parts = " + ".join(self._write(each.value) for each in working.addends)
            before, last = " > ".join(working.steps[:-1]), working.steps[-1]
            yield ReasonLine(depth, f"{parts} = {self._write(working.value)}: first {before}, then {last}")
            for addend in working.addends:
                yield from self.explain_response(addend, depth + 1)
            return
        if working.core_count > 1 or working.leads:
            yield from self._explain_shared(working, depth)
        else:
            has_counts = any(term.events.formula != str(term.events.number) for term in working.terms)
            counts_text = "; of each ceil((t + how much later it may come) / how often)" if has_counts else ""
            core_text = f", on core {working.core} alone" if working.core is not None else ""
            core_text += ", cores and what their threads use taken as one," if working.is_joined else ""
            head = (
                "the longest t in which there may be work all the time, until an activation that comes too soon,"
                if working.is_hold
                else f"the least t > 0 in which all of this is done{core_text}"
            )
            if working.is_queue:
                head, counts_text = "what is done in the queue until its end, its own work included,", ""
            yield ReasonLine(depth, f"{head} is {self._write(working.window)}{counts_text}:")
            yield from self.list_terms(working.terms, depth + 1)
            yield from self._sum_up([self._write(term.total) for term in working.terms], working.window, depth + 1)
        yield from self._explain_rest(working, depth)

    def _explain_shared(self, working: FigureWorking, depth: int) -> Iterator[ReasonLine]:
        """Yield A, the work of the threads that are waited for, and B, in which all cores are busy with others."""
        own_work = sum(term.total for term in working.terms)
        head = (
            "the longest t with A + B >= t, until an activation that comes too soon,"
            if working.is_hold
            else "the least t > 0 with A + B <= t"
        )
        beside = f"B the time in which all {working.core_count} cores may be busy with others"
        if working.leads:
            beside, head = "F what others are served before it on its core", head.replace("B", "F")
        yield ReasonLine(
            depth, f"{head} is {self._write(working.window)}: A is the work of its own threads, {beside}"
        )  # fmt: skip
        yield from self.list_terms(working.terms, depth + 1)
        parts = [self._write(term.total) for term in working.terms]
        sum_text = f" = {self._write(own_work)}" if len(parts) > 1 else ""
        yield ReasonLine(depth + 1, f"A = {' + '.join(parts)}{sum_text}" if parts else "A = 0 ms")
        if working.leads:
            yield from self._explain_serving(working, own_work, depth + 1)
        elif working.blocked_time:
            yield from self._explain_blocking(working, depth + 1)
        else:
            count = len(working.shares)
            others = f"the {count} other threads that have work" if count else "no other thread has work, which"
            yield ReasonLine(depth + 1, f"B = 0 ms: {others} cannot keep {working.core_count} cores busy all at once")
        relation = "=" if working.work == working.window else "<=" if working.work < working.window else ">="
        yield ReasonLine(
            depth + 1,
            f"{self._write(own_work)} + {self._write(working.blocked_time)} {relation} {self._write(working.window)}, A + {'F' if working.leads else 'B'}{' until then' if working.is_hold else ''}",
        )

    def _explain_serving(self, working: FigureWorking, own_work: int, depth: int) -> Iterator[ReasonLine]:
        """Yield what others are served before a thread that shares its core fairly: no thread more than A and a lead."""
        yield from self.list_terms(working.beside_terms, depth)
        leads = f"{len(working.leads)} x " if len(working.leads) > 1 else ""
        cut = self._write(own_work + sum(working.leads))
        yield ReasonLine(
            depth,
            f"no other thread is served more than {self._write(own_work)} + {leads}{self._write(working.leads[0])} = {cut}, "
            f"A and a lead{' for each job' if leads else ''}{self._describe_cuts(working.shares, 'that')}",
        )
        parts = [f"{self._write(share.counted)} {'/'.join(share.unit)}" for share in working.shares]
        yield ReasonLine(
            depth, " = ".join(["F", *filter(None, (" + ".join(parts),)), self._write(working.blocked_time)])
        )

    def _explain_blocking(self, working: FigureWorking, depth: int) -> Iterator[ReasonLine]:
        """Yield what all cores may be busy with: what comes, thread by thread, and what is pending from before."""
        yield from self.list_terms(working.beside_terms, depth)
        if working.is_backlog:
            yield from self._explain_backlog(working, depth)
            return
        parts = [f"{self._write(share.counted)} {'/'.join(share.unit)}" for share in working.shares]
        parts += [f"{self._write(working.pending)} pending"] if working.pending else []
        yield ReasonLine(
            depth,
            f"B = ({' + '.join(parts)}) / {working.core_count} = {self._write(working.blocked_time)}, what each of "
            f"{len(working.shares)} other threads has to do{self._describe_cuts(working.shares)}",
        )
        if working.pending:
            yield ReasonLine(
                depth + 1,
                f"{self._write(working.pending)} pending: what may be left over from before (carry-in), as at most "
                f"{working.core_count - 1} threads had work when the last core became busy",
            )

    def _explain_backlog(self, working: FigureWorking, depth: int) -> Iterator[ReasonLine]:
        """Yield what was pending when a core was idle last, and what of all that may be done before the figure ends."""
        yield from self.list_terms(working.pending_terms, depth)
        parts = [self._write(term.total) for term in (*working.beside_terms, *working.pending_terms)]
        own_work = sum(term.total for term in working.terms) - working.thread_wait
        left_parts = [self._write(ticks) for ticks in (own_work, working.unfinished) if ticks]
        left_text = "".join(f" - {part}" for part in left_parts)
        yield ReasonLine(
            depth,
            f"B = ({' + '.join(parts)}{left_text}) / {working.core_count} = {self._write(working.blocked_time)}: what comes, and "
            f"{self._write(working.pending)} that may have been pending when a core was idle last, without "
            f"{'the work in A' if working.thread_wait else 'A'}"
            f"{' and what is done after this' if working.unfinished else ''}",
        )

    def _describe_cuts(self, shares: Iterable[ThreadShare], word: str = "B") -> str:
        cuts = [share for share in shares if share.counted < share.work]
        if not cuts:
            return ""
        names = ", ".join(
            f"{' '.join(share.unit)} ({'any amount' if share.work >= ANY_AMOUNT else self._write(share.work)})"
            for share in cuts
        )
        return f", but none for longer than {word}: {names}" if word == "B" else f"; more to do have {names}"

    def _explain_rest(self, working: FigureWorking, depth: int) -> Iterator[ReasonLine]:
        """Yield what is taken off the window, where it does not begin with the activation."""
        if not working.arrival and not working.lead:
            return
        parts = [self._write(working.window)]
        reasons: list[str] = []
        if working.arrival:
            parts.append(self._write(working.arrival))
            who = "it" if working.is_queue else f"activation {working.activation}"
            reasons.append(f"{who} comes {parts[-1]} after the first at the earliest")
        if working.lead:
            parts.append(self._write(working.lead))
            reasons.append(
                f"t begins with the event, and {working.steps[-1]} {parts[-1]} after it at the earliest"
                if working.steps
                else f"t begins with the event, {parts[-1]} before the activation at least"
            )
        yield ReasonLine(depth, f"{' - '.join(parts)} = {self._write(working.value)}: {', and '.join(reasons)}")

    def list_terms(self, terms: Iterable[WorkTerm], depth: int) -> Iterator[ReasonLine]:
        """Yield terms: `3 x (2 ms scanner + 5 ms boxes) = 21 ms, since ceil((44 ms + 1 ms) / 40 ms) = 3`."""
        for term in terms:
            costs = _join_parts([f"{self._write(cost)} {name}" for name, cost in term.parts])
            number, formula = term.events
            reason = f", {term.reason}" if term.reason else ""
            because = "" if formula == str(number) else f", since {formula} = {number}"
            yield ReasonLine(depth, f"{number} x {costs} = {self._write(term.total)}{because}{reason}")

    def _sum_up(self, parts: list[str], total: int, depth: int) -> Iterator[ReasonLine]:
        if len(parts) > 1:
            yield ReasonLine(depth, f"{' + '.join(parts)} = {self._write(total)}")

    def explain_link(self, working: LinkWorking, depth: int) -> Iterator[ReasonLine]:
        """Yield how the queueing and the largest burst of a link come about."""
        write_size = figure_wording.format_size
        speed = f"{write_size(working.bandwidth)}/s"
        yield ReasonLine(
            depth,
            f"the least t > 0 in which all is sent that comes in t, at {speed}, is {self._write(working.window)}:",
        )
        yield from self.list_terms(working.terms, depth + 1)
        yield from self._sum_up([self._write(term.total) for term in working.terms], working.window, depth + 1)
        burst = Fraction(working.burst)
        when = f"{self._write(working.time)} after the first messages" if working.time else "all that comes at once"
        yield ReasonLine(
            depth,
            f"{write_size(burst)} / {speed} = {figure_wording.format_duration(burst / working.bandwidth * 10**9)}"
            f" for the largest burst alone, {when}:",
        )
        for term in working.burst_terms:
            sizes = _join_parts([f"{write_size(Fraction(size))} {name}" for name, size in term.parts])
            yield ReasonLine(depth + 1, f"{term.events.number} x {sizes} = {write_size(Fraction(term.total))}")
        if working.time:
            sent = working.bandwidth * working.time * self.tick / 10**9
            yield ReasonLine(depth + 1, f"{self._write(working.time)} x {speed} = {write_size(sent)} are sent by then")
        if len(working.burst_terms) == 1 and not working.time:
            return
        totals = " + ".join(write_size(Fraction(term.total)) for term in working.burst_terms)
        sent_text = f" - {write_size(working.bandwidth * working.time * self.tick / 10**9)}" if working.time else ""
        yield ReasonLine(depth + 1, f"{totals}{sent_text} = {write_size(burst)}")


def _join_parts(parts: Iterable[str]) -> str:
    """Write a sum in brackets, equal parts as a product; one part alone as it is."""
    numbers: dict[str, int] = {}
    for part in parts:
        numbers[part] = numbers.get(part, 0) + 1
    products = [part if number == 1 else f"{number} x {part}" for part, number in numbers.items()]
    return products[0] if len(products) == 1 else f"({' + '.join(products)})"


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
