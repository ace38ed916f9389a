"""Are rates consistent, and do triggers form cycles that never end, or that never begin?"""

from __future__ import annotations

import math
from collections import Counter, defaultdict
from collections.abc import Collection, Iterator
from fractions import Fraction

from archgen.diagnostics import NO_SPAN, Diagnostic, Label, Severity, join_words
from archgen.diagnostics.rule_options import RuleOption
from archgen.model.architecture import Architecture
from archgen.model.component import Component
from archgen.timing.analysis import Analysis, EdgeFit
from archgen.timing.figures.figure_wording import format_number, format_rate
from archgen.timing.figures.tick_unit import NS_PER_SECOND, written_period
from archgen.timing.figures.timing_values import TimingValue
from archgen.timing.rates.edge_fit import fires_each_time
from archgen.timing.system.thread_pools import name_lane
from archgen.timing.system.timing_system import Activity


def period_conflict(architecture: Architecture, analysis: Analysis, *, tolerance: Fraction) -> Iterator[Diagnostic]:
    """What an element states of its rate is not what its inputs, or the nodes and components that it is made of, give."""
    for name, derived in analysis.derived.items():
        stated_rate = analysis.paces[name].rate.value
        if stated_rate is None or not _is_impossible_rate(stated_rate, derived.rate, tolerance):
            continue
        activity = analysis.system.activities[name]
        reason = derived.reasons[-1] if derived.reasons else None
        yield Diagnostic(
            "period-conflict",
            f"`{name}` states {format_rate(stated_rate)}, but what fires it gives {_format_bounded_rate(derived.rate)}",
            activity.places.get("rate", activity.places.get("period", activity.at)),
            labels=(Label(reason.at, "it is fired here"),) if reason and reason.at != NO_SPAN else (),
            help="leave the rate out, or correct it; `behaviour: periodic` if a timer decides",
            element=name,
        )
    # A component with one node has one timing, written in either place. With several nodes its timing is a claim about
    # the whole, which no node inherits: it is compared with what the nodes publish.
    node_counts = Counter(component for node in architecture.nodes.values() for component in node.implements)
    for component in architecture.components.values():
        if component.timing and node_counts[component.id] > 1:
            yield from _compare_component_rate(analysis, component, _output_ids(component), tolerance)
    for shell in architecture.shells.values():
        if shell.timing:
            leaf_outputs = {
                leaf for output in _output_ids(shell) for leaf in architecture.leaf_ports_of("output", output)
            }
            yield from _compare_component_rate(analysis, shell, leaf_outputs, tolerance)


def _is_impossible_rate(stated_rate: Fraction, derived_rate: TimingValue, tolerance: Fraction) -> bool:
    """Whether a stated rate contradicts the derived one (both in Hz): another exact value, or beyond a bound.

    `tolerance` is the share of the derived rate by which the two may differ.
    """
    if derived_rate.value is None:
        return False
    is_above = stated_rate > (1 + tolerance) * derived_rate.value
    is_below = stated_rate < (1 - tolerance) * derived_rate.value
    if derived_rate.side == "at most":
        return is_above
    if derived_rate.side == "at least":
        return is_below
    return is_above or is_below


def _format_bounded_rate(value: TimingValue) -> str:
    """Format a rate (Hz) with the side on which it bounds: "at most 10 Hz"."""
    text = format_rate(value.value) if value.value is not None else "nothing known"
    return text if value.side == "exact" else f"{value.side} {text}"


def _compare_component_rate(
    analysis: Analysis, component: Component, output_ids: Collection[str], tolerance: Fraction
) -> Iterator[Diagnostic]:
    """Report a component with several nodes, or with components inside, whose stated rate none of its outputs has."""
    component_period = written_period(component.timing) if component.timing else None
    if component_period is None or component.timing is None:
        return
    stated_rate = NS_PER_SECOND / component_period
    # Nodes of one component may work at different rates: the claim stands if any output has the stated rate.
    published_rates = {
        key: rate_and_gap.rate for (_, key), rate_and_gap in analysis.outputs.items() if key in output_ids
    }
    if not published_rates or not all(
        _is_impossible_rate(stated_rate, published_rate, tolerance) for published_rate in published_rates.values()
    ):
        return
    port, port_rate = next(iter(published_rates.items()))
    senders = "the components inside" if component.children else "its nodes"
    yield Diagnostic(
        "period-conflict",
        f"`{component.id}` states {format_rate(stated_rate)}, but {senders} publish `{port}` at {_format_bounded_rate(port_rate)}",
        component.timing.places.get("rate", component.timing.places.get("period", component.timing.at)),
        help=f"correct the component's rate, or the timing of {senders}",
        element=component.id,
    )


