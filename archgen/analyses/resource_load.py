"""Can hosts, links and servers carry their load?"""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING

from archgen.diagnostics.diagnostic import Diagnostic, Label, Severity
from archgen.diagnostics.source_span import NO_SPAN
from archgen.timing.figures.figure_wording import format_duration, format_number
from archgen.timing.figures.value_arithmetic import add_values
from archgen.timing.load.host_loads import activity_share
from archgen.timing.system.core_placement import find_unplaced_containers

if TYPE_CHECKING:
    from collections.abc import Iterator

    from archgen.diagnostics.source_span import Span
    from archgen.model.architecture import Architecture
    from archgen.model.component import Component, PerformanceIndicator
    from archgen.timing.analysis import Analysis, HostLoad, ServiceLoad
    from archgen.timing.system.timing_system import Activity


def overloaded_host(architecture: Architecture, analysis: Analysis) -> Iterator[Diagnostic]:
    """What runs on a host needs more time than its cores have.

    Why: From a utilisation of 1 on, work is left over in each round, and responses grow without a bound. Cores to which
    something is pinned are looked at one by one; all else shares the others. Nodes without a host count as having a core of
    their own, which one of them alone can overload, too.

    Bad:
        groups:
          sensing:
            components:
              camera: {outputs: {image: sensor_msgs/msg/Image}}
              detector: {inputs: {image: camera.image}}
        nodes:
          camera: {implements: camera, host: pc, timing: {rate: 10 Hz, wcet: 30 ms}}
          detector: {implements: detector, host: pc, timing: {behaviour: event, wcet: 80 ms}}
        hosts: {pc: {cores: 1}}

    Good:
        groups:
          sensing:
            components:
              camera: {outputs: {image: sensor_msgs/msg/Image}}
              detector: {inputs: {image: camera.image}}
        nodes:
          camera: {implements: camera, host: pc, timing: {rate: 10 Hz, wcet: 30 ms}}
          detector: {implements: detector, host: pc, timing: {behaviour: event, wcet: 80 ms}}
        hosts: {pc: {cores: 2}}
    """
    for host, load in analysis.hosts.items():
        for place_name, cores, utilisation in load.core_loads:
            # A utilisation of exactly 1 can be schedulable (strictly periodic, fixed priorities), so the host's verdict
            # decides; the utilisation says which of its cores it is about.
            if utilisation.value is not None and utilisation.value >= cores and load.verdict == "overload":
                yield _report_overload(architecture, analysis, host, load, (place_name, cores, utilisation.value))
    yield from _find_overloaded_containers(architecture, analysis)
    # An activity may overload a core by itself on a host whose cores are enough in total, or without any host.
    overloaded_hosts = {host for host, load in analysis.hosts.items() if load.verdict == "overload"}
    for name, rate_and_gap in analysis.paces.items():
        activity = analysis.system.activities[name]
        own_share = activity_share(analysis.system, name, rate_and_gap).value
        # A period that is written is compared with the execution time by `long-execution`: one slip, one finding.
        if (
            activity.period is None
            and own_share is not None
            and own_share >= 1
            and activity.host not in overloaded_hosts
        ):
            yield Diagnostic(
                "overloaded-host",
                f"`{name}` takes {format_number(100 * own_share)} % of a core: it is fired again before it is done",
                activity.places.get("wcet", activity.at),
                help="fire it less often (`every`, `throttle`), or make it quicker",
                element=name,
            )


def _find_overloaded_containers(architecture: Architecture, analysis: Analysis) -> Iterator[Diagnostic]:
    """Yield a finding for each overloaded container that has no host and fewer threads than members."""
    # With a host, the host's utilisation counts the members already.
    for name, members in find_unplaced_containers(analysis.system).items():
        threads = analysis.system.threads.get(name) or 1
        utilisation = add_values(
            activity_share(analysis.system, member.id, analysis.paces[member.id]) for member in members
        ).value
        if utilisation is not None and utilisation >= threads:
            threads_phrase = "its thread" if threads == 1 else f"its {threads} threads"
            yield Diagnostic(
                "overloaded-host",
                f"`{name}` is overloaded: what runs there takes {format_number(100 * utilisation / threads)} % of {threads_phrase}",
                architecture.containers[name].at,
                help="give it more threads, move something out, or let it run less often",
                element=name,
            )


