"""Is every conceptual type that is used mapped to a message, and every declared one used?"""

from __future__ import annotations

from collections.abc import Iterator

from archgen.diagnostic import Diagnostic, Label, Severity
from archgen.model.architecture import Architecture
from archgen.model.component import Input, Output
from archgen.model.mapping import Type
from archgen.source import NOWHERE, Span
from archgen.suggest import did_you_mean


def _ports(architecture: Architecture) -> tuple[Output | Input, ...]:
    """Return all ports, outputs first: a finding is placed at an output that has the type if there is one."""
    return (*architecture.outputs.values(), *architecture.inputs.values())


def _uses(architecture: Architecture) -> dict[str, list[Span]]:
    """Return the spans where digital ports name each type, by type name."""
    found = dict[str, list[Span]]()
    for port in _ports(architecture):
        if port.type is not None and not port.physical:
            found.setdefault(port.type, []).append(port.type_at if port.type_at != NOWHERE else port.at)
    return found


def unmapped_type(architecture: Architecture) -> Iterator[Diagnostic]:
    """No message is named for a conceptual type that carries messages.

    Why: outputs and inputs of this type cannot become topics yet: nobody has decided what is sent. A port that is no message
    at all (a sound, a push, light) says `medium: physical` instead.

    Bad:

        groups:
          perception:
            components:
              tracker: {outputs: {people: Tracked people}}
              follower: {inputs: {people: tracker.people}}
        nodes:
          people_tracker: {implements: tracker}
          people_follower: {implements: follower}

    Good:

        groups:
          perception:
            components:
              tracker: {outputs: {people: Tracked people}}
              follower: {inputs: {people: tracker.people}}
        nodes:
          people_tracker: {implements: tracker}
          people_follower: {implements: follower}
        types:
          Tracked people: {message: vision_msgs/msg/Detection3DArray}
    """
    for name, places in _uses(architecture).items():
        type_ = architecture.types.get(name)
        if type_ is None or type_.message is None:
            yield Diagnostic(
                "unmapped-type",
                f"no message is named for the type `{name}`",
                places[0],
                labels=tuple(_elsewhere(type_, places[1:])),
                help=_mapped(name, architecture),
                element=name,
            )


def _elsewhere(type_: Type | None, places: list[Span]) -> Iterator[Label]:
    if type_ is not None and type_.at != NOWHERE and type_.origin == "project":
        yield Label(type_.at, "declared here, without a message")
    yield from (Label(place, "also used here") for place in places)


def _mapped(name: str, architecture: Architecture) -> str:
    known = {type_.name for type_ in architecture.types.values() if type_.message and type_.origin != "message"}
    guess = did_you_mean(name, known | set(architecture.interfaces.mapper))
    return guess or f"name it below `types:`, as in `{name}: {{message: package/msg/Name}}`"


def unused_type(architecture: Architecture) -> Iterator[Diagnostic]:
    """Nothing has a type that the project declares.

    Why: the mapping is written for nobody: the port that had this type was renamed or taken away, or the name differs in a
    letter. Types that stand in another one's `request`, `response` or `feedback` are used.

    Bad:

        groups:
          perception:
            components:
              camera: {outputs: {colour: Colour picture}}
              screen: {inputs: {colour: camera.colour}}
        nodes:
          camera_driver: {implements: camera}
          image_view: {implements: screen}
        types:
          Colour picture: {message: sensor_msgs/msg/Image}
          Colour pictures: {message: sensor_msgs/msg/Image}

    Good:

        groups:
          perception:
            components:
              camera: {outputs: {colour: Colour picture}}
              screen: {inputs: {colour: camera.colour}}
        nodes:
          camera_driver: {implements: camera}
          image_view: {implements: screen}
        types:
          Colour picture: {message: sensor_msgs/msg/Image}
    """
    if architecture.partial:
        return
    # Physical ports count here: their types need no message, but they use the type.
    used = {port.type for port in _ports(architecture)}
    for type_ in architecture.types.values():
        used |= {type_.request, type_.response, type_.feedback}
    # An unused mapping beside a used type without one is most likely a misspelt name.
    unmapped = [name for name in used if name and not _has_message(architecture, name)]
    for type_ in architecture.types.values():
        if type_.origin == "project" and type_.at != NOWHERE and type_.name not in used:
            yield Diagnostic(
                "unused-type",
                f"nothing has the type `{type_.name}`",
                type_.at,
                help=did_you_mean(type_.name, unmapped),
                element=type_.name,
            )


def _has_message(architecture: Architecture, name: str) -> bool:
    type_ = architecture.types.get(name)
    return type_ is not None and type_.message is not None


RULES = (
    (unmapped_type, Severity.WARNING),
    (unused_type, Severity.NOTE),
)
