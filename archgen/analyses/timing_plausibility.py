"""Do the figures of timing count: is each plausible, is any key without effect, and does what is written of processes and resources?"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterator, Mapping
from fractions import Fraction

from archgen.diagnostics import Diagnostic, Label, Severity, Span, join_words
from archgen.diagnostics.rule_options import RuleOption, format_percentage
from archgen.model.architecture import Architecture
from archgen.model.declared_timing import Timing
from archgen.model.deployment import Host
from archgen.model.node import Node
from archgen.model.port_media import is_physical
from archgen.model.quantity import Quantity
from archgen.timing.analysis import Analysis
from archgen.timing.chains.use_case_times import LIMIT_KEYS
from archgen.timing.figures.figure_wording import format_duration
from archgen.timing.system.timing_system import Activity

_NS_PER_SECOND = 10**9


def long_execution(architecture: Architecture, *, limit: Fraction) -> Iterator[Diagnostic]:
    """An execution takes longer, at worst, than the period in which it is to be done, or than the response that is declared."""
    yield from _find_above_period(architecture, ("wcet", "the worst case execution time"), "long-execution", limit)
    # One `timing` may be that of several components, and of all instances of a type.
    timings = {
        timing.places["response"]: (node, timing)
        for node in architecture.nodes.values()
        for timing in node.timing.values()
        if timing.response and timing.wcet and timing.response.value < _sum_held_times(timing)
    }
    for span, (node, timing) in timings.items():
        keys = "`wcet` and `uses`" if timing.uses else "`wcet`"
        yield Diagnostic(
            "long-execution",
            f"the response of `{node.id}` (`response`, {timing.response}) is below the execution time that it holds "
            f"({keys}, {format_duration(_sum_held_times(timing))}): what is declared is taken as it is",
            span,
            severity=Severity.WARNING,
            labels=(Label(timing.places["wcet"], "its execution time"),),
            help="write the response of the longest run, or leave it out: it is computed then",
            element=node.id,
        )


def _sum_held_times(timing: Timing) -> Fraction:
    """Return how long an activation works and uses resources at most, in ns."""
    return sum((use.max.value for use in timing.uses.values()), timing.wcet.value if timing.wcet else Fraction(0))


def large_jitter(architecture: Architecture, *, limit: Fraction) -> Iterator[Diagnostic]:
    """An activation may come later than the period after which the next one is due."""
    yield from _find_above_period(architecture, ("jitter", "the jitter"), "large-jitter", limit)


def _find_above_period(
    architecture: Architecture, described_key: tuple[str, str], rule_name: str, limit: Fraction
) -> Iterator[Diagnostic]:
    """Yield a finding for each figure that is above this share of the period, if both are written.

    `described_key` is the figure's key in `Timing`, and its name in a sentence.
    """
    key, description = described_key
    limit_phrase = "" if limit == 1 else f"{format_percentage(limit)} of "
    # A node that implements several components may have one `timing` for all of them: the same span comes up again.
    reported_spans: set[Span] = set()
    for node in architecture.nodes.values():
        for timing in node.timing.values():
            # `key` is an attribute of `Timing` and the key in the YAML (and in `places`) alike.
            quantity: Quantity | None = getattr(timing, key)
            period = _period_of(timing) if quantity else None
            if (
                quantity
                and period
                and quantity.value > (period if limit == 1 else limit * period)
                and timing.places[key] not in reported_spans
            ):
                reported_spans.add(timing.places[key])
                message = f"{description} of `{node.id}` (`{key}`, {quantity}) is above {limit_phrase}its period"
                cure = "this is legal: correct it only where a figure or a unit is wrong"
                period_key = "period" if timing.period else "rate"
                label = Label(timing.places[period_key], f"its {period_key}")
                yield Diagnostic(rule_name, message, timing.places[key], labels=(label,), help=cure, element=node.id)


def _period_of(timing: Timing) -> Fraction | None:
    """Return the period in ns, written as such or as a rate; None if neither is written."""
    if timing.period:
        return timing.period.value
    return _NS_PER_SECOND / timing.rate.value if timing.rate else None


_INPUT_TRIGGER_KEYS = ("trigger", "every", "throttle")
"""Keys that say how inputs trigger an activity: attributes of `Timing`, and keys of its `places`."""
_WHOLE_KEYS = frozenset({"behaviour", "period", "rate", *LIMIT_KEYS})
"""What is compared of a composed component's timing; a behaviour is what selectors find."""
# Behaviours that inputs do not trigger, each with the reason and the help of its finding.
_SELF_ACTIVATED = {
    "periodic": ("its period fires it", "leave it out, or write `behaviour: event` where inputs are to fire it"),
    "once": ("it works once, at the start", "leave it out"),
    "on_demand": (
        "calls fire it, each of them",
        "leave it out, or write `behaviour: event` where inputs are to fire it",
    ),
}


