"""What would be if some figures of timing were others: the questions of a page, answered as `archgen timing --set` does."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping, Sequence
from fractions import Fraction
from typing import Any

from archgen.diagnostics import make_visible
from archgen.emit.data import timing_json
from archgen.emit.site.html_text import shorten_figures
from archgen.link.process_overrides import OverrideError
from archgen.link.timing_overrides import apply_overrides
from archgen.model.declared_timing import Timing
from archgen.serve.project_state import ProjectState
from archgen.timing.analysis import ChainResult
from archgen.timing.figures.timing_values import TimingValue
from archgen.timing.run_analysis import analyse_architecture
from archgen.timing.system.timing_system import Activity
from archgen.views.lookup import Lookup
from archgen.views.timing import chain_status, value_format
from archgen.views.timing.timing_lookup import TimingLookup, bound_chains

_MAX_OVERRIDES = 200
_MAX_LENGTH = 500
JsonObject = dict[str, Any]


class QuestionError(ValueError):
    """What was sent is no question; the message says why."""


def read_question(data: bytes) -> tuple[str, ...]:
    """Read what is to be set, from `{"set": ["ELEMENT.timing.KEY=VALUE", ...]}`. Raise `QuestionError`."""
    try:
        question = json.loads(data)
    except (ValueError, RecursionError):
        question = None
    overrides = question.get("set") if isinstance(question, dict) else None
    if not isinstance(overrides, list) or not all(isinstance(text, str) for text in overrides):
        raise QuestionError('ask with {"set": ["ELEMENT.timing.KEY=VALUE"]}')
    if len(overrides) > _MAX_OVERRIDES or any(len(text) > _MAX_LENGTH for text in overrides):
        msg = f"at most {_MAX_OVERRIDES} figures can be set at once, each in at most {_MAX_LENGTH} letters"
        raise QuestionError(msg)
    return tuple(overrides)


def answer_question(state: ProjectState, overrides: Sequence[str]) -> JsonObject:
    """Return the timing as it is and as it would be: the document of `archgen timing --set --format json`, and `rows`,
    which say what differs in words. For what cannot be set, `error` says why.
    """
    present = state.lookup.timing
    if present is None:
        return {"error": "the project has no timing"}
    try:
        architecture = apply_overrides(state.checked_project.architecture, overrides)
    except OverrideError as error:
        return {"error": make_visible(str(error))}
    changed = bound_chains(analyse_architecture(architecture), architecture)
    return {
        "version": timing_json.VERSION,
        "set": list(overrides),
        "present": _to_json(present),
        "changed": _to_json(changed),
        "rows": [*_compare_chains(state.lookup, present, changed), *_compare_hosts(state.lookup, present, changed)],
    }


def _to_json(timing_lookup: TimingLookup) -> JsonObject:
    return timing_json.timing_to_json(timing_lookup.analysis, _by_id(timing_lookup))


def _by_id(timing_lookup: TimingLookup) -> dict[str, ChainResult]:
    return {result.id: result for result in timing_lookup.chains}


def _compare_chains(lookup: Lookup, present: TimingLookup, changed: TimingLookup) -> Iterator[JsonObject]:
    """Yield a row for each chain: the worst first, as it is now."""
    changed_chains = _by_id(changed)
    for result in present.chains:
        then = changed_chains[result.id]
        yield {
            "kind": "chain",
            "id": result.id,
            "title": lookup.architecture.chains[result.id].title,
            "now": _describe_chain(result),
            "then": _describe_chain(then),
            "difference": _format_difference(result.bound, then.bound),
            "differs": (result.bound, result.verdict) != (then.bound, then.verdict),
        }


def _describe_chain(result: ChainResult) -> JsonObject:
    return {
        "figure": shorten_figures(value_format.display_duration(result.bound)),
        "status": result.verdict if not chain_status.lacks_deadline(result) else "",
        "margin": shorten_figures(chain_status.describe_margin(result)),
    }


def _compare_hosts(lookup: Lookup, present: TimingLookup, changed: TimingLookup) -> Iterator[JsonObject]:
    """Yield a row for each host whose load differs."""
    for name, load in present.analysis.hosts.items():
        then = changed.analysis.hosts.get(name)
        if then is not None and then != load:
            host = lookup.architecture.hosts.get(name)
            yield {
                "kind": "host",
                "id": name,
                "title": host.title if host else name,
                "now": {
                    "figure": _display_share(load.share_of_cores or load.utilisation),
                    "status": "",
                    "margin": load.verdict,
                },
                "then": {
                    "figure": _display_share(then.share_of_cores or then.utilisation),
                    "status": "",
                    "margin": then.verdict,
                },
                "difference": "",
                "differs": True,
            }


def _display_share(value: TimingValue) -> str:
    return shorten_figures(value_format.display_share(value))


def _format_difference(old_value: TimingValue, new_value: TimingValue) -> str:
    """Say by how much a bound grows or shrinks; nothing where either is not known whole."""
    if old_value.value is None or new_value.value is None or not (old_value.complete and new_value.complete):
        return ""
    difference: Fraction = new_value.value - old_value.value
    if not difference:
        return ""
    sign = "+" if difference > 0 else "\N{MINUS SIGN}"
    return f"{sign}{chain_status.round_duration(abs(difference))}"


def list_figures(state: ProjectState, chain_id: str) -> list[JsonObject]:
    """Return the figures of a chain that a page offers to try out, step by step: what `--set` calls them, and their
    values as they are written.
    """
    timing_lookup = state.lookup.timing
    result = _by_id(timing_lookup).get(chain_id) if timing_lookup else None
    if timing_lookup is None or result is None:
        return []
    names = dict.fromkeys((*(term.activity for term in result.terms), *result.through))
    return _list_named_figures(state, timing_lookup, names)


def list_host_figures(state: ProjectState, host_id: str) -> list[JsonObject]:
    """Return the figures of what runs on a host, as `list_figures` does; the largest load first."""
    timing_lookup = state.lookup.timing
    load = timing_lookup.analysis.hosts.get(host_id) if timing_lookup else None
    if timing_lookup is None or load is None:
        return []
    shares = sorted(load.activity_shares, key=lambda share: -(share[1].value or 0))
    return _list_named_figures(state, timing_lookup, [name for name, _ in shares])


def _list_named_figures(state: ProjectState, timing_lookup: TimingLookup, names: Iterable[str]) -> list[JsonObject]:
    return [
        figure
        for name in names
        if (activity := timing_lookup.analysis.system.activities.get(name)) is not None
        for figure in _list_activity_figures(state, activity)
    ]


def _list_activity_figures(state: ProjectState, activity: Activity) -> Iterator[JsonObject]:
    architecture = state.checked_project.architecture
    node = architecture.nodes.get(activity.node)
    if node is None:
        return
    timing = node.timing.get(activity.component or "", Timing(at=node.at))
    element = f"{node.id}.{activity.component}" if len(node.implements) > 1 and activity.component else node.id
    named = {"element": activity.id, "node": node.id}
    yield {**named, "set": f"{element}.timing.wcet", "label": "Execution time", "value": _write_value(timing.wcet)}
    if timing.rate is not None or timing.period is not None:
        key = "rate" if timing.rate is not None else "period"
        label = "Rate" if key == "rate" else "Period"
        yield {**named, "set": f"{element}.timing.{key}", "label": label, "value": _write_value(getattr(timing, key))}
    yield {**named, "set": f"{element}.timing.priority", "label": "Priority", "value": _write_value(timing.priority)}
    if node.container is None and len(architecture.hosts) > 1:
        hosts: Mapping[str, str] = {host.id: host.title for host in architecture.hosts.values()}
        yield {**named, "set": f"{node.id}.host", "label": "Host", "value": node.host or "", "options": hosts}


def _write_value(value: object) -> str:
    return "" if value is None else str(value)
