"""Timing for programs: the JSON format, version 1, as `schemas/timing.schema.json` describes it.

Durations are in milliseconds, rates in Hz, sizes in B, traffic in B/s, shares without unit.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from archgen.timing.analysis import Analysis, ChainResult, ChainTerm, ResourceLoad
from archgen.timing.chains.chain_bounds import BoundedPath
from archgen.timing.chains.fused_inputs import FusedInputs, find_fused_inputs
from archgen.timing.figures.timing_values import TimingValue, is_known_bound
from archgen.timing.search.proposals import Proposal
from archgen.timing.system.timing_system import Arc

VERSION = 1
_MS = 10**6
JsonObject = dict[str, Any]


def timing_to_json(
    analysis: Analysis, chains: Mapping[str, ChainResult], proposal: Proposal | None = None
) -> JsonObject:
    """Return everything as plain data."""
    return {
        "version": VERSION,
        "elements": {name: _element_to_json(analysis, name) for name in analysis.system.activities},
        "edges": [
            {
                **arc_ends(edge.arc),
                "loss": quantity_to_json(edge.loss),
                "rereads": quantity_to_json(edge.rereads),
                "beat": duration_to_json(edge.beat),
                "queue": quantity_to_json(edge.queue),
            }
            for edge in analysis.edges
        ],
        "chains": {name: chain_to_json(result, proposal) for name, result in chains.items()},
        "hosts": {
            name: {
                "utilisation": quantity_to_json(load.utilisation),
                "rate_monotonic_bound": quantity_to_json(load.rate_monotonic_bound),
                "earliest_deadline_bound": quantity_to_json(load.earliest_deadline_bound),
                "cores": load.cores,
                "verdict": load.verdict,
            }
            for name, load in analysis.hosts.items()
        },
        "links": {
            name: {
                "bytes_per_second": quantity_to_json(load.traffic),
                "share": quantity_to_json(load.share),
                "burst": quantity_to_json(load.burst),
                "queueing": duration_to_json(load.queueing),
            }
            for name, load in analysis.links.items()
        },
        "topics": {
            name: {
                "bytes_per_second": quantity_to_json(load.published),
                "delivered_bytes_per_second": quantity_to_json(load.delivered),
                "size": quantity_to_json(load.size),
            }
            for name, load in analysis.topics.items()
        },
        "services": {
            name: {
                "callers": list(load.callers),
                "answer": duration_to_json(load.worst),
                "waits": {caller: duration_to_json(wait) for caller, wait in load.waits.items()},
                "synchronous_response": {
                    caller: duration_to_json(response) for caller, response in load.synchronous_responses.items()
                },
            }
            for name, load in analysis.services.items()
        },
        "resources": {name: _resource_to_json(load) for name, load in analysis.resources.items()},
        "fused": {fused.activity: _fused_to_json(fused) for fused in find_fused_inputs(analysis)},
    }


def _resource_to_json(load: ResourceLoad) -> JsonObject:
    return {
        "host": load.host,
        "scheduling": load.order,
        "utilisation": quantity_to_json(load.utilisation),
        "verdict": load.verdict,
        "users": {
            name: {"share": quantity_to_json(share), "longest_use": duration_to_json(load.waits[name])}
            for name, share in load.shares
        },
    }


def _fused_to_json(fused: FusedInputs) -> JsonObject:
    return {
        "within": None if fused.within is None else float(fused.within / _MS),
        "apart": duration_to_json(fused.apart),
        "gap": duration_to_json(fused.gap),
        "ages": {_port_name(key): duration_to_json(age) for key, age in fused.ages.items()},
    }


def _element_to_json(analysis: Analysis, name: str) -> JsonObject:
    rates, response, activity = analysis.paces[name], analysis.responses[name], analysis.system.activities[name]
    return {
        "behaviour": rates.behaviour,
        "inferred": rates.inferred,
        "rate": quantity_to_json(rates.rate),
        "gap": duration_to_json(rates.gap),
        "response": duration_to_json(response.worst),
        "best_response": duration_to_json(response.best),
        "response_tier": response.tier,
        "percentiles": {key: float(ticks * analysis.system.tick / _MS) for key, ticks in activity.percentiles.items()},
        "measured": activity.wcet_measured,
    }


def chain_to_json(result: ChainResult, proposal: Proposal | None = None) -> JsonObject:
    """Return a chain's figures, and what was found beyond them."""
    return {
        "through": list(result.through),
        "bound": duration_to_json(result.bound),
        "best": duration_to_json(result.best),
        "reduced_reaction": duration_to_json(result.reduced_reaction),
        "reduced_age": duration_to_json(result.reduced_age),
        "terms": [term_to_json(chain_term) for chain_term in result.terms],
        "deadline": duration_to_json(result.deadline)["value"] if result.deadline else None,
        "deadline_shares": [
            {"share": each.name, "limit": float(each.limit / _MS), "verdict": each.verdict} for each in result.shares
        ],
        "slack": None if result.slack is None else float(result.slack / _MS),
        "verdict": result.verdict,
        **_evidence_to_json(result, proposal),
    }


