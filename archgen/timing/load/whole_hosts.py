"""A host of several cores taken as one: while anything waits there, at least one of its cores works.

So from the last instant at which nothing was pending on the host, all that the events since then lead to is done as soon
as a single core would have done it, however the work is divided, pinned or ordered. This bounds every run on a host that
is loaded with less than one core's worth, also where runs go to and fro between pinned cores, and the delays of one core
would come back to it as jitter for ever.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from archgen.frozen import NamedTuple
from archgen.timing.figures.timing_values import ResponseTier
from archgen.timing.load.core_responses import CoreResponses
from archgen.timing.load.inner_core import InnerCore, prepare_inner_core
from archgen.timing.load.inner_triggers import find_inner_triggers
from archgen.timing.load.thread_work import WorstResponse
from archgen.timing.system.core_placement import ProcessingResource
from archgen.timing.system.thread_pools import ThreadUnit
from archgen.timing.system.timing_system import TimingSystem
from archgen.timing.system.trigger_graph import TriggerGraph


class HostLimit(NamedTuple):
    """What bounds an activity on a host taken as one core, in ticks: from its activation, and from the host's event on.

    `storing_wait` bounds how long a message may wait to be stored that it only reads. What bounds a way over hosts (`tier`)
    bounds a response alone.
    """

    response: int
    delay: int | None
    storing_wait: int | None = None
    tier: ResponseTier = "whole host"

    def limit_to(self, other: HostLimit | None) -> HostLimit:
        """Return the smaller limits of two."""
        if other is None or self.response <= other.response:
            return self
        return self._replace(response=other.response, tier=other.tier)


def find_whole_hosts(
    system: TimingSystem, triggers: TriggerGraph, resources: Iterable[ProcessingResource]
) -> dict[str, InnerCore]:
    """Return each host of several cores, as one core, on which activities fire one another."""
    units_by_host: dict[str, list[ThreadUnit]] = {}
    hosts_of_one_core: set[str] = set()
    hosts_with_waits: set[str] = set()
    for resource in resources:
        if resource.host is None or resource.missing:
            continue
        if any(system.activities[name].suspends for name in resource.members):
            hosts_with_waits.add(resource.host)
        if resource.host not in units_by_host and resource.cores == 1 and not resource.undisturbed:
            hosts_of_one_core.add(resource.host)
        else:
            hosts_of_one_core.discard(resource.host)
        units_by_host.setdefault(resource.host, []).extend(resource.units)
    whole_hosts: dict[str, InnerCore] = {}
    for host, units in units_by_host.items():
        # What waits for a GPU leaves all cores idle.
        if host in hosts_of_one_core or host in hosts_with_waits:
            continue
        whole_host = ProcessingResource(host, host, 1, tuple(units))
        inner_triggers = find_inner_triggers(system, triggers, whole_host)
        if inner_triggers is not None:
            # In any order: what is urgent has no core to itself here.
            whole_hosts[host] = prepare_inner_core(system, whole_host, inner_triggers, is_ranked=False)
    return whole_hosts


def list_host_limits(core_responses: CoreResponses) -> dict[str, HostLimit]:
    """Return the limits of the activities that have one."""
    limits: dict[str, HostLimit] = {}
    for name, response in core_responses.response_of.items():
        delays = [way.delay for way in core_responses.ways_to[name]]
        known_delays = [delay for delay in delays if delay is not None]
        if response.value is not None and response.tier != "declared" and delays and len(known_delays) == len(delays):
            storing_wait = core_responses.storing_waits.get(name)
            limits[name] = HostLimit(response.value, max(known_delays), storing_wait.value if storing_wait else None)
    return limits


def limit_responses(core_responses: CoreResponses, limits: Mapping[str, HostLimit]) -> CoreResponses:
    """Return responses, ways and waits, none longer than its host's limit."""
    response_of = dict(core_responses.response_of)
    storing_waits = dict(core_responses.storing_waits)
    for name, wait in core_responses.storing_waits.items():
        limit = limits.get(name)
        if (
            limit is not None
            and limit.storing_wait is not None
            and (wait.value is None or wait.value > limit.storing_wait)
        ):
            storing_waits[name] = WorstResponse(limit.storing_wait, "whole host")
    ways_to = dict(core_responses.ways_to)
    for name, response in core_responses.response_of.items():
        limit = limits.get(name)
        if limit is None or response.tier in {"declared", "unknown"}:
            continue
        if response.value is None or response.value > limit.response:
            response_of[name] = WorstResponse(limit.response, limit.tier)
        ways_to[name] = tuple(
            way
            if limit.delay is None or (way.delay is not None and way.delay <= limit.delay)
            else way._replace(delay=limit.delay)
            for way in core_responses.ways_to.get(name, ())
        )
    return CoreResponses(response_of, ways_to, storing_waits)
