"""What a word from the command line means in timing: an activity, a node, a component, an output."""

from __future__ import annotations

from collections.abc import Iterable

from archgen.model.architecture import Architecture, Waypoint
from archgen.suggest import closest, did_you_mean
from archgen.timing.system import System


class UnknownNameError(ValueError):
    """A word names nothing that timing knows of, or several things; the text says which."""


def waypoint(architecture: Architecture, system: System, word: str) -> Waypoint:
    """Return the element of a chain that a word means: complete ids first, then the last parts of ids."""
    if word in system.activities or word in architecture.nodes:
        return Waypoint("node", word)
    if word in architecture.components:
        return Waypoint("component", word)
    if word in architecture.outputs:
        return Waypoint("output", word)
    components = ending(architecture.components, word)
    outputs = ending(architecture.outputs, word)
    found = [*components, *outputs]
    if len(found) == 1:
        return Waypoint("component" if components else "output", found[0])
    if found:
        msg = f"`{word}` may mean {_either(found)}"
        raise UnknownNameError(msg)
    known = [*system.activities, *architecture.nodes, *architecture.components, *architecture.outputs]
    raise UnknownNameError(nothing(word, known))


def activities(architecture: Architecture, system: System, word: str) -> tuple[str, ...]:
    """Return the ids of the activities that a word means: one, all of a node, or all of a component."""
    from archgen.timing import route

    if word in system.activities:
        return (word,)
    point = waypoint(architecture, system, word)
    return route.points(system, architecture, (point,))[0].activities


def ending(ids: Iterable[str], word: str) -> list[str]:
    """Return the dotted ids that end in the given words."""
    return [name for name in ids if name == word or name.endswith(f".{word}")]


def nothing(word: str, known: Iterable[str]) -> str:
    """Say that a word names nothing, with a guess at what was meant."""
    names = {part: name for name in known for part in (name.rpartition(".")[2], name)}
    guess = did_you_mean(word, names) if closest(word, names) else None
    return f"nothing is called `{word}`; {guess or '`archgen list` gives the names of all elements'}"


def _either(found: list[str], most: int = 6) -> str:
    """List possible meanings, at most so many."""
    shown = ", ".join(f"`{name}`" for name in found[:most])
    return shown + (f" and {len(found) - most} more" if len(found) > most else "")
