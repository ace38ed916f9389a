"""Are the ports of composed components carried by what is inside?"""

from __future__ import annotations

from typing import TYPE_CHECKING

from archgen.diagnostics.diagnostic import Diagnostic, Severity

if TYPE_CHECKING:
    from collections.abc import Iterator

    from archgen.model.architecture import Architecture


def unread_input(architecture: Architecture) -> Iterator[Diagnostic]:
    """A composed component has an input that nothing inside reads."""
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
    """A composed component has an output that nothing inside feeds."""
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
