"""Timing for programs: the JSON format, version 1, as `schemas/timing.schema.json` describes it.

Durations are in milliseconds, rates in Hz, sizes in B, traffic in B/s, shares without unit.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from archgen.timing.analysis import Analysis, ChainResult, Term
from archgen.timing.chains import Found
from archgen.timing.sums import known
from archgen.timing.system import Arc
from archgen.timing.value import Value

VERSION = 1
_MS = 10**6
Plain = dict[str, Any]


def document(analysis: Analysis, chains: Mapping[str, ChainResult]) -> Plain:
    """Return everything as plain data."""
    return {
        "version": VERSION,
        "elements": {name: _element(analysis, name) for name in analysis.system.activities},
        "edges": [
            {
                **ends(edge.arc),
                "loss": quantity(edge.loss),
                "rereads": quantity(edge.rereads),
                "beat": time(edge.beat),
                "queue": quantity(edge.queue),
            }
            for edge in analysis.edges
        ],
        "chains": {name: chain(result) for name, result in chains.items()},
        "hosts": {
            name: {
                "utilisation": quantity(load.utilisation),
                "rate_monotonic_bound": quantity(load.rate_monotonic_bound),
                "earliest_deadline_bound": quantity(load.earliest_deadline_bound),
                "cores": load.cores,
                "verdict": load.verdict,
            }
            for name, load in analysis.hosts.items()
        },
        "links": {
            name: {
                "bytes_per_second": quantity(load.traffic),
                "share": quantity(load.share),
                "burst": quantity(load.burst),
                "queueing": time(load.queueing),
            }
            for name, load in analysis.links.items()
        },
        "topics": {
            name: {
                "bytes_per_second": quantity(load.published),
                "delivered_bytes_per_second": quantity(load.delivered),
                "size": quantity(load.size),
            }
            for name, load in analysis.topics.items()
        },
        "services": {
            name: {
                "callers": list(load.callers),
                "answer": time(load.worst),
                "waits": {caller: time(wait) for caller, wait in load.waits.items()},
                "synchronous_response": {caller: time(whole) for caller, whole in load.synchronous.items()},
            }
            for name, load in analysis.services.items()
        },
    }


def _element(analysis: Analysis, name: str) -> Plain:
    pace, response = analysis.paces[name], analysis.responses[name]
    return {
        "behaviour": pace.behaviour,
        "inferred": pace.inferred,
        "rate": quantity(pace.rate),
        "gap": time(pace.gap),
        "response": time(response.worst),
        "best_response": time(response.best),
        "response_tier": response.tier,
    }


def chain(result: ChainResult) -> Plain:
    """Return a chain's figures."""
    return {
        "through": list(result.through),
        "bound": time(result.bound),
        "best": time(result.best),
        "reduced_reaction": time(result.reduced_reaction),
        "reduced_age": time(result.reduced_age),
        "terms": [term(each) for each in result.terms],
        "deadline": time(result.deadline)["value"] if result.deadline else None,
        "verdict": result.verdict,
    }


def ways(source: str, target: str, count: int, worst: Iterable[Found], best: Iterable[Found]) -> Plain:
    """Return the ways between two elements: their number, the worst ones, and the quickest best cases."""
    return {
        "version": VERSION,
        "from": source,
        "to": target,
        "count": count,
        "worst": [_way(way) for way in worst],
        "best": [_way(way) for way in best],
    }


def _way(way: Found) -> Plain:
    return {"through": list(way.through), "bound": time(way.bound), "terms": [term(each) for each in way.terms]}


def term(each: Term) -> Plain:
    """Return one term of a sum."""
    return {
        "element": each.activity,
        "sampling": time(each.sampling),
        "response": time(each.response),
        "link": time(each.link),
        "why": each.why,
        "at": str(each.at) if each.at.file else None,
    }


def ends(arc: Arc) -> dict[str, str]:
    """Return both ends of an arc: the activity and the port's own name (a topic's full name where it is internal)."""
    return {"from": f"{arc.source}.{_own(arc.output)}", "to": f"{arc.target}.{_own(arc.input)}"}


def _own(key: str) -> str:
    return key if key.startswith("/") else key.rpartition(".")[2]


def quantity(value: Value) -> Plain:
    """Return a value as it is; an incomplete one says on which side of it the true value lies."""
    bound = {} if value.complete or value.value is None else {"side": "at most" if known(value) else "at least"}
    return {
        "value": None if value.value is None else float(value.value),
        "complete": value.complete,
        **bound,
        "missing": list(value.missing),
        "assumptions": list(value.assumptions),
    }


def time(value: Value) -> Plain:
    """Return a duration, converted from ns to milliseconds."""
    return {**quantity(value), "value": None if value.value is None else float(value.value / _MS)}
