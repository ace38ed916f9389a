"""Simulation results and their assumptions as plain data for `--format json` (schemas/simulation.schema.json)."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction

from archgen.simulation import simulation_assumptions
from archgen.simulation.chain_witnesses import bound_data_ages, bound_utilisation, upper_bound
from archgen.simulation.simulation_result import (
    ChainFigures,
    DurationDistribution,
    ObservedChain,
    SimulationResult,
    list_seen_shares,
)
from archgen.timing.analysis import Analysis, ChainResult
from archgen.timing.figures.timing_values import TimingValue

_MS = 10**6
SimulationJson = dict[str, object]


def simulation_to_json(
    result: SimulationResult, analysis: Analysis, chains: Mapping[str, ChainResult]
) -> SimulationJson:
    """Return everything as JSON data: durations in ms, rates in Hz, shares without unit."""
    age_bounds = bound_data_ages(analysis, chains)
    return {
        "version": 1,
        "seconds": result.seconds,
        "seeds": result.seeds,
        "first_seed": result.first_seed,
        "events": result.events,
        "note": "Seen, not bounded: each largest figure is a lower bound on the worst case.",
        "chains": {
            key: _chain_to_json(observed, chains[key], age_bounds[key], analysis)
            for key, observed in result.chains.items()
        },
        "elements": {key: _activity_to_json(result, analysis, key) for key in result.activities},
        "hosts": {
            key: {
                "load": float(observed.mean_load),
                "largest_load": float(observed.largest_load),
                "utilisation": None if (bound := bound_utilisation(analysis, key)) is None else float(bound),
            }
            for key, observed in result.hosts.items()
        },
        "links": {
            key: {
                "wait": _ns_to_ms(observed.wait),
                "bound": _bound_in_ms(analysis.links[key].queueing) if key in analysis.links else None,
                "load": float(observed.share),
            }
            for key, observed in result.links.items()
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
        "unknown": list(result.unknown_figures),
        "assumptions": {
            "random": list(simulation_assumptions.list_random_choices(analysis.system)),
            "defaults": [
                {"figure": default.figure, "taken": default.assumed_value, "of": list(default.element_ids)}
                for default in simulation_assumptions.list_default_figures(analysis.system)
            ],
            "contradictions": list(simulation_assumptions.find_simulated_contradictions(result, analysis)),
            "not_simulated": list(simulation_assumptions.NOT_SIMULATED),
        },
    }


def _chain_to_json(
    observed: ObservedChain, chain_result: ChainResult, age_bound: TimingValue, analysis: Analysis
) -> SimulationJson:
    return {
        "through": list(observed.through),
        "inputs": observed.all_inputs.input_count,
        **_figures_to_json(observed.all_inputs),
        "reduced_reaction": {
            "largest": _ns_to_ms(observed.all_inputs.reduced_reaction),
            "bound": _bound_in_ms(chain_result.reduced_reaction),
        },
        "reduced_age": {
            "largest": _ns_to_ms(observed.all_inputs.reduced_age),
            "bound": _bound_in_ms(chain_result.reduced_age),
        },
        "bound": _bound_in_ms(chain_result.bound),
        "age_bound": _bound_in_ms(age_bound),
        "assumptions": list(dict.fromkeys((*chain_result.bound.assumptions, *age_bound.assumptions))),
        "conditional": _conditional_to_json(observed, analysis),
        "deadline": _bound_in_ms(chain_result.deadline) if chain_result.deadline else None,
        "deadline_shares": [
            {"share": seen.share, "limit": _ns_to_ms(seen.limit), "seen": _ns_to_ms(seen.seen), "verdict": seen.verdict}
            for seen in list_seen_shares(observed, chain_result)
        ],
    }


def _conditional_to_json(observed: ObservedChain, analysis: Analysis) -> SimulationJson | None:
    if observed.forwarded_inputs is None:
        return None
    return {
        "because": list(simulation_assumptions.list_selective_elements(analysis.system, observed.through)),
        "inputs": observed.forwarded_inputs.input_count,
        **_figures_to_json(observed.forwarded_inputs),
        "reduced_reaction": _ns_to_ms(observed.forwarded_inputs.reduced_reaction),
        "reduced_age": _ns_to_ms(observed.forwarded_inputs.reduced_age),
    }


def _figures_to_json(figures: ChainFigures) -> SimulationJson:
    return {"reaction": _distribution_to_json(figures.reaction), "age": _distribution_to_json(figures.age)}


def _activity_to_json(result: SimulationResult, analysis: Analysis, activity_id: str) -> SimulationJson:
    observed = result.activities[activity_id]
    response, rates = analysis.responses.get(activity_id), analysis.paces.get(activity_id)
    return {
        "jobs": observed.jobs,
        "rate": float(observed.rate),
        "least_response": _ns_to_ms(observed.best_response),
        "largest_response": _ns_to_ms(observed.worst_response),
        "response_bound": _bound_in_ms(response.worst) if response else None,
        "largest_gap": _ns_to_ms(observed.activation_gap),
        "gap_bound": _bound_in_ms(rates.gap) if rates else None,
        "read_ages": {key: _ns_to_ms(age) for key, age in observed.read_ages.items()},
        "fused": {
            "largest_age": _ns_to_ms(observed.fused_age),
            "largest_spread": _ns_to_ms(observed.fused_spread),
        }
        if observed.fused_age is not None
        else None,
    }


def _distribution_to_json(distribution: DurationDistribution | None) -> SimulationJson | None:
    if distribution is None:
        return None
    figures = {
        "min": distribution.least,
        "median": distribution.median,
        "p95": distribution.percentile_95,
        "max": distribution.largest,
    }
    return {key: _ns_to_ms(value) for key, value in figures.items()}


def _bound_in_ms(value: TimingValue) -> float | None:
    return _ns_to_ms(upper_bound(value))


def _ns_to_ms(value: Fraction | None) -> float | None:
    # Rounded to a picosecond, so that the noise of binary fractions does not show.
    return None if value is None else round(float(value / _MS), 9)
