"""What methods of values do in launch files in Python: of lists, dicts, texts, and of the description that is launched."""

from __future__ import annotations

import ast
from collections.abc import Mapping

from archgen.plugin.importing import Span
from archgen.plugins.ros.launch.launch_actions import LaunchAction
from archgen.plugins.ros.launch.launch_values import (
    MAX_TEXT,
    OPEN_FILE,
    LaunchValue,
    Substitution,
    UnknownValue,
    join_values,
)
from archgen.plugins.ros.launch.python_statements import StatementReader
from archgen.plugins.ros.launch.python_values import BoundMethod, CallArguments, fill_text

_TEXT_METHODS = frozenset(
    {"lower", "upper", "strip", "lstrip", "rstrip", "replace", "split", "startswith", "endswith", "title"}
)
_MAX_GROWTH = 100
_SAME_METHODS = frozenset(
    {"perform", "as_posix", "resolve", "absolute", "toxml", "toprettyxml", "expanduser", "copy", "string", "__str__"}
)


class MethodReader(StatementReader):
    """Reads calls of methods."""

    def add_children(self, action: LaunchAction, value: LaunchValue, depth: int = 0) -> None:
        """Put what a value holds into an action, list by list."""
        if value is None or depth > 20:  # noqa: PLR2004 - lists in lists
            return
        if not self.budget.pay():
            self._run.tell_excess(action.word, action.span)
            return
        if isinstance(value, LaunchAction):
            action.children.append(value)
        elif isinstance(value, list | tuple):
            # However long it is, something is left for the lines behind it.
            followed = value[: self.budget.left // 4]
            if len(followed) < len(value):
                self._run.tell_excess(action.word, action.span)
            for item in followed:
                self.add_children(action, item, depth + 1)
        elif isinstance(value, UnknownValue):
            line = value.line or action.span.line
            span = Span(value.file or action.span.file, line, 1, line, 2)
            reason = f"what it gives is computed: `{value.reason}`"
            action.children.append(LaunchAction("unread", _name_call(value.reason), span, {"reason": reason}))

    def call_method(self, method: BoundMethod, arguments: CallArguments, node: ast.Call) -> LaunchValue:  # noqa: C901, PLR0911, PLR0912
        """Return what a method gives; what it changes is changed."""
        owner, name = method.owner, method.name
        if name == "perform_substitution":
            return arguments.get(0, "substitution")
        if name == "get" and isinstance(owner, BoundMethod) and owner.name == "launch_configurations":
            return Substitution("var", tuple(arguments.positional[:2]))
        if isinstance(owner, LaunchAction) and name in {"add_action", "add_entity"}:
            self.add_children(owner, arguments.get(0, "action", "entity"))
            if owner.children and self.conditions and not owner.children[-1].conditions:
                owner.children[-1].conditions += self.conditions
            return None
        if name == "read" and isinstance(owner, Substitution) and owner.kind == OPEN_FILE:
            # What a file holds is what printing it gives.
            return Substitution("command", (["cat ", owner.parts[0]],))
        if name == "find" and isinstance(owner, Substitution) and owner.kind in {"share", "prefix"}:
            return Substitution(owner.kind, (arguments.get(0, "package_name"),))
        if name in _SAME_METHODS and isinstance(owner, str | Substitution):
            return owner
        if isinstance(owner, list):
            return self._call_list_method(owner, name, arguments, node)
        if isinstance(owner, dict):
            return self._call_dict_method(owner, name, arguments, node)
        if name == "join" and isinstance(owner, str):
            return self._join_texts(owner, arguments.get(0), node)
        if name == "joinpath" and isinstance(owner, str | Substitution):
            return Substitution("path", (owner, *arguments.positional))
        if name == "format" and isinstance(owner, str):
            return self._format_text(owner, arguments, node)
        text = self.force(owner)
        if (
            name in _TEXT_METHODS
            and isinstance(text, str)
            and all(isinstance(each, str) for each in arguments.positional)
        ):
            # A text in the place of each letter, or a list of all letters.
            grown = (len(text) + 1) * max((len(each) for each in arguments.positional[1:]), default=1)
            if not self.pay_to_repeat(node, len(text)) or grown > MAX_TEXT * _MAX_GROWTH:
                return self.quote(node)
            try:
                found: LaunchValue = getattr(text, name)(*arguments.positional)
            except (
                TypeError,
                ValueError,
            ):  # as it would be when the file is run: an empty separator, an argument too few
                return self.quote(node)
            return found if not isinstance(found, str) or len(found) <= MAX_TEXT else self.quote(node)
        return self.quote(node)

    def _call_list_method(
        self, owner: list[LaunchValue], name: str, arguments: CallArguments, node: ast.Call
    ) -> LaunchValue:
        value = arguments.get(0)
        if name == "append":
            owner.append(self._with_conditions(value))
        elif name == "extend":
            if self.pay_for(value, node):
                items = list(value) if isinstance(value, list | tuple) else [value]
                owner += map(self._with_conditions, items)
        elif (
            name == "insert" and len(arguments.positional) > 1 and isinstance(value, int) and self.pay_for(owner, node)
        ):
            owner.insert(value, self._with_conditions(arguments.positional[1]))
        elif name == "copy":
            return list(owner)
        else:
            return self.quote(node)
        return None

    def _with_conditions(self, value: LaunchValue) -> LaunchValue:
        """Return an action that is added only if the conditions around hold."""
        if isinstance(value, LaunchAction):
            known = set(map(id, value.conditions))
            value.conditions += [each for each in self.conditions if id(each) not in known]
        return value

    def _call_dict_method(  # noqa: C901, PLR0911 - a method each
        self, owner: dict[LaunchValue, LaunchValue], name: str, arguments: CallArguments, node: ast.Call
    ) -> LaunchValue:
        value = arguments.get(0)
        match name:
            case "update":
                if isinstance(value, Mapping):
                    owner |= value if self.pay_for(value, node) else {}
                elif value is not None:
                    self.tell_lost("update", f"what it adds is computed: `{self.quote(node).reason}`", node)
                owner |= arguments.named
                return None
            case "items" if self.pay_for(owner, node):
                return [[key, each] for key, each in owner.items()]
            case "keys":
                return list(owner)
            case "values":
                return list(owner.values())
            case "copy":
                return dict(owner)
            case "get" if isinstance(value, str | int):
                return owner.get(value, arguments.get(1, "default"))
            case "pop" if isinstance(value, str | int):
                return owner.pop(value, arguments.get(1))
            case "setdefault" if isinstance(value, str | int):
                return owner.setdefault(value, arguments.get(1))
        return self.quote(node)

    def _join_texts(self, separator: str, items: LaunchValue, node: ast.Call) -> LaunchValue:
        if not isinstance(items, list | tuple) or not all(isinstance(item, str | Substitution) for item in items):
            return self.quote(node)
        parts: list[LaunchValue] = []
        for item in items:
            parts += [separator, item] if parts and separator else [item]
        return join_values(parts) if parts else ""

    def _format_text(self, text: str, arguments: CallArguments, node: ast.Call) -> LaunchValue:
        made = None if arguments.named else fill_text(text.split("{}"), arguments.positional, "{")
        return self.quote(node) if made is None else made


def _name_call(text: str) -> str:
    """Return the name of what is called, for the kind of a note."""
    name = text.partition("(")[0].strip()
    return name.rpartition(".")[2] if name.replace(".", "").replace("_", "").isalnum() else "expression"
