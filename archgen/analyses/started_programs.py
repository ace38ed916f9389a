"""Can each program and node be started as it is described: a port of its own, somebody who activates it, a way to start?"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator

from archgen.derivation.wire.running_state import ANY_NODE, RunningStates
from archgen.diagnostics import Diagnostic, Label, Severity, Span
from archgen.model.architecture import Architecture
from archgen.model.declared_timing import Timing
from archgen.model.node import NO_START, SIGN_KEYS, Endpoint, Node, StartUp
from archgen.model.process_scheduling import (
    MAX_PRIORITY,
    find_process_scheduling,
    heeds_priorities,
    list_pinned_cores,
    list_process_timings,
)


def shared_port(architecture: Architecture) -> Iterator[Diagnostic]:
    """Two programs on one host are to listen on the same port."""
    first_nodes: dict[tuple[str | None, int], Node] = {}
    for node in architecture.nodes.values():
        port = node.start.ready.port if node.start else None
        if port is None:
            continue
        first = first_nodes.setdefault((node.host, port), node)
        if first is not node:
            place = f"on `{node.host}`" if node.host else "and on no host that is named"
            yield Diagnostic(
                "shared-port",
                f"`{first.id}` and `{node.id}` are both to listen on the port {port} {place}",
                _find_port_span(node),
                labels=(Label(_find_port_span(first), f"`{first.id}`"),),
                help="give one of them another port" + ("" if node.host else ", or each its host"),
                element=node.id,
            )


def _find_port_span(node: Node) -> Span:
    places = node.start.ready.places if node.start else {}
    return places.get("port", node.at)


def silent_node(architecture: Architecture) -> Iterator[Diagnostic]:
    """A lifecycle node is never activated, or stays short of it while others wait for what it sends."""
    if not architecture.describes_start():
        return
    yield from _find_unactivated(architecture)
    on_chains = {point.id for chain in architecture.chains.values() for point in chain.through}
    silent: dict[str, list[tuple[Endpoint, Endpoint]]] = defaultdict(list)
    for topic in architecture.topics.values():
        for writer in topic.writers:
            # What somebody brings into a state, he may bring further.
            if writer.runs == "inactive" and not (architecture.nodes[writer.node].start or NO_START).by_written:
                for reader in topic.readers:
                    if architecture.nodes[reader.node].written:
                        silent[writer.node].append((writer, reader))
    for node_id, ends in silent.items():
        writer, reader = ends[0]
        is_on_chain = any(not on_chains.isdisjoint((end.node, end.component, writer.port)) for writer, end in ends)
        names = list(dict.fromkeys(f"`{end.name}`" for end, _ in ends))
        more = f" and {len(names) - 1} more" if len(names) > 1 else ""
        yield Diagnostic(
            "silent-node",
            f"`{node_id}` is left `{(architecture.nodes[node_id].start or NO_START).state}`: "
            f"`{reader.node}` waits for {names[0]}{more} in vain",
            writer.evidence["runs"].at,
            severity=Severity.ERROR if is_on_chain else None,
            labels=(Label(reader.at, "read here"),) if reader.at.file else (),
            help="write `start: {state: active}`, or `start: {by: NODE}` with the node that activates it",
            element=node_id,
        )


def _find_unactivated(architecture: Architecture) -> Iterator[Diagnostic]:
    """Yield the lifecycle nodes that nobody activates; none where a manager activates nodes that are not known."""
    managed_names = RunningStates(architecture).managers
    if ANY_NODE in managed_names:
        return
    managers: dict[str, list[str]] = defaultdict(list)
    for node in architecture.nodes.values():
        if node.start and node.start.by:
            managers[node.start.by.id].append(node.id)
    called_names = {end.name for end in architecture.endpoints if end.use == "calls"}
    usual = max(managers, key=lambda name: len(managers[name]), default=None)
    for node in architecture.nodes.values():
        is_left = (node.start or NO_START).wanted_state is None and node.full_name not in managed_names
        # A program that calls this service of it is its manager, too.
        is_left = is_left and f"{node.full_name}/change_state" not in called_names
        if "lifecycle" in node.kinds and is_left:
            by_help = f"`start: {{by: {usual}}}`" if usual else "`start: {by: NODE}` with the node that manages it"
            yield Diagnostic(
                "silent-node",
                f"nobody activates the lifecycle node `{node.id}`",
                node.kind_at,
                help=f"write `start: {{state: active}}`, or {by_help}",
                element=node.id,
            )


def unstarted_program(architecture: Architecture) -> Iterator[Diagnostic]:
    """A program has no command and no package, and nothing shows that it is up."""
    if not architecture.describes_start():
        return
    for node in architecture.nodes.values():
        has_command = bool(node.command or (node.package and node.executable))
        is_known = has_command or node.status == "planned" or (node.start or NO_START).ready.has_sign
        if node.is_program and node.written and not is_known:
            yield Diagnostic(
                "unstarted-program",
                f"nothing says how the program `{node.id}` is started, nor how one sees that it is up",
                node.kind_at,
                help="write its `command`, or `start: {ready: ...}` where somebody else starts it; while it is not "
                "decided, `status: planned`",
                element=node.id,
            )


_PROCESS_KEYS = ("respawn", "respawn_delay", "environment", "directory", "user")
"""What belongs to a process, and not to a node that a container loads into its own."""
_WAITING_BEHAVIOURS = {"event": "it waits for the next message", "on_demand": "it waits for the next call"}
_RIGHTS_PROGRAMS = frozenset({"sudo", "doas", "su", "pkexec", "run0"})
_SHELLS = frozenset({"sh", "bash", "dash", "zsh", "ksh", "fish", "cmd", "powershell", "pwsh"})
_SHELL_OPTIONS = ("-c", "-lc", "-ic", "/c", "-Command")


def idle_start(architecture: Architecture) -> Iterator[Diagnostic]:
    """A key of `start` has no effect where it stands."""
    for node in architecture.nodes.values():
        if node.command and (node.executable or node.plugin):
            other = "executable" if node.executable else "plugin"
            yield Diagnostic(
                "idle-start",
                f"`{other}` of `{node.id}` has no effect: its `command` starts it",
                node.command_at,
                help="keep one of them",
                element=node.id,
            )
        for key, reason, help_line in _list_idle_keys(node, node.start) if node.start else ():
            places = {**node.start.ready.places, **node.start.places} if node.start else {}
            yield Diagnostic(
                "idle-start",
                f"`{key}` of `{node.id}` has no effect: {reason}",
                places.get(key, node.at),
                labels=(Label(node.container_at, "its container"),) if key in _PROCESS_KEYS and node.container else (),
                help=help_line,
                element=node.id,
            )


def _list_idle_keys(node: Node, start: StartUp) -> Iterator[tuple[str, str, str]]:
    """Yield keys that have no effect, each with the reason and with what to do."""
    written_keys = [key for key in _PROCESS_KEYS if getattr(start, key)]
    if node.container is not None:
        for key in written_keys:
            yield key, f"the container `{node.container}` loads it into its own process", "leave it out"
    elif start.respawn_delay is not None and not start.respawn:
        yield "respawn_delay", "it is not started again", "write `respawn: true` beside it, or leave it out"
    signs = [key for key in SIGN_KEYS if getattr(start.ready, key) is not None]
    if start.once:
        for key in signs:
            yield key, "it runs `once`, and what starts after it waits for its end", "leave one of the two out"
    elif start.ready.within is not None and not signs:
        yield (
            "within",
            "nothing says what is waited for",
            "say how one sees that it is up, such as `ready: {topic: /map}`",
        )
    if "lifecycle" not in node.kinds:
        for key in ("state", "by"):
            if key in start.places:
                yield key, "it is no lifecycle node", "write `kind: lifecycle`, or leave it out"


def endless_once(architecture: Architecture) -> Iterator[Diagnostic]:
    """What runs `once` never comes to its end."""
    for node in architecture.nodes.values():
        reason = _find_endless_reason(node) if node.start and node.start.once else None
        if node.start and reason:
            yield Diagnostic(
                "endless-once",
                f"`{node.id}` runs `once`, but never comes to its end: {reason}",
                node.start.places.get("once", node.at),
                help="take `once` out, and write in `ready` how one sees that it is up",
                element=node.id,
            )


def _find_endless_reason(node: Node) -> str | None:
    if node.start and node.start.respawn:
        return "it is started again whenever it ends"
    if node.container is not None:
        return f"the container `{node.container}` keeps it"
    if "lifecycle" in node.kinds:
        return "a lifecycle node waits for its next transition"
    if any(use.use == "serves" for use in node.uses):
        return "it offers a service or an action"
    return next(filter(None, map(_describe_endless_timing, node.timing.values())), None)


def _describe_endless_timing(timing: Timing) -> str | None:
    if timing.period is not None or timing.rate is not None or timing.behaviour == "periodic":
        return "it works periodically"
    return _WAITING_BEHAVIOURS.get(timing.behaviour or "")


def indirect_command(architecture: Architecture) -> Iterator[Diagnostic]:
    """A command asks for another user's rights, or hands a line to a shell."""
    for node in architecture.nodes.values():
        program = node.command[0].replace("\\", "/").rpartition("/")[2].removesuffix(".exe") if node.command else ""
        if program in _RIGHTS_PROGRAMS:
            message, help_line = f"asks for rights with `{program}`", "leave it out, and write `start: {user: root}`"
        elif program in _SHELLS and any(word in _SHELL_OPTIONS for word in node.command[1:]):
            message = f"hands a line to the shell `{program}`"
            help_line = "write the words of the command itself, or a script of your own with a name"
        else:
            continue
        yield Diagnostic(
            "indirect-command",
            f"the command of `{node.id}` {message}",
            node.command_at,
            help=help_line,
            element=node.id,
        )


