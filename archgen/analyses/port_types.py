"""Do the types and media that inputs expect agree with what their sources send?"""

from __future__ import annotations

from typing import TYPE_CHECKING

from archgen.diagnostic import Diagnostic, Label, Severity
from archgen.model.mapping import flow_of, full_message

if TYPE_CHECKING:
    from collections.abc import Iterator

    from archgen.model.architecture import Architecture
    from archgen.model.component import Output


def fits(architecture: Architecture, expected: str, output: Output) -> bool:
    """Whether an output sends the type that an input expects. An output without a type does.

    Conceptual types are compared by name: two types with the same message still mean different things. If one of them
    is written as a message, the messages are compared. A caller may expect a service's type, or a type inside it.
    """
    sent = output.type
    if sent is None or sent == expected:
        return True
    mapped = architecture.types.get(sent)
    if full_message(expected) or full_message(sent):
        messages = {_message(architecture, expected), _message(architecture, sent)}
        # A type that is not mapped yet may still be mapped to this message.
        return None in messages or len(messages) == 1
    if mapped is None or flow_of(mapped.message) == "topic":
        return False
    return expected in {mapped.request, mapped.response, mapped.feedback}


def type_mismatch(architecture: Architecture) -> Iterator[Diagnostic]:
    """An input expects another type than its source sends.

    Why: The two sides mean different things by the same connection. A type on an input is what its author counts on; two
    types with one ROS message are still two types (a pose of the robot is no pose of an object).

    Bad:
        groups:
          driving:
            components:
              localisation: {outputs: {pose: Robot pose}}
              gripper: {inputs: {target: {from: localisation.pose, type: Object pose}}}
              tracker: {outputs: {pose: {type: Object pose, external: The operator's tablet}}}
        types:
          Robot pose: geometry_msgs/msg/PoseStamped
          Object pose: geometry_msgs/msg/PoseStamped
        nodes:
          localisation: {implements: localisation}
          gripper: {implements: gripper}
          tracker: {implements: tracker}

    Good:
        groups:
          driving:
            components:
              localisation: {outputs: {pose: {type: Robot pose, external: The operator's tablet}}}
              gripper: {inputs: {target: {from: tracker.pose, type: Object pose}}}
              tracker: {outputs: {pose: Object pose}}
        types:
          Robot pose: geometry_msgs/msg/PoseStamped
          Object pose: geometry_msgs/msg/PoseStamped
        nodes:
          localisation: {implements: localisation}
          gripper: {implements: gripper}
          tracker: {implements: tracker}
    """
    for connection in architecture.connections:
        entry = architecture.inputs[connection.input]
        expected = entry.type
        if expected is None:
            continue
        wrong = [
            o for o in map(architecture.outputs.__getitem__, connection.outputs) if not fits(architecture, expected, o)
        ]
        if wrong:
            names = " and ".join(f"`{o.id}` sends `{o.type}`" for o in wrong[:2])
            more = f" (and {len(wrong) - 2} more)" if len(wrong) > 2 else ""  # noqa: PLR2004 - two are named
            yield Diagnostic(
                "type-mismatch",
                f"the input `{entry.name}` of `{entry.component}` expects `{expected}`, but {names}{more}",
                connection.at,
                labels=(Label(entry.type_at, "expected here"), *(Label(o.type_at, "sent here") for o in wrong[:2])),
                help=_help(architecture, expected, wrong[0]),
                element=entry.component,
            )


def medium_mismatch(architecture: Architecture) -> Iterator[Diagnostic]:
    """An input is said to be physical, but its source sends messages.

    Why: What can be touched, seen or heard has no topic. The node would not subscribe to the data that is meant for it.

    Bad:
        groups:
          speech:
            components:
              synthesis: {outputs: {words: std_msgs/msg/String}}
              loudspeaker:
                inputs: {words: {from: synthesis.words, medium: physical}}
                outputs: {sound: {type: Speech, medium: physical, external: The user hears the robot}}
        nodes:
          synthesis: {implements: synthesis}
          loudspeaker: {implements: loudspeaker}

    Good:
        groups:
          speech:
            components:
              synthesis: {outputs: {words: std_msgs/msg/String}}
              loudspeaker:
                inputs: {words: synthesis.words}
                outputs: {sound: {type: Speech, medium: physical, external: The user hears the robot}}
        nodes:
          synthesis: {implements: synthesis}
          loudspeaker: {implements: loudspeaker}
    """
    for connection in architecture.connections:
        entry = architecture.inputs[connection.input]
        digital = next((o for o in connection.outputs if not architecture.outputs[o].physical), None)
        if entry.physical and digital:
            yield Diagnostic(
                "medium-mismatch",
                f"the input `{entry.name}` of `{entry.component}` is physical, but `{digital}` sends messages",
                connection.at,
                labels=(Label(architecture.outputs[digital].at, "not physical"),),
                help="leave `medium: physical` out at the input, or write it at the output too",
                element=entry.component,
            )


def _help(architecture: Architecture, expected: str, output: Output) -> str | None:
    """Suggest to use one name where both types have the same message."""
    messages = {_message(architecture, expected), architecture.message(output)}
    if len(messages) == 1 and None not in messages:
        return f"both travel as `{messages.pop()}`, but are two types: use one name if they mean the same"
    return None


def _message(architecture: Architecture, name: str) -> str | None:
    """Return the message of a conceptual type, or of a type that is itself the name of a message; None if unmapped."""
    mapped = architecture.types.get(name)
    return (mapped.message if mapped else None) or full_message(name)


RULES = (
    (type_mismatch, Severity.ERROR),
    (medium_mismatch, Severity.WARNING),
)
