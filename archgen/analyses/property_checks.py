"""Are the properties of elements what the project says that they are, and is each one there that it asks for?"""

from __future__ import annotations

from collections.abc import Iterator

from archgen.diagnostics import Diagnostic, Label, Severity, Span, find_closest, join_words
from archgen.model.architecture import AnnotatedElement, Architecture, list_annotated_elements
from archgen.model.element_annotations import PropertyDeclaration, find_property_fault, shorten_value


def wrong_property(architecture: Architecture) -> Iterator[Diagnostic]:
    """A property is not what the project declares: on another kind of element, of another type, or outside of its
    range.
    """
    if not architecture.properties:
        return
    judged_places: set[Span] = set()
    for each in list_annotated_elements(architecture):
        annotations = each.element.annotations
        for name, text in annotations.properties.items():
            # What instances have of their type is one slip.
            place = annotations.property_places[name]
            if place not in judged_places:
                judged_places.add(place)
                yield from _judge_property(architecture, each, name, text, place)


def _judge_property(
    architecture: Architecture, each: AnnotatedElement, name: str, text: str, place: Span
) -> Iterator[Diagnostic]:
    declared = architecture.properties.get(name)
    if declared is None:
        # What could not be read may declare it.
        guess = None if architecture.partial else find_closest(name, architecture.properties)
        if guess and name not in architecture.unread_keys:
            message = f"no property is declared as `{name}`"
            help_line = f"did you mean `{guess}`?"
            yield Diagnostic("wrong-property", message, place, Severity.WARNING, help=help_line, element=each.owner_id)
        return
    if not _is_property_of(declared, each.kind):
        fault = f"it is a property of {join_words([_name_kinds(kind) for kind in declared.of])}"
    else:
        fault = find_property_fault(declared, text) or ""
    if fault:
        yield Diagnostic(
            "wrong-property",
            f"{_phrase_element(each)} cannot have `{name}: {shorten_value(text)}`: {fault}",
            place,
            labels=(Label(declared.at, "declared here"),),
            element=each.owner_id,
        )


def _is_property_of(declared: PropertyDeclaration, kind: str) -> bool:
    # An instance has what its type says: what components have, types may say.
    return not declared.of or kind in declared.of or (kind == "component_type" and "component" in declared.of)


def _name_kinds(kind: str) -> str:
    words = kind.replace("_", " ")
    return words.removesuffix("y") + "ies" if words.endswith("y") else f"{words}s"


def _phrase_element(each: AnnotatedElement) -> str:
    return f"the {each.kind.replace('_', ' ')} `{each.id}`"


def missing_property(architecture: Architecture) -> Iterator[Diagnostic]:
    """An element lacks a property that the project asks of each one of its kind."""
    required_properties = [each for each in architecture.properties.values() if each.required]
    if not required_properties:
        return
    for each in list_annotated_elements(architecture):
        missing = [declared for declared in required_properties if each.lacks(declared)]
        if missing:
            names = join_words([f"`{declared.id}`" for declared in missing])
            yield Diagnostic(
                "missing-property",
                f"{_phrase_element(each)} has no {names}",
                each.element.at,
                labels=(Label(missing[0].at, "asked for here"),),
                help=f"write it: `properties: {{{missing[0].id}: ...}}`",
                element=each.owner_id,
            )


RULES = (
    (wrong_property, Severity.ERROR),
    (missing_property, Severity.WARNING),
)
