"""Which of several changes made something fall: those without which it had not happened."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from itertools import chain
from typing import Any

from archgen.compare.asked_limits import can_affect_timing
from archgen.compare.comparison import Change
from archgen.compare.key_phrases import name_key
from archgen.compare.losses.change_context import ChangeContext, tick_name
from archgen.compare.losses.timing_causes import TimingCauses
from archgen.derivation import derive_low_level
from archgen.diagnostics import NO_SPAN, fit_lines, join_words
from archgen.frozen import NamedTuple, dataclass, replace
from archgen.grouping import group_pairs
from archgen.model.architecture import Architecture, PortEdge
from archgen.model.component import Component, Output
from archgen.model.declared_timing import Timing
from archgen.timing.analysis import Analysis
from archgen.timing.figures.timing_values import TimingValue
from archgen.timing.run_analysis import analyse_for_chains

_MAX_ANALYSED = 20_000
"""How many activities are analysed for one comparison in all: those of a large robot with a few changes."""
_NODE_KEYS = frozenset({"host", "container", "threads", "scheduling", "reentrant", "callback_groups"})
"""What a node says of itself alone; other keys say what it does for whom, and with whom."""
_TIMING_FIELDS = {"rate": ("rate", "period"), "wcet": ("wcet", "measured_times"), "core": ("core", "cores")}
"""The fields of `timing` that one compared key stands for, where they are several."""


class VersionsWithout:
    """The second version without some of its changes, by their indices; each is analysed once."""

    def __init__(self, context: ChangeContext) -> None:
        """Start with nothing analysed."""
        self._context = context
        self._known: dict[frozenset[int], tuple[Architecture, Analysis] | None] = {}
        self._left = _MAX_ANALYSED

    def analyse(self, indices: frozenset[int]) -> tuple[Architecture, Analysis] | None:
        """Return the version without some changes with its analysis; None where one of them cannot be taken back alone,
        or too much was analysed already.
        """
        if indices not in self._known:
            self._left -= len(self._context.after.nodes)
            architecture = _take_all_back(self._context, indices) if self._left >= 0 else None
            self._known[indices] = (architecture, analyse_for_chains(architecture)) if architecture else None
        return self._known[indices]


def _find_whole(context: ChangeContext, change: Change) -> str | None:
    """Return the component that is taken back as a whole with a change; None where a figure or a place alone is."""
    kind, own_id = change.element_kind, context.common_id(change)
    if kind in {"input", "output", "connection"}:
        return own_id.rpartition(".")[0]
    is_figure = change.kind == "changed" and ((change.key or "").startswith("timing.") or change.key in _NODE_KEYS)
    if is_figure or kind not in {"component", "node"}:
        return None
    node = context.after.nodes.get(own_id) or context.before.nodes.get(own_id)
    return own_id if kind == "component" else next(iter(node.implements), None) if node else None


def _take_all_back(context: ChangeContext, indices: frozenset[int]) -> Architecture | None:
    architecture: Architecture | None = context.after
    wholes: dict[str, None] = {}
    is_type_changed = False
    for change in (context.changes[index] for index in sorted(indices)):
        is_type_changed |= change.element_kind == "type"
        if change.kind in {"renamed", "moved"} or architecture is None:
            continue
        # The parts of what came or went are connections of others, too.
        own_wholes = filter(None, (_find_whole(context, each) for each in context.walk_change(change)))
        if _find_whole(context, change):
            wholes |= dict.fromkeys(own_wholes)
        elif change.kind == "changed":
            architecture = _take_back_figure(context, architecture, change)
        elif change.kind == "removed":
            return None  # of anything else that is new, figures are touched by what names it
    if architecture is not None and wholes:
        architecture = _swap_components(context, architecture, wholes)
    return architecture if architecture is None or not (wholes or is_type_changed) else _derive_again(architecture)


def _derive_again(architecture: Architecture) -> Architecture:
    """Return an architecture with planned nodes, endpoints and topics as they follow from the rest."""
    # A planned node with a place is written: somebody says where it will run.
    nodes = {name: node for name, node in architecture.nodes.items() if node.written or node.at != NO_SPAN}
    return derive_low_level(replace(architecture, nodes=nodes))


def _take_back_figure(context: ChangeContext, architecture: Architecture, change: Change) -> Architecture | None:
    """Return an architecture with a figure or a place as it was; None where it cannot be taken back."""
    kind, key = change.element_kind, change.key or ""
    if key.startswith("timing."):
        return _take_back_timing(context, architecture, change)
    section = f"{kind}s"
    elements: Mapping[str, Any] = getattr(architecture, section, {})
    old_element = getattr(context.before, section, {}).get(context.old_id(kind, change.element_id))
    name = key.removeprefix("latency.").partition(".")[0]
    if change.element_id not in elements or not hasattr(old_element, name):
        return None
    value = getattr(old_element, name)
    if isinstance(value, str):
        # A host or a container, which may have another name now.
        value = context.matched_ids.common_id(name, value)
    if name == "through" and any(context.matched_ids.common_id(each.kind, each.id) != each.id for each in value):
        return None
    changed: dict[str, Any] = {
        section: {**elements, change.element_id: replace(elements[change.element_id], **{name: value})}
    }
    return replace(architecture, **changed)


def _take_back_timing(context: ChangeContext, architecture: Architecture, change: Change) -> Architecture | None:
    """Return an architecture with one key below `timing` as it was, at all nodes of a component or at a node."""
    nodes = dict(architecture.nodes)
    for node in architecture.nodes.values():
        old_node = context.before.nodes.get(context.old_id("node", node.id))
        for part, timing in node.timing.items() if old_node else ():
            lead = f"timing.{part}." if change.element_id == node.id and len(node.implements) > 1 else "timing."
            is_meant = change.element_id == (node.id if change.element_kind == "node" else part)
            if old_node and is_meant and (change.key or "").startswith(lead):
                old_part = context.old_id("component", part)
                name = (change.key or "").removeprefix(lead).partition(".")[0]
                values: dict[str, Any] = {
                    each: getattr(old_node.timing.get(old_part, Timing()), each, ...)
                    for each in _TIMING_FIELDS.get(name.removesuffix("s"), (name,))
                }
                # Mappings and triggers name ports by their ids.
                has_ids = any(isinstance(value, Mapping) or hasattr(value, "inputs") for value in values.values())
                if ... in values.values() or (part != old_part and has_ids):
                    return None
                own_node = nodes[node.id]
                nodes[node.id] = replace(own_node, timing={**own_node.timing, part: replace(timing, **values)})
    return None if nodes == architecture.nodes else replace(architecture, nodes=nodes)


def _swap_components(
    context: ChangeContext, architecture: Architecture, ids: Mapping[str, None]
) -> Architecture | None:
    """Return an architecture with some components and their nodes as they were, or without those that are new."""
    before = context.before
    components = {name: each for name, each in architecture.components.items() if name not in ids}
    components |= {name: before.components[name] for name in ids if name in before.components}
    nodes = {name: each for name, each in architecture.nodes.items() if ids.keys().isdisjoint(each.implements)}
    swapped = [each for each in before.nodes.values() if not ids.keys().isdisjoint(each.implements)]
    names = [*ids, *(name for node in swapped for name in (node.id, node.host, node.container) if name)]
    known = components.keys()
    if any(context.matched_ids.rename_in_text(name) != name for name in names) or any(
        node.id in nodes or not known >= set(node.implements) for node in swapped
    ):
        return None
    return _connect(replace(architecture, nodes=nodes | {node.id: node for node in swapped}), components)


def _connect(architecture: Architecture, components: Mapping[str, Component]) -> Architecture:
    """Return an architecture with these components, connected as their inputs say."""
    outputs = {port.id: port for each in components.values() for port in each.outputs.values()}
    components = {name: _cut_lost_sources(each, outputs) for name, each in components.items()}
    inputs = {port.id: port for each in components.values() for port in each.inputs.values()}
    connections = tuple(connection for port in inputs.values() for connection in port.connections)
    known = {**architecture.shells, **components}
    groups = {
        name: replace(
            group, components={key: known[each.id] for key, each in group.components.items() if each.id in known}
        )
        for name, group in architecture.groups.items()
    }
    edges = tuple(PortEdge(output, each.input, each.at) for each in connections for output in each.outputs)
    return replace(
        architecture,
        components=components,
        groups=groups,
        inputs=inputs,
        outputs=outputs,
        connections=connections,
        edges=edges,
    )


def _cut_lost_sources(component: Component, outputs: Mapping[str, Output]) -> Component:
    """Return a component whose inputs read nothing that is not there."""
    if all(outputs.keys() >= set(each.outputs) for port in component.inputs.values() for each in port.connections):
        return component
    inputs = {}
    for name, port in component.inputs.items():
        kept = ((each, tuple(output for output in each.outputs if output in outputs)) for each in port.connections)
        inputs[name] = replace(port, connections=tuple(replace(each, outputs=names) for each, names in kept if names))
    return replace(component, inputs=inputs)


_MAX_CANDIDATES = 8
"""How many changes are taken back one by one."""
_MAX_NAMES = 4

FallTest = Callable[[Architecture, Analysis, frozenset[int]], bool]
"""Whether it also falls in a version without some changes: the architecture, its analysis, the changes' indices."""