def idle_timing(architecture: Architecture, analysis: Analysis) -> Iterator[Diagnostic]:
    """A key of timing has no effect where it stands."""
    has_calls = any(timing.calls for node in architecture.nodes.values() for timing in node.timing.values())
    uses = _port_uses(architecture) if has_calls else {}
    # One `timing` may stand for several components of a node: its faults are reported once.
    reported_spans: set[Span] = set()
    for node in architecture.nodes.values():
        for timing in node.timing.values():
            for finding in (
                *_find_idle_triggers(node, timing),
                *_find_idle_calls(node, timing, uses),
                *_find_idle_gaps(node, timing),
                *_find_idle_dropping(node, timing),
                *_find_idle_measurement(node, timing),
            ):
                if finding.span not in reported_spans:
                    reported_spans.add(finding.span)
                    yield finding
    yield from _find_idle_inputs(architecture, analysis)
    yield from _find_idle_freshness(architecture)
    yield from _find_idle_wholes(architecture)
    yield from _find_idle_shares(architecture)
    yield from _find_partial_priorities(analysis)


def _port_uses(architecture: Architecture) -> Mapping[tuple[str, str], set[str]]:
    """Return how each node uses each port ("publishes", ..., "unknown" without a message), by node id and port id."""
    uses = defaultdict[tuple[str, str], set[str]](set)
    for endpoint in architecture.endpoints:
        # Without a message nobody knows yet whether it will be a topic or a service: no `calls` is idle then.
        uses[endpoint.node, endpoint.port or endpoint.label].add(endpoint.use if endpoint.message else "unknown")
    return uses


def _find_idle_triggers(node: Node, timing: Timing) -> Iterator[Diagnostic]:
    # As timing infers it: who states a rate and no behaviour is periodic.
    has_rate = timing.period is not None or timing.rate is not None
    behaviour = timing.behaviour or ("periodic" if has_rate else None)
    if behaviour not in _SELF_ACTIVATED:
        return
    reason, cure = _SELF_ACTIVATED[behaviour]
    key = "period" if timing.period is not None else "rate"
    span = timing.places.get("behaviour" if timing.behaviour else key)
    for name in _INPUT_TRIGGER_KEYS:
        if getattr(timing, name) is not None:
            labels = (Label(span, reason),) if span else ()
            message = f"`{name}` of `{node.id}` has no effect: {reason}"
            yield Diagnostic("idle-timing", message, timing.places[name], labels=labels, help=cure, element=node.id)


def _find_idle_calls(node: Node, timing: Timing, uses: Mapping[tuple[str, str], set[str]]) -> Iterator[Diagnostic]:
    for port in timing.calls:
        if uses.get((node.id, port)) == {"subscribes"}:
            yield Diagnostic(
                "idle-timing",
                f"`calls` of `{node.id}` has no effect for `{port}`: it is a topic, which nobody calls",
                # The linker records the span of each entry below `calls` as `calls PORT`.
                timing.places.get(f"calls {port}", timing.places.get("calls", timing.at)),
                help="`calls` counts calls of services and actions; of a topic, `every` takes each n-th message",
                element=node.id,
            )


def _find_idle_gaps(node: Node, timing: Timing) -> Iterator[Diagnostic]:
    for port, output in timing.outputs.items():
        if output.max_gap is not None and not output.conditional:
            yield Diagnostic(
                "idle-timing",
                f"`max_gap` of `{port}` has no effect: it is published at each activation",
                output.at,
                help="write `conditional: true` beside it, or leave it out",
                element=node.id,
            )


def _find_idle_dropping(node: Node, timing: Timing) -> Iterator[Diagnostic]:
    if timing.dropped is not None and timing.throttle is None and (timing.every or 1) == 1:
        yield Diagnostic(
            "idle-timing",
            f"`dropped` of `{node.id}` has no effect: without `every` or `throttle` no message is dropped",
            timing.places["dropped"],
            help="leave it out, or write what drops messages, such as `every: 3`",
            element=node.id,
        )


def _find_idle_measurement(node: Node, timing: Timing) -> Iterator[Diagnostic]:
    if timing.wcet is None and timing.measured_times is not None and timing.measured_times.is_measured:
        yield Diagnostic(
            "idle-timing",
            f"`measured` of `{node.id}` has no effect: no longest time is written that it could be about",
            timing.places["wcet"],
            help="write the longest time that was seen: `wcet: {max: 80 ms, measured: true}`",
            element=node.id,
        )


