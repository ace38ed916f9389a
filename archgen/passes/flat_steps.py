"""The steps of use cases once the components around others are gone: each runs between leaves that are connected."""

from __future__ import annotations

from collections.abc import Mapping

from archgen.diagnostics.source_span import Span
from archgen.link import mapping_values
from archgen.model.architecture import Architecture
from archgen.model.step_connections import StepConnection, StepConnections
from archgen.model.use_case_steps import Step, StepEnd
from archgen.syntax.yaml_tree import MappingEntry, MappingNode, ScalarNode, SequenceNode, YamlNode


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
        cases: dict[str, MappingEntry] = {}
        for case in mapping_values.get_body(section):
            cases[case.key] = case
            body = mapping_values.get_body(case)
            steps = body.get("steps")
            if isinstance(steps, SequenceNode):
                items = [self._rewrite_step(each) for each in steps.items]
                written = MappingEntry("steps", body.entries["steps"].key_span, SequenceNode(items, steps.span))
                value = MappingNode({**body.entries, "steps": written}, body.span)
                cases[case.key] = MappingEntry(case.key, case.key_span, value)
        return MappingEntry(section.key, section.key_span, MappingNode(cases, section.value.span))

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
                entries[key] = MappingEntry(key, entries[key].key_span, scalar)
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