def _output_ids(component: Component) -> frozenset[str]:
    return frozenset(output.id for output in component.outputs.values())


def lost_samples(_: Architecture, analysis: Analysis, *, tolerance: Fraction) -> Iterator[Diagnostic]:
    """An element waits for all of several inputs, and one of them comes more often than it can be used."""
    for edge in analysis.edges:
        target = analysis.system.activities[edge.arc.target]
        waits_for_all = (
            target.mode == "all" and edge.arc.input in target.triggers and target.every == 1 and not target.throttle
        )
        if not waits_for_all or (edge.loss.value or 0) <= tolerance or target.period is not None:
            continue
        sent_rate = analysis.outputs[edge.arc.source, edge.arc.output].rate.value
        read_rate = analysis.paces[target.id].rate.value
        if sent_rate is None or not read_rate:
            continue  # `deadlocked-trigger` reports what never runs
        yield Diagnostic(
            "lost-samples",
            f"`{target.id}` uses {format_number(100 * (1 - (edge.loss.value or 0)))} % of what `{edge.arc.source}` sends: "
            f"it comes at {format_rate(sent_rate)}, all inputs together at {format_rate(read_rate)}",
            edge.arc.at if edge.arc.at != NO_SPAN else target.at,
            help="let one input fire it and sample the other (`trigger: [input]`), or give the sources one rate",
            element=target.id,
        )


def short_queue(_: Architecture, analysis: Analysis, *, margin: Fraction) -> Iterator[Diagnostic]:
    """An element keeps a queue that overflows before it is read."""
    for edge in analysis.edges:
        depth, coming_count = edge.arc.depth, edge.queue.value
        if not edge.arc.depth_written or depth is None or depth < 2 or coming_count is None:  # noqa: PLR2004
            continue
        needed_depth = math.ceil((1 + margin) * coming_count)
        if needed_depth <= depth:
            continue
        target = analysis.system.activities[edge.arc.target]
        if target.behaviour == "periodic" or fires_each_time(analysis.system, edge.arc):
            yield _report_overflow(edge, target, (depth, coming_count, needed_depth))


def _report_overflow(edge: EdgeFit, target: Activity, depths: tuple[int, Fraction, int]) -> Diagnostic:
    """Report a queue; `depths` are what it holds, what can come, and what it must hold with the rule's margin."""
    depth, coming_count, needed_depth = depths
    # Without a margin more can come than it holds; with one, all of it may fit.
    margin_phrase = " with the margin" if needed_depth > coming_count else ""
    contrast = "but" if coming_count > depth else "and"
    return Diagnostic(
        "short-queue",
        f"`{target.id}` keeps {depth} messages of `{edge.arc.topic}`, {contrast} {coming_count} can come before it has read them",
        edge.arc.queue_at if edge.arc.queue_at != NO_SPAN else edge.arc.at,
        help=f"`depth: {needed_depth}` keeps all of them{margin_phrase}, `depth: 1` says that only the newest counts",
        element=target.id,
    )


def endless_trigger(architecture: Architecture, analysis: Analysis) -> Iterator[Diagnostic]:
    """Elements fire one another in a ring: an event that enters it circulates for ever."""
    for ring in analysis.endless:
        members = [analysis.system.activities[name] for name in ring]
        # It is an error only if the behaviour of every member is written: an inferred one may be wrong. The finding is
        # placed at a member whose behaviour is written, if there is one.
        inferred_members = [activity for activity in members if activity.behaviour_inferred]
        first = next((activity for activity in members if not activity.behaviour_inferred), members[0])
        # Programs that exist run as they run: of none of them has anybody said how.
        is_guess = all(
            each.behaviour_inferred and architecture.nodes[each.node].status == "existing" for each in members
        )
        guess = Severity.NOTE if is_guess else Severity.WARNING
        yield Diagnostic(
            "endless-trigger",
            f"{_join_quoted(ring)} fire one another without an end"
            if len(ring) > 1
            else f"`{ring[0]}` fires itself without an end",
            first.places.get("trigger", first.at),
            severity=guess if inferred_members else None,
            labels=tuple(
                Label(member.at, "in the ring") for member in members if member is not first and member.at != NO_SPAN
            ),
            help="let one of them run by a timer (`period`), or only sample what comes back: name its other inputs in `trigger`",
            element=first.id,
        )


