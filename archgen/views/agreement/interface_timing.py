"""How often and how much an interface carries, and which chains pass through it."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction

from archgen.analyses.kept_promises import list_sent_limits
from archgen.frozen import NamedTuple, dataclass, replace
from archgen.model.declared_timing import OutputTiming, Timing
from archgen.model.node import Endpoint
from archgen.model.partner_interfaces import PartnerInterface, list_givers
from archgen.timing.analysis import ChainResult, EventPace, find_pace
from archgen.timing.chains.chain_verdicts import LimitState, judge_upper_limit
from archgen.timing.figures.timing_values import TimingValue
from archgen.timing.system import activity_builder
from archgen.timing.system.message_sizes import MessageSize
from archgen.timing.system.timing_system import Arc, TimingSystem
from archgen.views import inline_text
from archgen.views.agreement.promise_rows import (
    MAX_GAP,
    RATE,
    SOURCE_PHRASE,
    PromiseRow,
    PromiseStrength,
    TermName,
    promise_limit,
)
from archgen.views.lookup import Lookup
from archgen.views.shapes import Inlines, Text
from archgen.views.timing import timing_tables, value_format
from archgen.views.timing.timing_lookup import TimingLookup

_NO_TIMING = Timing()
_SIZE_PARTS = {
    "topic": (("Size", ""),),
    "service": (("Size of a request", "_Request"), ("Size of an answer", "_Response")),
    "action": (("Size of a goal", "_Goal"), ("Size of a result", "_Result"), ("Size of feedback", "_Feedback")),
}


def promise_timing(
    lookup: Lookup, activity_names: activity_builder.ActivityNames, interface: PartnerInterface
) -> Iterator[PromiseRow]:
    """Yield rate, largest gap, size and traffic; for a service or action, how soon it answers."""
    if interface.flow == "physical":
        return
    timed = lookup.timing
    givers = list_givers(lookup.architecture, interface)
    if timed is not None:
        for endpoint in givers:
            node = endpoint.node if len(givers) > 1 else ""
            yield from _GivenPace(lookup, timed, activity_names, endpoint, node).list_rows()
    for name, part in _SIZE_PARTS[interface.flow]:
        message = f"{interface.message}{part}" if interface.message else None
        size = lookup.message_size(message, None if part else interface.type)
        if size.bytes is not None or interface.flow == "topic":
            yield _size_row(TermName("size", name), size)
    if timed is not None and interface.flow == "topic":
        yield PromiseRow(TermName("traffic", "Traffic"), expected=_traffic_runs(timed, interface))


def find_giver_timing(lookup: Lookup, endpoint: Endpoint) -> Timing:
    """Return what is written of the timing behind an endpoint."""
    return lookup.architecture.nodes[endpoint.node].timing.get(endpoint.component or "", _NO_TIMING)


class JudgedWords(NamedTuple):
    """A promise with what follows from figures: a sentence in two parts, whether it is kept, and the figure."""

    promise: str
    words: str
    state: LimitState
    bound: TimingValue

    @property
    def sentence(self) -> str:
        """Return the sentence."""
        return f"{self.promise}: {self.words}."


def judge_sent_gaps(
    lookup: Lookup, activity_names: activity_builder.ActivityNames, endpoint: Endpoint
) -> Iterator[JudgedWords]:
    """Yield what a node promises of the gap between two messages, with the one that is expected."""
    if lookup.timing is None or endpoint.flow != "topic":
        return
    gap = find_pace(lookup.timing.analysis, activity_names, endpoint).gap
    figure = _spell_duration(gap)
    most = figure if figure.startswith("at least") else f"up to {figure}"
    # A gap without a value is one without a bound.
    expected = "there is no bound" if gap.value is None else f"{most} is expected"
    for key, limit in list_sent_limits(lookup.architecture, endpoint):
        name = {"timing.max_gap": "largest gap", "qos.deadline": "QoS deadline"}[key]
        promise = f"The {name} of {limit} that `{endpoint.node}` promises may not be kept"
        yield JudgedWords(promise, expected, judge_upper_limit(gap, limit.value), gap)


@dataclass(frozen=True, slots=True)
class _GivenPace:
    """What one endpoint gives, and how often. `node` is its node where several give."""

    lookup: Lookup
    timed: TimingLookup
    activity_names: activity_builder.ActivityNames
    endpoint: Endpoint
    node: str

    @property
    def activity(self) -> str:
        return activity_builder.activity_of_endpoint(self.activity_names, self.endpoint)

    @property
    def timing(self) -> Timing:
        return find_giver_timing(self.lookup, self.endpoint)

    def list_rows(self) -> Iterator[PromiseRow]:
        if self.endpoint.flow != "topic":
            yield self._answer_row()
            return
        pace = find_pace(self.timed.analysis, self.activity_names, self.endpoint)
        output_timing = self.timing.outputs.get(self.endpoint.port or "", OutputTiming())
        yield self._rate_row(pace, output_timing)
        if output_timing.conditional:
            yield PromiseRow(
                TermName("sent", "Sent", self.node), inline_text.to_inlines("only when there is something to send")
            )
        if self.timing.jitter:
            yield promise_limit(TermName("jitter", "Jitter", self.node), self.timing.jitter, "jitter", "up to {}")
        if pace.behaviour not in {"once", "on_demand"}:
            yield self._gap_row(pace, output_timing)

    def _rate_row(self, pace: EventPace, output_timing: OutputTiming) -> PromiseRow:
        name, words = replace(RATE, node=self.node), _spell_rate(pace)
        if pace.rate.value is not None and not pace.inferred:
            # "At each activation" is a promise of its own: an output that becomes conditional promises less.
            strength: PromiseStrength = {"rate": pace.rate.value, "each activation": int(not output_timing.conditional)}
            return PromiseRow(name, _make_figure(words, pace.rate.value), self._rate_by_inputs(pace), strength)
        if pace.behaviour in {"once", "on_demand"}:
            is_written = self.timing.behaviour is not None
            runs = _make_figure(words, pace.rate.value)
            return PromiseRow(name, runs) if is_written else PromiseRow(name, expected=runs)
        return PromiseRow(name, expected=self._expected_rate(pace, words))

    def _expected_rate(self, pace: EventPace, words: str) -> Inlines:
        if pace.rate.value is None:
            return ()
        origins = timing_tables.link_origins(self.timed, self.timed.rate_origins.get(self.activity, ()))
        source = f"{SOURCE_PHRASE}the rate of " if origins else ", computed"
        # Names of programs as plain text: in a contract they are words like others.
        return (*_make_figure(f"{words}{source}", pace.rate.value), *(replace(run, code=False) for run in origins))

    def _rate_by_inputs(self, pace: EventPace) -> Inlines:
        """Return what the inputs give, where that is another rate than the written one."""
        by_inputs = self.timed.analysis.derived.get(self.activity)
        if by_inputs is None or by_inputs.rate.value in {None, pace.rate.value}:
            return ()
        words = f"{_spell_signs(value_format.display_rate(by_inputs.rate))}{SOURCE_PHRASE}its inputs"
        return _make_figure(words, by_inputs.rate.value)

    def _gap_row(self, pace: EventPace, output_timing: OutputTiming) -> PromiseRow:
        # What is not conditional is sent at each activation: `max_gap` has no effect there.
        limit = output_timing.max_gap if output_timing.conditional else None
        words = _spell_duration(pace.gap)
        is_known = words != value_format.UNKNOWN_FIGURE and "promised" not in pace.gap.assumptions
        source = f"{SOURCE_PHRASE}when {self.activity} is activated and how long it takes" if pace.gap.value else ""
        name = replace(MAX_GAP, node=self.node)
        row = promise_limit(name, limit, "gap") if limit else PromiseRow(name)
        return replace(row, expected=inline_text.to_inlines(f"{words}{source}") if is_known else ())

    def _answer_row(self) -> PromiseRow:
        name, limit = TermName("response", "Answers within", self.node), self.timing.response
        if limit:
            return promise_limit(name, limit, "response")
        response = self.timed.analysis.responses.get(self.activity)
        if response is None or response.worst.value is None:
            return PromiseRow(name)
        source = (
            "its execution time, a core of its own assumed" if response.tier == "dedicated" else "the load of its host"
        )
        # "Answers within at least 20 ms" would read as a limit.
        figure = value_format.display_duration(response.worst)
        words = f"{figure.removeprefix('>= ')} or more" if figure.startswith(">= ") else figure
        return PromiseRow(name, expected=_make_figure(f"{words}{SOURCE_PHRASE}{source}", response.worst.value))


def _spell_rate(pace: EventPace) -> str:
    words = _spell_signs(value_format.format_short_rate(pace))
    return f"{words}-driven" if words.endswith(", event") else words


def _spell_duration(value: TimingValue) -> str:
    return _spell_signs(value_format.display_duration(value))


def _spell_signs(figures: str) -> str:
    """Return figures with words for their signs: not everybody who signs reads `<=`."""
    return figures.replace("<= ", "at most ").replace(">= ", "at least ")


def _size_row(name: TermName, size: MessageSize) -> PromiseRow:
    if size.bytes is None:
        return PromiseRow(name)
    amount = value_format.display_bytes(TimingValue(Fraction(size.bytes)))
    words = amount if size.exact else f"at most {amount}"
    if size.written:
        return PromiseRow(name, _make_figure(words, size.bytes), strength={"size": -size.bytes})
    return PromiseRow(name, expected=_make_figure(f"{words}{SOURCE_PHRASE}the definition of the message", size.bytes))


def _traffic_runs(timed: TimingLookup, interface: PartnerInterface) -> Inlines:
    loads = [(name, timed.analysis.topics.get(name)) for name in interface.topic_names]
    traffic_phrases = [
        f"{_spell_signs(value_format.display_traffic(load.published))}{f' on {name}' if len(interface.topic_names) > 1 else ''}"
        for name, load in loads
        if load and load.published.value is not None
    ]
    total = sum(load.published.value or 0 for _, load in loads if load)
    return _make_figure(f"{', '.join(traffic_phrases)}{SOURCE_PHRASE}rate and size", total) if traffic_phrases else ()


def _make_figure(words: str, number: Fraction | int | None) -> Inlines:
    """Return a figure in words, sorted by its number in the base unit."""
    return (Text(words, sort_number=None if number is None else str(number)),)


def find_chains_through(
    lookup: Lookup, activity_names: activity_builder.ActivityNames, interface: PartnerInterface
) -> Iterator[ChainResult]:
    """Yield the chains that lead over the interface from giver to taker."""
    if lookup.timing is None:
        return
    giver_keys = {activity_builder.endpoint_key(endpoint) for endpoint in interface.giver_endpoints}
    taking_activities = {
        activity_builder.activity_of_endpoint(activity_names, endpoint) for endpoint in interface.taker_endpoints
    }
    system = lookup.timing.analysis.system
    for result in lookup.timing.chains:
        steps = zip(result.through, result.through[1:], strict=False)
        named_outputs = {point.id for point in lookup.architecture.chains[result.id].through if point.kind == "output"}
        arcs = (
            arc
            for step, next_step in steps
            for arc in _arcs_between(system, step, next_step)
            # A chain that names an output of an element takes no other way from there.
            if arc.output in named_outputs or named_outputs.isdisjoint(system.activities[arc.source].outputs)
        )
        if any({arc.source, arc.target} & taking_activities and {arc.output, arc.input} & giver_keys for arc in arcs):
            yield result


def _arcs_between(system: TimingSystem, step: str, next_step: str) -> list[Arc]:
    """Return what joins two steps of a chain: topics; services and actions only if there is no topic."""
    arcs = [arc for arc in system.arcs_from.get(step, ()) if arc.target == next_step]
    return [arc for arc in arcs if arc.role == "data"] or arcs
