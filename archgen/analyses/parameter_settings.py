"""Are the parameters that nodes are given those that their components declare, and has each one a value?"""

from __future__ import annotations

from collections.abc import Iterator

from archgen.derivation.wire.running_state import CLOCK_PARAMETER
from archgen.diagnostics import NO_SPAN, Diagnostic, Label, Severity, Span, did_you_mean, join_words
from archgen.model.architecture import Architecture
from archgen.model.component import Component
from archgen.model.node import Node, PortUse
from archgen.model.parameter import Parameter, ParameterValue
from archgen.model.parameter_values import (
    canonical_name,
    find_declarations,
    find_effective_parameters,
    find_value_fault,
    is_open_parameter,
    is_ros_parameter,
    list_node_components,
)
from archgen.model.ros_distro import is_ros_1

_GUESS_BUDGET = 1_000_000
"""Names that unknown ones are compared with, in all: 20,000 unknown ones among 50,000 would take minutes."""
_STANDARD_PARAMETERS = {CLOCK_PARAMETER: Parameter(CLOCK_PARAMETER, type="boolean")}
"""What each node of ROS 2 declares by itself; with a value of another type it ends as it starts."""
_MAX_SHOWN = 6
"""Parameters that one finding names."""


def unknown_parameter(architecture: Architecture) -> Iterator[Diagnostic]:
    """A node is given a parameter that none of its components declares, or an instance one that its type does not."""
    judges = [_NodeJudge(architecture, node) for node in architecture.nodes.values()]
    known_values: set[tuple[str, Span]] = set()
    unknown_values: dict[tuple[str, Span], tuple[_NodeJudge, ParameterValue]] = {}
    for judge in judges:
        # A file may give to many nodes what only one of them knows.
        for value in judge.node.file_values:
            key = (value.name, value.name_at)
            if judge.may_know(value.name):
                known_values.add(key)
            else:
                unknown_values.setdefault(key, (judge, value))
    findings = [(judge, value) for judge in judges for value in judge.node.own_values if not judge.may_know(value.name)]
    findings += [finding for key, finding in unknown_values.items() if key not in known_values]
    guess_count = 0
    for judge, value in findings:
        guess_count += judge.declaration_count
        yield judge.report_unknown(value, may_guess=guess_count <= _GUESS_BUDGET)
    for component in architecture.list_described_components():
        yield from _find_unknown_settings(architecture, component)


def _find_unknown_settings(architecture: Architecture, component: Component) -> Iterator[Diagnostic]:
    """Yield the parameters that an instance sets and its type does not declare: it changes values only."""
    component_type = architecture.component_types.get(component.type_name)
    if component_type is None or not component_type.parameters or component.parameters == component_type.parameters:
        return
    ros_1 = is_ros_1(architecture.distro)
    for name, parameter in component.parameters.items():
        is_known = name in component_type.parameters or is_ros_parameter(name, ros_1=ros_1)
        if not is_known and not is_open_parameter(name, (component,)):
            yield Diagnostic(
                "unknown-parameter",
                f"`{component.id}` sets the parameter `{name}`, which its type `{component_type.id}` does not declare",
                parameter.at,
                labels=(Label(component_type.at, "the type"),),
                help=did_you_mean(name, component_type.parameters)
                or "declare it at the type, or write the name of its set into `open`",
                element=component.id,
            )


class _NodeJudge:
    """What the components of one node declare."""

    def __init__(self, architecture: Architecture, node: Node) -> None:
        self.node = node
        self._ros_1 = is_ros_1(architecture.distro)
        self._components = list_node_components(architecture, node)
        self._declarations = find_declarations(architecture, node)
        self._is_judged = bool(self._components) and all(component.parameters for component in self._components)

    @property
    def declaration_count(self) -> int:
        """How many names a guess is made among."""
        return len(self._declarations)

    def may_know(self, written_name: str) -> bool:
        """Whether a parameter is declared, open or ROS's own, or a component declares none at all."""
        if not self._is_judged:
            return True
        name = canonical_name(written_name, ros_1=self._ros_1)
        return (
            name in self._declarations
            or is_ros_parameter(name, ros_1=self._ros_1)
            or is_open_parameter(name, self._components)
        )

    def report_unknown(self, value: ParameterValue, *, may_guess: bool) -> Diagnostic:
        name = canonical_name(value.name, ros_1=self._ros_1)
        names = [f"`{component.id}`" for component in self._components[:_MAX_SHOWN]]
        whose = f"{names[0]} does not declare" if len(names) == 1 else f"none of {join_words(names)} declares"
        return Diagnostic(
            "unknown-parameter",
            f"`{self.node.id}` is given the parameter `{name}`, which {whose}",
            value.name_at,
            labels=(Label(self._components[0].at, "the component"),),
            help=(did_you_mean(name, self._declarations) if may_guess else None)
            or "declare it at the component, or write the name of its set into `open`",
            element=self.node.id,
        )


