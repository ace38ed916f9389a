"""What the elements of chains stand for, and what their bounds rest on: looked up once for all chains of an analysis.

To go through all activities for each chain takes time in proportion to both.

What a word from the command line means in timing: an activity, a node, a component, an output.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from archgen.diagnostics.common_wording import join_first
from archgen.diagnostics.suggestions import NAMES_HELP, did_you_mean, find_closest
from archgen.frozen import dataclass
from archgen.model.architecture import Architecture, Waypoint
from archgen.model.graph_search import find_strong_components
from archgen.timing.analysis import Analysis
from archgen.timing.chains.trigger_arrivals import TriggerArrivals
from archgen.timing.system.timing_system import TimingSystem


@dataclass(frozen=True, slots=True)
class ChainPoint:
    """What an element of a chain stands for: activities, and the output by which it is left (None: any)."""

    activities: tuple[str, ...]
    output: str | None = None


class ElementIndex:
    """The activities of each node and component."""

    def __init__(self, system: TimingSystem, architecture: Architecture) -> None:
        """Go through all activities."""
        self._system, self.architecture = system, architecture
        self._of_node: dict[str, list[str]] = {}
        self._of_component: dict[str, list[str]] = {}
        for activity in system.activities.values():
            self._of_node.setdefault(activity.node, []).append(activity.id)
            node = architecture.nodes.get(activity.node)
            for component in _component_ids(activity.component, node.implements if node else ()):
                self._of_component.setdefault(component, []).append(activity.id)

    def resolve_points(self, waypoints: Sequence[Waypoint]) -> tuple[ChainPoint, ...]:
        """Return the activities of each element."""
        return tuple(self._resolve_point(point) for point in waypoints)

    def _resolve_point(self, point: Waypoint) -> ChainPoint:
        activities = self._system.activities
        if point.kind == "node":
            return ChainPoint((point.id,) if point.id in activities else tuple(self._of_node.get(point.id, ())))
        if point.kind == "component":
            # A composed component is the worst way through its leaves.
            leaves = self.architecture.leaves_of(point.id)
            return ChainPoint(tuple(each for leaf in leaves for each in self._of_component.get(leaf, ())))
        output = self.architecture.outputs.get(point.id)
        owners = self._of_component.get(output.component, []) if output else []
        publishing = [name for name in owners if point.id in activities[name].outputs]
        return ChainPoint(tuple(publishing or owners), point.id)


def _component_ids(own_name: str | None, implemented_ids: Sequence[str]) -> tuple[str, ...]:
    """Return the complete ids of the components that an activity belongs to."""
    if own_name is None:
        # An activity's component may be the last part of an id only (see `name_activities`).
        return tuple(implemented_ids[:1])
    return tuple(component for component in implemented_ids if own_name in {component, component.rpartition(".")[2]})


class MeasuredBasis:
    """The measured execution times on which figures rest: they are the longest that were seen, and prove nothing."""

    def __init__(self, analysis: Analysis) -> None:
        """Find what each activity rests on: what fires it, what shares a host or a resource, and what these rest on."""
        activities = analysis.system.activities
        self._measured = [name for name, activity in activities.items() if activity.wcet_measured]
        self._basis_of: dict[str, int] = {}
        """The measured activities (as bits) on which each activity, host and resource rests."""
        if self._measured:
            neighbours = _list_neighbours(analysis)
            bits = {name: 1 << number for number, name in enumerate(self._measured)}
            parts = find_strong_components(neighbours, lambda name: neighbours[name])
            for part in reversed(parts):  # what a part rests on is found before
                basis = 0
                for name in part:
                    basis |= bits.get(name, 0)
                    for neighbour in neighbours[name]:
                        basis |= self._basis_of.get(neighbour, 0)
                self._basis_of.update(dict.fromkeys(part, basis))

    def describe(self, through: Iterable[str]) -> str:
        """Say which measured execution times the bound of a chain rests on; empty for none."""
        basis = 0
        for name in through if self._basis_of else ():
            basis |= self._basis_of[name]
        names = tuple(name for number, name in enumerate(self._measured) if basis >> number & 1)
        return f"the execution time of {join_first(names)} is the longest that was seen, not proven" if names else ""


def _list_neighbours(analysis: Analysis) -> dict[str, list[str]]:
    """Return on what each activity rests at once, with places between those that share them."""
    arrivals, activities = TriggerArrivals(analysis), analysis.system.activities
    neighbours: dict[str, list[str]] = {
        name: [arc.source for arc in analysis.system.arcs_into.get(name, ()) if arrivals.fires_reader(arc)]
        for name in activities
    }
    # Ids have no blanks.
    for name, activity in activities.items():
        if activity.response is not None:
            continue
        places = [f"host {activity.host}"] if activity.host else []
        for place in (*places, *(f"resource {key}" for key in activity.uses)):
            neighbours[name].append(place)
            neighbours.setdefault(place, []).append(name)
    return neighbours


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
