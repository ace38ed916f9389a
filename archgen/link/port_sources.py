"""Find what each port takes its data from where components hold components: what is written, and what follows by itself.

Inputs take from outputs, from inputs of the component around them, from whole components and groups; outputs of composed
components pass on what stands inside. `outputs_behind` follows all of these down to the outputs of leaves.

Find the ports of composed components that nothing inside carries: there the design is not finished inside.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from archgen.compose.expanded_project import ComponentShell
from archgen.diagnostics import Span
from archgen.frozen import NamedTuple, replace
from archgen.link import mapping_values
from archgen.link.element_outline import ElementOutline
from archgen.link.reference_resolution import ReferenceResolver
from archgen.link.source_references import SourceReferences
from archgen.model.component import Output
from archgen.model.message_types import ConceptualType
from archgen.model.path_resolver import ElementRef
from archgen.model.port_media import flow_of_port, is_physical
from archgen.syntax.yaml_tree import MappingEntry, MappingNode

PortKey = tuple[str, str]
"""A port: `input` or `output`, and its complete id. An input and an output of a component may have one id."""


class PortSource(NamedTuple):
    """One thing that a port takes its data from."""

    target: ElementRef
    """An output, an input of the component around, or a whole component or group."""
    written: str
    at: Span
    is_made: bool = False
    """Whether `autoconnect` joined the two."""


class PortSources:
    """What each input, and each output of a composed component, takes its data from."""

    def __init__(
        self, outline: ElementOutline, resolver: ReferenceResolver, types: Mapping[str, ConceptualType]
    ) -> None:
        """Take what the project declares, the resolver of references, and the types, which say what is a message."""
        self.outline = outline
        self._resolver = resolver
        self._types = types
        self._references = SourceReferences(outline, resolver)
        self._sources: dict[PortKey, tuple[PortSource, ...]] = {}
        self._outputs_behind: dict[PortKey, tuple[str, ...]] = {}
        self.ambiguous_ports: set[PortKey] = set()
        """Ports that could be joined in several ways, which is reported: no rule calls them unfed besides."""

    def list_sources(self, port: PortKey) -> tuple[PortSource, ...]:
        """Return what a port takes its data from, each reference resolved once."""
        if port not in self._sources:
            self._sources[port] = tuple(self._resolve_written(port))
        return self._sources[port]

    def add_source(self, port: PortKey, source: PortSource) -> None:
        """Add what follows by itself to what a port takes its data from."""
        self._sources[port] = (*self.list_sources(port), source)

    def find_entry(self, port: PortKey) -> MappingEntry | None:
        """Return where an input is written; None for one that nobody declares."""
        component_id, _, name = port[1].rpartition(".")
        return self.outline.inputs.get(component_id, {}).get(name)

    def _resolve_written(self, port: PortKey) -> Iterator[PortSource]:
        kind, port_id = port
        component_id, _, name = port_id.rpartition(".")
        ports = (
            {key: mapping_values.get_body(entry) for key, entry in self.outline.inputs[component_id].items()}
            if kind == "input"
            else self.outline.given_outputs.get(component_id, {})
        )
        if name not in ports:
            return
        for reference in mapping_values.get_scalars(ports[name], "from"):
            target = (
                self._references.resolve_source(reference, component_id)
                if kind == "input"
                else self._references.resolve_given(reference, component_id)
            )
            if target is not None:
                yield PortSource(target, reference.text, reference.span)

    def resolve_feeders(self, component_id: str) -> Iterator[PortSource]:
        """Yield the components that an instance names as sources of all its inputs (`from` of the instance)."""
        entry = self.outline.components.get(component_id)
        body = mapping_values.get_body(entry or self.outline.shells[component_id].entry)
        for reference in mapping_values.get_scalars(body, "from"):
            target = self._references.resolve_source(reference, component_id)
            if target is not None and target.kind in {"component", "group"}:
                yield PortSource(target, reference.text, reference.span)
            elif target is not None:
                self._resolver.report(
                    "unknown-reference",
                    f"`from` of an instance names components: `{reference.text}` is an output",
                    reference.span,
                    help_line="write the output at the input that reads it",
                    element=component_id,
                )

    def outputs_behind(self, target: ElementRef, reader_id: str) -> tuple[str, ...]:
        """Return the outputs of leaves that something stands for: an output of a leaf for itself.

        Whole components and groups stand for all that carry messages, except the reader's own.
        """
        if target.kind == "output":
            return self._follow_output(target.id)
        if target.kind == "input":
            return self._follow_port(("input", target.id))
        outputs = self._list_message_outputs(target)
        behind = (leaf for output in outputs for leaf in self._follow_output(output))
        return tuple(dict.fromkeys(leaf for leaf in behind if leaf.rpartition(".")[0] != reader_id))

    def leaf_outputs_of(self, output_id: str) -> tuple[str, ...]:
        """Return the outputs of leaves behind an output; one that gives nothing on stands for itself."""
        return self._follow_output(output_id)

    def type_of_output(self, output_id: str) -> str | None:
        """Return the type of an output: as written, or that of what it passes on."""
        component_id, _, name = output_id.rpartition(".")
        written_type = self.outline.outputs[component_id][name].type
        if written_type or component_id not in self.outline.shells:
            return written_type
        behind = [leaf for leaf in self._follow_output(output_id) if leaf != output_id]
        return self.type_of_output(behind[0]) if behind else None

    def type_of_input(self, input_id: str) -> str | None:
        """Return the type of an input: as written, or that of the outputs that it reads."""
        entry = self.find_entry(("input", input_id))
        text = mapping_values.get_text(mapping_values.get_body(entry), "type") if entry else None
        if text:
            return mapping_values.normalise_type_name(text)
        behind = self._follow_port(("input", input_id))
        return self.type_of_output(behind[0]) if behind else None

    def _follow_output(self, output_id: str) -> tuple[str, ...]:
        """Return the outputs of leaves behind an output; one that gives nothing on stands for itself."""
        component_id = output_id.rpartition(".")[0]
        if component_id not in self.outline.shells:
            return (output_id,)
        return self._follow_port(("output", output_id)) or self._stand_for_itself(output_id)

    def _stand_for_itself(self, output_id: str) -> tuple[str, ...]:
        """Return an output of a composed component that nothing inside feeds; nothing for one that only passes on."""
        return () if self.list_sources(("output", output_id)) else (output_id,)

    def _follow_port(self, port: PortKey) -> tuple[str, ...]:
        """Return the outputs of leaves that feed a port.

        Without recursion: what only passes on may stand behind one another in thousands. What comes back to itself
        brings nothing new.
        """
        pending = [port]
        open_ports: set[PortKey] = set()
        while pending:
            current = pending[-1]
            if current in self._outputs_behind:
                pending.pop()
                continue
            asked_ports = [] if current in open_ports else self._list_asked_ports(current)
            unknown_ports = [
                each for each in asked_ports if each not in self._outputs_behind and each not in open_ports
            ]
            open_ports.add(current)
            if unknown_ports:
                pending += unknown_ports
                continue
            component_id = current[1].rpartition(".")[0]
            behind = (
                output
                for source in self.list_sources(current)
                for output in self._find_known_outputs(source.target, component_id)
            )
            self._outputs_behind[current] = tuple(dict.fromkeys(behind))
            pending.pop()
        return self._outputs_behind[port]

    def _list_asked_ports(self, port: PortKey) -> list[PortKey]:
        """Return the ports of composed components that what feeds a port stands behind."""
        asked_ports: list[PortKey] = []
        for source in self.list_sources(port):
            target = source.target
            if target.kind == "input":
                asked_ports.append(("input", target.id))
            elif target.kind == "output":
                asked_ports += [("output", target.id)] if self._is_shell_port(target.id) else []
            else:
                asked_ports += [
                    ("output", output.id)
                    for member in self._list_members(target)
                    if member in self.outline.shells
                    for output in self.outline.outputs[member].values()
                ]
        return asked_ports

    def _find_known_outputs(self, target: ElementRef, reader_id: str) -> tuple[str, ...]:
        """Return what stands behind something of which all asked ports are known, or come back to themselves."""
        if target.kind == "input":
            return self._outputs_behind.get(("input", target.id), ())
        if target.kind == "output" and self._is_shell_port(target.id):
            return self._outputs_behind.get(("output", target.id), ()) or self._stand_for_itself(target.id)
        return self.outputs_behind(target, reader_id)

    def _is_shell_port(self, port_id: str) -> bool:
        return port_id.rpartition(".")[0] in self.outline.shells

    def find_outside(self, port: PortKey) -> MappingNode:
        """Return what an input of a composed component around says of where it comes from outside of the system."""
        seen_ports: set[PortKey] = set()
        current: PortKey | None = port
        while current is not None and current not in seen_ports:
            seen_ports.add(current)
            entry = self.find_entry(current)
            body = mapping_values.get_body(entry) if entry else mapping_values.EMPTY_MAPPING
            if body.get("external") is not None:
                return body
            targets = (source.target for source in self.list_sources(current))
            current = next((("input", target.id) for target in targets if target.kind == "input"), None)
        return mapping_values.EMPTY_MAPPING

    def list_given_outside(self) -> dict[str, MappingNode]:
        """Return what outputs of composed components say of who reads them outside, by the leaf's output that they pass on."""
        given: dict[str, MappingNode] = {}
        for shell_id, bodies in self.outline.given_outputs.items():
            for name, body in bodies.items():
                if body.get("external") is not None:
                    given.update(dict.fromkeys(self._follow_output(f"{shell_id}.{name}"), body))
        return given

    def spread_media(self) -> None:
        """Hand media on between an output and the port that passes it on, in both directions: to the one that has none."""
        for name, shell_id, body in self._list_given_outputs():
            if mapping_values.get_medium(body, "medium"):
                medium = self.outline.outputs[shell_id][name].medium
                for leaf in self._find_given(shell_id, name):
                    if not leaf.medium_written:
                        self.outline.outputs[leaf.component][leaf.name] = replace(leaf, medium=medium)
        for name, shell_id, body in self._list_given_outputs():
            words = {leaf.medium for leaf in self._find_given(shell_id, name)}
            if mapping_values.get_medium(body, "medium") is None and len(words) == 1:
                outputs = self.outline.outputs[shell_id]
                outputs[name] = replace(outputs[name], medium=min(words))
        # Which outputs a whole component stands for hangs on their media.
        self.forget_outputs()

    def _list_given_outputs(self) -> Iterator[tuple[str, str, MappingNode]]:
        """Yield the outputs of composed components as written: name, component, and what is written."""
        for shell_id, bodies in self.outline.given_outputs.items():
            yield from ((name, shell_id, body) for name, body in bodies.items())

    def _find_given(self, shell_id: str, name: str) -> Iterator[Output]:
        """Yield the outputs of leaves that an output of a composed component passes on."""
        for leaf_id in self._follow_output(f"{shell_id}.{name}"):
            component_id, _, leaf_name = leaf_id.rpartition(".")
            if component_id != shell_id:
                yield self.outline.outputs[component_id][leaf_name]

    def forget_outputs(self) -> None:
        """Forget what was followed: sources were added since."""
        self._outputs_behind.clear()

    def _list_message_outputs(self, target: ElementRef) -> Iterator[str]:
        for component_id in self._list_members(target):
            for output in self.outline.outputs[component_id].values():
                output_type = self._types.get(self.type_of_output(output.id) or "")
                if not is_physical(output) and flow_of_port(output, output_type) == "topic":
                    yield output.id

    def _list_members(self, target: ElementRef) -> list[str]:
        return [target.id] if target.kind == "component" else self.outline.members[target.id]


