"""End to end flows become chains."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from archgen.plugin import dataclass
from archgen.plugin.importing import make_id, make_unique_id
from archgen.plugins.aadl.aadl_tree import AadlFlow, Path
from archgen.plugins.aadl.archgen_words import find_own_texts
from archgen.plugins.aadl.component_bodies import Body
from archgen.plugins.aadl.import_notes import NoteList
from archgen.plugins.aadl.property_values import PropertyScope, read_time_range
from archgen.plugins.aadl.robot_groups import LaunchedSystem
from archgen.plugins.aadl.structures import ClassifierStructure


@dataclass(frozen=True, slots=True)
class _FlowPlace:
    """Where end to end flows stand: the ids from the group on, and what archgen says of the flows there, by their names."""

    structure: ClassifierStructure
    scope: PropertyScope
    ids: tuple[str, ...]
    own_words: Mapping[str, Mapping[str, str]]


class ChainMapper:
    """Makes the chains of all roots."""

    def __init__(self, notes: NoteList) -> None:
        self.chains: dict[str, Body] = {}
        self._notes = notes

    def add_chains(self, system: LaunchedSystem) -> None:
        """Add the end to end flows of a root, of its groups, and of the components in them."""
        group_of_root = next((frame.group_id for frame in system.frames if not frame.path), "")
        places: list[tuple[ClassifierStructure, PropertyScope, tuple[str, ...]]] = [
            (system.structure, system.scope, (group_of_root,))
        ]
        places += [(frame.structure, frame.scope, (frame.group_id,)) for frame in system.frames if frame.path]
        places += [(inst.structure, inst.scope, inst.ids) for inst in system.instances.values() if inst.structure.parts]
        for structure, scope, ids in places:
            own_words = {key: find_own_texts(scope, (), key) for key in ("flow_ways", "flow_ids", "flow_titles")}
            for flow in structure.resolved.flows.values():
                if flow.kind == "end to end":
                    self._add_chain(system, _FlowPlace(structure, scope, ids, own_words), flow)

    def _add_chain(self, system: LaunchedSystem, place: _FlowPlace, flow: AadlFlow) -> None:
        own_way = place.own_words["flow_ways"].get(flow.name, "")
        through = own_way.split(", ") if own_way else []
        known = {".".join(instance.ids) for instance in system.instances.values()} if own_way else set()
        if gone := next((each for each in through if "." in each and each not in known), None):
            words = f"`{gone}` of archgen::Flow_Ways is no component any more: flow {flow.name} leads as its steps do"
            self._notes.add_contradiction("end to end flow", words, flow.span)
            through = []
        for step in () if through else flow.steps:
            if _leads_nowhere(place.structure, step):
                words = f"step {'.'.join(step)} of flow {flow.name} is neither a part nor a connection; it is left out"
                self._notes.add_contradiction("end to end flow", words, flow.span)
            for reference in _name_step(system, place.structure, place.ids, step):
                if not through or through[-1] != reference:
                    through.append(reference)
        if len(through) <= 1:
            words = f"flow {flow.name} leads through fewer than two components"
            self._notes.add("end to end flow", words, flow.span)
            return
        own_id = place.own_words["flow_ids"].get(flow.name, "")
        chain_id = make_unique_id(make_id(own_id or flow.name, "chain"), self.chains.keys())
        body: Body = {"through": through}
        if title := place.own_words["flow_titles"].get(flow.name):
            body["title"] = title
        lowest, highest = read_time_range(place.scope.value((flow.name.lower(),), "latency"))
        body |= {"deadline": highest} if highest else {}
        hints = {"name": flow.name} if flow.name != chain_id and not own_id else {}
        if lowest and lowest != highest and not lowest.startswith("0 "):
            hints["shortest"] = lowest
        self.chains[chain_id] = {**body, "hints": {"aadl": hints}} if hints else body


def _leads_nowhere(structure: ClassifierStructure, step: Path) -> bool:
    """Whether a step of a flow names nothing that stands there."""
    name, resolved = step[0].lower(), structure.resolved
    return not any(name in known for known in (resolved.parts, resolved.connections, resolved.ports)) and not any(
        (name, is_inner) in resolved.flows for is_inner in (False, True)
    )


def _name_step(
    system: LaunchedSystem, structure: ClassifierStructure, ids: tuple[str, ...], step: Path
) -> Iterator[str]:
    """Yield the components that a step of a flow leads through; a connection is none."""
    names = tuple(name.lower() for name in step)
    part = structure.parts.get(names[0])
    if part is None:
        return
    group_id = system.groups.get(part.name) if structure is system.structure else None
    if group_id is None:
        yield ".".join((*ids, part.id))
        return
    if part.structure is not None and len(names) > 1:
        yield from _go_through(part.structure, group_id, names[1])


def _go_through(structure: ClassifierStructure, group_id: str, flow_name: str) -> Iterator[str]:
    """Yield the components of a group through which its own flow leads."""
    flow = structure.resolved.flows.get((flow_name, True))
    for step in flow.steps if flow else ():
        if part := structure.parts.get(step[0].lower()):
            yield f"{group_id}.{part.id}"
