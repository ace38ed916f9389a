"""One step of a start-up as plain data for templates: what runs, what it waits for, and how one sees that it is up."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from archgen.plugin.findings import Span
from archgen.plugin.generating import write_place
from archgen.plugin.model import Architecture
from archgen.plugin.starting import DEFAULT_SECONDS, KIND_WORDS, StartStep, describe_ready, format_seconds, name_waits
from archgen.plugins.start_scripts.start_hints import read_hint

UNPLACED = "no-host"
"""What the computer of steps without a host is called: no id has a hyphen."""
_SEEN_FROM_AFAR = frozenset({"port", "topic", "service"})


def record_step(
    step: StartStep, number: int, names: Mapping[str, str], architecture: Architecture, ros: int
) -> dict[str, Any]:
    """Return a step as plain data. `names` are those of all steps, by id; times are in seconds, as texts."""
    host = architecture.hosts.get(step.host or "")
    way = _find_way(step, ros)
    lifecycle = _record_lifecycle(step)
    signs = [
        {"kind": each.kind, "target": each.target, "is_seen_from_afar": each.kind in _SEEN_FROM_AFAR}
        for each in step.signals
        if each.kind != "end"
    ]
    is_brought = way == "loaded" or lifecycle is not None
    return {
        "number": number,
        "id": step.id,
        "name": step.file_name,
        "title": step.title or step.id,
        "kind": KIND_WORDS[step.kind],
        "phase": step.phase,
        "host": step.host or UNPLACED,
        "address": (read_hint(host.annotations, "address") if host else "") or step.host or "localhost",
        "runs": way,
        "is_watched": bool(signs) or lifecycle is not None,
        "command": list(step.command),
        "preparations": [list(words) for words in step.preparations],
        "values": _record_values(step, ros),
        "awaited": [
            {"name": names[each.awaited], "until": each.until, "reasons": list(each.reasons)}
            for each in name_waits(step)
        ],
        "signs": signs,
        "within": step.seconds_at_most or (str(DEFAULT_SECONDS) if is_brought else None),
        "lifecycle": lifecycle,
        "container": step.ros.container if step.ros and way == "loaded" else None,
        "respawn": (format_seconds(step.respawn_delay) if step.respawn_delay else "0") if step.respawn else None,
        "environment": [{"name": name, "value": value} for name, value in step.environment.items()],
        "directory": step.directory,
        "user": step.user,
        "needs_rights": list(step.needs_rights),
        "image": _find_image(step, architecture),
        "up_when": describe_ready(step),
        "place": write_place(_find_place(step, architecture)),
    }


def _find_way(step: StartStep, ros: int) -> str:
    """Return how a step runs: until it is stopped, to its end, as a command that loads it, or nobody knows how."""
    if not step.command:
        return "nobody"
    if step.once:
        return "once"
    # In ROS 1 the command that loads a nodelet stays, and takes it away again at its end.
    return "loaded" if step.kind == "composable" and step.container is not None and ros != 1 else "program"


def _record_lifecycle(step: StartStep) -> dict[str, Any] | None:
    if not step.transitions or step.ros is None:
        return None
    return {
        "node": step.ros.full_name,
        "state": step.state,
        "transitions": [words[-1] for words in step.transitions],
    }


def _record_values(step: StartStep, ros: int) -> list[dict[str, Any]]:
    """Return the parameters whose values are the output of commands: ROS 1 has them on a server, by their complete names."""
    if step.ros is None:
        return []
    return [
        {"name": f"{step.ros.full_name}/{name.replace('.', '/')}" if ros == 1 else name, "words": list(words)}
        for name, words in step.ros.value_commands.items()
    ]


def _find_place(step: StartStep, architecture: Architecture) -> Span:
    if step.kind == "container":
        return architecture.containers[step.container or ""].at
    return architecture.nodes[step.id].at


def _find_image(step: StartStep, architecture: Architecture) -> str:
    """Return the image that holds a step's program: its own, else that of its host; empty where none is written."""
    if step.kind == "container":
        element = architecture.containers[step.container or ""].annotations
    else:
        element = architecture.nodes[step.id].annotations
    host = architecture.hosts.get(step.host or "")
    return read_hint(element, "image") or (read_hint(host.annotations, "image") if host else "")