def _find_idle_inputs(architecture: Architecture, analysis: Analysis) -> Iterator[Diagnostic]:
    """Yield what is said of storing at inputs that fire, whose messages are worked on, and of services, which answer."""
    for activity in analysis.system.activities.values():
        timing = architecture.nodes[activity.node].timing.get(activity.component or "")
        arcs = analysis.system.arcs_into.get(activity.id, ())
        called_inputs = {arc.input for arc in arcs if arc.role == "answer"}
        source_counts = Counter((arc.input, arc.topic) for arc in arcs if arc.role == "data")
        for port, input_timing in timing.inputs.items() if timing else ():
            is_timed = input_timing.wcet is not None or input_timing.bcet is not None
            if port in activity.triggers and (is_timed or input_timing.stored_at_once):
                idle_key = "the time" if is_timed else "`stored`"
                reason = f"it fires `{activity.id}`"
            elif port in called_inputs and input_timing.stored_at_once:
                idle_key, reason = "`stored`", "it is a service or an action, of which no message is stored"
            elif input_timing.memory and all(count == 1 for (key, _), count in source_counts.items() if key == port):
                idle_key, reason = "`memory`", "no topic of it has several sources"
            else:
                continue
            message = f"{idle_key} below `inputs` of `{port}` has no effect: {reason}"
            advice = "its time is a part of `wcet`: add it there" if idle_key == "the time" else "leave it out"
            yield Diagnostic("idle-timing", message, input_timing.at, help=advice, element=activity.node)


def _find_idle_freshness(architecture: Architecture) -> Iterator[Diagnostic]:
    for port in architecture.inputs.values():
        if port.freshness is not None and is_physical(port):
            yield Diagnostic(
                "idle-timing",
                f"`freshness` of `{port.id}` has no effect: it is physical, so that nothing is sent there",
                port.freshness_at,
                help="write it at an input that reads a message",
                element=port.component,
            )


def _find_idle_shares(architecture: Architecture) -> Iterator[Diagnostic]:
    """Yield figures of a fair order where everything has a real-time priority, so that nothing shares a core."""
    for host in architecture.hosts.values():
        timings = [
            each for node in architecture.nodes.values() if node.host == host.id for each in node.timing.values()
        ]
        if host.fair is None or not timings or any(timing.priority is None for timing in timings):
            continue
        yield Diagnostic(
            "idle-timing",
            f"`fair` of `{host.id}` has no effect: everything on it has a real-time priority",
            host.fair.at,
            labels=(Label(timings[0].places["priority"], "one of them"),),
            help="leave it out, or take the priority from what is to share the cores",
            element=host.id,
        )


def _find_partial_priorities(analysis: Analysis) -> Iterator[Diagnostic]:
    """Yield priorities in processes on fair hosts of which something has none: a thread is a real-time one, or it is none."""
    members: dict[str, list[Activity]] = defaultdict(list)
    for activity in analysis.system.activities.values():
        if activity.executor and activity.host in analysis.system.fair_shares:
            members[activity.executor].append(activity)
    for activities in members.values():
        urgent = next((each for each in activities if each.priority is not None), None)
        other = next((each for each in activities if each.priority is None), None)
        if urgent is not None and other is not None:
            yield Diagnostic(
                "idle-timing",
                f"`priority` of `{urgent.id}` has no effect: `{other.id}` has none, and its threads run both",
                urgent.places["priority"],
                labels=(Label(other.places.get("wcet", other.at), "has none"),),
                help="write a priority at all that these threads run, or let them run in processes of their own",
                element=urgent.node,
            )


def _find_idle_wholes(architecture: Architecture) -> Iterator[Diagnostic]:
    """Yield the keys of timing of composed components that nothing compares: what is inside has its own."""
    keys_of_shells = (
        (shell, key, span)
        for shell in architecture.shells.values()
        for key, span in (shell.timing.places.items() if shell.timing else ())
    )
    for shell, key, span in keys_of_shells:
        # Each entry of `calls` and `uses` has a place of its own, under a key with a blank.
        if key not in _WHOLE_KEYS and " " not in key:
            yield Diagnostic(
                "idle-timing",
                f"`{key}` of `{shell.id}` has no effect: the components inside have timing of their own",
                span,
                help="write it at one of them; of the whole, `period` or `rate`, `deadline` and `response` are compared",
                element=shell.id,
            )