@dataclass(frozen=True, slots=True)
class SeparatedCauses:
    """The indices of the changes at which something is laid, and how they do it; the note is empty for a single one."""

    indices: tuple[int, ...]
    note: str = ""


class _ChangeGroup(NamedTuple):
    """Changes that are taken back together, and those of them that are told."""

    indices: tuple[int, ...]
    told: tuple[int, ...]


class CauseSeparator:
    """Separates the changes that made figures worse."""

    def __init__(self, causes: TimingCauses) -> None:
        """Start with the changes that may have made them worse, as `TimingCauses` finds them."""
        self._causes = causes
        self._context = causes.context
        self._versions = VersionsWithout(causes.context)

    def separate(self, activities: Sequence[str], own_indices: Iterable[int], falls: FallTest) -> SeparatedCauses:
        """Return the causes of what happens at some activities of the second version.

        They are the changes without which it does not happen; where any of several is enough, all of which that is
        true; where neither, all that reach it. `own_indices` are the changes of what is asked.
        """
        reach = sorted({*self._causes.find_causes(activities), *own_indices})
        worsening = sorted({*self._causes.all_worsening_changes(), *own_indices}) or [
            # Now and then less work makes a bound longer: then there is nothing else to blame.
            index
            for index, change in enumerate(self._context.changes)
            if any(map(can_affect_timing, self._context.walk_change(change)))
        ]
        reach = reach or worsening
        groups = self._group(worsening)
        if len(groups) > _MAX_CANDIDATES:
            groups = self._group(sorted({*reach, *self._causes.find_reach(activities)}))
        if len(groups) == 1:
            return SeparatedCauses(groups[0].told)
        if len(groups) > _MAX_CANDIDATES:
            return self._name_all(reach)
        return self._separate(groups, reach, falls)

    def _separate(self, groups: Sequence[_ChangeGroup], reach: Sequence[int], falls: FallTest) -> SeparatedCauses:
        everything = frozenset(chain.from_iterable(group.indices for group in groups))
        needed = [(group, self._falls_without(frozenset(group.indices), falls)) for group in groups]
        # What cannot be taken back alone may be the cause as well as any other.
        if any(found is None and set(group.indices) & set(reach) for group, found in needed):
            return self._name_all(reach)
        found_groups = [group for group, found in needed if found is False]
        if found_groups:
            either = "either" if len(found_groups) == 2 else "any one of them"  # noqa: PLR2004
            return self._note(found_groups, f" together: without {either} it holds")
        alone = [(group, self._falls_without(everything - set(group.indices), falls)) for group in groups]
        found_groups = [group for group, found in alone if found]
        if found_groups and self._falls_without(everything, falls) is False:
            return self._note(found_groups, ", each alone")
        return self._name_all(reach)

    def _falls_without(self, indices: frozenset[int], falls: FallTest) -> bool | None:
        version = self._versions.analyse(indices)
        return None if version is None else falls(*version, indices)

    def _group(self, indices: Sequence[int]) -> list[_ChangeGroup]:
        """Group changes that are taken back together: the same key of instances of one type, all of a component that is
        taken back as a whole. Of one that is new those that read it now go along, and are not told.
        """
        context = self._context
        wholes = {_find_whole(context, context.changes[index]) for index in indices} - {None}
        groups = group_pairs((self._find_origin(context.changes[index], wholes) or index, index) for index in indices)
        return [
            _ChangeGroup(
                tuple(members),
                tuple(
                    index
                    for index in members
                    if (context.changes[index].element_kind, context.changes[index].kind) == ("component", "added")
                )
                or tuple(members),
            )
            for members in groups.values()
        ]

    def _find_origin(self, change: Change, wholes: Collection[str | None]) -> object:
        """Return what the changes of a group have in common, None for a change that stands for itself."""
        component = self._context.after.components.get(change.element_id)
        if isinstance(change.after, list) and change.element_kind == "connection":
            gained = {source.rpartition(".")[0] for source in change.after} - self._context.before.components.keys()
            if whole_sources := sorted(gained.intersection(filter(None, wholes))):
                return whole_sources[0]
        node = self._context.after.nodes.get(change.element_id) if change.element_kind == "node" else None
        parts = [_find_whole(self._context, change), *(node.implements if node else (change.element_id,))]
        whole = next((part for part in parts if part in wholes and part), None)
        if whole or component is None or not component.type_name:
            return whole
        return component.type_name, change.key, str(change.before), str(change.after)

    def _name_all(self, indices: Sequence[int]) -> SeparatedCauses:
        return SeparatedCauses(tuple(indices), "; causes not separated" if len(indices) > 1 else "")

    def _note(self, groups: Sequence[_ChangeGroup], ending: str) -> SeparatedCauses:
        indices = tuple(sorted(chain.from_iterable(group.told for group in groups)))
        names = [self._name_change(group.told[0]) for group in groups]
        named = join_words(fit_lines(names, _MAX_NAMES + 1, "{} more"))
        return SeparatedCauses(indices, f"; {named}{ending}" if len(names) > 1 else "")

    def _name_change(self, index: int) -> str:
        """Name what a change is of, with its owner: whoever is broken sees his own part in it."""
        change = self._context.changes[index]
        owners = sorted(self._context.owners_of_change(index))
        words = name_key(change.element_kind, change.key) if change.key else change.kind
        owned = f" of {join_words([self._context.name_partner(owner) for owner in owners])}" if owners else ""
        return f"{tick_name(change.element_id)} ({words}){owned}"

    def lacks_new_figures_only(self, causes: SeparatedCauses, bound: TimingValue) -> bool:
        """Whether a bound is unknown only since elements that are new have no figures yet: nobody took one away."""
        activities = self._causes.timing_pair.after.system.activities
        is_new = all(name in activities and self._causes.old_activity(name) is None for name in bound.missing)
        is_added = all(self._context.changes[index].kind == "added" for index in causes.indices)
        return bool(bound.missing) and is_new and is_added