def wrong_parameter(architecture: Architecture) -> Iterator[Diagnostic]:
    """A parameter is given a value that it cannot have: of another type, outside of its range, or none of its choices."""
    # Composed components first: a value that they hand in is one slip, however many take it.
    reported_values: set[Span] = set()
    for component in architecture.list_described_components():
        for parameter in component.parameters.values():
            if parameter.handed_from is None or parameter.value_at not in reported_values:
                for finding in _judge_value(parameter, parameter.value, parameter.value_at, component.id):
                    reported_values.add(parameter.value_at)
                    yield finding
    # What every node is given is one slip, whoever declares it.
    seen_places: set[tuple[str, Span]] = set()
    ros_1 = is_ros_1(architecture.distro)
    for node in architecture.nodes.values():
        declarations = {**({} if ros_1 else _STANDARD_PARAMETERS), **find_declarations(architecture, node)}
        for value in (*architecture.ros_parameters, *node.file_values, *node.own_values):
            name = canonical_name(value.name, ros_1=ros_1)
            if name not in declarations or (name, value.at) in seen_places:
                continue
            for finding in _judge_value(declarations[name], value.value, value.at, node.id):
                seen_places.add((name, value.at))
                yield finding


def _judge_value(parameter: Parameter, value: object, span: Span, element: str) -> Iterator[Diagnostic]:
    fault = find_value_fault(parameter, value)
    if fault is None:
        return
    labels = () if parameter.at == NO_SPAN or span == parameter.value_at else (Label(parameter.at, "declared here"),)
    is_inferred = parameter.type is None and " is no " in fault
    help_line = "write `type` at its declaration, if that of its value is not meant" if is_inferred else None
    yield Diagnostic(
        "wrong-parameter",
        f"the parameter `{parameter.name}` of `{element}` cannot have this value: {fault}",
        span,
        labels=labels,
        help=help_line,
        element=element,
    )


def unset_parameter(architecture: Architecture) -> Iterator[Diagnostic]:
    """A parameter has no value: neither its component nor a node gives it one."""
    for node in architecture.nodes.values():
        # A program that exists may take from its command line what it wants, as robot_state_publisher does.
        is_told_otherwise = node.unread_files or (node.status == "existing" and node.arguments)
        if is_told_otherwise or not any(map(_needs_value, find_declarations(architecture, node).values())):
            continue
        unset_names = [
            name
            for name, each in find_effective_parameters(architecture, node).items()
            if each.origin == "none" and each.declaration is not None and _needs_value(each.declaration)
        ]
        if unset_names:
            yield _report_unset(architecture, node, unset_names)
    connected_inputs = {edge.input for edge in architecture.edges}
    for node in architecture.nodes.values():
        for use in node.uses:
            is_nameless = use.named_by is not None and not use.topics and not use.own_name
            if is_nameless and use.port in connected_inputs and not node.unread_files:
                yield from _find_nameless_input(architecture, node, use)


def _find_nameless_input(architecture: Architecture, node: Node, use: PortUse) -> Iterator[Diagnostic]:
    """Report an input that something feeds, where the parameter that names its topic is not given."""
    name = use.named_by or ""
    if not {"*", "{"}.intersection(name) and name not in find_effective_parameters(architecture, node):
        message = (
            f"something feeds `{use.port}`, but `{node.id}` reads it only where its parameter `{name}` names a topic"
        )
        help_line = f"write it at the node: `parameters: {{{name}: ...}}`"
        yield Diagnostic("unset-parameter", message, node.at, help=help_line, element=node.id)


def _needs_value(parameter: Parameter) -> bool:
    """Whether a node has to give the value: the component neither has one nor is handed one."""
    return parameter.value is None and parameter.handed_from is None


def _report_unset(architecture: Architecture, node: Node, names: list[str]) -> Diagnostic:
    declarations = find_declarations(architecture, node)
    shown_names = [f"`{name}`" for name in names[:_MAX_SHOWN]]
    if len(names) > _MAX_SHOWN:
        shown_names.append(f"{len(names) - _MAX_SHOWN} more")
    words = f"the parameter{'s' if len(names) > 1 else ''} {join_words(shown_names)}"
    if not node.written:
        # Nobody has decided yet which node it is: one may give the value.
        component = node.implements[0]
        return Diagnostic(
            "unset-parameter",
            f"nobody gives a value to {words} of `{component}`",
            declarations[names[0]].at,
            Severity.NOTE,
            help=f"write it at the declaration, or at a node: `parameters: {{{names[0]}: ...}}`",
            element=component,
        )
    return Diagnostic(
        "unset-parameter",
        f"nobody gives a value to {words} of the node `{node.id}`",
        node.at,
        labels=(Label(declarations[names[0]].at, "declared here"),),
        help=f"write it at the {_find_writer(architecture, node)}: `parameters: {{{names[0]}: ...}}`",
        element=node.id,
    )


def _find_writer(architecture: Architecture, node: Node) -> str:
    """Return where the parameters of a node are written: at the component that brings it along, else at itself."""
    components = [architecture.components[name] for name in node.implements if name in architecture.components]
    return "component" if any(component.at == node.at for component in components) else "node"


def unused_parameter_file(architecture: Architecture) -> Iterator[Diagnostic]:
    """A parameter file that a node names says nothing to it, or cannot be read."""
    for node in architecture.nodes.values():
        if node.file_remarks and any(each.parameters for each in list_node_components(architecture, node)):
            for remark in node.file_remarks:
                yield Diagnostic("unused-parameter-file", remark.message, remark.at, help=remark.help, element=node.id)


RULES = (
    (unknown_parameter, Severity.WARNING),
    (wrong_parameter, Severity.ERROR),
    (unset_parameter, Severity.WARNING),
    (unused_parameter_file, Severity.NOTE),
)
