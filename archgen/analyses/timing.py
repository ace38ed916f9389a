"""Are rates consistent: what elements state and what their inputs give, what is sent and what is read?"""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING

from archgen.diagnostic import Diagnostic, Label, Severity
from archgen.source import NOWHERE
from archgen.timing.edges import fires
from archgen.timing.ticks import SECOND, period
from archgen.timing.wording import number, rate

if TYPE_CHECKING:
    from collections.abc import Iterator
    from fractions import Fraction

    from archgen.model.architecture import Architecture
    from archgen.model.component import Component
    from archgen.source import Span
    from archgen.timing.analysis import Analysis, EdgePace
    from archgen.timing.system import Activity
    from archgen.timing.value import Value


def period_conflict(architecture: Architecture, found: Analysis) -> Iterator[Diagnostic]:
    """What an element states of its rate is not what its inputs, or the nodes that implement it, give.

    Why: An event-driven element runs when its inputs arrive. Where it states another rate, one of the two is wrong, and so is
    every figure that follows from it. The stated one is used, so that the rest can be judged meanwhile.

    Bad:
        groups:
          sensing:
            components:
              camera: {outputs: {image: sensor_msgs/msg/Image}}
              detector: {inputs: {image: camera.image}}
        nodes:
          camera: {implements: camera, timing: {rate: 30 Hz}}
          detector: {implements: detector, timing: {behaviour: event, rate: 10 Hz}}

    Good:
        groups:
          sensing:
            components:
              camera: {outputs: {image: sensor_msgs/msg/Image}}
              detector: {inputs: {image: camera.image}}
        nodes:
          camera: {implements: camera, timing: {rate: 30 Hz}}
          detector: {implements: detector, timing: {behaviour: event, every: 3}}
    """
    for name, derived in found.derived.items():
        stated = found.paces[name].rate.value
        if stated is None or not _differs(stated, derived.rate):
            continue
        activity = found.system.activities[name]
        reason = derived.reasons[-1] if derived.reasons else None
        yield Diagnostic(
            "period-conflict",
            f"`{name}` states {rate(stated)}, but what fires it gives {_bounded(derived.rate)}",
            _stated_at(activity),
            labels=(Label(reason.at, "it is fired here"),) if reason and reason.at != NOWHERE else (),
            help="leave the rate out, or correct it; `behaviour: periodic` if a timer decides",
            element=name,
        )
    # A component with one node has one timing, written in either place. With several nodes its timing is a claim about
    # the whole, which no node inherits: it is compared with what the nodes publish.
    shared = Counter(component for node in architecture.nodes.values() for component in node.implements)
    for component in architecture.components.values():
        if component.timing and shared[component.id] > 1:
            yield from _claim(found, component)


def _differs(stated: Fraction, derived: Value) -> bool:
    """Whether a stated rate contradicts the derived one (both in Hz): another exact value, or beyond a bound."""
    if derived.value is None:
        return False
    if derived.side == "at most":
        return stated > derived.value
    if derived.side == "at least":
        return stated < derived.value
    return stated != derived.value


def _bounded(value: Value) -> str:
    """Format a rate (Hz) with the side on which it bounds: "at most 10 Hz"."""
    text = rate(value.value) if value.value is not None else "nothing known"
    return text if value.side == "exact" else f"{value.side} {text}"


def _stated_at(activity: Activity) -> Span:
    return activity.places.get("rate", activity.places.get("period", activity.at))


def _claim(found: Analysis, component: Component) -> Iterator[Diagnostic]:
    """Report a component with several nodes whose stated rate none of its outputs has."""
    claimed = period(component.timing) if component.timing else None
    if claimed is None or component.timing is None:
        return
    stated = SECOND / claimed
    # Nodes of one component may work at different rates: the claim stands if any output has the stated rate.
    published = {key: pace.rate for (_, key), pace in found.outputs.items() if key in _ports(component)}
    if not published or not all(_differs(stated, one) for one in published.values()):
        return
    port, given = next(iter(published.items()))
    yield Diagnostic(
        "period-conflict",
        f"`{component.id}` states {rate(stated)}, but its nodes publish `{port}` at {_bounded(given)}",
        component.timing.places.get("rate", component.timing.places.get("period", component.timing.at)),
        help="correct the component's rate, or the timing of its nodes",
        element=component.id,
    )


def _ports(component: Component) -> frozenset[str]:
    return frozenset(output.id for output in component.outputs.values())


