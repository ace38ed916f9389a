"""What a word from the command line means in timing: an activity, a node, a component, an output."""

from __future__ import annotations

from collections.abc import Iterable

from archgen.diagnostics.common_wording import join_first
from archgen.diagnostics.suggestions import NAMES_HELP, did_you_mean, find_closest
from archgen.model.architecture import Architecture, Waypoint
from archgen.timing.system.timing_system import TimingSystem


class UnknownNameError(ValueError):
    """A word names nothing that timing knows of, or several things; the text says which."""


def resolve_waypoint(architecture: Architecture, system: TimingSystem, word: str) -> Waypoint:
    """Return the element of a chain that a word means: complete ids first, then the last parts of ids."""
    if word in system.activities or word in architecture.nodes:
        return Waypoint("node", word)
    if word in architecture.components:
        return Waypoint("component", word)
    if word in architecture.outputs:
        return Waypoint("output", word)
    components = ids_ending_in(architecture.components, word)
    outputs = ids_ending_in(architecture.outputs, word)
    matches = [*components, *outputs]
    if len(matches) == 1:
        return Waypoint("component" if components else "output", matches[0])
    if matches:
        raise UnknownNameError(f"`{word}` may mean {join_first([f'`{name}`' for name in matches])}")
    known_names = [*system.activities, *architecture.nodes, *architecture.components, *architecture.outputs]
    raise UnknownNameError(unknown_name_text(word, known_names))


def resolve_activities(architecture: Architecture, system: TimingSystem, word: str) -> tuple[str, ...]:
    """Return the ids of the activities that a word means: one, all of a node, or all of a component."""
    from archgen.timing.chains.element_index import ElementIndex

    if word in system.activities:
        return (word,)
    point = resolve_waypoint(architecture, system, word)
    return ElementIndex(system, architecture).resolve_points((point,))[0].activities


def ids_ending_in(ids: Iterable[str], word: str) -> list[str]:
    """Return the dotted ids that end in the given words."""
    return [name for name in ids if name == word or name.endswith(f".{word}")]


_MIN_PART = 4
"""The letters of the shortest word that is looked for within longer names."""


def _find_longer(word: str, names: Iterable[str]) -> str | None:
    """Ask for the one name that has a word as one of its parts: `stereo` for `stereo_camera`."""
    longer_names = sorted({name for name in names if "." not in name and word in name.split("_")})
    return f"did you mean `{longer_names[0]}`?" if len(longer_names) == 1 and len(word) >= _MIN_PART else None


def unknown_name_text(word: str, known_names: Iterable[str]) -> str:
    """Say that a word names nothing, with a guess at what was meant."""
    names = {part: name for name in known_names for part in (name.rpartition(".")[2], name)}
    guess = did_you_mean(word, names) if find_closest(word, names) else _find_longer(word, names)
    return f"nothing is called `{word}`; {guess or NAMES_HELP}"
