"""What files of keys and values take for granted (`needs` of a manifest): tags that differ, and values on one line."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterable, Iterator, Mapping

from archgen.diagnostics.diagnostic import Diagnostic, Label, Rule
from archgen.diagnostics.source_span import Span, first_written_span
from archgen.model.component import Component, Input, Output
from archgen.views.generation.component_records import (
    SetParameter,
    list_parameter_tags,
    list_set_parameters,
    name_program_tag,
    name_tag,
)
from archgen.views.generation.generation_context import GenerationContext
from archgen.views.records.record_sources import to_plain

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
