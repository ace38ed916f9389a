"""Can hosts and links carry their load?"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from fractions import Fraction

from archgen.diagnostics import NO_SPAN, Diagnostic, Label, Severity
from archgen.diagnostics.rule_options import RuleOption, format_percentage
from archgen.model.architecture import Architecture
from archgen.model.deployment import Link
from archgen.timing.analysis import Analysis, HostLoad, LinkLoad
from archgen.timing.figures.figure_wording import format_duration, format_number
from archgen.timing.figures.timing_values import add_values
from archgen.timing.load.host_loads import activity_share
from archgen.timing.system.thread_pools import find_unplaced_pools


def overloaded_host(architecture: Architecture, analysis: Analysis, *, limit: Fraction) -> Iterator[Diagnostic]:
    """What runs on a host needs more time than its cores have."""
    for host, load in analysis.hosts.items():
        for place_name, cores, utilisation in load.core_loads:
            # A utilisation of exactly 1 can be schedulable (strictly periodic, fixed priorities), so the host's verdict
            # decides; the utilisation says which of its cores it is about. Below 1 there is nothing to schedule about.
            is_beyond = utilisation.value is not None and utilisation.value >= limit * cores
            if utilisation.value is not None and is_beyond and (limit < 1 or load.verdict == "overload"):
                yield _report_overload(architecture, analysis, host, load, (place_name, cores, utilisation.value))
    yield from _find_overloaded_containers(architecture, analysis, limit)
    yield from _find_overloaded_resources(architecture, analysis, limit)
    # An activity may overload a core by itself on a host whose cores are enough in total, or without any host.
    overloaded_hosts = {host for host, load in analysis.hosts.items() if load.verdict == "overload"}
    for name, rate_and_gap in analysis.paces.items():
        activity = analysis.system.activities[name]
        # A period that is written is compared with the execution time by `long-execution`: one slip, one finding.
        if activity.period is not None or activity.host in overloaded_hosts:
            continue
        own_share = activity_share(analysis.system, name, rate_and_gap).value
        if own_share is not None and own_share >= 1:
            yield Diagnostic(
                "overloaded-host",
                f"`{name}` takes {format_number(100 * own_share)} % of a core: it is fired again before it is done",
                activity.places.get("wcet", activity.at),
                help="fire it less often (`every`, `throttle`), or make it quicker",
                element=name,
            )


def _find_overloaded_containers(
    architecture: Architecture, analysis: Analysis, limit: Fraction
) -> Iterator[Diagnostic]:
    """Yield a finding for each overloaded process that has no host and fewer threads than members."""
    # With a host, the host's utilisation counts the members already.
    for pool, members in find_unplaced_pools(analysis.system).items():
        kind, _, name = pool.key.partition(" ")
        threads = pool.threads or 1
        utilisation = add_values(
            activity_share(analysis.system, member.id, analysis.paces[member.id]) for member in members
        ).value
        if utilisation is not None and utilisation >= limit * threads:
            threads_phrase = "its thread" if threads == 1 else f"its {threads} threads"
            yield Diagnostic(
                "overloaded-host",
                f"`{name}` is {_describe_excess(utilisation / threads)}: what runs there takes {format_number(100 * utilisation / threads)} % of {threads_phrase}",
                (architecture.containers if kind == "container" else architecture.nodes)[name].at,
                help="give it more threads, move something out, or let it run less often",
                element=name,
            )


def _find_overloaded_resources(architecture: Architecture, analysis: Analysis, limit: Fraction) -> Iterator[Diagnostic]:
    """Yield a finding for each resource (a GPU) of which more is asked than it can do."""
    for name, load in analysis.resources.items():
        utilisation = load.utilisation.value
        if utilisation is None or utilisation < limit or (limit == 1 and utilisation == 1):
            continue
        heaviest = analysis.system.activities[max(load.shares, key=lambda part: part[1].value or 0)[0]]
        span = heaviest.places.get(f"uses {name}", heaviest.at)
        yield Diagnostic(
            "overloaded-host",
            f"`{name}` is {_describe_excess(utilisation)}: what uses it takes {format_number(100 * utilisation)} % of its time",
            architecture.resources[name].at if name in architecture.resources else heaviest.at,
            labels=(Label(span, f"`{heaviest.id}` takes most"),) if span != NO_SPAN else (),
            help="use it less often or for a shorter time, or give some of the work another one",
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
        f"`{name}` is {_describe_excess(utilisation / cores)}: what runs there takes {format_number(100 * utilisation / cores)} % of {f'its {cores} cores' if cores > 1 else 'its core'}",
        architecture.hosts[host_id].at,
        labels=(Label(heaviest.places.get("wcet", heaviest.at), f"`{heaviest.id}` takes most"),)
        if heaviest.at != NO_SPAN
        else (),
        help=_advise_on_load(analysis, [name for _, name in activity_loads]),
        element=host_id,
    )


def _advise_on_load(analysis: Analysis, activity_ids: Sequence[str]) -> str:
    """Say what can be done about a load (the heaviest comes first), and what of it is only taken for granted."""
    calls = [(name, text) for name in activity_ids if (text := _describe_calls(analysis, name))]
    if calls and calls[0][0] == activity_ids[0]:
        return f"{calls[0][1]}, or move something to another host"
    advice = "move something to another host or core, or let it run less often"
    return "; ".join((advice, *(text for _, text in calls[:1])))


def _describe_calls(analysis: Analysis, activity_id: str) -> str:
    """Describe who calls a server as often as it runs itself, because nothing says how often; empty for none."""
    requests = [
        arc
        for arc in analysis.system.arcs_into.get(activity_id, ())
        if arc.role == "request" and arc.output not in analysis.system.activities[arc.source].calls
    ]
    rates = [(arc, analysis.paces[arc.source].rate.value) for arc in requests]
    known_rates = [(arc, rate) for arc, rate in rates if rate]
    if not known_rates:
        return ""
    arc, rate = max(known_rates, key=lambda pair: pair[1])
    return (
        f"`{arc.source}` is taken to call `{activity_id}` once in each activation, {format_number(rate)} times a second: "
        f"write in its timing how often it calls (`calls: {{{arc.output.rpartition('.')[2]}: 0.1}}`)"
    )


def _describe_excess(utilisation: Fraction) -> str:
    """Describe a load (1 is all there is) at or above the rule's limit."""
    return "overloaded" if utilisation >= 1 else "loaded beyond its limit"


