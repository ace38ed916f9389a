"""What launch files of all kinds are turned into before anything is filled in: actions, in the order of the file.

What a launch file starts: nodes, containers and programs, with everything filled in.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from archgen.plugin.importing import Span
from archgen.plugin.model import NO_SCHEDULING, ProcessScheduling
from archgen.plugins.ros.launch.launch_values import LaunchValue

ActionKind = str
"""`argument` `configure` `node` `container` `load` `process` `include` `group` `namespace` `parameter` `parameter_file`
`remap` `environment` `host` `server_parameter` `later` `call` `ignored` `unread`."""


@dataclass(slots=True, eq=False)
class LaunchCondition:
    """When an action counts: if a value is true, or (`is_negated`) if it is not."""

    value: LaunchValue
    is_negated: bool = False


@dataclass(slots=True, eq=False)
class ConditionalValue:
    """A remap, parameter, variable or argument of an action that counts only under conditions."""

    value: LaunchValue
    conditions: list[LaunchCondition]


@dataclass(slots=True, eq=False)
class LaunchAction:
    """One action. `word` is what the file calls it, `values` its arguments by archgen's names for them."""

    kind: ActionKind
    word: str
    span: Span
    values: dict[str, LaunchValue] = field(default_factory=dict)
    children: list[LaunchAction] = field(default_factory=list)
    conditions: list[LaunchCondition] = field(default_factory=list)

    def get(self, name: str, default: LaunchValue = None) -> LaunchValue:
        """Return an argument."""
        return self.values.get(name, default)


@dataclass(slots=True, eq=False)
class LaunchedNode:
    """One node, container (`container`), node in a container (`loaded`), or program that is no node (`program`)."""

    form: str
    word: str
    """What the launch file calls it."""
    span: Span
    file: str
    """The launch file that starts it."""
    action: LaunchAction | None = None
    """The action that starts it."""
    package: str = ""
    executable: str = ""
    plugin: str = ""
    name: str = ""
    program_name: str = ""
    """What its program calls itself where nothing else names it, as far as the library that ships knows."""
    namespace: str = ""
    is_lifecycle: bool = False
    is_nodelet: bool = False
    command: list[str] = field(default_factory=list)
    arguments: list[str] = field(default_factory=list)
    remaps: dict[str, str] = field(default_factory=dict)
    unclear_remaps: set[str] = field(default_factory=set)
    """What a program says and a computed remap gives another name; `*` where that is computed, too."""
    parameters: dict[str, LaunchValue] = field(default_factory=dict)
    unclear_parameters: dict[str, str] = field(default_factory=dict)
    """Why the value of a parameter is not known, by its name; by `*` why those are not that nothing else gives: a file is not read."""
    file_parameters: set[str] = field(default_factory=set)
    """The names of the parameters that a file gives, and nothing behind it."""
    parameter_files: list[str] = field(default_factory=list)
    parameter_commands: dict[str, list[str]] = field(default_factory=dict)
    host: str = ""
    respawn: bool = False
    respawn_delay: str = ""
    environment: dict[str, str] = field(default_factory=dict)
    directory: str = ""
    user: str = ""
    scheduling: ProcessScheduling = NO_SCHEDULING
    container: LaunchedNode | None = None
    container_name: str = ""
    """The full name of the container that loads it, where another action starts that."""
    conditions: list[str] = field(default_factory=list)
    is_on: bool = True
    """Whether its conditions hold by the defaults, as far as that can be told."""
    launch_arguments: dict[str, str] = field(default_factory=dict)
    """The launch arguments that were filled in, with their values."""
    written: dict[str, str] = field(default_factory=dict)
    """What stood where an argument was filled in, by the key: `$(var use_sim_time)`."""
    other_ways: list[dict[str, Any]] = field(default_factory=list)
    """What else may start it, by other conditions."""

    @property
    def full_name(self) -> str:
        """Its name with the namespace; empty where the program names itself."""
        return f"{self.namespace.rstrip('/')}/{self.name}" if self.name else ""

    @property
    def known_name(self) -> str:
        """Its name with the namespace, or what is known of how its program calls it; empty where nothing is."""
        name = self.name or self.program_name
        return f"{self.namespace.rstrip('/')}/{name}" if name else ""


def join_names(outer: str, inner: str) -> str:
    """Return a name in a namespace, from the root; one that begins with `/` stays as it is. Empty stands for the root."""
    if inner.startswith("/"):
        return inner
    return f"{outer.rstrip('/')}/{inner}" if inner else outer.rstrip("/")


def clean_name(name: str) -> str:
    """Return a name as ROS 1 cleans it: without empty parts."""
    return ("/" if name.startswith("/") else "") + "/".join(part for part in name.split("/") if part)
