"""Does data flow where the project forbids it?"""

from __future__ import annotations

from typing import TYPE_CHECKING

from archgen.diagnostic import Diagnostic, Label, Severity
from archgen.model.mapping import flow_of
from archgen.model.selector import Selecting

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator

    from archgen.model.architecture import Architecture, Policy
    from archgen.model.component import Connection


def forbidden_flows(
    architecture: Architecture, tails: Collection[str], heads: Collection[str]
) -> Iterator[tuple[Connection, tuple[str, ...]]]:
    """Yield each connection that carries data directly from a sender to a receiver, with the outputs that do.

    Senders and receivers are complete ids of components. A service or action carries data both ways: from its client to
    its server, and back. What a component sends to itself does not count.
    """
    both_ways = {o.id for o in architecture.outputs.values() if flow_of(architecture.message(o)) != "topic"}
    for connection in architecture.connections:
        reader = architecture.inputs[connection.input].component
        found = []
        for output in connection.outputs:
            sender = architecture.outputs[output].component
            there = sender in tails and reader in heads
            back = output in both_ways and reader in tails and sender in heads
            if sender != reader and (there or back):
                found.append(output)
        if found:
            yield connection, tuple(found)


def forbidden_flow(architecture: Architecture) -> Iterator[Diagnostic]:
    """Data flows directly between two parts of the robot that a policy keeps apart.

    Why: The project itself wrote the policy down: that reasoning drives no motor by itself, or that pictures do not leave the
    robot. A policy speaks of direct connections. To forbid every way, however long, let it select what lies behind:
    `from: camera+` is the camera with all that it feeds.

    Bad:
        groups:
          reasoning:
            components:
              reasoner: {outputs: {command: geometry_msgs/msg/Twist}}
          driving:
            components:
              base: {role: sink, inputs: {command: reasoner.command}}
        nodes:
          reasoner: {implements: reasoner}
          base: {implements: base}
        policies:
          no_shortcut: {title: Reasoning never drives motors itself, forbid: {from: reasoning, to: "role:sink"}}

    Good:
        groups:
          reasoning:
            components:
              reasoner: {outputs: {goal: geometry_msgs/msg/PoseStamped}}
          driving:
            components:
              planner: {inputs: {goal: reasoner.goal}, outputs: {command: geometry_msgs/msg/Twist}}
              base: {role: sink, inputs: {command: planner.command}}
        nodes:
          reasoner: {implements: reasoner}
          planner: {implements: planner}
          base: {implements: base}
        policies:
          no_shortcut: {title: Reasoning never drives motors itself, forbid: {from: reasoning, to: "role:sink"}}
    """
    selecting = Selecting(architecture)
    for policy in architecture.policies.values():
        # A selector with an error selects nothing, and `wrong-selector` reports it.
        tails, _ = selecting.select(policy.forbid_from) if policy.forbid_from else (None, ())
        heads, _ = selecting.select(policy.forbid_to) if policy.forbid_to else (None, ())
        if tails and heads:
            for connection, outputs in forbidden_flows(architecture, tails.components, heads.components):
                yield _forbidden(architecture, policy, connection, outputs)


def _forbidden(
    architecture: Architecture, policy: Policy, connection: Connection, outputs: tuple[str, ...]
) -> Diagnostic:
    named = " and ".join(f"`{output}`" for output in outputs[:3])
    more = f" (and {len(outputs) - 3} more)" if len(outputs) > 3 else ""  # noqa: PLR2004 - three are named
    verb = "goes" if len(outputs) == 1 else "go"
    return Diagnostic(
        "forbidden-flow",
        f"{named}{more} {verb} to `{connection.input}`, which the policy `{policy.id}` forbids: {policy.title}",
        connection.at,
        labels=(Label(policy.at, "the policy"),),
        element=architecture.inputs[connection.input].component,
    )


RULES = ((forbidden_flow, Severity.ERROR),)
