"""Does each input name its sources once, and either inside of the system or outside?"""

from __future__ import annotations

from typing import TYPE_CHECKING

from archgen.diagnostics.diagnostic import Diagnostic, Severity, diagnose_repetition

if TYPE_CHECKING:
    from collections.abc import Iterator

    from archgen.model.architecture import Architecture
    from archgen.model.component import Connection


def repeated_source(architecture: Architecture) -> Iterator[Diagnostic]:
    """An input names the same source twice."""
    for port in architecture.inputs.values():
        first_connections: dict[str, Connection] = {}
        for connection in port.connections:
            first_connection = first_connections.setdefault(connection.target, connection)
            if first_connection is not connection:
                yield diagnose_repetition(
                    "repeated-source",
                    f"`{port.name}` of `{port.component}` names `{connection.target}` twice",
                    connection.at,
                    first_connection.at,
                    help_line="take one of them out, or name what was meant",
                    element=port.component,
                )


def mixed_source(architecture: Architecture) -> Iterator[Diagnostic]:
    """An input comes from a component and from outside of the system at once."""
    for port in architecture.inputs.values():
        if port.connections and port.external is not None:
            yield Diagnostic(
                "mixed-source",
                f"`{port.name}` of `{port.component}` comes from `{port.connections[0].target}` and from outside",
                port.at,
                help="keep `from` or `external`, or write two inputs",
                element=port.component,
            )


RULES = (
    (repeated_source, Severity.WARNING),
    (mixed_source, Severity.WARNING),
)
