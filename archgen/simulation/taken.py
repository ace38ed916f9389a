"""What a simulation assumes: what it draws at random, what was filled in for figures nobody wrote, what contradicts
itself.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

from archgen.simulation.result import Result
from archgen.timing.analysis import Analysis
from archgen.timing.selective import selective
from archgen.timing.system import Activity, System
from archgen.timing.wording import duration

NOT_SIMULATED = (
    "caches, migration, context switches and interrupts",
    "the middleware's own threads, and what callbacks of inputs that do not fire take",
    "lost packets",
    "drifting clocks",
    "start-up",
    "callers that block until the answer is there",
    "deadlines and liveliness of quality of service",
    "whatever is outside of the architecture",
)
"""The user's copy of this list is in docs/simulation.md."""


_SOMETIMES = {
    "data": "does not always publish",
    "request": "does not always call",
    "answer": "does not always answer this caller on",
}


@dataclass(frozen=True, slots=True)
class Default:
    """A figure that was not written, the value assumed for it, and the elements it is missing from."""

    figure: str
    taken: str
    of: tuple[str, ...]


def drawn(system: System) -> tuple[str, ...]:
    """Return phrases for what each seed draws at random, as far as this system leaves it open."""
    activities, arcs = system.activities.values(), system.arcs
    containers = [name for name, threads in system.threads.items() if threads == 1]
    found = (
        (any(a.period for a in activities), "the phase of each clock (every fourth run starts all at once)"),
        (any(a.jitter for a in activities), "how late a release with jitter is"),
        (any((a.wcet or 0) > (a.bcet or 0) for a in activities), "execution times from bcet to wcet"),
        (
            any((a.worst or 0) > (a.best or 0) and a.link not in system.queued for a in arcs),
            "latencies of links from best to worst",
        ),
        (any(a.conditional for a in activities), "when a conditional output is published"),
        (any(a.every > 1 for a in activities), "where `every` begins to count"),
        (any(a.host and a.priority is None for a in activities), "who comes first among those without a priority"),
        (bool(containers), "the order in which an executor looks at its callbacks"),
        (any(a.response is not None for a in activities), "when what has a declared response ends, within it"),
    )
    return tuple(text for applies, text in found if applies)


def defaults(system: System) -> tuple[Default, ...]:
    """Return the figures that nobody wrote and the simulation needs."""
    working = [a for a in system.activities.values() if a.behaviour != "once"]
    ranked = {a.host for a in working if a.priority is not None}
    bare = {a.host for a in working if a.host and system.cores.get(a.host) is None}
    found = (
        Default("wcet", "0", tuple(a.id for a in working if a.wcet is None and a.response is None)),
        Default("bcet", "0", tuple(a.id for a in working if a.wcet and a.bcet is None)),
        Default("jitter", "none", tuple(a.id for a in working if a.period and "jitter" not in a.places)),
        Default(
            "priority",
            "after all that have one",
            tuple(a.id for a in working if a.host in ranked and a.priority is None),
        ),
        Default("host", "a core of its own", tuple(a.id for a in working if a.host is None)),
        Default("cores", "1", tuple(sorted(host for host in bare if host))),
        Default("calls", "1 for each activation", tuple(a.id for a in working if _calls_by_default(system, a))),
        Default(
            "latency",
            "the best that is written (0 without one), and on a link with a bandwidth the wait for it",
            tuple(dict.fromkeys(f"{a.source} to {a.target}" for a in system.arcs if a.worst is None)),
        ),
    )
    return tuple(default for default in found if default.of)


def _calls_by_default(system: System, activity: Activity) -> bool:
    """Return whether an activity calls without saying how often."""
    requests = [arc for arc in system.out_of.get(activity.id, ()) if arc.role == "request"]
    return any(arc.output not in activity.calls for arc in requests)


def contradictions(result: Result, analysis: Analysis) -> tuple[str, ...]:
    """Return sentences on what is written but cannot hold: there an observed figure may exceed its bound."""
    return (*_rates(analysis), *_silences(result, analysis))


def _rates(analysis: Analysis) -> Iterator[str]:
    for name, derived in analysis.derived.items():
        stated = analysis.paces[name]
        if derived.gap.value is not None and derived.gap.value != stated.gap.value:
            period = (analysis.system.activities[name].period or 0) * analysis.system.tick
            yield f"{name} states a period of {duration(period)}, and its inputs fire it at another: here they do"


def _silences(result: Result, analysis: Analysis) -> Iterator[str]:
    for name, seen in result.activities.items():
        promised = analysis.system.activities[name].max_gaps
        for key, silence in seen.silences.items():
            limit = promised[key] * analysis.system.tick if key in promised else None
            if limit is not None and silence > limit:
                yield (
                    f"{name} promises {key} every {duration(limit)} at least, and had no chance to for {duration(silence)}"
                )


def choosy(system: System, through: tuple[str, ...]) -> tuple[str, ...]:
    """Return phrases for the elements of a chain that may not send each input on, and do not promise when they do."""
    found = (
        f"{source} {_SOMETIMES[arc.role]} {arc.topic}"
        for source, target in pairwise(through)
        for arc in system.out_of.get(source, ())
        if arc.target == target and selective(system, arc)
    )
    return tuple(dict.fromkeys(found))
