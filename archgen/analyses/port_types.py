"""Do the types and media that inputs expect agree with what their sources send?"""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING

from archgen.diagnostics.diagnostic import Diagnostic, Label, Severity
from archgen.model.component import Output
from archgen.model.message_types import flow_of, full_message_name

if TYPE_CHECKING:
    from collections.abc import Iterator

    from archgen.model.architecture import Architecture


def is_expected_type(architecture: Architecture, expected_type: str, output: Output) -> bool:
    """Whether an output sends the type that an input expects. An output without a type does.

    Conceptual types are compared by name: two types with the same message still mean different things. If one of them
    is written as a message, the messages are compared. A caller may expect a service's type, or a type inside it.
    """
    sent_type = output.type
    if sent_type is None or sent_type == expected_type:
        return True
    mapped = architecture.types.get(sent_type)
    if full_message_name(expected_type) or full_message_name(sent_type):
        messages = {_message_of_type(architecture, expected_type), _message_of_type(architecture, sent_type)}
        # A type that is not mapped yet may still be mapped to this message.
        return None in messages or len(messages) == 1
    if mapped is None or flow_of(mapped.message) == "topic":
        return False
    return expected_type in {mapped.request, mapped.response, mapped.feedback}


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
        expected_type = entry.type
        if expected_type is None:
            continue
        wrong_outputs = [
            o
            for o in map(architecture.outputs.__getitem__, connection.outputs)
            if not is_expected_type(architecture, expected_type, o)
        ]
        if wrong_outputs:
            names = " and ".join(f"`{o.id}` sends `{o.type}`" for o in wrong_outputs[:2])
            suffix = f" (and {len(wrong_outputs) - 2} more)" if len(wrong_outputs) > 2 else ""  # noqa: PLR2004 - two are named
            yield Diagnostic(
                "type-mismatch",
                f"the input `{entry.name}` of `{entry.component}` expects `{expected_type}`, but {names}{suffix}",
                connection.at,
                labels=(
                    Label(entry.type_at, "expected here"),
                    *(Label(o.type_at, "sent here") for o in wrong_outputs[:2]),
                ),
                help=_suggest_common_type(architecture, expected_type, wrong_outputs[0]),
                element=entry.component,
            )


def medium_mismatch(architecture: Architecture) -> Iterator[Diagnostic]:
    """An input is said to be physical, but its source sends messages; or a node reads messages that a physical source never sends.

    Why: What can be touched, seen or heard has no topic. The node would not subscribe to the data that is meant for it, or
    subscribe to a topic that nobody publishes.

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
        digital_output = next((o for o in connection.outputs if not architecture.outputs[o].physical), None)
        if entry.physical and digital_output:
            yield Diagnostic(
                "medium-mismatch",
                f"the input `{entry.name}` of `{entry.component}` is physical, but `{digital_output}` sends messages",
                connection.at,
                labels=(Label(architecture.outputs[digital_output].at, "not physical"),),
                help="leave `medium: physical` out at the input, or write it at the output too",
                element=entry.component,
            )
    yield from _find_readers_of_physical_outputs(architecture)


def _find_readers_of_physical_outputs(architecture: Architecture) -> Iterator[Diagnostic]:
    """Report what nodes subscribe to, or call, for inputs whose sources are all physical."""
    outputs_by_input = defaultdict[str, list[Output]](list)
    for edge in architecture.edges:
        outputs_by_input[edge.input].append(architecture.outputs[edge.output])
    for node in architecture.nodes.values():
        for use in node.uses:
            entry = architecture.inputs.get(use.port or "")
            outputs = outputs_by_input.get(use.port or "", [])
            # A physical input is `wrong-section`'s; one that is also fed from outside may get its messages there.
            if entry and not entry.physical and not entry.external and outputs and all(o.physical for o in outputs):
                yield Diagnostic(
                    "medium-mismatch",
                    f"`{node.id}` {'subscribes to' if use.use == 'subscribes' else use.use} `{entry.name}`, but `{outputs[0].id}` is physical and sends no messages",
                    use.at,
                    labels=(Label(outputs[0].at, "physical"),),
                    help="leave the entry out at the node, or `medium: physical` at the output",
                    element=node.id,
                )


def _suggest_common_type(architecture: Architecture, expected_type: str, output: Output) -> str | None:
    """Suggest to use one name where both types have the same message."""
    message = architecture.message_of(output)
    if message is not None and message == _message_of_type(architecture, expected_type):
        return f"both travel as `{message}`, but are two types: use one name if they mean the same"
    return None


def _message_of_type(architecture: Architecture, type_name: str) -> str | None:
    """Return the message of a conceptual type, or of a type that is itself the name of a message; None if unmapped."""
    mapped = architecture.types.get(type_name)
    return (mapped.message if mapped else None) or full_message_name(type_name)


RULES = (
    (type_mismatch, Severity.ERROR),
    (medium_mismatch, Severity.WARNING),
)
