"""The jobs of one computer, for those who start what needs nothing more: systemd and compose.

A program is one job, and waiting until it is up is another: who needs no more than its start waits for the first, all others
for the second.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

_HOW_MUCH = ("started", "completed", "healthy")


def list_jobs(host: Mapping[str, Any]) -> list[dict[str, Any]]:
    """Return the jobs of a computer, with its steps and the `ends` of its phases, in the order of the plan.

    `needs` of each are what its step waits for, `depends_on` the same with all of the phase before. `how` a need is met: the
    job has `completed`, what it runs has `started`, or that is `healthy`: its own second job says so.
    """
    steps = {step["name"]: step for step in host["steps"]}
    return [job for step in host["steps"] for job in _list_jobs_of_step(step, steps, host)]


def list_phase_needs(host: Mapping[str, Any]) -> dict[str, list[dict[str, str]]]:
    """Return for each phase of a computer what must be there at its end."""
    needs: dict[str, list[dict[str, str]]] = {phase: [] for phase in host["phases"]}
    for step in host["steps"]:
        needs[step["phase"]] += _list_ends(step)
    return needs


def _list_jobs_of_step(
    step: Mapping[str, Any], steps: Mapping[str, Mapping[str, Any]], host: Mapping[str, Any]
) -> Iterator[dict[str, Any]]:
    phases: Sequence[str] = host["phases"]
    place = phases.index(step["phase"])
    phase_before = phases[place - 1] if place else None
    common = {
        "network": host["network"],
        "dds_profile": host["dds_profile"],
        "host": host["name"],
        "place": step["place"],
        "step": step,
        "phase_before": phase_before,
    }
    needs = [need for each in step["awaited"] for need in _list_needs(steps.get(each["name"]), each["until"])]
    wall = host["ends"][phase_before] if phase_before else []
    if _has_process(step):
        yield {
            **common,
            "name": step["name"],
            "kind": step["runs"],
            "needs": needs,
            "depends_on": _merge_needs(needs + wall),
        }
        if step["is_watched"]:
            own_need = [_make_need(step, _end_of_process(step))]
            is_health = step["runs"] == "program" and not step["lifecycle"]
            yield {
                **common,
                "name": f"{step['name']}-up",
                "kind": "up",
                "needs": own_need,
                "depends_on": own_need,
                "is_health": is_health,
            }
    elif list_seen_signs(step):
        own_needs = needs if step["is_own"] else []
        yield {
            **common,
            "name": f"{step['name']}-up",
            "kind": "up",
            "needs": own_needs,
            "depends_on": _merge_needs(own_needs + wall),
            "is_health": False,
        }


def _merge_needs(needs: Sequence[dict[str, str]]) -> list[dict[str, str]]:
    """Return needs so that each program is named once, with the most that is needed of it."""
    merged: dict[str, dict[str, str]] = {}
    for need in needs:
        service = need["step"] if need["how"] == "healthy" else need["job"]
        if service not in merged or _HOW_MUCH.index(need["how"]) > _HOW_MUCH.index(merged[service]["how"]):
            merged[service] = need
    return list(merged.values())


def _list_needs(awaited: Mapping[str, Any] | None, until: str) -> Iterator[dict[str, str]]:
    if awaited is None:
        return
    if until == "started" and _has_process(awaited):
        yield _make_need(awaited, _end_of_process(awaited))
    elif until != "started":
        yield from _list_ends(awaited)


def _list_ends(step: Mapping[str, Any]) -> Iterator[dict[str, str]]:
    """Yield what shows that a step is up: nothing for one of which nobody here sees that."""
    if not _has_process(step):
        if list_seen_signs(step):
            yield _make_need(step, "completed", up=True)
    elif not step["is_watched"]:
        yield _make_need(step, _end_of_process(step))
    elif step["lifecycle"] or step["runs"] != "program":
        yield _make_need(step, "completed", up=True)
    else:
        yield _make_need(step, "healthy", up=True)


def _make_need(step: Mapping[str, Any], how: str, *, up: bool = False) -> dict[str, str]:
    return {"job": f"{step['name']}-up" if up else step["name"], "step": step["name"], "how": how}


def _has_process(step: Mapping[str, Any]) -> bool:
    return bool(step["is_own"]) and step["runs"] != "nobody"


def _end_of_process(step: Mapping[str, Any]) -> str:
    """Return how one tells that the process of a step did its part: it runs, or has come to its end."""
    return "started" if step["runs"] == "program" else "completed"


def list_seen_signs(step: Mapping[str, Any]) -> list[Mapping[str, Any]]:
    """Return the signs by which this computer sees that a step is up: all of its own, of others those that are open to it."""
    if step["is_own"]:
        return list(step["signs"])
    return [sign for sign in step["signs"] if sign["is_seen_from_afar"] or (step["is_here"] and sign["kind"] == "file")]