def _evidence_to_json(result: ChainResult, proposal: Proposal | None) -> JsonObject:
    """Return the run in which a chain is late, and what would prove it; nothing where there is neither."""
    document: JsonObject = {}
    chain_id, run = result.id, result.late_run
    if run:
        document["witness"] = {
            "seed": run.seed,
            "seconds": run.seconds,
            "longest": float(run.longest / _MS),
            "orders": [order._asdict() for order in run.orders],
        }
    if proposal and chain_id in proposal.tried[0].late:
        best = proposal.best
        tried: dict[str, dict[str, None]] = {}
        for change in dict.fromkeys(change for each in proposal.tried for change in each.changes):
            tried.setdefault(change.kind, {})[change.element] = None
        is_met = chain_id not in best.late
        document["remedy"] = {
            "set": list(map(str, best.changes)) if is_met else [],
            "bound": duration_to_json(TimingValue(best.bounds[chain_id])) if is_met else None,
            "tried": {kind: list(names) for kind, names in tried.items()},
            "cut": proposal.is_cut,
        }
        if chain_id in proposal.hopeless:
            document["floor"] = float(proposal.hopeless[chain_id] / _MS)
    return document


def ways_to_json(
    source: str, target: str, count: int, worst: Iterable[BoundedPath], best: Iterable[BoundedPath]
) -> JsonObject:
    """Return the ways between two elements: their number, the worst ones, and the quickest best cases."""
    return {
        "version": VERSION,
        "from": source,
        "to": target,
        "count": count,
        "worst": [_way_to_json(way) for way in worst],
        "best": [_way_to_json(way) for way in best],
    }


def _way_to_json(way: BoundedPath) -> JsonObject:
    return {
        "through": list(way.through),
        "bound": duration_to_json(way.bound),
        "terms": [term_to_json(chain_term) for chain_term in way.terms],
    }


def term_to_json(chain_term: ChainTerm) -> JsonObject:
    """Return one term of a sum."""
    return {
        "element": chain_term.activity,
        "sampling": duration_to_json(chain_term.sampling),
        "response": duration_to_json(chain_term.response),
        "link": duration_to_json(chain_term.link),
        "why": chain_term.why,
        "at": str(chain_term.at) if chain_term.at.file else None,
    }


def arc_ends(arc: Arc) -> dict[str, str]:
    """Return both ends of an arc: the activity and the port's own name (a topic's full name where it is internal)."""
    return {"from": f"{arc.source}.{_port_name(arc.output)}", "to": f"{arc.target}.{_port_name(arc.input)}"}


def _port_name(key: str) -> str:
    return key if key.startswith("/") else key.rpartition(".")[2]


def quantity_to_json(value: TimingValue) -> JsonObject:
    """Return a value as it is; an incomplete one says on which side of it the true value lies."""
    bound = (
        {} if value.complete or value.value is None else {"side": "at most" if is_known_bound(value) else "at least"}
    )
    return {
        "value": None if value.value is None else float(value.value),
        "complete": value.complete,
        **bound,
        "missing": list(value.missing),
        "assumptions": list(value.assumptions),
    }


def duration_to_json(value: TimingValue) -> JsonObject:
    """Return a duration, converted from ns to milliseconds."""
    return {**quantity_to_json(value), "value": None if value.value is None else float(value.value / _MS)}