def absent_core(architecture: Architecture) -> Iterator[Diagnostic]:
    """An element is pinned to a core that its host does not have."""
    # One `timing` may stand for several components of a node: its faults are reported once.
    reported_spans: set[Span] = set()
    for node in architecture.nodes.values():
        host = architecture.hosts.get(node.host or "")
        for timing in node.timing.values():
            for key, cores in (("core", () if timing.core is None else (timing.core,)), ("cores", timing.cores or ())):
                span, absent_cores = timing.places.get(key), _list_absent_cores(host, cores)
                if host is not None and span is not None and absent_cores and span not in reported_spans:
                    reported_spans.add(span)
                    yield _report_absent_cores(f"`{node.id}` is pinned to", host, absent_cores, (key, span), node.id)
    for host in architecture.hosts.values():
        for core in _list_absent_cores(host, tuple(host.core_scheduling)):
            yield _report_absent_cores(
                "an order is written for", host, [core], ("scheduling", host.core_places[core]), host.id
            )


def _list_absent_cores(host: Host | None, cores: tuple[int, ...]) -> list[int]:
    """Return the cores that a host does not have. One that does not say how many it has is judged by nobody."""
    return [core for core in cores if host is not None and host.cores is not None and core >= host.cores]


def _report_absent_cores(
    beginning: str, host: Host, cores: list[int], place: tuple[str, Span], element_id: str
) -> Diagnostic:
    key, span = place
    word = "core" if len(cores) == 1 else "cores"
    available_cores = "only core 0" if host.cores == 1 else f"the cores 0 to {(host.cores or 1) - 1}"
    return Diagnostic(
        "absent-core",
        f"{beginning} {word} {join_words([str(core) for core in cores])}, but `{host.id}` has {available_cores}",
        span,
        labels=(Label(host.at, "its host"),),
        help=f"cores are counted from 0; correct `{key}`, or the host's `cores`",
        element=element_id,
    )


TIMING_RULES = ((idle_timing, Severity.WARNING),)


def idle_executor(architecture: Architecture) -> Iterator[Diagnostic]:
    """A key of a node that says how its callbacks run has no effect where it stands."""
    for node in architecture.nodes.values():
        container = architecture.containers.get(node.container or "")
        for key in ("threads", "scheduling") if container else ():
            if container and key in node.executor_places:
                yield Diagnostic(
                    "idle-executor",
                    f"`{key}` of `{node.id}` has no effect: it runs in the container `{container.id}`",
                    node.executor_places[key],
                    labels=(Label(node.container_at, "its container"),),
                    help=f"write it at the container: `containers: {{{container.id}: {{{key}: {getattr(node, key)}}}}}`",
                    element=node.id,
                )
        if node.callback_groups:
            yield from _find_idle_groups(node)


def _find_idle_groups(node: Node) -> Iterator[Diagnostic]:
    if node.reentrant:
        reason, help_line = "it is `reentrant`: all of its callbacks run side by side", "keep one of them"
    elif len(node.implements) == 1:
        reason = "it implements one component, whose callbacks are in one group anyway"
        help_line = "leave it out, or write `reentrant: true` where its callbacks run side by side"
    else:
        return
    yield Diagnostic(
        "idle-executor",
        f"`callback_groups` of `{node.id}` has no effect: {reason}",
        node.executor_places["callback_groups"],
        help=help_line,
        element=node.id,
    )


def remote_resource(architecture: Architecture) -> Iterator[Diagnostic]:
    """An element uses a resource of another computer."""
    # One `timing` may stand for several components of a node: its faults are reported once.
    reported_spans: set[Span] = set()
    for node in architecture.nodes.values():
        for timing in node.timing.values():
            for resource in (architecture.resources[name] for name in timing.uses):
                span = timing.places.get(f"uses {resource.id}", timing.at)
                if node.host and resource.host and node.host != resource.host and span not in reported_spans:
                    reported_spans.add(span)
                    yield Diagnostic(
                        "remote-resource",
                        f"`{node.id}` runs on `{node.host}`, but uses `{resource.id}` of `{resource.host}`",
                        span,
                        labels=(Label(resource.at, "the resource"),),
                        help="correct one of the two hosts; what asks a server there is a service, and the server a node",
                        element=node.id,
                    )


RULES = (
    (
        long_execution,
        Severity.NOTE,
        (RuleOption("limit", 100, 1, 100, "The share of its period that an execution may take."),),
    ),
    (
        large_jitter,
        Severity.NOTE,
        (RuleOption("limit", 100, 1, 1000, "The share of the period by which an activation may come late."),),
    ),
    (absent_core, Severity.WARNING),
    (idle_executor, Severity.WARNING),
    (remote_resource, Severity.WARNING),
)
