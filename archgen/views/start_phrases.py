"""The words of a start-up's plan: why a step waits, until when, and what shows that it is up."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

from archgen.bringup.plan_shapes import DroppedWait, StartStep, Wait, WaitEnd, WaitReason
from archgen.diagnostics import join_first, join_words
from archgen.frozen import dataclass
from archgen.model.node import Endpoint, Node, ReadyConditions
from archgen.model.quantity import Quantity
from archgen.views.timing_words import name_cores

KIND_WORDS = {"program": "program", "node": "node", "container": "container", "composable": "loaded node"}
_MAX_PORTS = 2
"""So many outputs are named for which a step waits; the rest is counted."""
_PORT_VERBS: Mapping[WaitReason, str] = {
    "service": "calls",
    "data": "reads",
    "sampled": "samples",
    "optional": "may read",
    "managed": "activates what it reads:",
}


@dataclass(frozen=True, slots=True)
class NamedWait:
    """All for which a step waits for one other: until when (`ready`, `ended`, `started`), and why."""

    awaited: str
    until: WaitEnd
    reasons: tuple[str, ...]
    waits: tuple[Wait, ...]


def name_waits(step: StartStep) -> list[NamedWait]:
    """Return what a step waits for, each other step once, what is needed most first."""
    return [
        NamedWait(
            each.awaited, each.until, tuple(dict.fromkeys(describe_reason(wait) for wait in each.waits)), each.waits
        )
        for each in step.awaited
    ]


def describe_reason(wait: Wait) -> str:
    """Return why a step waits, with its first outputs: `reads a.b.scan and 2 more`."""
    if wait.reason == "container":
        return "is loaded there"
    if wait.reason == "after":
        return "as written"
    if wait.reason == "manages":
        return "manages it"
    outputs = list(dict.fromkeys(output for output, _ in wait.ports))
    return f"{_PORT_VERBS[wait.reason]} {join_first(outputs, _MAX_PORTS)}"


def describe_dropped(dropped: DroppedWait, steps: Mapping[str, StartStep]) -> str:
    """Return a sentence on a wait that was given up, without its end."""
    wait = dropped.wait
    opening = f"{wait.waiting} does not wait for {wait.awaited} ({describe_reason(wait)})"
    if not dropped.circle:
        return f"{opening}: its phase {steps[wait.waiting].phase} is over before {steps[wait.awaited].phase} begins"
    between = dropped.circle[1:-1]
    if not between:
        return f"{opening}: {wait.awaited} waits for {wait.waiting}"
    return f"{opening}: {wait.awaited} waits for {wait.waiting}, by way of {join_words(list(reversed(between)))}"


def describe_circle(dropped: DroppedWait, steps: Mapping[str, StartStep]) -> str:
    """Return what is contradictory in waits that never give way."""
    wait = dropped.wait
    if not dropped.circle:
        phases = f"{steps[wait.waiting].phase} is over before {steps[wait.awaited].phase} begins"
        return f"{wait.waiting} cannot start after {wait.awaited}: {phases}"
    if len(dropped.circle) == 1:
        return f"{wait.waiting} cannot start after itself"
    return f"{wait.waiting} cannot start after {' after '.join([*reversed(dropped.circle[1:]), wait.waiting])}"


def list_ready_phrases(ready: ReadyConditions) -> Iterator[str]:
    """Yield what must hold so that something counts as up."""
    if ready.port is not None:
        yield f"the port {ready.port} accepts connections"
    if ready.file is not None:
        yield f"the file {ready.file} is there"
    if ready.topic is not None:
        yield f"a message has come on {ready.topic}"
    if ready.service is not None:
        yield f"{ready.service} is offered"
    if ready.log is not None:
        yield f"its output holds “{ready.log}”"
    if ready.wait is not None:
        yield f"{ready.wait} have passed"


def describe_ready(step: StartStep) -> str:
    """Return when what starts after a step goes on; empty where that is at once."""
    within = f", within {step.ready.within}" if step.ready.within is not None else ""
    if step.once:
        return f"it has ended{within}"
    phrases = list(list_ready_phrases(step.ready))
    return f"{join_words(phrases)}{within}" if phrases else ""


def describe_unknown(step: StartStep) -> str:
    """Return why there is no command: it does not exist yet, somebody else starts it, or nobody says how."""
    if step.status == "planned":
        return "planned: there is nothing to start yet"
    return "started by somebody else" if step.signals else "nothing says how it is started"


def describe_lifecycle(step: StartStep) -> str:
    """Return what brings a lifecycle node into which state; empty for all others."""
    if step.state is None:
        return ""
    if step.manager:
        return f"{step.state}, by {join_words(list(step.manager))}"
    return f"{step.state} ({', '.join(words[-1] for words in step.transitions)})" if step.transitions else step.state


def describe_process(step: StartStep) -> list[str]:
    """Return how a step runs: folder, user, variables, whether it is started again."""
    phrases = [f"in {step.directory}"] if step.directory else []
    phrases += [f"as the user {step.user}"] if step.user else []
    phrases += [f"on {name_cores(step.scheduling.cores)}"] if step.scheduling.cores else []
    phrases += [f"with {name}={value}" for name, value in step.environment.items()]
    phrases += [_describe_respawn(step.respawn_delay)] if step.respawn else []
    return phrases


def describe_start(node: Node) -> str:
    """Return what a node says of its start-up, in a line; empty where it says nothing."""
    start = node.start
    if start is None:
        return ""
    within = f" within {start.ready.within}" if start.ready.within is not None else ""
    signs = join_words(list(list_ready_phrases(start.ready)))
    parts = [f"in the phase {start.phase}" if start.phase else ""]
    parts.append(f"after {join_words([target.id for target in start.after])}" if start.after else "")
    parts.append(f"once, to its end{within}" if start.once else f"up when {signs}{within}" if signs else "")
    parts.append(f"brought into the state {start.wanted_state}" if start.wanted_state else "")
    parts[-1] += f" by {start.by.id}" if start.by and start.wanted_state else ""
    parts += [f"in {start.directory}" if start.directory else "", f"as the user {start.user}" if start.user else ""]
    parts += [f"with {name}={value}" for name, value in start.environment.items()]
    parts.append(_describe_respawn(start.respawn_delay) if start.respawn else "")
    return "; ".join(part for part in parts if part)


def list_running_facts(endpoints: Iterable[Endpoint]) -> Iterator[tuple[str, str]]:
    """Yield the domain and the clock of a node, and whether it runs, by its ends: what is no default, each with its place."""
    evidence = {name: (each, end) for end in endpoints for name, each in end.evidence.items()}
    for name, field in (("domain", "domain"), ("clock", "clock"), ("state", "runs")):
        found, endpoint = evidence.get(field, (None, None))
        value = getattr(endpoint, field, None)
        if found and value != "planned":
            place = f" ({found.at.file}:{found.at.line})" if found.at.file else ""
            yield name, f"{'unknown:' if value is None else f'{value}, by'} {found.rule}{place}"


def describe_override(endpoint: Endpoint) -> str:
    """Return what parameters do to the quality of service of an end; empty where there are none."""
    words = {
        "obeyed": "overridden by",
        "unknown": "overridden, if its program allows that, by",
        "ignored": "not overridden: its program ignores",
    }
    if endpoint.qos_override is None:
        return ""
    names = {each.rule: each.at for name, each in endpoint.evidence.items() if name.startswith("qos.")}
    rules = [f"{rule} ({at.file}:{at.line})" for rule, at in names.items()]
    return f"{words[endpoint.qos_override]} {join_words(rules) or 'what it is given'}"


def _describe_respawn(delay: Quantity | None) -> str:
    return f"started again after {delay}" if delay is not None else "started again at once"