def deadlocked_trigger(_: Architecture, analysis: Analysis) -> Iterator[Diagnostic]:
    """Elements wait for all of several inputs, one of which never comes: they never run."""
    arriving_keys = _find_arriving_keys(analysis)
    for ring in analysis.deadlocked:
        members = [analysis.system.activities[name] for name in ring]
        # Only an activity that waits for several inputs can start a deadlock; the other members wait for its output.
        first = next(activity for activity in members if activity.mode in {"all", "match"})
        missing_keys = [key for key in first.triggers if key not in arriving_keys[first.id]]
        reason = (
            f"nothing feeds {_join_quoted(missing_keys)}"
            if missing_keys
            else f"{_join_quoted(ring)} wait for one another"
        )
        awaited = "all of its triggers" if first.mode == "all" else "messages that match"
        yield Diagnostic(
            "deadlocked-trigger",
            f"`{first.id}` never runs: it waits for {awaited}, and {reason}",
            first.places.get("trigger", first.at),
            labels=tuple(
                Label(member.at, "waits, too") for member in members if member is not first and member.at != NO_SPAN
            ),
            help=f"name in `trigger: {{{first.mode}: [...]}}` only the inputs that it has to wait for",
            element=first.id,
        )


def deadlocked_call(architecture: Architecture, analysis: Analysis) -> Iterator[Diagnostic]:
    """A callback waits, and the server that it calls has no other thread: the answer never comes."""
    system = analysis.system
    for arc in system.arcs:
        caller, server = system.activities[arc.source], system.activities[arc.target]
        # What a component asks another one of its node for is a function that it calls, unless ROS carries it.
        is_call = arc.role == "request" and arc.topic in architecture.topics
        if is_call and caller.wait and name_lane(system, caller) == name_lane(system, server):
            yield Diagnostic(
                "deadlocked-call",
                f"`{caller.id}` waits in its callback and calls `{arc.topic}` of `{server.id}`, which has the same thread: "
                "if it waits for that answer, it waits for ever",
                caller.places.get("response", caller.at),
                labels=(Label(server.at, "the server"),) if server.at != NO_SPAN else (),
                help="move one of them into another process, or do not wait: an answer comes in a callback of its own",
                element=caller.id,
            )


def _find_arriving_keys(analysis: Analysis) -> dict[str, set[str]]:
    """Return the input keys at which something arrives, from other activities or from outside, by activity id."""
    arriving_keys = defaultdict[str, set[str]](set)
    for arc in analysis.system.arcs:
        arriving_keys[arc.target].add(arc.input)
    for name, keys in analysis.system.external_inputs.items():
        arriving_keys[name].update(keys)
    return arriving_keys


def _join_quoted(names: tuple[str, ...] | list[str]) -> str:
    """Join names in backticks as in "`a`, `b` and `c`"."""
    return join_words([f"`{name}`" for name in names])


RULES = (
    (
        period_conflict,
        Severity.WARNING,
        (RuleOption("tolerance", 0, 0, 50, "The share by which what is stated may differ from what follows."),),
    ),
    (
        lost_samples,
        Severity.WARNING,
        (RuleOption("tolerance", 0, 0, 99, "The share of what is sent that may be thrown away."),),
    ),
    (
        short_queue,
        Severity.WARNING,
        (RuleOption("margin", 0, 0, 1000, "The share of what can come that must fit in besides."),),
    ),
    (endless_trigger, Severity.ERROR),
    (deadlocked_trigger, Severity.ERROR),
    (deadlocked_call, Severity.WARNING),
)