def saturated_link(architecture: Architecture, analysis: Analysis, *, limit: Fraction) -> Iterator[Diagnostic]:
    """What is sent over a link is more than its bandwidth carries, at all or within the latency that is written."""
    for name, load in analysis.links.items():
        if load.share.value is None or load.share.value < limit:
            yield from _find_broken_latency(architecture.links[name], load)
            continue
        topic = max(load.topic_traffic, key=lambda part: part[1].value or 0)[0]
        yield Diagnostic(
            "saturated-link",
            f"`{name}` is to carry {format_number(100 * load.share.value)} % of its bandwidth, most of it `{topic}`"
            + ("" if limit == 1 else f"; its limit is {format_percentage(limit)}"),
            architecture.links[name].at,
            help="send less often or less at once (compressed, for instance), or run writer and reader on one host",
            element=name,
        )


def _find_broken_latency(link: Link, load: LinkLoad) -> Iterator[Diagnostic]:
    if load.longest_sending is None or link.worst is None or load.longest_sending[0] <= link.worst.value:
        return
    duration, topic = load.longest_sending
    shown_duration, written = format_duration(duration), format_duration(link.worst.value)
    yield Diagnostic(
        "saturated-link",
        f"`{link.id}` takes {shown_duration} for a message of `{topic}` by its bandwidth, longer than its latency of {written}",
        link.at,
        help="write the latency that the largest message has, with what waits before it, or send less at once",
        element=link.id,
    )


RULES = (
    (
        overloaded_host,
        Severity.WARNING,
        (RuleOption("limit", 100, 1, 100, "The share of its cores, or threads, from which on a host counts."),),
    ),
    (
        saturated_link,
        Severity.WARNING,
        (RuleOption("limit", 100, 1, 100, "The share of its bandwidth from which on a link counts."),),
    ),
)