def _report_overload(
    architecture: Architecture, analysis: Analysis, host_id: str, load: HostLoad, busy_place: tuple[str, int, Fraction]
) -> Diagnostic:
    """Report an overloaded host, or the cores of it that `place` names: (name, number of cores, utilisation)."""
    name, cores, utilisation = busy_place
    activity_loads = sorted(
        ((v.value or Fraction(0), activity_id) for activity_id, v in load.activity_shares), key=lambda p: -p[0]
    )
    heaviest = analysis.system.activities[activity_loads[0][1]]
    return Diagnostic(
        "overloaded-host",
        f"`{name}` is overloaded: what runs there takes {format_number(100 * utilisation / cores)} % of {_format_cores(cores)}",
        architecture.hosts[host_id].at,
        labels=(Label(heaviest.places.get("wcet", heaviest.at), f"`{heaviest.id}` takes most"),)
        if heaviest.at != NO_SPAN
        else (),
        help="move something to another host or core, or let it run less often",
        element=host_id,
    )


def _format_cores(count: int) -> str:
    """Format a number of cores with its possessive: "its 4 cores"."""
    return "its core" if count == 1 else f"its {count} cores"


def slow_component(architecture: Architecture, analysis: Analysis) -> Iterator[Diagnostic]:
    """A component's node takes longer than the execution time that its performance asks for.

    Why: `performance` says what the component promises to others. Its node's worst response is above that: the execution time
    with all that gets in its way on its host, or what it declares. `archgen timing --why NODE` shows how it is found.

    Bad:
        groups:
          sensing:
            components:
              detector:
                performance: {detection: {execution_time: 100 ms}}
                outputs: {objects: {type: vision_msgs/msg/Detection3DArray, external: The recording}}
        nodes:
          detector: {implements: detector, timing: {period: 500 ms, wcet: 180 ms}}

    Good:
        groups:
          sensing:
            components:
              detector:
                performance: {detection: {execution_time: 200 ms}}
                outputs: {objects: {type: vision_msgs/msg/Detection3DArray, external: The recording}}
        nodes:
          detector: {implements: detector, timing: {period: 500 ms, wcet: 180 ms}}
    """
    for activity in analysis.system.activities.values():
        component = architecture.components.get(activity.component or "")
        worst_response = analysis.responses[activity.id].worst.value
        if component is None or worst_response is None:
            continue  # unknown, or unbounded by an overload, which `overloaded-host` reports
        for indicator in component.performance:
            required_time = indicator.execution_time
            if required_time is not None and worst_response > required_time.value:
                # Whether the activity alone is too slow, or what runs beside it makes it so: `wcet` is in ticks.
                is_undisturbed = (
                    activity.response is not None or worst_response == (activity.wcet or 0) * analysis.system.tick
                )
                yield _report_slow_component(
                    component, indicator, activity, worst_response, is_undisturbed=is_undisturbed
                )


def _report_slow_component(
    component: Component,
    indicator: PerformanceIndicator,
    activity: Activity,
    worst_response: Fraction,
    *,
    is_undisturbed: bool,
) -> Diagnostic:
    """Report a response that is above the required execution time, both in ns."""
    span = activity.places.get("wcet" if activity.response is None else "response", activity.at)
    cause = "" if is_undisturbed or activity.host is None else f" with all that works on `{activity.host}`"
    return Diagnostic(
        "slow-component",
        f"`{component.id}` is asked to need at most {indicator.execution_time}, but `{activity.id}` takes up to {format_duration(worst_response)}{cause}",
        indicator.at,
        labels=(Label(span, "takes longer" if is_undisturbed else "takes longer with what gets in its way"),)
        if span != NO_SPAN
        else (),
        help="make the node quicker, give it a priority or a core, or correct what the performance promises",
        element=component.id,
    )


