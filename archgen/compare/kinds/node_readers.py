"""How the keys of nodes are read for comparing, those of their start-up among them."""

from __future__ import annotations

import shlex
from collections.abc import Iterable, Mapping

from archgen.bringup.start_plan import resolve_conditions
from archgen.compare.kinds.key_spec import ReadContext
from archgen.compare.normal_values import freeze_value, parameter_leaves, unordered_values
from archgen.frozen import replace
from archgen.model.component import PATTERN_GROUP
from archgen.model.declared_timing import Timing
from archgen.model.node import Node
from archgen.model.start_up import StartTarget, StartUp


def read_ros_name(node: Node, _context: ReadContext) -> str | None:
    """Return the name of a node where that is not its id. Topics that follow it are keys of its ports."""
    return None if node.name == node.id else node.name


def read_command(node: Node, _context: ReadContext) -> str | None:
    """Return the words of what starts a node, as a shell would take them."""
    return " ".join(map(shlex.quote, node.command)) or None


def read_arguments(node: Node, _context: ReadContext) -> str | None:
    """Return the arguments of a node, as a shell would take them."""
    return " ".join(map(shlex.quote, node.arguments)) or None


def read_host(node: Node, context: ReadContext) -> str | None:
    """Return the host of a node that says so itself."""
    own_container = context.architecture.containers.get(node.container) if node.container else None
    # A host that is the container's own adds nothing, and would change with it.
    is_inherited = own_container is not None and own_container.host == node.host
    return None if is_inherited else context.common_id("host", node.host)


def read_callback_groups(node: Node, context: ReadContext) -> Mapping[str, object]:
    """Return the components of each callback group."""
    return {
        name: unordered_values(context.matched_ids.common_id("component", component) for component in members)
        for name, members in node.callback_groups.items()
    }


def read_parameters(node: Node, _context: ReadContext) -> Mapping[str, object]:
    """Return what a node and its files set; that it stands in the one or the other is no difference."""
    values = {value.name: freeze_value(value.value) for value in node.file_values}
    return values | {
        key: value for name, parameter in node.parameters.items() for key, value in parameter_leaves(name, parameter)
    }


def read_commands(node: Node, _context: ReadContext) -> Mapping[str, object]:
    """Return the commands whose output parameters are, by the parameter."""
    return {name: " ".join(words) for name, words in node.parameter_commands.items()}


def find_untold_timing(node: Node, context: ReadContext) -> Mapping[str, Timing]:
    """Return the timing that no component reports: of components with several nodes, and of a node without any."""
    return {
        f"{context.matched_ids.common_id('component', component)}." if len(node.implements) > 1 else "": timing
        for component, timing in node.timing.items()
        if component not in context.told_components
    }


def find_start(node: Node, context: ReadContext) -> StartUp | None:
    """Return what a node says of its start-up, with the names of ROS that it waits for written out."""
    start = node.start
    if start is None:
        return None
    return replace(start, ready=resolve_conditions(start.ready, node, context.architecture.distro))


def read_start_targets(start: StartUp, context: ReadContext) -> frozenset[str]:
    """Return after what a node starts."""
    return unordered_values(_common_ids(start.after, context))


def read_start_manager(start: StartUp, context: ReadContext) -> str | None:
    """Return what brings a lifecycle node into its state."""
    return next(iter(_common_ids((start.by,) if start.by else (), context)), None)


def _common_ids(targets: Iterable[StartTarget], context: ReadContext) -> tuple[str, ...]:
    # What a component type names inside of itself is another component in each instance: it is told there.
    own_targets = (target for target in targets if not target.id.startswith(f"{PATTERN_GROUP}."))
    return tuple(context.matched_ids.common_id(target.kind, target.id) for target in own_targets)
