"""The keys below `start` of a node: when it starts, and how one sees that it is up."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from archgen.compare.kinds.kind_spec import Effect, KeySpec, ReadContext
from archgen.compare.normal_values import unordered_values
from archgen.derivation import ros_names
from archgen.model.component_type_patterns import PATTERN_GROUP
from archgen.model.node import Node
from archgen.model.start_up import SIGN_KEYS, StartTarget

START_KEYS = (
    KeySpec("phase", effect=Effect.SYSTEM, noun="start phase"),
    KeySpec("after", effect=Effect.SYSTEM, list_verbs=("now starts after", "no longer waits for")),
    *(KeySpec(f"ready.{key}", effect=Effect.SYSTEM, noun=f"{key} that shows it is up") for key in SIGN_KEYS[:-1]),
    KeySpec("ready.wait", effect=Effect.SYSTEM, noun="pause after its start"),
    KeySpec("ready.within", effect=Effect.SYSTEM, noun="longest time until it is up"),
    KeySpec("respawn", effect=Effect.SYSTEM, noun="start again whenever it ends"),
    KeySpec("respawn_delay", effect=Effect.SYSTEM, noun="pause before it is started again"),
    KeySpec("environment.", effect=Effect.SYSTEM),
    KeySpec("directory", effect=Effect.SYSTEM, noun="folder in which it runs"),
    KeySpec("user", effect=Effect.SYSTEM, noun="user as whom it runs"),
    KeySpec("once", effect=Effect.SYSTEM, noun="one run to its end"),
    KeySpec("state", effect=Effect.SYSTEM, noun="state that it is brought into"),
    KeySpec("by", effect=Effect.SYSTEM, verb="is brought into its state by"),
)


def read_start(node: Node, context: ReadContext) -> Mapping[str, object]:
    """Return what a node says of its start-up, by the key below `start`; what counts by itself is left out."""
    start = node.start
    if start is None:
        return {}
    ready = {key: getattr(start.ready, key) for key in (*SIGN_KEYS, "within")}
    for key in ("topic", "service"):
        ready[key] = ros_names.resolve_ros_name(ready[key], node) if ready[key] else None
    values = {
        "phase": start.phase,
        "after": unordered_values(_common_ids(start.after, context)),
        **{f"ready.{key}": value for key, value in ready.items()},
        "respawn": start.respawn or None,
        "respawn_delay": start.respawn_delay,
        **{f"environment.{name}": value for name, value in start.environment.items()},
        "directory": start.directory,
        "user": start.user,
        "once": start.once or None,
        "state": start.state,
        "by": next(iter(_common_ids((start.by,) if start.by else (), context)), None),
    }
    return {key: value for key, value in values.items() if value is not None and value != frozenset()}


def _common_ids(targets: Iterable[StartTarget], context: ReadContext) -> tuple[str, ...]:
    # What a component type names inside of itself is another component in each instance: it is told there.
    own_targets = (target for target in targets if not target.id.startswith(f"{PATTERN_GROUP}."))
    return tuple(context.matched_ids.common_id(target.kind, target.id) for target in own_targets)
