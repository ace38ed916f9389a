"""What feeds the inputs of components once the components around them are gone: connections lifted to the leaves."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from archgen.diagnostics import Span
from archgen.link import mapping_values
from archgen.model.architecture import Architecture
from archgen.model.step_connections import StepConnection, StepConnections
from archgen.model.use_case_steps import Step, StepEnd
from archgen.passes.linked_tree import LinkedTree
from archgen.syntax.yaml_tree import MappingEntry, MappingNode, ScalarNode, SequenceNode, YamlNode, change_at


class FlatSteps:
    """Writes use cases of which the ends are leaves."""

    def __init__(self, architecture: Architecture, flat_ids: Mapping[str, str]) -> None:
        """Take what the linker knows, and the complete ids that leaves get."""
        self._architecture = architecture
        self._flat_ids = flat_ids
        self._connections = StepConnections(architecture)
        self._steps: dict[Span, Step] = {
            each.at: each for case in architecture.use_cases.values() for each in case.steps
        }

    def rewrite_use_cases(self, section: MappingEntry) -> MappingEntry:
        """Return the section with the ends of steps called as they are now."""
        return section.with_value(change_at(section.value, ("*", "steps"), self._rewrite_steps))

    def _rewrite_steps(self, steps: YamlNode) -> YamlNode:
        if not isinstance(steps, SequenceNode):
            return steps
        return SequenceNode(list(map(self._rewrite_step, steps.items)), steps.span)

    def _rewrite_step(self, node: YamlNode) -> YamlNode:
        source = mapping_values.get_scalar(node, "from") if isinstance(node, MappingNode) else None
        step = self._steps.get(source.span) if source else None
        if step is None or not isinstance(node, MappingNode):
            return node
        connection = next(iter(self._connections.find_connections(step)), None)
        entries = dict(node.entries)
        for key, end in (("from", step.source), ("to", step.target)):
            name = self._name_end(end, connection)
            if name != end.id:
                scalar = ScalarNode(name, name, entries[key].value.span)
                entries[key] = entries[key].with_value(scalar)
        return MappingNode(entries, node.span)

    def _name_end(self, end: StepEnd, connection: StepConnection | None) -> str:
        """Return how an end is called now: of a composed component, the leaf that is connected, else the first one."""
        if end.kind not in {"component", "output"}:
            return end.id
        ports = [each for each in (connection.output, connection.input) if each] if connection else []
        if end.kind == "output":
            behind = self._architecture.leaf_ports_of("output", end.id)
            leaf_id, _, name = next((each for each in ports if each in behind), behind[0]).rpartition(".")
            return f"{self._flat_ids[leaf_id]}.{name}" if leaf_id in self._flat_ids else end.id
        leaves = [each for each in self._architecture.leaves_of(end.id) if each in self._flat_ids]
        connected = (leaf for port in ports if (leaf := port.rpartition(".")[0]) in leaves)
        return next((self._flat_ids[each] for each in (*connected, *leaves)), end.id)


_SAID_OUTSIDE = ("external", "medium")
_SAID_OF_OUTPUTS = ("promise", "version", "deprecated")


class FlatSources:
    """Writes the ports of leaves with what the ports around them say."""

    def __init__(self, linked: LinkedTree, flat_ids: Mapping[str, str]) -> None:
        """Take what the linker knows, and the complete ids that leaves get."""
        self._linked = linked
        self._sources = linked.joined_sources
        self._flat_ids = flat_ids
        self._outside_readers = self._sources.list_given_outside()
        self._component_ids = frozenset(flat_ids.values())
        self._said_by_leaf = dict(self._list_said())

    def write_inputs(self, component_id: str, names: tuple[str, ...], written: MappingNode) -> MappingNode:
        """Return the inputs of a leaf, each with the outputs of leaves that it reads."""
        entries: dict[str, MappingEntry] = {}
        for name in names:
            entry = self._linked.outline.inputs[component_id][name]
            entries[name] = MappingEntry(name, entry.key_span, self._write_input(component_id, entry))
        return MappingNode(entries, written.span)

    def write_outputs(self, component_id: str, names: tuple[str, ...], written: MappingNode) -> MappingNode:
        """Return the outputs of a leaf, each with what is said of it where it is passed on."""
        entries: dict[str, MappingEntry] = {}
        for name in names:
            entry = written.entries[name]
            body = mapping_values.get_body(entry)
            output_id = f"{component_id}.{name}"
            inner = {key: each for key, each in body.entries.items() if key != "from"}
            outside = self._outside_readers.get(output_id)
            if outside is not None and "external" not in inner:
                inner |= {
                    key: outside.entries[key] for key in _SAID_OUTSIDE if key in outside.entries and key not in inner
                }
            inner |= {key: each for key, each in self._said_by_leaf.get(output_id, {}).items() if key not in inner}
            self._add_medium(output_id, inner, entry.key_span)
            entries[name] = MappingEntry(name, entry.key_span, MappingNode(inner, body.span))
        return MappingNode(entries, written.span)

    def _write_input(self, component_id: str, entry: MappingEntry) -> MappingNode:
        body = mapping_values.get_body(entry)
        port = ("input", f"{component_id}.{entry.key}")
        entries = dict(body.entries)
        references = list(self._list_references(component_id, port[1]))
        if references:
            key_span = entries["from"].key_span if "from" in entries else entry.key_span
            entries["from"] = MappingEntry("from", key_span, SequenceNode(list(references), references[0].span))
        outside = self._sources.find_outside(port)
        if not references and "from" in entries and self._sources.list_sources(port):
            # It reads an input around it that nothing in the project feeds: nothing else feeds it either.
            written = entries.pop("from")
            if "external" not in outside.entries:
                entries["from"] = MappingEntry("from", written.key_span, SequenceNode([], entry.key_span))
        if "external" not in entries:
            entries |= {
                key: outside.entries[key] for key in _SAID_OUTSIDE if key in outside.entries and key not in entries
            }
        return MappingNode(entries, body.span)

    def _list_references(self, component_id: str, input_id: str) -> Iterator[ScalarNode]:
        """Yield what an input names once its sources are leaves; what nobody resolves stays as it is written."""
        flat_id = self._flat_ids[component_id]
        seen: set[str] = set()
        for source in self._sources.list_sources(("input", input_id)):
            target = source.target
            if target.kind == "component" and target.id in self._linked.outline.components:
                texts = [self._flat_ids[target.id]]
            elif target.kind == "group" and not self._holds_shells(target.id):
                texts = [target.id]
            else:
                texts = [
                    self._name_output(each, flat_id) for each in self._sources.outputs_behind(target, component_id)
                ]
            for text in texts:
                if text not in seen:
                    seen.add(text)
                    yield ScalarNode(text, text, source.at)

    def _holds_shells(self, group_id: str) -> bool:
        return any(each in self._linked.outline.shells for each in self._linked.outline.members[group_id])

    def _name_output(self, output_id: str, reader_id: str) -> str:
        """Return how a component of a flat project names an output: with its group where that is another."""
        component_id, _, name = output_id.rpartition(".")
        flat_id = self._flat_ids[component_id]
        group_id, _, own_name = flat_id.partition(".")
        short = f"{own_name}.{name}"
        is_beside = group_id == reader_id.partition(".")[0] and short not in self._component_ids
        return short if is_beside else f"{flat_id}.{name}"

    def _list_said(self) -> Iterator[tuple[str, dict[str, MappingEntry]]]:
        """Yield what outputs of composed components say of what they pass on, by the leaf's output."""
        outline = self._linked.outline
        for shell_id, bodies in outline.given_outputs.items():
            for name, body in bodies.items():
                said = {key: body.entries[key] for key in _SAID_OF_OUTPUTS if key in body.entries}
                behind = self._sources.leaf_outputs_of(f"{shell_id}.{name}") if said else ()
                if len(behind) == 1 and behind[0] != f"{shell_id}.{name}":
                    yield behind[0], said

    def _add_medium(self, output_id: str, entries: dict[str, MappingEntry], place: Span) -> None:
        """Write the medium that an output has from what passes it on."""
        component_id, _, name = output_id.rpartition(".")
        output = self._linked.outline.outputs[component_id][name]
        if "medium" not in entries and output.medium != self._linked.outline.middleware:
            entries["medium"] = MappingEntry("medium", place, ScalarNode(output.medium, output.medium, place))
