"""What is promised of an interface, and what is only expected: two things that an agreement never mixes.

Promised is what an owner wrote. Expected is what follows from other figures, and nobody answers for it: how often and how
much an interface carries, and which chains pass through it.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction

from archgen.analyses.kept_promises import list_sent_limits
from archgen.frozen import NamedTuple, dataclass, field, replace
from archgen.model.declared_timing import OutputTiming, Timing
from archgen.model.node import Endpoint, Qos
from archgen.model.partner_interfaces import PartnerInterface, list_givers
from archgen.model.quantity import Quantity
from archgen.timing.analysis import ChainResult, EventPace, find_pace
from archgen.timing.chains.chain_verdicts import LimitState, judge_upper_limit
from archgen.timing.chains.measured_comparison import Observation
from archgen.timing.figures.figure_wording import format_duration, format_rate
from archgen.timing.figures.timing_values import TimingValue
from archgen.timing.system import activity_builder
from archgen.timing.system.message_sizes import MessageSize
from archgen.timing.system.timing_system import Arc, TimingSystem
from archgen.views import inline_text
from archgen.views.lookup import Lookup
from archgen.views.shapes import Column, Inlines, Table, Text, make_columns
from archgen.views.timing import timing_tables, value_format
from archgen.views.timing.timing_lookup import TimingLookup

PromiseStrength = Mapping[str, Fraction | int]
"""How much is promised, by aspects (`rate`, `reliability`): less of one, or one that is gone, is a weaker promise."""
SOURCE_PHRASE = ", follows from "
"""What stands between an expected figure and what it follows from."""
_UNLIMITED = 10**30


@dataclass(frozen=True, slots=True)
class TermName:
    """What a term is called. `key` is what code calls it; `node` is whose term it is, where several nodes give."""

    key: str
    title: str
    node: str = ""

    @property
    def text(self) -> str:
        """The name as it stands alone: `Rate of lidar_driver`."""
        return f"{self.title} of {self.node}" if self.node else self.title

    @property
    def words(self) -> str:
        """The name as it stands inside of a sentence."""
        return self.text if self.key == "qos" else self.text.lower()


RATE, MAX_GAP, MAX_AGE = (
    TermName("rate", "Rate"),
    TermName("max_gap", "Largest gap"),
    TermName("max_age", "Greatest age"),
)
QOS_OFFERED = TermName("qos", "QoS offered")


@dataclass(frozen=True, slots=True)
class PromiseRow:
    """A term with what is promised, expected and was measured of it, each empty where there is nothing.

    `promise_identity` is the same for whatever promises the same, in other units or words; left out, it is the text.
    """

    name: TermName
    promised: Inlines = ()
    expected: Inlines = ()
    strength: PromiseStrength = field(default_factory=dict)
    promise_identity: str = ""
    measured: Inlines = ()


def _promise_limit(name: TermName, limit: Quantity, aspect: str, words: str = "{}") -> PromiseRow:
    """Return the promise to stay below a limit; `words` has a place for it."""
    strength = {aspect: -limit.value}
    promised = (Text(words.format(limit), sort_number=str(limit.value)),)
    return PromiseRow(name, promised, (), strength, str(limit.value))


def is_weaker(old_strength: PromiseStrength, new_strength: PromiseStrength) -> bool:
    """Whether something that was promised is not, or not as much, any more."""
    return any(aspect not in new_strength or new_strength[aspect] < figure for aspect, figure in old_strength.items())


def join_figures(runs: Inlines) -> str:
    """Return the figures alone, without what each follows from; readers of different ports may see several."""
    lines = (run.text for index, run in enumerate(runs) if run.line_break or not index)
    return ", ".join(line.partition(SOURCE_PHRASE)[0].removesuffix(", computed") for line in lines)


def measure_qos(qos: Qos) -> PromiseStrength:
    """Return how much a quality of service promises. Deadline and lease promise more the shorter they are."""
    limits = {"deadline": qos.deadline, "lease": qos.lease_duration}
    return {
        "reliability": int(qos.reliability == "reliable"),
        "durability": int(qos.durability == "transient_local"),
        "depth": _UNLIMITED if qos.history == "keep_all" else qos.depth or 0,
        "lifespan": qos.lifespan.value if qos.lifespan else _UNLIMITED,
        "liveliness": int(qos.liveliness == "manual_by_topic"),
        **{aspect: -limit.value for aspect, limit in limits.items() if limit},
    }


def identify_qos(qos: Qos) -> str:
    """Return a text that two qualities of service share if their values are the same, whatever their profiles are called."""
    return ", ".join(f"{aspect} {figure}" for aspect, figure in measure_qos(qos).items())


def write_promise_table(anchor: str, caption: str, giver_title: str, rows: tuple[PromiseRow, ...]) -> Table:
    """Write what is promised beside what is expected and was measured; where there is nothing, the table says so."""
    columns: tuple[Column, ...] = make_columns(
        ("Term", 0.8), (f"Promised by {giver_title}", 1.3), ("Expected, not promised", 1.7)
    )
    cells: tuple[tuple[Inlines, ...], ...] = tuple(
        (
            inline_text.to_inlines(row.name.text),
            row.promised or inline_text.to_inlines(Text("nothing", muted=True)),
            row.expected or (() if row.promised else inline_text.to_inlines(Text("not known", muted=True))),
        )
        for row in rows
    )
    if any(row.measured for row in rows):
        columns = (*columns, Column("Measured", 0.8))
        cells = tuple((*cell, row.measured) for cell, row in zip(cells, rows, strict=True))
    return Table(anchor, caption, columns, cells, numbered=False)


_NS_PER_SECOND = 10**9
_ROW_ASPECTS = {RATE.key: "rate", MAX_GAP.key: "gap", MAX_AGE.key: "max_age"}
_PROMISED_ASPECTS = {MAX_GAP.key: ("gap", "max_gap"), RATE.key: ("rate",), MAX_AGE.key: ("max_age",)}


def add_measured(
    lookup: Lookup,
    activity_names: activity_builder.ActivityNames,
    interface: PartnerInterface,
    rows: Sequence[PromiseRow],
    observations: Sequence[Observation],
) -> tuple[PromiseRow, ...]:
    """Return rows with what was measured of the interface's topics, else of who sends it.

    A row of one of several nodes (`Rate of NODE`) has what was measured of that node alone.
    """
    if interface.flow != "topic":
        return tuple(rows)
    givers = {
        endpoint.node: activity_builder.activity_of_endpoint(activity_names, endpoint)
        for endpoint in list_givers(lookup.architecture, interface)
    }
    topic_figures = _collect_figures(observations, set(interface.topic_names))
    all_figures = topic_figures or _collect_figures(observations, set(givers.values()) if len(givers) == 1 else set())
    figures_by_row = {
        row.name: _collect_figures(observations, {givers.get(row.name.node, "")})
        if row.name.node and row.name.key in _ROW_ASPECTS
        else all_figures
        for row in rows
    }
    measured_rows = [_measure_row(row, figures_by_row[row.name]) for row in rows]
    if "max_age" in all_figures and not any(row.name == MAX_AGE for row in rows):
        measured_rows.append(_measure_row(PromiseRow(MAX_AGE), all_figures))
    return tuple(measured_rows)


def _collect_figures(observations: Sequence[Observation], ids: set[str]) -> dict[str, Fraction]:
    """Return the worst that was seen of some topics or activities: rate in Hz, gap and age in ns."""
    figures: dict[str, list[Fraction]] = {}
    for observation in observations:
        if observation.id in ids:
            for aspect, value in _list_figures(observation):
                figures.setdefault(aspect, []).append(value)
    return {aspect: min(values) if aspect == "rate" else max(values) for aspect, values in figures.items()}


def _list_figures(observation: Observation) -> Iterator[tuple[str, Fraction]]:
    figures = observation.figures
    if "rate" in figures:
        yield "rate", figures["rate"].value
    elif "period" in figures and figures["period"].value:
        yield "rate", _NS_PER_SECOND / figures["period"].value
    if "max_period" in figures:
        yield "gap", figures["max_period"].value
    if "delay" in figures:
        yield "max_age", figures["delay"].value


def _measure_row(row: PromiseRow, figures: dict[str, Fraction]) -> PromiseRow:
    value = figures.get(_ROW_ASPECTS.get(row.name.key, ""))
    return row if value is None else replace(row, measured=_write_figure(row, value))


def _write_figure(row: PromiseRow, value: Fraction) -> Inlines:
    """Return a measured figure, marked where it is worse than what is promised."""
    key = row.name.key
    promised = next((row.strength[each] for each in _PROMISED_ASPECTS[key] if each in row.strength), None)
    if key == RATE.key:
        text, is_worse = format_rate(value), promised is not None and value < promised
    else:
        text, is_worse = format_duration(value), promised is not None and value > -promised
    words = f"{text} on arrival" if key == MAX_AGE.key else text
    if is_worse:
        return (Text(f"{words}, worse than promised", status="missed", sort_number=str(value)),)
    return (Text(words, sort_number=str(value)),)


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
            yield _promise_limit(TermName("jitter", "Jitter", self.node), self.timing.jitter, "jitter", "up to {}")
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
        row = _promise_limit(name, limit, "gap") if limit else PromiseRow(name)
        return replace(row, expected=inline_text.to_inlines(f"{words}{source}") if is_known else ())

    def _answer_row(self) -> PromiseRow:
        name, limit = TermName("response", "Answers within", self.node), self.timing.response
        if limit:
            return _promise_limit(name, limit, "response")
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
