"""What is written about the start-up of a node, as the resolved record has it."""

from __future__ import annotations

from archgen.model.start_up import ReadyConditions, StartUp
from archgen.views.records.record_values import drop_unknown, record_quantity


def record_start(start: StartUp | None) -> dict[str, object]:
    """Return what a node says of its start-up; empty where it says nothing. Durations are in ns."""
    if start is None:
        return {}
    return drop_unknown(
        {
            "phase": start.phase,
            "after": [target.id for target in start.after],
            "ready": record_ready(start.ready),
            "respawn": start.respawn or None,
            "respawn_delay": record_quantity(start.respawn_delay, "ns"),
            "environment": dict(start.environment),
            "directory": start.directory,
            "user": start.user,
            "once": start.once or None,
            "state": start.state,
            "by": start.by.id if start.by else None,
        }
    )


def record_ready(ready: ReadyConditions) -> dict[str, object]:
    """Return by what one knows that something has started; empty where that is not said."""
    return drop_unknown(
        {
            **{key: getattr(ready, key) for key in ("port", "file", "topic", "service", "log")},
            "wait": record_quantity(ready.wait, "ns"),
            "within": record_quantity(ready.within, "ns"),
        }
    )
