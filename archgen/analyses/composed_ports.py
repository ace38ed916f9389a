"""Are the ports of composed components carried by what is inside?"""

from __future__ import annotations

from typing import TYPE_CHECKING

from archgen.diagnostics.diagnostic import Diagnostic, Severity

if TYPE_CHECKING:
    from collections.abc import Iterator

    from archgen.model.architecture import Architecture


def unread_input(architecture: Architecture) -> Iterator[Diagnostic]:
    """A composed component has an input that nothing inside reads.

    Why: What comes in goes nowhere: the design is not finished inside, or a component there reads something else. Until then the
    input counts as that of a leaf, so that a design from the outside to the inside can be checked, drawn and timed.

    Bad:
        groups:
          driving:
            components:
              lidar: {outputs: {scan: sensor_msgs/msg/LaserScan}}
              base:
                inputs: {scan: lidar.scan}
                components:
                  wheels: {inputs: {speed: {external: The operator}}}
        nodes: {lidar: {implements: lidar}, base: {implements: base}}

    Good:
        groups:
          driving:
            components:
              lidar: {outputs: {scan: sensor_msgs/msg/LaserScan}}
              base:
                inputs: {scan: lidar.scan}
                components:
                  wheels: {inputs: {scan: self.scan, speed: {external: The operator}}}
        nodes: {lidar: {implements: lidar}, base: {implements: base}}
    """
    for shell in architecture.shells.values():
        for port in shell.inputs.values():
            if not architecture.shell_ports[f"input {port.id}"]:
                yield Diagnostic(
                    "unread-input",
                    f"nothing inside of `{shell.id}` reads its input `{port.name}`",
                    port.at,
                    help=f"write `self.{port.name}` at an input inside, or take it out",
                    element=shell.id,
                )


def unfed_output(architecture: Architecture) -> Iterator[Diagnostic]:
    """A composed component has an output that nothing inside feeds.

    Why: Its readers wait for what nobody sends: `from` at the output says which component inside gives it. Until then the output
    counts as that of a leaf.

    Bad:
        groups:
          sensing:
            components:
              localization:
                outputs: {pose: geometry_msgs/msg/PoseStamped}
                components:
                  fusion: {outputs: {pose: {type: geometry_msgs/msg/PoseStamped, external: The log}}}
              screen: {inputs: {pose: localization.pose}}
        nodes: {localization: {implements: localization}, screen: {implements: screen}}

    Good:
        groups:
          sensing:
            components:
              localization:
                outputs: {pose: {from: fusion.pose}}
                components:
                  fusion: {outputs: {pose: {type: geometry_msgs/msg/PoseStamped, external: The log}}}
              screen: {inputs: {pose: localization.pose}}
        nodes: {localization: {implements: localization}, screen: {implements: screen}}
    """
    for shell in architecture.shells.values():
        for port in shell.outputs.values():
            # What only passes on what comes back to itself has nothing behind it either.
            is_unfed = architecture.leaf_ports_of("output", port.id) == (port.id,)
            if is_unfed and port.id not in architecture.suspected_ids:
                yield Diagnostic(
                    "unfed-output",
                    f"nothing inside of `{shell.id}` feeds its output `{port.name}`",
                    port.at,
                    help=f"write `{port.name}: {{from: component.output}}`, or take it out",
                    element=shell.id,
                )


RULES = (
    (unread_input, Severity.WARNING),
    (unfed_output, Severity.WARNING),
)