class OpenShells:
    """Which ports of composed components are carried inside, and which count as a leaf's."""

    def __init__(self, outline: ElementOutline, sources: PortSources) -> None:
        """Take what the project declares, and what its ports take their data from."""
        self._outline = outline
        self._sources = sources
        self._readers: dict[str, list[str]] = {}
        for reader in self._list_inner_ports():
            for source in sources.list_sources(reader):
                if source.target.kind == "input":
                    self._readers.setdefault(source.target.id, []).append(reader[1])
        self._open_shells: dict[str, list[ComponentShell]] = {}
        for shell in outline.shells.values():
            if any(map(self.is_open, self._list_ports(shell))):
                self._open_shells.setdefault(shell.group, []).append(shell)

    def is_open(self, port: PortKey) -> bool:
        """Whether nothing inside reads an input, or feeds an output."""
        if port[0] == "input":
            return port[1] not in self._readers
        return not self._sources.list_sources(port)

    def list_in_group(self, group_id: str) -> Sequence[ComponentShell]:
        """Return the composed components of a group that have open ports."""
        return self._open_shells.get(group_id, ())

    def list_carried_ports(self) -> dict[str, tuple[str, ...]]:
        """Return what stands behind each port: the outputs that an output passes on, the ports that read an input."""
        carried: dict[str, tuple[str, ...]] = {}
        for shell in self._outline.shells.values():
            for kind, port_id in self._list_ports(shell):
                behind = (
                    tuple(self._readers.get(port_id, ()))
                    if kind == "input"
                    else tuple(source.target.id for source in self._sources.list_sources((kind, port_id)))
                )
                carried[f"{kind} {port_id}"] = behind
        return carried

    def _list_ports(self, shell: ComponentShell) -> Iterator[PortKey]:
        yield from (("input", f"{shell.id}.{name}") for name in self._outline.inputs[shell.id])
        yield from (("output", f"{shell.id}.{name}") for name in self._outline.outputs[shell.id])

    def _list_inner_ports(self) -> Iterator[PortKey]:
        for component_id, inputs in self._outline.inputs.items():
            yield from (("input", f"{component_id}.{name}") for name in inputs)
        for shell in self._outline.shells.values():
            yield from (("output", f"{shell.id}.{name}") for name in self._outline.outputs[shell.id])
