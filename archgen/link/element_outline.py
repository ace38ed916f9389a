"""List the groups, components and ports of the merged project, before any reference is resolved."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping

from archgen.compose import ExpandedProject
from archgen.compose.expanded_project import ComponentShell
from archgen.diagnostics import Diagnostic, did_you_mean
from archgen.frozen import dataclass, field
from archgen.link import mapping_values
from archgen.link.link_memory import LinkMemory, OutlinedPorts
from archgen.link.promise_reading import read_deprecation, read_promise
from archgen.link.value_readers import read_values
from archgen.model.component import Output
from archgen.model.port_media import ROS
from archgen.syntax.yaml_tree import MappingEntry, MappingNode

_PROMISING_KEYS = frozenset({"promise", "version", "deprecated"})


@dataclass(slots=True)
class ElementOutline:
    """What the project declares on its high level. Inputs stay as written: what feeds them is not known yet."""

    groups: dict[str, MappingEntry] = field(default_factory=dict)
    components: dict[str, MappingEntry] = field(default_factory=dict)
    """Leaves by complete id."""
    expansion: ExpandedProject | None = None
    """What components are made from and stand in; None where none is composed or an instance."""
    outputs: dict[str, dict[str, Output]] = field(default_factory=dict)
    """By component id and name, those of composed components included."""
    given_outputs: dict[str, dict[str, MappingNode]] = field(default_factory=dict)
    """The outputs of composed components as written, by component id and name."""
    inputs: dict[str, dict[str, MappingEntry]] = field(default_factory=dict)
    """By component id and name, those of composed components included."""
    undeclared_inputs: list[tuple[str, MappingEntry]] = field(default_factory=list)
    """Inputs that `to` at an output names and nobody declares, with their components."""
    middleware: str = ROS
    """What digital ports travel over where they do not say."""
    promises_something: bool = False
    """Whether an output has a promise, a version, or is deprecated."""
    diagnostics: list[Diagnostic] = field(default_factory=list)
    """What is wrong with promises."""
    members: dict[str, list[str]] = field(default_factory=dict)
    """The components that stand directly in each group, leaves first, by complete ids."""

    @property
    def shells(self) -> Mapping[str, ComponentShell]:
        """The composed components by complete id, outer ones first."""
        return self.expansion.shells if self.expansion else {}

    @property
    def port_names(self) -> Mapping[str, Mapping[str, Collection[str]]]:
        """The names of the ports by kind (`input`, `output`) and component id."""
        return {"input": self.inputs, "output": self.outputs}

    def list_inside(self, component_id: str) -> Iterator[str]:
        """Yield all that a composed component holds, leaves and composed ones, by complete ids. A leaf holds nothing."""
        shell = self.shells.get(component_id)
        for child_id in shell.children if shell else ():
            if child_id in self.inputs:
                yield child_id
                yield from self.list_inside(child_id)

    def list_outputs(self) -> Iterator[Output]:
        """Iterate over every output, those of composed components included."""
        for outputs in self.outputs.values():
            yield from outputs.values()

    def list_used_types(self) -> Iterator[str]:
        """Yield the types that ports mention, with repetitions."""
        for component, outputs in self.outputs.items():
            for entry in self.inputs[component].values():
                type_text = mapping_values.get_text(mapping_values.get_body(entry), "type")
                if type_text:
                    yield mapping_values.normalise_type_name(type_text)
            yield from (output.type for output in outputs.values() if output.type)


def build_outline(expansion: ExpandedProject, memory: LinkMemory | None = None) -> ElementOutline:
    """Return the outline of a merged project in which all types are written out, by complete ids.

    Ports of components that `memory` knows are taken over, where no component holds others.
    """
    if not expansion.is_plain:
        memory = None
    project = mapping_values.get_mapping(expansion.root, "project")
    element_outline = ElementOutline(
        expansion=None if expansion.is_plain else expansion,
        middleware=mapping_values.get_medium(project, "middleware") or ROS,
    )
    members = element_outline.members
    for group_id, entry, body in mapping_values.iterate_elements(expansion.root, "groups"):
        element_outline.groups[group_id] = entry
        members[group_id] = []
        for path, component, component_body in mapping_values.iterate_elements(body, "components"):
            component_id = f"{group_id}.{path}"
            element_outline.components[component_id] = component
            if component_id not in expansion.parents:
                members[group_id].append(component_id)
            if memory is None:
                _outline_ports(element_outline, component_id, component_body)
            else:
                _recall_ports(element_outline, component_id, component_body, memory)
    # Behind all leaves: `members` lists these first.
    for shell in expansion.shells.values():
        body = mapping_values.get_body(shell.entry)
        if shell.parent is None:
            members[shell.group].append(shell.id)
        _outline_ports(element_outline, shell.id, body)
        element_outline.given_outputs[shell.id] = {
            name: output_body for name, _, output_body in mapping_values.iterate_elements(body, "outputs")
        }
    return element_outline


def diagnose_undeclared_inputs(outline: ElementOutline) -> Iterator[Diagnostic]:
    """Report what `to` names and no component has."""
    for component_id, entry in outline.undeclared_inputs:
        yield Diagnostic(
            "unknown-reference",
            f"no input `{entry.key}` in `{component_id}`",
            entry.key_span,
            help=did_you_mean(entry.key, outline.inputs[component_id]) or "`to` declares no input: write it there",
            element=component_id,
        )


def _recall_ports(element_outline: ElementOutline, component_id: str, body: MappingNode, memory: LinkMemory) -> None:
    """Outline the ports of a component, those that are known from another version without making them anew."""
    middleware = element_outline.middleware
    for known in memory.ports.list_known(component_id):
        # By identity: the tree of a file that did not change is the same object in both versions.
        if known.body is body and known.middleware == middleware:
            element_outline.inputs[component_id], element_outline.outputs[component_id] = known.inputs, known.outputs
            return
    _outline_ports(element_outline, component_id, body)
    inputs, outputs = element_outline.inputs[component_id], element_outline.outputs[component_id]
    is_plain = len(inputs) == len(mapping_values.get_mapping(body, "inputs").entries) and all(
        _PROMISING_KEYS.isdisjoint(mapping_values.get_body(entry).entries)
        for entry in mapping_values.get_mapping(body, "outputs")
    )
    if is_plain:  # nothing else is noted of it
        memory.ports.keep_part(component_id, OutlinedPorts(body, middleware, inputs, outputs))


def _outline_ports(element_outline: ElementOutline, component_id: str, body: MappingNode) -> None:
    element_outline.inputs[component_id] = {
        e.key: e for e in mapping_values.get_mapping(body, "inputs") if mapping_values.get_body(e).declares
    }
    if len(element_outline.inputs[component_id]) < len(mapping_values.get_mapping(body, "inputs").entries):
        undeclared_entries = (
            e for e in mapping_values.get_mapping(body, "inputs") if not mapping_values.get_body(e).declares
        )
        element_outline.undeclared_inputs += [(component_id, entry) for entry in undeclared_entries]
    element_outline.outputs[component_id] = {
        e.key: _declare_output(element_outline, component_id, e) for e in mapping_values.get_mapping(body, "outputs")
    }


def _declare_output(element_outline: ElementOutline, component: str, entry: MappingEntry) -> Output:
    body = mapping_values.get_body(entry)
    said = read_values("output", Output, body)
    if not _PROMISING_KEYS.isdisjoint(body.entries):
        element_outline.promises_something = True
        said["promise"] = read_promise(body, component, element_outline.diagnostics)
        said["deprecated"] = read_deprecation(body, component, element_outline.diagnostics)
    return Output(
        id=f"{component}.{entry.key}",
        name=entry.key,
        component=component,
        medium=mapping_values.get_medium(body, "medium") or element_outline.middleware,
        medium_written=mapping_values.get_medium(body, "medium") is not None,
        at=entry.key_span,
        **said,
    )