def uneven_process(architecture: Architecture) -> Iterator[Diagnostic]:
    """Parts of one process have different priorities, or are pinned to different cores: who starts it can give it only one."""
    processes: dict[tuple[str, str], list[Node]] = defaultdict(list)
    for node in architecture.nodes.values():
        processes["container" if node.container else "node", node.container or node.id].append(node)
    for (kind, process), nodes in processes.items():
        container = architecture.containers[process] if kind == "container" else None
        # A program of its own may give each of its threads what it likes.
        is_known = container.package is None if container else nodes[0].is_generated
        # An order of its own, by priority: they are those of callbacks in its threads.
        if not is_known or (container or nodes[0]).scheduling in {"fixed_priority", "non_preemptive"}:
            continue
        told = find_process_scheduling(architecture, nodes)
        timings = list_process_timings(nodes)
        urgent = [each for each in timings if each and each.priority is not None]
        pinned = [each for each in timings if each and list_pinned_cores(each)]
        name = f"the container `{process}`" if kind == "container" else f"`{process}`"
        is_uneven = urgent and len({each.priority if each else None for each in timings}) > 1
        if is_uneven and heeds_priorities(architecture, nodes):
            yield _tell_uneven(name, "priority", urgent, nodes[0])
        elif urgent and not is_uneven and not 1 <= (urgent[0].priority or 0) <= MAX_PRIORITY:
            yield Diagnostic(
                "uneven-process",
                f"{name} has the priority {urgent[0].priority}: SCHED_FIFO has those from 1 to {MAX_PRIORITY}",
                urgent[0].places["priority"],
                help="write one of these; the larger one runs first",
                element=nodes[0].id,
            )
        if pinned and not told.cores:
            yield _tell_uneven(name, "core", pinned, nodes[0])


def _tell_uneven(name: str, key: str, timings: list[Timing], first: Node) -> Diagnostic:
    places = [each.places.get(key) or each.places["cores"] for each in timings]
    what = "does not have one priority" if key == "priority" else "is not pinned to one set of cores"
    word = {"priority": "priority", "core": "cores"}[key]
    return Diagnostic(
        "uneven-process",
        f"{name} {what} in all that it runs: who starts a process gives all of its threads the same, so none is given",
        places[0],
        labels=tuple(Label(place, "and here") for place in places[1:2]),
        help=f"write the same {word} for all that it runs, or let this run in a process of its own",
        element=first.id,
    )


RULES = (
    (shared_port, Severity.WARNING),
    (silent_node, Severity.WARNING),
    (unstarted_program, Severity.WARNING),
    (idle_start, Severity.WARNING),
    (endless_once, Severity.WARNING),
    (indirect_command, Severity.WARNING),
    (uneven_process, Severity.NOTE),
)
