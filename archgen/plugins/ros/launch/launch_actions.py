"""What launch files of all kinds are turned into before anything is filled in: actions, in the order of the file."""

from __future__ import annotations

from dataclasses import dataclass, field

from archgen.plugin.importing import Span
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
    is_taken: bool = False
    """Whether it was met when the file was walked through: what is made and never added is noted."""

    def get(self, name: str, default: LaunchValue = None) -> LaunchValue:
        """Return an argument."""
        return self.values.get(name, default)
