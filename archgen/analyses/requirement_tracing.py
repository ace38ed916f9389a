"""Is every requirement served by a component, and does every component serve a requirement?"""

from __future__ import annotations

from typing import TYPE_CHECKING

from archgen.diagnostics.diagnostic import Diagnostic, Severity
from archgen.diagnostics.suggestions import did_you_mean, find_closest

if TYPE_CHECKING:
    from collections.abc import Iterator

    from archgen.diagnostics.source_span import Span
    from archgen.model.architecture import Architecture, Requirement


def unknown_requirement(architecture: Architecture) -> Iterator[Diagnostic]:
    """A component or chain names a requirement that nobody declares.

    Why: The trace from requirements to components has a loose end. Most often it is a slip in the id, or a requirement that
    was dropped. A requirement of only this component can be written as a sentence in its place.

    Bad:
        requirements:
          R-1: The operator sees what the robot sees
        groups:
          sensing:
            components:
              camera: {requirements: [R-1], outputs: {image: sensor_msgs/msg/Image}}
              screen: {requirements: [R-11], inputs: {image: camera.image}}
        nodes:
          camera: {implements: camera}
          screen: {implements: screen}

    Good:
        requirements:
          R-1: The operator sees what the robot sees
        groups:
          sensing:
            components:
              camera: {requirements: [R-1], outputs: {image: sensor_msgs/msg/Image}}
              screen: {requirements: [R-1, Readable in sunlight], inputs: {image: camera.image}}
        nodes:
          camera: {implements: camera}
          screen: {implements: screen}
    """
    for component in architecture.components.values():
        for use in component.requirements:
            if use.is_id and not _is_declared(architecture, use.text):
                yield _report_unknown_requirement(architecture, use.text, use.at, component.id)
    for chain in architecture.chains.values():
        for requirement in chain.requirements:
            # Unlike a component's, a chain's requirements do not say which of them are sentences: these have blanks.
            if not _is_declared(architecture, requirement) and " " not in requirement:
                yield _report_unknown_requirement(architecture, requirement, chain.at, chain.id)


def _is_declared(architecture: Architecture, requirement: str) -> bool:
    """Whether a requirement is declared, or may be declared in what could not be read."""
    return requirement in architecture.requirements or requirement in architecture.unread_keys


def _report_unknown_requirement(
    architecture: Architecture, requirement_id: str, span: Span, element: str
) -> Diagnostic:
    guess = did_you_mean(requirement_id, architecture.requirements)
    cure = guess or "declare it in the section `requirements`, or write a sentence in its place"
    return Diagnostic(
        "unknown-requirement", f"no requirement `{requirement_id}` is declared", span, help=cure, element=element
    )


def uncovered_requirement(architecture: Architecture) -> Iterator[Diagnostic]:
    """No component and no chain serves a requirement.

    Why: What was promised is nobody's task yet.

    Bad:
        requirements:
          R-1: The operator sees what the robot sees
          R-2: The operator hears what the robot hears
        groups:
          sensing:
            components:
              camera: {requirements: [R-1], outputs: {image: sensor_msgs/msg/Image}}
              screen: {requirements: [R-1], inputs: {image: camera.image}}
        nodes:
          camera: {implements: camera}
          screen: {implements: screen}

    Good:
        requirements:
          R-1: The operator sees what the robot sees
          R-2: The picture is not older than a second
        groups:
          sensing:
            components:
              camera: {requirements: [R-1], outputs: {image: sensor_msgs/msg/Image}}
              screen: {requirements: [R-1, R-2], inputs: {image: camera.image}}
        nodes:
          camera: {implements: camera}
          screen: {implements: screen}
    """
    if architecture.partial:
        return
    named_ids = {use.text for c in architecture.components.values() for use in c.requirements if use.is_id}
    named_ids.update(requirement for chain in architecture.chains.values() for requirement in chain.requirements)
    # A misspelt id is reported by `unknown-requirement`; the requirement that it means is not reported once more.
    misspelt_ids = {
        find_closest(text, architecture.requirements) for text in named_ids if text not in architecture.requirements
    }
    for requirement in architecture.requirements.values():
        if requirement.id not in named_ids and requirement.id not in misspelt_ids:
            yield Diagnostic(
                "uncovered-requirement",
                f"no component and no chain serves the requirement `{requirement.id}`{_title_suffix(requirement)}",
                requirement.at,
                help=f"name `{requirement.id}` in `requirements` of the component or chain whose task it is",
                element=requirement.id,
            )


def _title_suffix(requirement: Requirement) -> str:
    return "" if requirement.title == requirement.id else f" ({requirement.title})"


def unjustified_component(architecture: Architecture) -> Iterator[Diagnostic]:
    """A component serves no requirement, though the project declares some.

    Why: Either the component is not needed, or a requirement was never written down. A project without requirements is not
    asked.

    Bad:
        requirements:
          R-1: The operator sees what the robot sees
        groups:
          sensing:
            components:
              camera: {requirements: [R-1], outputs: {image: sensor_msgs/msg/Image}}
              screen: {inputs: {image: camera.image}}
        nodes:
          camera: {implements: camera}
          screen: {implements: screen}

    Good:
        requirements:
          R-1: The operator sees what the robot sees
        groups:
          sensing:
            components:
              camera: {requirements: [R-1], outputs: {image: sensor_msgs/msg/Image}}
              screen: {requirements: [R-1], inputs: {image: camera.image}}
        nodes:
          camera: {implements: camera}
          screen: {implements: screen}
    """
    if not architecture.requirements:
        return
    for component in architecture.components.values():
        if not component.requirements:
            yield Diagnostic(
                "unjustified-component",
                f"`{component.id}` serves no requirement",
                component.at,
                help="name in its `requirements` what it is there for, as an id or in a sentence",
                element=component.id,
            )


RULES = (
    (unknown_requirement, Severity.ERROR),
    (uncovered_requirement, Severity.WARNING),
    (unjustified_component, Severity.WARNING),
)
