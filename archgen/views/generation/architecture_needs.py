"""What a generator takes for granted (`needs` of its manifest): of an architecture, of keys and values, and of names."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Callable, Iterable, Iterator, Mapping

from archgen.diagnostics import Diagnostic, Label, Rule, Severity, Span, first_written_span
from archgen.model.architecture import Architecture
from archgen.model.component import Component, Input, Output
from archgen.views.generation.component_records import (
    SetParameter,
    list_parameter_tags,
    list_set_parameters,
    name_program_tag,
    name_tag,
)
from archgen.views.generation.generation_context import NOT_GENERATED, GenerationContext
from archgen.views.records.record_sources import to_plain

UNMET_NEED = Rule(
    "unmet-need",
    Severity.ERROR,
    "A generator takes something for granted that does not hold.",
    fixed=True,
)
"""What `archgen generate` says where `needs` of a backend do not hold. `archgen check` never says it."""
GENERATION_RULES = (NOT_GENERATED, UNMET_NEED)


def find_unmet_needs(context: GenerationContext, needs: tuple[str, ...]) -> Iterator[Diagnostic]:
    """Yield what of the `needs` of a backend does not hold."""
    for need in needs:
        yield from _FINDERS[need](context)


def _find_composed(context: GenerationContext) -> Iterator[Diagnostic]:
    for shell in context.architecture.shells.values():
        yield _diagnose_need(
            f"`{shell.id}` holds components, and what is generated here knows no components inside of others",
            shell.id,
            context.architecture,
            help_line="`archgen transform flatten -o flat.yaml` makes a project without; generate from that",
        )


def _find_generics(context: GenerationContext) -> Iterator[Diagnostic]:
    """Yield the component types and types of data that stand for many."""
    architecture = context.architecture
    generic_types = [
        *((each.id, each.at) for each in architecture.component_types.values() if each.generic),
        *((each.name, each.at) for each in architecture.types.values() if each.generic),
    ]
    for name, span in generic_types:
        yield Diagnostic(
            UNMET_NEED.name,
            f"`{name}` stands for many types, and what is generated here knows no such types",
            span,
            UNMET_NEED.severity,
            help="`archgen transform remove_generics -o plain.yaml` makes a project without; generate from that",
            element=name,
        )


def _find_several_sources(context: GenerationContext) -> Iterator[Diagnostic]:
    architecture = context.architecture
    for component_id in context.wanted_components:
        for port in architecture.components[component_id].inputs.values():
            outputs = list(dict.fromkeys(output for each in port.connections for output in each.outputs))
            if len(outputs) > 1:
                named_outputs = " and ".join(f"`{each}`" for each in outputs[:3])
                labels = tuple(Label(each.at, "a source") for each in port.connections[1:])
                yield Diagnostic(
                    UNMET_NEED.name,
                    f"`{port.id}` has {len(outputs)} sources, {named_outputs}{', ...' if len(outputs) > 3 else ''}: "  # noqa: PLR2004
                    "what is generated here knows one",
                    first_written_span(port.connections[0].at, port.at),
                    UNMET_NEED.severity,
                    labels=labels,
                    help="give it an input for each source, or put a component between that joins them",
                    element=port.id,
                )


def _find_repeated_names(context: GenerationContext) -> Iterator[Diagnostic]:
    architecture = context.architecture
    first_ids = dict[str, str]()
    for component in architecture.list_described_components():
        first_id = first_ids.setdefault(component.name, component.id)
        if first_id != component.id:
            first = architecture.find_component(first_id)
            yield _diagnose_need(
                f"`{first_id}` and `{component.id}` are both called `{component.name}`, and what is generated here knows "
                "components by their last names",
                component.id,
                architecture,
                help_line="give one of them another id; `archgen transform flatten -o flat.yaml` gives names of their own",
                labels=(Label(first.at, "the first one"),) if first else (),
            )


def _diagnose_need(
    message: str, component_id: str, architecture: Architecture, *, help_line: str, labels: tuple[Label, ...] = ()
) -> Diagnostic:
    component = architecture.find_component(component_id)
    assert component is not None  # noqa: S101 - both callers have it from the architecture
    return Diagnostic(
        UNMET_NEED.name, message, component.at, UNMET_NEED.severity, labels=labels, help=help_line, element=component_id
    )


_FINDERS: Mapping[str, Callable[[GenerationContext], Iterator[Diagnostic]]] = {
    "flat": _find_composed,
    "no_generics": _find_generics,
    "one_source": _find_several_sources,
    "unique_names": _find_repeated_names,
    "distinct_tags": lambda context: find_unfit_tags(context, UNMET_NEED),
    "one_line_values": lambda context: find_unfit_values(context, UNMET_NEED),
}


_TAG = re.compile(r"[A-Za-z][A-Za-z0-9_-]*\Z")
_LINE_BREAKING = frozenset(("Cc", "Cs", "Zl", "Zp"))
"""Categories of characters that end a line somewhere, or that no file of text holds."""
_SUBSTITUTION_MARK = "$("


def find_unfit_tags(context: GenerationContext, rule: Rule) -> Iterator[Diagnostic]:
    """Yield tags that are no words, and those that two ports or parameters of one component share."""
    for component_id in context.wanted_components:
        component = context.architecture.components[component_id]
        yield from _judge_tags([(name_program_tag(component, context.backend), component.id, component.at)], rule)
        yield from _judge_tags(_list_port_tags(component.outputs, context.backend), rule)
        yield from _judge_tags(_list_port_tags(component.inputs, context.backend), rule)
        yield from _judge_tags(_list_value_tags(context, component), rule)


def _list_port_tags(ports: Mapping[str, Input | Output], backend: str) -> Iterator[tuple[str, str, Span]]:
    return ((name_tag(each.annotations.hints, backend, each.name), each.id, each.at) for each in ports.values())


def _list_value_tags(context: GenerationContext, component: Component) -> Iterator[tuple[str, str, Span]]:
    for each in _list_parameters(context, component):
        span = first_written_span(each.declaration.at if each.declaration else each.at, component.at)
        yield ".".join(list_parameter_tags(each, context.backend)), f"{component.id} {'.'.join(each.path)}", span


def _judge_tags(tags: Iterable[tuple[str, str, Span]], rule: Rule) -> Iterator[Diagnostic]:
    first_elements: dict[str, tuple[str, Span]] = {}
    for tag, element, span in tags:
        owner = element.partition(" ")[0]
        if not all(_TAG.match(each) for each in tag.split(".")):
            yield Diagnostic(
                rule.name,
                f"the tag of `{element}` is no word: letters, digits, `_` and `-`, a letter first",
                span,
                rule.severity,
                help="give it another `tag` in its hints",
                element=owner,
            )
        first_element, first_span = first_elements.setdefault(tag, (element, span))
        if first_element != element:
            yield Diagnostic(
                rule.name,
                f"`{first_element}` and `{element}` have the same tag `{tag}`",
                span,
                rule.severity,
                labels=(Label(first_span, "the first one"),),
                help="give one of them another `tag` in its hints, or another name",
                element=owner,
            )


def find_unfit_values(context: GenerationContext, rule: Rule) -> Iterator[Diagnostic]:
    """Yield values of parameters that no line of a file can hold."""
    for component_id in context.wanted_components:
        component = context.architecture.components[component_id]
        for each in _list_parameters(context, component):
            fault = _find_value_fault(to_plain(each.value))
            if fault:
                yield Diagnostic(
                    rule.name,
                    f"the value of `{'.'.join(each.path)}` of `{component.id}` {fault[0]}",
                    first_written_span(each.at, component.at),
                    rule.severity,
                    help=fault[1],
                    element=component.id,
                )


def _list_parameters(context: GenerationContext, component: Component) -> Iterator[SetParameter]:
    node = context.nodes_by_component.get(component.id)
    return list_set_parameters(context.architecture, component, node)


def _find_value_fault(value: object) -> tuple[str, str] | None:
    """Return what is wrong with a value, and what to do about it; None where nothing is."""
    if not isinstance(value, list):
        return find_text_fault(value) if isinstance(value, str) else None
    if any(isinstance(each, str) and '"' in each for each in value):
        return "has a double quote in a list, where texts stand in double quotes", "write it without"
    if any(isinstance(each, list | dict) for each in value):
        return "is a list of more than texts and numbers, which has no line of its own", "make sets of parameters of it"
    return next(filter(None, map(_find_value_fault, value)), None)


def find_text_fault(text: str) -> tuple[str, str] | None:
    """Return what is wrong with a text that is to stand on one line, and what to do about it; None where nothing is."""
    if any(unicodedata.category(character) in _LINE_BREAKING for character in text):
        return "has a line break or a control character, and stands on one line of a file", "write it without"
    if _SUBSTITUTION_MARK in text:
        return "is filled in by a launch file, and nothing fills it in here", "give a value"
    return None


def find_name_clashes(names: Iterable[tuple[str, str, Span]], meaning: str) -> Iterator[Diagnostic]:
    """Yield a finding for each element whose generated name another one has, also on systems that ignore case.

    `names` are the generated name of each element, its id, and its place; `meaning` says what they name: `class`.
    """
    first_elements = dict[str, tuple[str, Span]]()
    for name, element, span in names:
        first_element, first_span = first_elements.setdefault(name.casefold(), (element, span))
        if first_element != element:
            yield Diagnostic(
                NOT_GENERATED.name,
                f"`{first_element}` and `{element}` give the same {meaning} `{name}`",
                span,
                NOT_GENERATED.severity,
                labels=(Label(first_span, "the first one"),),
                help="give one of them another id",
                element=element,
            )
