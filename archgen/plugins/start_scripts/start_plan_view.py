"""The view `plan`: the start-up as generators write it, computer by computer; all of it is from the one plan.

One step of a start-up as plain data for templates: what runs, what it waits for, and how one sees that it is up. What
hints tell the start-up: under which address a computer is found, and which image holds a program.

The jobs of one computer, for those who start what needs nothing more: systemd and compose.

A program is one job, and waiting until it is up is another: who needs no more than its start waits for the first, all others
for the second.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from typing import Any

from archgen.plugin.findings import NO_SPAN, Diagnostic, Span, did_you_mean, first_written_span
from archgen.plugin.generating import GeneratedView, GenerationContext, tell_left_out, write_place
from archgen.plugin.model import PHASES, Architecture, ElementAnnotations
from archgen.plugin.ros import shared_topic_names
from archgen.plugin.starting import (
    DEFAULT_SECONDS,
    KIND_WORDS,
    StartPlan,
    StartStep,
    describe_dropped,
    describe_ready,
    find_looking_variables,
    find_wanted_steps,
    format_seconds,
    has_substitution,
    make_start_plan,
    name_waits,
    record_dds_profile,
)

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


def make_view(context: GenerationContext) -> GeneratedView:
    """Make the steps of each computer, in the order of the plan, with what they wait for on other ones."""
    architecture = context.architecture
    plan = make_start_plan(architecture)
    names = {step.id: step.file_name for step in plan.steps}
    records = {
        step.id: record_step(step, number, names, architecture, context.ros_generation)
        for number, step in enumerate(plan.steps, start=1)
    }
    wanted_ids = find_wanted_steps(plan, context)
    wanted_hosts = dict.fromkeys(step.host for step in plan.steps if step.id in wanted_ids)
    steps = {step.id: step for step in plan.steps}
    folder = str(context.options.get("folder") or "") or f"/opt/{architecture.project.id}"
    hosts = [_record_host(architecture, host, plan, records, wanted_ids) for host in wanted_hosts]
    for record in hosts:
        record["file_name"] = f"{record['name']}.{context.part}" if context.part else record["name"]
    return GeneratedView(
        {
            "project": {"id": architecture.project.id, "title": architecture.project.title},
            "ros": context.ros_generation,
            "distro": architecture.distro or "",
            "is_whole": context.is_whole,
            "prefix": f"{architecture.project.id}.{context.part}" if context.part else architecture.project.id,
            "folder": folder.rstrip("/"),
            "image": str(context.options.get("image") or ""),
            "phases": [phase for phase, _ in plan.phases],
            "hosts": hosts,
            # The file of settings is one for all parts.
            "computers": list(dict.fromkeys(step.host or UNPLACED for step in plan.steps)),
            "jobs": [job for host in hosts for job in host["jobs"]],
            "targets": [
                {"host": host["name"], "phase": phase, "phase_before": before, "needs": needs}
                for host in hosts
                for (phase, needs), before in zip(host["ends"].items(), [None, *host["ends"]], strict=False)
            ],
            "steps": [records[step.id] for step in plan.steps if step.id in wanted_ids],
            "given_up": [describe_dropped(each, steps) for each in plan.dropped if each.wait.waiting in wanted_ids],
        },
        tuple(find_unread_hints(architecture)),
    )


def _record_host(
    architecture: Architecture,
    host: str | None,
    plan: StartPlan,
    records: Mapping[str, dict[str, Any]],
    wanted_ids: Collection[str],
) -> dict[str, Any]:
    """Return a computer with its steps, and among them those of others for which they wait."""
    own_steps = [step for step in plan.steps if step.host == host and step.id in wanted_ids]
    own_ids = {step.id for step in own_steps}
    awaited_ids = {each.awaited for step in own_steps for each in step.awaited}
    last_phase = max(PHASES.index(step.phase) for step in own_steps)
    shown_steps = [
        step
        for step in plan.steps
        if step.id in own_ids or step.id in awaited_ids or PHASES.index(step.phase) < last_phase
    ]
    element = architecture.hosts.get(host or "")
    record: dict[str, Any] = {
        "name": host or UNPLACED,
        "place": write_place(element.at) if element else "",
        "title": element.title if element else "Computer of what has no host",
        "address": element.network_name if element else host or "localhost",
        "network": [{"name": name, "value": value} for name, value in find_looking_variables(own_steps).items()],
        "dds_profile": record_dds_profile(architecture, host),
        "phases": list(dict.fromkeys(step.phase for step in shown_steps)),
        "steps": [
            {
                **records[step.id],
                "is_own": step.id in own_ids,
                "is_here": step.host == host,
                "is_by_others": step.id not in wanted_ids,
            }
            for step in shown_steps
        ],
        "others": [
            {
                "name": record["host"],
                "address": "localhost" if record["host"] == (host or UNPLACED) else record["address"],
            }
            for record in {
                records[step.id]["host"]: records[step.id] for step in shown_steps if step.id not in own_ids
            }.values()
        ],
    }
    for step in record["steps"]:
        step["seen_signs"] = list_seen_signs(step)
    record["ends"] = list_phase_needs(record)
    return {**record, "jobs": list_jobs(record)}


UNPLACED = "no-host"
"""What the computer of steps without a host is called: no id has a hyphen."""
_SEEN_FROM_AFAR = frozenset({"port", "topic", "service"})


def record_step(
    step: StartStep, number: int, names: Mapping[str, str], architecture: Architecture, ros: int
) -> dict[str, Any]:
    """Return a step as plain data. `names` are those of all steps, by id; times are in seconds, as texts."""
    host = architecture.hosts.get(step.host or "")
    way, launch = _find_way(step, ros), step.ros
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
        "address": host.network_name if host else step.host or "localhost",
        "runs": way,
        "is_watched": bool(signs) or lifecycle is not None,
        "command": list(step.command),
        "preparations": [list(words) for words in step.preparations],
        "values": _record_values(step, ros),
        "same": sorted(set(launch.remaps.values()) & shared_topic_names(architecture.shared_topics)) if launch else [],
        "fills": launch is not None and any(map(has_substitution, launch.all_values.values())),
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
        "scheduling": {
            "words": list(step.scheduling.words),
            "priority": step.scheduling.priority,
            "cores": list(step.scheduling.cores),
        },
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


_BACKEND = "start"


def read_hint(annotations: ElementAnnotations, key: str) -> str:
    """Return what `hints: {start: {KEY: ...}}` of an element says; empty where it says nothing of that."""
    hints = annotations.hints.get(_BACKEND)
    value = hints.get(key) if isinstance(hints, Mapping) else None
    return value.strip() if isinstance(value, str) else ""


def find_unread_hints(architecture: Architecture) -> Iterator[Diagnostic]:
    """Yield the hints for the start-up that nobody reads: unknown ones, and those that are no text."""
    for host in architecture.hosts.values():
        yield from _judge_hints(host.id, host.annotations, host.at, ("image",))
    for container in architecture.containers.values():
        yield from _judge_hints(container.id, container.annotations, container.at, ("image",))
    for node in architecture.nodes.values():
        yield from _judge_hints(node.id, node.annotations, node.at, ("image",))


def _judge_hints(
    element: str, annotations: ElementAnnotations, at: Span, known_keys: tuple[str, ...]
) -> Iterator[Diagnostic]:
    hints = annotations.hints.get(_BACKEND)
    if hints is None:
        return
    places = annotations.hint_places
    place = first_written_span(places.get((_BACKEND,), NO_SPAN), at)
    known = f"what is known here is {' and '.join(f'`{key}`' for key in known_keys)}, each a text"
    if not isinstance(hints, Mapping):
        yield tell_left_out(
            f"the hints of `{element}` for `start` are no mapping", place, element=element, help_line=known
        )
        return
    for key, value in hints.items():
        key_place = first_written_span(places.get((_BACKEND, key), NO_SPAN), place)
        if key not in known_keys:
            message = f"nobody reads the hint `{key}` of `{element}` for `start`"
            yield tell_left_out(
                message, key_place, element=element, help_line=did_you_mean(str(key), known_keys) or known
            )
        elif not isinstance(value, str) or not value.strip():
            message = f"the hint `{key}` of `{element}` for `start` is no text"
            yield tell_left_out(message, key_place, element=element, help_line=known)
