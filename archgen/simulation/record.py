"""Simulation results and their assumptions as plain data for `--format json` (schemas/simulation.schema.json)."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction

from archgen.simulation import taken
from archgen.simulation.compared import ages, known, utilisation
from archgen.simulation.result import ChainSeen, Distribution, Figures, Result
from archgen.timing.analysis import Analysis, ChainResult
from archgen.timing.value import Value

_MS = 10**6
Plain = dict[str, object]


def plain(result: Result, analysis: Analysis, chains: Mapping[str, ChainResult]) -> Plain:
    """Return everything as JSON data: durations in ms, rates in Hz, shares without unit."""
    oldest = ages(analysis, chains)
    return {
        "version": 1,
        "seconds": result.seconds,
        "seeds": result.seeds,
        "events": result.events,
        "note": "Seen, not bounded: each largest figure is a lower bound on the worst case.",
        "chains": {key: _chain(seen, chains[key], oldest[key], analysis) for key, seen in result.chains.items()},
        "elements": {key: _activity(result, analysis, key) for key in result.activities},
        "hosts": {
            key: {
                "load": float(seen.mean),
                "largest_load": float(seen.largest),
                "utilisation": _share(utilisation(analysis, key)),
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
            {
                "element": element,
                "input": port,
                "topic": topic,
                "fires": port in analysis.system.activities[element].triggers,
                "count": count,
            }
            for (element, port, topic), count in result.drops.items()
        ],
        "unknown": list(result.unknown),
        "assumptions": _assumptions(result, analysis),
    }


def _assumptions(result: Result, analysis: Analysis) -> Plain:
    return {
        "random": list(taken.drawn(analysis.system)),
        "defaults": [
            {"figure": one.figure, "taken": one.taken, "of": list(one.of)} for one in taken.defaults(analysis.system)
        ],
        "contradictions": list(taken.contradictions(result, analysis)),
        "not_simulated": list(taken.NOT_SIMULATED),
    }


def _chain(seen: ChainSeen, found: ChainResult, oldest: Value, analysis: Analysis) -> Plain:
    return {
        "through": list(seen.through),
        "inputs": seen.every.inputs,
        **_figures(seen.every),
        "reduced_reaction": {"largest": _ms(seen.every.reduced_reaction), "bound": _bound(found.reduced_reaction)},
        "reduced_age": {"largest": _ms(seen.every.reduced_age), "bound": _bound(found.reduced_age)},
        "bound": _bound(found.bound),
        "age_bound": _bound(oldest),
        "assumptions": list(dict.fromkeys((*found.bound.assumptions, *oldest.assumptions))),
        "conditional": _conditional(seen, analysis),
        "deadline": _bound(found.deadline) if found.deadline else None,
    }


def _conditional(seen: ChainSeen, analysis: Analysis) -> Plain | None:
    if seen.passing is None:
        return None
    return {
        "because": list(taken.choosy(analysis.system, seen.through)),
        "inputs": seen.passing.inputs,
        **_figures(seen.passing),
        "reduced_reaction": _ms(seen.passing.reduced_reaction),
        "reduced_age": _ms(seen.passing.reduced_age),
    }


def _figures(seen: Figures) -> Plain:
    return {"reaction": _spread(seen.reaction), "age": _spread(seen.age)}


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


def _bound(value: Value) -> float | None:
    return _ms(known(value))


def _share(value: Fraction | None) -> float | None:
    return None if value is None else float(value)


def _ms(value: Fraction | None) -> float | None:
    # Rounded to a picosecond, so that the noise of binary fractions does not show.
    """Convert ns to ms."""
    return None if value is None else round(float(value / _MS), 9)
