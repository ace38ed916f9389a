"""What was seen beside the bounds of the analysis: as plain data for `--format json`, and as text."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction

from archgen.simulation.result import ChainSeen, Distribution, Result
from archgen.timing.analysis import Analysis, ChainResult
from archgen.timing.chains import data_age
from archgen.timing.network import Network
from archgen.timing.value import Value

_MS = 10**6
Plain = dict[str, object]


def pauses(analysis: Analysis) -> dict[tuple[str, str], Fraction]:
    """Give the largest time between two chances to publish each conditional output, in ns, where it is known."""
    found = {}
    for activity in analysis.system.activities.values():
        gap = _known(analysis.paces[activity.id].gap) if activity.id in analysis.paces else None
        response = analysis.responses.get(activity.id)
        worst = _known(response.worst) if response else None
        if gap is None or worst is None or response is None:
            continue
        for output in activity.conditional:
            found[activity.id, output] = gap + worst - (response.best.value or 0)
    return found


def ages(analysis: Analysis, chains: Mapping[str, ChainResult]) -> dict[str, Value]:
    """Bound the data age of each chain: where an event is the stimulus, it is larger than the reaction time."""
    network = Network.of(analysis)
    return {key: data_age(network, found) for key, found in chains.items()}


def plain(result: Result, analysis: Analysis, chains: Mapping[str, ChainResult]) -> Plain:
    """Give everything as JSON data: durations in ms, rates in Hz, shares without unit (schemas/simulation.schema.json)."""
    oldest = ages(analysis, chains)
    return {
        "version": 1,
        "seconds": result.seconds,
        "seeds": result.seeds,
        "events": result.events,
        "note": "Seen, not bounded: each largest figure is a lower bound on the worst case.",
        "chains": {
            key: {**_chain(seen, chains[key]), "age_bound": _bound(oldest[key])} for key, seen in result.chains.items()
        },
        "elements": {key: _activity(result, analysis, key) for key in result.activities},
        "hosts": {
            key: {
                "load": float(seen.mean),
                "largest_load": float(seen.largest),
                "utilisation": _number(analysis.hosts[key].utilisation) if key in analysis.hosts else None,
            }
            for key, seen in result.hosts.items()
        },
        "links": {
            key: {
                "wait": _ms(seen.wait),
                "bound": _bound(analysis.links[key].queueing) if key in analysis.links else None,
                "load": float(seen.share),
            }
            for key, seen in result.links.items()
        },
        "drops": [
            {"element": element, "input": port, "topic": topic, "count": count}
            for (element, port, topic), count in result.drops.items()
        ],
        "unknown": list(result.unknown),
    }


def _chain(seen: ChainSeen, found: ChainResult) -> Plain:
    return {
        "through": list(seen.through),
        "reaction": _spread(seen.reaction),
        "age": _spread(seen.age),
        "bound": _bound(found.bound),
        "reduced_reaction": {
            "largest": _ms(seen.reduced_reaction),
            "bound": _bound(found.reduced_reaction),
        },
        "reduced_age": {"largest": _ms(seen.reduced_age), "bound": _bound(found.reduced_age) if found else None},
        "deadline": _bound(found.deadline) if found.deadline else None,
    }


def _activity(result: Result, analysis: Analysis, key: str) -> Plain:
    seen, response, pace = result.activities[key], analysis.responses.get(key), analysis.paces.get(key)
    return {
        "jobs": seen.jobs,
        "rate": float(seen.rate),
        "least_response": _ms(seen.best),
        "largest_response": _ms(seen.worst),
        "response_bound": _bound(response.worst) if response else None,
        "largest_gap": _ms(seen.activation_gap),
        "gap_bound": _bound(pace.gap) if pace else None,
    }


def _spread(seen: Distribution | None) -> Plain | None:
    if seen is None:
        return None
    figures = {"min": seen.least, "median": seen.median, "p95": seen.most_of_it, "max": seen.largest}
    return {key: _ms(value) for key, value in figures.items()}


def _known(value: Value) -> Fraction | None:
    """Give a figure that is a bound from above; a sum with gaps is none."""
    return value.value if value.complete and value.side != "at least" else None


def _bound(value: Value) -> float | None:
    return _ms(_known(value))


def _number(value: Value) -> float | None:
    known = _known(value)
    return None if known is None else float(known)


def _ms(value: Fraction | None) -> float | None:
    return None if value is None else round(float(value / _MS), 9)


def text(title: str, result: Result, analysis: Analysis, chains: Mapping[str, ChainResult]) -> str:
    """Give everything for people: each seen figure beside its bound."""
    lines = [
        title,
        "",
        f"Seen in {result.seconds} s from each of {result.seeds} seeds ({result.events} events).",
        "The largest figures seen are lower bounds on the worst case; what stands beside them are bounds from above.",
    ]
    lines += _chains_text(result, chains, ages(analysis, chains))
    lines += _activities_text(result, analysis)
    lines += _hosts_text(result, analysis)
    if result.drops:
        lines += ["", f"  {'Samples pushed out of a queue unread':62}{'count':>10}"]
        lines += [f"  {f'{element} <- {topic}':62}{count:>10}" for (element, _, topic), count in result.drops.items()]
    if result.unknown:
        lines += ["", "Not known, and taken as nothing: " + ", ".join(result.unknown) + "."]
    return "\n".join(lines) + "\n"


def _row(name: str, *cells: str) -> str:
    return f"  {name[:36]:36}" + "".join(f"{cell:>12}" for cell in cells)


def _chains_text(result: Result, chains: Mapping[str, ChainResult], oldest: Mapping[str, Value]) -> list[str]:
    if not result.chains:
        return []
    lines = ["", _row("Chains (ms)", "least", "median", "95 %", "largest", "bound", "deadline")]
    assumed: dict[str, None] = {}
    for key, seen in result.chains.items():
        deadline = chains[key].deadline
        parts = (("reaction", seen.comparable.reaction, chains[key].bound), ("age", seen.comparable.age, oldest[key]))
        for what, spread, bound in parts:
            figures = (spread.least, spread.median, spread.most_of_it, spread.largest) if spread else (None,) * 4
            mark = "*" if bound.assumptions and _known(bound) is not None else ""
            assumed |= dict.fromkeys(bound.assumptions if mark else ())
            ends = (_cell(bound) + mark, _cell(deadline) if deadline else "-")
            lines.append(_row(f"{key} {what}", *map(_figure, figures), *ends))
    return [
        *lines,
        *(["", "  * holds only as far as this does:"] if assumed else []),
        *(f"    {said}" for said in assumed),
    ]


def _activities_text(result: Result, analysis: Analysis) -> list[str]:
    lines = ["", _row("Elements (ms)", "jobs/s", "response", "bound", "largest gap", "bound")]
    for key, seen in result.activities.items():
        response, pace = analysis.responses.get(key), analysis.paces.get(key)
        lines.append(
            _row(
                key,
                f"{float(seen.rate):.3f}",
                _figure(seen.worst),
                _cell(response.worst) if response else "-",
                _figure(seen.activation_gap),
                _cell(pace.gap) if pace else "-",
            )
        )
    return lines


def _hosts_text(result: Result, analysis: Analysis) -> list[str]:
    lines = ["", _row("Load", "mean", "busiest", "bound")] if result.hosts else []
    for key, seen in result.hosts.items():
        bound = _known(analysis.hosts[key].utilisation) if key in analysis.hosts else None
        lines.append(_row(key, *(_share(share) for share in (seen.mean, seen.largest, bound))))
    if result.links:
        lines += ["", _row("Links (ms)", "load", "wait", "bound")]
    for key, link in result.links.items():
        load = analysis.links.get(key)
        lines.append(_row(key, _share(link.share), _figure(link.wait), _cell(load.queueing) if load else "-"))
    return lines


def _figure(value: Fraction | None) -> str:
    return "-" if value is None else f"{float(value / _MS):.3f}"


def _cell(value: Value) -> str:
    known = _known(value)
    return _figure(known) if known is not None else "no bound"


def _share(value: Fraction | None) -> str:
    return "-" if value is None else f"{float(value * 100):.1f} %"
