"""Can hosts, links and servers carry their load?"""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING

from archgen.diagnostic import Diagnostic, Label, Severity
from archgen.source import NOWHERE
from archgen.timing.bounds import share
from archgen.timing.placement import homeless
from archgen.timing.sums import total
from archgen.timing.wording import duration, number

if TYPE_CHECKING:
    from collections.abc import Iterator

    from archgen.model.architecture import Architecture
    from archgen.model.component import Component, Indicator
    from archgen.source import Span
    from archgen.timing.analysis import Analysis, HostLoad, ServiceLoad
    from archgen.timing.system import Activity


def overloaded_host(architecture: Architecture, found: Analysis) -> Iterator[Diagnostic]:
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
    for host, load in found.hosts.items():
        for place, cores, used in load.places:
            # A utilisation of exactly 1 can be schedulable (strictly periodic, fixed priorities), so the host's verdict
            # decides; the utilisation says which of its cores it is about.
            if used.value is not None and used.value >= cores and load.verdict == "overload":
                yield _overload(architecture, found, host, load, (place, cores, used.value))
    yield from _overloaded_containers(architecture, found)
    # An activity may overload a core by itself on a host whose cores are enough in total, or without any host.
    full = {host for host, load in found.hosts.items() if load.verdict == "overload"}
    for name, pace in found.paces.items():
        activity = found.system.activities[name]
        alone = share(found.system, name, pace).value
        # A period that is written is compared with the execution time by `long-execution`: one slip, one finding.
        if activity.period is None and alone is not None and alone >= 1 and activity.host not in full:
            yield Diagnostic(
                "overloaded-host",
                f"`{name}` takes {number(100 * alone)} % of a core: it is fired again before it is done",
                activity.places.get("wcet", activity.at),
                help="fire it less often (`every`, `throttle`), or make it quicker",
                element=name,
            )


def _overloaded_containers(architecture: Architecture, found: Analysis) -> Iterator[Diagnostic]:
    """Yield a finding for each overloaded container that has no host and fewer threads than members."""
    # With a host, the host's utilisation counts the members already.
    for name, members in homeless(found.system).items():
        threads = found.system.threads.get(name) or 1
        used = total(share(found.system, one.id, found.paces[one.id]) for one in members).value
        if used is not None and used >= threads:
            several = "its thread" if threads == 1 else f"its {threads} threads"
            yield Diagnostic(
                "overloaded-host",
                f"`{name}` is overloaded: what runs there takes {number(100 * used / threads)} % of {several}",
                architecture.containers[name].at,
                help="give it more threads, move something out, or let it run less often",
                element=name,
            )


def _overload(
    architecture: Architecture, found: Analysis, host: str, load: HostLoad, place: tuple[str, int, Fraction]
) -> Diagnostic:
    """Report an overloaded host, or the cores of it that `place` names: (name, number of cores, utilisation)."""
    name, cores, used = place
    parts = sorted(((v.value or Fraction(0), part) for part, v in load.parts), key=lambda p: -p[0])
    heaviest = found.system.activities[parts[0][1]]
    return Diagnostic(
        "overloaded-host",
        f"`{name}` is overloaded: what runs there takes {number(100 * used / cores)} % of {_cores(cores)}",
        architecture.hosts[host].at,
        labels=(Label(heaviest.places.get("wcet", heaviest.at), f"`{heaviest.id}` takes most"),)
        if heaviest.at != NOWHERE
        else (),
        help="move something to another host or core, or let it run less often",
        element=host,
    )


def _cores(count: int) -> str:
    """Format a number of cores with its possessive: "its 4 cores"."""
    return "its core" if count == 1 else f"its {count} cores"


def slow_component(architecture: Architecture, found: Analysis) -> Iterator[Diagnostic]:
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
    for activity in found.system.activities.values():
        component = architecture.components.get(activity.component or "")
        worst = found.responses[activity.id].worst.value
        if component is None or worst is None:
            continue  # unknown, or unbounded by an overload, which `overloaded-host` reports
        for indicator in component.performance:
            asked = indicator.execution_time
            if asked is not None and worst > asked.value:
                # Whether the activity alone is too slow, or what runs beside it makes it so: `wcet` is in ticks.
                alone = activity.response is not None or worst == (activity.wcet or 0) * found.system.tick
                yield _slow(component, indicator, activity, worst, alone=alone)


def _slow(
    component: Component, indicator: Indicator, activity: Activity, worst: Fraction, *, alone: bool
) -> Diagnostic:
    """Report a response that is above the required execution time, both in ns."""
    place = activity.places.get("wcet" if activity.response is None else "response", activity.at)
    others = "" if alone or activity.host is None else f" with all that works on `{activity.host}`"
    return Diagnostic(
        "slow-component",
        f"`{component.id}` is asked to need at most {indicator.execution_time}, but `{activity.id}` takes up to {duration(worst)}{others}",
        indicator.at,
        labels=(Label(place, "takes longer" if alone else "takes longer with what gets in its way"),)
        if place != NOWHERE
        else (),
        help="make the node quicker, give it a priority or a core, or correct what the performance promises",
        element=component.id,
    )


def saturated_link(architecture: Architecture, found: Analysis) -> Iterator[Diagnostic]:
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
    for name, load in found.links.items():
        if load.share.value is None or load.share.value < 1:
            continue
        topic = max(load.parts, key=lambda part: part[1].value or 0)[0]
        yield Diagnostic(
            "saturated-link",
            f"`{name}` is to carry {number(100 * load.share.value)} % of its bandwidth, most of it `{topic}`",
            architecture.links[name].at,
            help="send less often or less at once (compressed, for instance), or run writer and reader on one host",
            element=name,
        )


def slow_service(_: Architecture, found: Analysis) -> Iterator[Diagnostic]:
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
    seen: set[tuple[str, str]] = set()
    for arc in found.system.arcs:
        if arc.role != "request" or arc.flow != "service" or (arc.source, arc.target) in seen:
            continue
        seen.add((arc.source, arc.target))
        load, caller = found.services[arc.target], found.system.activities[arc.source]
        waited = load.waits[caller.id].value
        # Only periodic callers can be late for their own next activation.
        if waited is None or caller.period is None:
            continue
        there_is = caller.period * found.system.tick
        if waited > there_is:
            server = found.system.activities[arc.target]
            yield _late(load, caller, server, (waited, there_is), arc.at)


def _late(
    load: ServiceLoad, caller: Activity, server: Activity, times: tuple[Fraction, Fraction], place: Span
) -> Diagnostic:
    """Report a caller that waits longer than its period; `times` are both, in ns, in this order."""
    several = f", with {len(load.callers)} callers" if len(load.callers) > 1 else ""
    return Diagnostic(
        "slow-service",
        f"`{caller.id}` runs every {duration(times[1])}, but waits up to {duration(times[0])} for `{server.id}`{several}",
        place if place != NOWHERE else caller.at,
        labels=(Label(server.places.get("wcet", server.at), "takes this long for each"),)
        if server.at != NOWHERE
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