def saturated_link(architecture: Architecture, analysis: Analysis) -> Iterator[Diagnostic]:
    """What is sent over a link is more than its bandwidth carries.

    Why: Each reader on another host has a copy of its own sent. Where the sum is the bandwidth or more, messages queue up
    until they are dropped, and no latency can be promised.

    Bad:
        groups:
          sensing:
            components:
              camera: {outputs: {image: Picture}}
              viewer: {inputs: {image: camera.image}}
        types: {Picture: {message: sensor_msgs/msg/Image, size: 6 MB}}
        nodes:
          camera: {implements: camera, host: head, timing: {rate: 30 Hz}}
          viewer: {implements: viewer, host: base}
        hosts: {head: {}, base: {}}
        links: {cable: {connects: [head, base], bandwidth: 1 Gbit/s}}

    Good:
        groups:
          sensing:
            components:
              camera: {outputs: {image: Picture}}
              viewer: {inputs: {image: camera.image}}
        types: {Picture: {message: sensor_msgs/msg/CompressedImage, size: 600 kB}}
        nodes:
          camera: {implements: camera, host: head, timing: {rate: 30 Hz}}
          viewer: {implements: viewer, host: base}
        hosts: {head: {}, base: {}}
        links: {cable: {connects: [head, base], bandwidth: 1 Gbit/s}}
    """
    for name, load in analysis.links.items():
        if load.share.value is None or load.share.value < 1:
            continue
        topic = max(load.topic_traffic, key=lambda part: part[1].value or 0)[0]
        yield Diagnostic(
            "saturated-link",
            f"`{name}` is to carry {format_number(100 * load.share.value)} % of its bandwidth, most of it `{topic}`",
            architecture.links[name].at,
            help="send less often or less at once (compressed, for instance), or run writer and reader on one host",
            element=name,
        )


def slow_service(_: Architecture, analysis: Analysis) -> Iterator[Diagnostic]:
    """A service takes longer, with all its callers waiting, than one of them has before it runs again.

    Why: Each caller may find the calls of all others before its own: with K callers an answer takes up to K times the
    server's execution time, and more where others work on the server's host. A periodic caller that waits for its answers
    is late then, and skips a period. Actions, which nobody waits for, are not meant here.

    Bad:
        groups:
          moving:
            components:
              planner: {outputs: {plan: nav_msgs/srv/GetPlan}}
              control: {inputs: {plan: planner.plan}}
              watch: {inputs: {plan: planner.plan}}
        nodes:
          planner: {implements: planner, timing: {wcet: 60 ms}}
          control: {implements: control, timing: {period: 100 ms}}
          watch: {implements: watch, timing: {period: 1 s}}

    Good:
        groups:
          moving:
            components:
              planner: {outputs: {plan: nav_msgs/srv/GetPlan}}
              control: {inputs: {plan: planner.plan}}
              watch: {inputs: {plan: planner.plan}}
        nodes:
          planner: {implements: planner, timing: {wcet: 60 ms}}
          control: {implements: control, timing: {period: 200 ms}}
          watch: {implements: watch, timing: {period: 1 s}}
    """
    examined_pairs: set[tuple[str, str]] = set()
    for arc in analysis.system.arcs:
        if arc.role != "request" or arc.flow != "service" or (arc.source, arc.target) in examined_pairs:
            continue
        examined_pairs.add((arc.source, arc.target))
        load, caller = analysis.services[arc.target], analysis.system.activities[arc.source]
        waiting_time = load.waits[caller.id].value
        # Only periodic callers can be late for their own next activation.
        if waiting_time is None or caller.period is None:
            continue
        caller_period = caller.period * analysis.system.tick
        if waiting_time > caller_period:
            server = analysis.system.activities[arc.target]
            yield _report_slow_service(load, caller, server, (waiting_time, caller_period), arc.at)


def _report_slow_service(
    load: ServiceLoad, caller: Activity, server: Activity, waiting_and_period: tuple[Fraction, Fraction], span: Span
) -> Diagnostic:
    """Report a caller that waits longer than its period; `times` are both, in ns, in this order."""
    callers_phrase = f", with {len(load.callers)} callers" if len(load.callers) > 1 else ""
    return Diagnostic(
        "slow-service",
        f"`{caller.id}` runs every {format_duration(waiting_and_period[1])}, but waits up to {format_duration(waiting_and_period[0])} for `{server.id}`{callers_phrase}",
        span if span != NO_SPAN else caller.at,
        labels=(Label(server.places.get("wcet", server.at), "takes this long for each"),)
        if server.at != NO_SPAN
        else (),
        help="make the service quicker, call it less often (`calls`), or make it an action",
        element=caller.id,
    )


RULES = (
    (overloaded_host, Severity.WARNING),
    (slow_component, Severity.WARNING),
    (saturated_link, Severity.WARNING),
    (slow_service, Severity.WARNING),
)