def lost_samples(_: Architecture, found: Analysis) -> Iterator[Diagnostic]:
    """An element waits for all of several inputs, and one of them comes more often than it can be used.

    Why: An element that fires when all of its inputs have something new runs as often as the slowest of them. What the
    others send more often is thrown away, and where the rates have no common measure, the pairs that are put together are
    of another age each time. An element that samples its inputs by a timer does so on purpose, and is not meant here.

    Bad:
        groups:
          sensing:
            components:
              left: {outputs: {image: sensor_msgs/msg/Image}}
              right: {outputs: {image: sensor_msgs/msg/Image}}
              stereo: {inputs: {left: left.image, right: right.image}}
        nodes:
          left: {implements: left, timing: {rate: 30 Hz}}
          right: {implements: right, timing: {rate: 25 Hz}}
          stereo: {implements: stereo, timing: {trigger: all}}

    Good:
        groups:
          sensing:
            components:
              left: {outputs: {image: sensor_msgs/msg/Image}}
              right: {outputs: {image: sensor_msgs/msg/Image}}
              stereo: {inputs: {left: left.image, right: right.image}}
        nodes:
          left: {implements: left, timing: {rate: 30 Hz}}
          right: {implements: right, timing: {rate: 30 Hz}}
          stereo: {implements: stereo, timing: {trigger: all}}
    """
    for edge in found.edges:
        target = found.system.activities[edge.arc.target]
        waits = target.mode == "all" and edge.arc.input in target.triggers and target.every == 1 and not target.throttle
        if not waits or not edge.loss.value or target.period is not None:
            continue
        sent = found.outputs[edge.arc.source, edge.arc.output].rate.value
        read = found.paces[target.id].rate.value
        if sent is None or not read:
            continue  # `deadlocked-trigger` reports what never runs
        yield Diagnostic(
            "lost-samples",
            f"`{target.id}` uses {number(100 * (1 - edge.loss.value))} % of what `{edge.arc.source}` sends: "
            f"it comes at {rate(sent)}, all inputs together at {rate(read)}",
            edge.arc.at if edge.arc.at != NOWHERE else target.at,
            help="let one input fire it and sample the other (`trigger: [input]`), or give the sources one rate",
            element=target.id,
        )


def short_queue(_: Architecture, found: Analysis) -> Iterator[Diagnostic]:
    """An element keeps a queue that overflows before it is read.

    Why: Whoever asks for a queue of several messages means to read all of them. Until a periodic reader has been through once
    more, its largest gap and its response time pass, and the response of what each message fires; what comes in that time
    must fit in, or the oldest is lost without a sign. A queue of one (only the newest counts), and a depth that nobody wrote, are not meant here.

    Bad:
        groups:
          sensing:
            components:
              imu: {outputs: {motion: sensor_msgs/msg/Imu}}
              filter: {inputs: {motion: imu.motion}}
        nodes:
          imu: {implements: imu, timing: {rate: 200 Hz, wcet: 1 ms, bcet: 1 ms}}
          filter:
            implements: filter
            subscribes: {motion: {qos: {depth: 5}}}
            timing: {rate: 20 Hz, wcet: 2 ms}

    Good:
        groups:
          sensing:
            components:
              imu: {outputs: {motion: sensor_msgs/msg/Imu}}
              filter: {inputs: {motion: imu.motion}}
        nodes:
          imu: {implements: imu, timing: {rate: 200 Hz, wcet: 1 ms, bcet: 1 ms}}
          filter:
            implements: filter
            subscribes: {motion: {qos: {depth: 11}}}
            timing: {rate: 20 Hz, wcet: 2 ms}
    """
    for edge in found.edges:
        depth, needed = edge.arc.depth, edge.queue.value
        if not edge.arc.depth_written or depth is None or depth < 2 or needed is None or needed <= depth:  # noqa: PLR2004
            continue
        target = found.system.activities[edge.arc.target]
        if target.behaviour == "periodic" or fires(found.system, edge.arc):
            yield _overflow(edge, target, depth, needed)


def _overflow(edge: EdgePace, target: Activity, depth: int, needed: Fraction) -> Diagnostic:
    return Diagnostic(
        "short-queue",
        f"`{target.id}` keeps {depth} messages of `{edge.arc.topic}`, but {needed} can come before it has read them",
        edge.arc.queue_at if edge.arc.queue_at != NOWHERE else edge.arc.at,
        help=f"`depth: {needed}` keeps all of them, `depth: 1` says that only the newest counts",
        element=target.id,
    )


RULES = (
    (period_conflict, Severity.WARNING),
    (lost_samples, Severity.WARNING),
    (short_queue, Severity.WARNING),
)
