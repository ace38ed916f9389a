"""Does what is written of a node's start count, does what is run once come to its end, and is its command one?"""

from __future__ import annotations

from typing import TYPE_CHECKING

from archgen.diagnostics.diagnostic import Diagnostic, Label, Severity
from archgen.model.start_up import SIGN_KEYS

if TYPE_CHECKING:
    from collections.abc import Iterator

    from archgen.model.architecture import Architecture
    from archgen.model.declared_timing import Timing
    from archgen.model.node import Node
    from archgen.model.start_up import StartUp

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


RULES = (
    (idle_start, Severity.WARNING),
    (endless_once, Severity.WARNING),
    (indirect_command, Severity.WARNING),
)
