"""Does data flow where the project forbids it?"""

from __future__ import annotations

from typing import TYPE_CHECKING

from archgen.diagnostics.diagnostic import Diagnostic, Label, Severity
from archgen.model.selector_evaluation import SelectorEvaluator

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator

    from archgen.model.architecture import Architecture, Policy
    from archgen.model.component import Connection


def find_forbidden_flows(
    architecture: Architecture, senders: Collection[str], receivers: Collection[str]
) -> Iterator[tuple[Connection, tuple[str, ...]]]:
    """Yield each connection that carries data directly from a sender to a receiver, with the outputs that do.

    Senders and receivers are complete ids of components. A service or action carries data both ways: from its client to
    its server, and back. What a component sends to itself does not count.
    """
    both_ways = {o.id for o in architecture.outputs.values() if architecture.flow_of(o) != "topic"}
    for connection in architecture.connections:
        reader = architecture.inputs[connection.input].component
        forbidden_outputs = []
        for output in connection.outputs:
            sender = architecture.outputs[output].component
            is_forward = sender in senders and reader in receivers
            is_backward = output in both_ways and reader in senders and sender in receivers
            if sender != reader and (is_forward or is_backward):
                forbidden_outputs.append(output)
        if forbidden_outputs:
            yield connection, tuple(forbidden_outputs)


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
    evaluator = SelectorEvaluator(architecture)
    for policy in architecture.policies.values():
        # A selector with an error selects nothing, and `wrong-selector` reports it.
        senders, _ = evaluator.evaluate(policy.forbid_from) if policy.forbid_from else (None, ())
        receivers, _ = evaluator.evaluate(policy.forbid_to) if policy.forbid_to else (None, ())
        if senders and receivers:
            for connection, outputs in find_forbidden_flows(architecture, senders.components, receivers.components):
                yield _report_forbidden_flow(architecture, policy, connection, outputs)


def _report_forbidden_flow(
    architecture: Architecture, policy: Policy, connection: Connection, outputs: tuple[str, ...]
) -> Diagnostic:
    output_names = " and ".join(f"`{output}`" for output in outputs[:3])
    suffix = f" (and {len(outputs) - 3} more)" if len(outputs) > 3 else ""  # noqa: PLR2004 - three are named
    verb = "goes" if len(outputs) == 1 else "go"
    return Diagnostic(
        "forbidden-flow",
        f"{output_names}{suffix} {verb} to `{connection.input}`, which the policy `{policy.id}` forbids: {policy.title}",
        connection.at,
        labels=(Label(policy.at, "the policy"),),
        element=architecture.inputs[connection.input].component,
    )


RULES = ((forbidden_flow, Severity.ERROR),)
