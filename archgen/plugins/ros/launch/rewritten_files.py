"""What launch files write over parameter files: `RewrittenYaml` and `ReplaceString` of Nav2."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from archgen.plugins.ros.launch.launch_actions import LaunchCondition
from archgen.plugins.ros.launch.launch_context import LaunchContext
from archgen.plugins.ros.launch.launch_parameter_values import CommandWords, evaluate_parameter, read_value_text
from archgen.plugins.ros.launch.launch_values import LaunchValue, UnknownValue


@dataclass(slots=True, eq=False)
class FileRewrites:
    """Values by the names of parameters, and texts that are put in the place of others, under a condition."""

    values: Mapping[LaunchValue, LaunchValue] = field(default_factory=dict)
    texts: Mapping[LaunchValue, LaunchValue] = field(default_factory=dict)
    condition: LaunchCondition | None = None

    def change_values(self, values: Mapping[str, Any], context: LaunchContext) -> dict[str, Any]:
        """Return what a file says with the changes in it; an UnknownValue where only the launch tells."""
        changed = evaluate_parameter(self.values, context)
        is_replaced = True if self.condition is None else context.judge_condition(self.condition)[1]
        texts = {} if is_replaced is False else evaluate_parameter(self.texts, context)
        found: dict[str, Any] = {}
        for name, value in values.items():
            # What is written over a file by its last name, as Nav2's RewrittenYaml has it.
            new_value = changed.get(name, changed.get(name.rpartition(".")[2]))
            if isinstance(new_value, CommandWords):
                new_value = UnknownValue("the output of a command")
            if isinstance(new_value, str):
                new_value = read_value_text(new_value)
            if new_value is None:
                new_value = _replace_texts(value, texts, is_sure=is_replaced is True)
            found[name] = new_value
        return found


def _replace_texts(value: Any, texts: Mapping[str, Any], *, is_sure: bool) -> Any:  # noqa: ANN401 - a value of a file
    if isinstance(value, list):
        items = [_replace_texts(item, texts, is_sure=is_sure) for item in value]
        return next((item for item in items if isinstance(item, UnknownValue)), items)
    for old, new in texts.items():
        if isinstance(value, str) and old in value:
            if not is_sure or not isinstance(new, str):
                return UnknownValue(value)
            value = value.replace(old, new)
    return value
