"""Is what outputs promise kept by what follows from the figures of timing?"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterator, Mapping, Sequence
from fractions import Fraction

from archgen.diagnostics import NO_SPAN, Diagnostic, Label, Severity, Span
from archgen.frozen import NamedTuple
from archgen.grouping import group_pairs
from archgen.model.architecture import Architecture
from archgen.model.component_nesting import list_described_outputs
from archgen.model.node import Endpoint
from archgen.model.promise import Promise
from archgen.model.quantity import Quantity
from archgen.model.ros_distro import is_ros_1
from archgen.timing.analysis import Analysis, EventPace, find_pace
from archgen.timing.chains.chain_verdicts import LimitState, find_sent_ages, judge_lower_limit, judge_upper_limit
from archgen.timing.figures.figure_wording import format_duration, format_rate
from archgen.timing.figures.timing_values import UNKNOWN_VALUE, TimingValue, add_values, smallest_value
from archgen.timing.system import activity_builder
from archgen.timing.system.timing_system import Arc

PROMISED_WORDS = {"rate": "", "max_gap": "gaps of at most ", "max_age": "no greater age than "}
"""What stands before a promised figure, by its key."""
_HELP = {
    "rate": "let it be sent more often, or promise a lower rate",
    "max_gap": "let it be sent more often and at each run, or promise a longer gap",
    "max_age": "let it be sent more often, let it fire its reader, or promise a greater age",
}


class JudgedPromise(NamedTuple):
    """What an output promises, held against what follows for what is sent by a leaf (`leaf`, its output).

    An age is judged at each of those who read it: `read_over`.
    """

    port: str
    leaf: str
    key: str
    limit: Quantity
    bound: TimingValue
    state: LimitState
    at: Span
    read_over: Arc | None = None
    is_sent_once: bool = False

    @property
    def promised(self) -> str:
        """Return what is promised, in words."""
        return f"{PROMISED_WORDS[self.key]}{self.limit}"

    @property
    def words(self) -> str:
        """Return in words what follows instead."""
        if self.key == "rate":
            side = "at most " if self.bound.side == "at most" else ""
            rate = f"{side}{format_rate(self.bound.value or Fraction(0))} follows from the timing"
            return "it is sent once" if self.is_sent_once else rate
        where = f"where `{self.read_over.target}` reads it" if self.read_over else "between two messages"
        value = self.bound.value
        return f"there is no bound {where}" if value is None else f"it may be {format_duration(value)} {where}"

    @property
    def help(self) -> str:
        """Return what can be done about one that is broken."""
        return "let it be sent again and again, or promise no rate" if self.is_sent_once else _HELP[self.key]


def broken_promise(architecture: Architecture, analysis: Analysis) -> Iterator[Diagnostic]:
    """What follows from the figures of timing is worse than what an output promises."""
    told: set[tuple[str, str, Span]] = set()
    for broken in find_broken_promises(architecture, analysis):
        # What is passed on as it is promised inside is not told twice.
        if (broken.key, broken.leaf, broken.at) not in told:
            told.add((broken.key, broken.leaf, broken.at))
            yield _diagnose_broken(broken)


def find_broken_promises(architecture: Architecture, analysis: Analysis) -> Iterator[JudgedPromise]:
    """Yield what outputs promise and figures do not keep, leaves first; of an age that of the reader who reads the oldest."""
    worst: dict[tuple[str, str, str], JudgedPromise] = {}
    for judged in judge_promises(architecture, analysis):
        key = judged.port, judged.leaf, judged.key
        if judged.state == "broken" and (key not in worst or rank_bound(judged.bound) > rank_bound(worst[key].bound)):
            worst[key] = judged
    yield from worst.values()


def judge_promises(
    architecture: Architecture, analysis: Analysis, promises: Mapping[str, Promise] | None = None
) -> Iterator[JudgedPromise]:
    """Yield what outputs promise of rate, gap and age with what figures say of it, leaves first.

    `promises` of outputs, by their ids, are others than those that are written.
    """
    promising = [
        (output.id, promise)
        for _, output in list_described_outputs(architecture)
        if (promise := output.promise if promises is None else promises.get(output.id))
        and (promise.rate or promise.max_gap or promise.max_age)
    ]
    if not promising:
        return
    paces = _find_paces(architecture, analysis)
    leaves = {leaf for output, _ in promising for leaf in architecture.leaf_ports_of("output", output)}
    ages = group_pairs((arc.output, (arc, age)) for arc, age in find_sent_ages(analysis, leaves))
    promising.sort(key=lambda each: each[0] not in architecture.outputs)
    for output, promise in promising:
        for leaf in architecture.leaf_ports_of("output", output):
            yield from _judge_promise(output, leaf, promise, paces.get(leaf, ()), ages.get(leaf, ()))


def list_sent_limits(architecture: Architecture, endpoint: Endpoint) -> Iterator[tuple[str, Quantity]]:
    """Yield what a node promises of the gap between two messages that it sends at a port, by `timing.max_gap` and
    `qos.deadline`.
    """
    if endpoint.use != "publishes" or endpoint.port is None:
        return
    timing = architecture.nodes[endpoint.node].timing.get(endpoint.component or "")
    sent = timing.outputs.get(endpoint.port) if timing else None
    if sent and sent.conditional and sent.max_gap:
        yield "timing.max_gap", sent.max_gap
    if endpoint.qos.deadline and not is_ros_1(architecture.distro):
        yield "qos.deadline", endpoint.qos.deadline


def judge_sent_limits(
    architecture: Architecture, analysis: Analysis, find_limit: Callable[[str, str], Quantity | None]
) -> Iterator[tuple[str, str, Quantity, TimingValue, LimitState]]:
    """Yield limits of gaps that nodes promise, each with its port, its key, the gap that follows and whether it is kept.

    `find_limit` returns the limit of a port and a key.
    """
    activity_names = activity_builder.name_activities(architecture)
    for endpoint in architecture.endpoints:
        for key in ("timing.max_gap", "qos.deadline") if endpoint.use == "publishes" and endpoint.port else ():
            if limit := find_limit(endpoint.port or "", key):
                gap = find_pace(analysis, activity_names, endpoint).gap
                yield endpoint.port or "", key, limit, gap, judge_upper_limit(gap, limit.value)


def _find_paces(architecture: Architecture, analysis: Analysis) -> Mapping[str, Sequence[EventPace]]:
    """Return how often something is sent at each output, by its nodes."""
    activity_names = activity_builder.name_activities(architecture)
    paces: dict[str, list[EventPace]] = defaultdict(list)
    for endpoint in architecture.endpoints:
        if endpoint.use == "publishes" and endpoint.port:
            activity = activity_builder.activity_of_endpoint(activity_names, endpoint)
            pace = analysis.outputs.get((activity, activity_builder.endpoint_key(endpoint)))
            if pace is not None:
                paces[endpoint.port].append(pace)
    return paces


def _judge_promise(
    port: str, leaf: str, promise: Promise, paces: Sequence[EventPace], ages: Sequence[tuple[Arc, TimingValue]]
) -> Iterator[JudgedPromise]:
    at = {key: promise.places.get(key, promise.at) for key in PROMISED_WORDS}
    if promise.rate is not None:
        rate = add_values(pace.rate for pace in paces) if paces else UNKNOWN_VALUE
        is_sent_once = bool(paces) and all(pace.behaviour == "once" for pace in paces)
        state = "broken" if is_sent_once else judge_lower_limit(rate, promise.rate.value)
        yield JudgedPromise(port, leaf, "rate", promise.rate, rate, state, at["rate"], is_sent_once=is_sent_once)
    if promise.max_gap is not None:
        gap = smallest_value(pace.gap for pace in paces) if paces else UNKNOWN_VALUE
        state = judge_upper_limit(gap, promise.max_gap.value)
        yield JudgedPromise(port, leaf, "max_gap", promise.max_gap, gap, state, at["max_gap"])
    if promise.max_age is not None:
        for arc, age in ages:
            state = judge_upper_limit(age, promise.max_age.value)
            yield JudgedPromise(port, leaf, "max_age", promise.max_age, age, state, at["max_age"], arc)


def rank_bound(value: TimingValue) -> tuple[bool, Fraction]:
    """Return the sort key of a bound: none at all is the longest."""
    return value.value is None, value.value or Fraction(0)


def _diagnose_broken(broken: JudgedPromise) -> Diagnostic:
    labels = (Label(broken.read_over.at, "read here"),) if broken.read_over and broken.read_over.at != NO_SPAN else ()
    return Diagnostic(
        "broken-promise",
        f"`{broken.port}` promises {broken.promised}: {broken.words}",
        broken.at,
        labels=labels,
        help=broken.help,
        element=broken.port.rpartition(".")[0],
    )


RULES = ((broken_promise, Severity.WARNING),)
