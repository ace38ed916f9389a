"""Write the declarations of parameters out: sets become dotted names, values mappings; what contradicts itself is reported.

Normalising twice changes nothing.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from archgen.diagnostics import Diagnostic, diagnose_repetition, did_you_mean
from archgen.model.parameter import MAX_NAME_LENGTH
from archgen.schema.component_sugar import list_component_bodies
from archgen.syntax.yaml_tree import MappingEntry, MappingNode, ScalarNode, SequenceNode

if TYPE_CHECKING:
    from collections.abc import Iterator

    from archgen.diagnostics import Span

DECLARATION_KEYS = (
    *("type", "value", "unit", "range", "choices", "description", "read_only", "visibility", "from", "hints"),
)
"""The keys of a declaration. A mapping with any other key is a set of parameters."""
_TELLING_KEYS = frozenset({"value", "type", "choices", "from"})
"""One of them makes a mapping with keys of a declaration only a declaration."""
_TEXT_KEYS = frozenset({"type", "unit", "description", "visibility", "from"})
_TYPE_WORDS = frozenset({"boolean", "integer", "float", "string", "bool", "int", "double", "number", "text", "str"})
"""Types as archgen and other tools call them: who writes one of them means a declaration."""
_WORDS_OF_OTHERS = {
    **dict.fromkeys(("default", "default_value"), "write the value as `value`"),
    **dict.fromkeys(
        ("min", "max", "minimum", "maximum", "lower", "upper", "bounds", "limits", "validation"),
        "write what it may be as `range: [LOWEST, HIGHEST]` or `choices: [...]`",
    ),
}
"""What generate_parameter_library and dynamic_reconfigure call the same."""
_LIMIT_COUNT = 2


def expand_parameters(root: MappingNode) -> Iterator[Diagnostic]:
    """Bring the parameters of all components into the normal form, in place: declarations by dotted name."""
    for component_id, body in list_component_bodies(root):
        entry = body.entries.get("parameters")
        if entry is not None and isinstance(entry.value, MappingNode):
            expander = _SetExpander(component_id)
            expander.expand_set(entry.value, "")
            entry.value = MappingNode(expander.declarations, entry.value.span)
            yield from expander.diagnostics


class _SetExpander:
    """Takes the sets of one component apart."""

    def __init__(self, component_id: str) -> None:
        self.component_id = component_id
        self.declarations: dict[str, MappingEntry] = {}
        self.diagnostics: list[Diagnostic] = []

    def expand_set(self, mapping: MappingNode, prefix: str) -> None:
        for entry in mapping:
            name = f"{prefix}{entry.key}"
            if len(name) > MAX_NAME_LENGTH:
                self._report(
                    f"the name of a parameter has more than {MAX_NAME_LENGTH} characters",
                    entry.key_span,
                    "use shorter names, or fewer sets in one another",
                )
            elif isinstance(entry.value, MappingNode) and entry.value.entries and not _is_declaration(entry.value):
                self._find_misspelt_key(entry.value, name)
                self.expand_set(entry.value, f"{name}.")
            else:
                self._add_declaration(MappingEntry(name, entry.key_span, self._make_declaration(entry)))

    def _add_declaration(self, entry: MappingEntry) -> None:
        first_entry = self.declarations.setdefault(entry.key, entry)
        if first_entry is not entry:
            self.diagnostics.append(
                diagnose_repetition(
                    "conflicting-values",
                    f"the parameter `{entry.key}` is written twice",
                    entry.key_span,
                    first_entry.key_span,
                    help_line="a set and a name with a dot mean the same: keep one of them",
                    element=self.component_id,
                )
            )

    def _make_declaration(self, entry: MappingEntry) -> MappingNode:
        node = entry.value
        if isinstance(node, ScalarNode) and node.value is None:
            return MappingNode({}, node.span)
        if not isinstance(node, MappingNode):
            return MappingNode({"value": MappingEntry("value", node.span, node)}, node.span)
        written_entries = [
            each for each in node if not (isinstance(each.value, ScalarNode) and each.value.value is None)
        ]
        for each in written_entries:
            if each.key in _TEXT_KEYS and isinstance(each.value, ScalarNode):
                # As text `1.10` stays `1.10` in a packed file, where all below `parameters` keeps the kind it has.
                each.value = ScalarNode(each.value.text, each.value.text, each.value.span, each.value.is_plain)
        if written_entries and _TELLING_KEYS.isdisjoint(each.key for each in written_entries):
            # `{value: , unit: m}`: without the empty key, it would be a set the next time.
            written_entries += [each for each in node if each.key in _TELLING_KEYS][:1]
        declaration = MappingNode({each.key: each for each in written_entries}, node.span)
        self._check_range(declaration)
        return declaration

    def _check_range(self, declaration: MappingNode) -> None:
        node = declaration.get("range")
        if not isinstance(node, SequenceNode):
            return
        limits = [item.value for item in node.items if isinstance(item, ScalarNode)]
        numbers = [limit for limit in limits if isinstance(limit, int | float) and not isinstance(limit, bool)]
        if len(numbers) == len(limits) == _LIMIT_COUNT and numbers[0] <= numbers[1]:
            return
        self._report("a range is the least and the greatest number", node.span, "write both: `range: [0, 1.5]`")
        del declaration.entries["range"]

    def _find_misspelt_key(self, parameter_set: MappingNode, name: str) -> None:
        """Report a key that makes a set of what is meant as a declaration: `{type: float, valeu: 0.5}`."""
        type_node = parameter_set.get("type")
        has_type = isinstance(type_node, ScalarNode) and type_node.text.removesuffix("[]") in _TYPE_WORDS
        # `{value: 2, limits: [0, 3]}`: all that is no key of a declaration is a word of others for one.
        others = parameter_set.entries.keys() - {*DECLARATION_KEYS}
        if not has_type and not ("value" in parameter_set.entries and others <= _WORDS_OF_OTHERS.keys()):
            return
        for entry in parameter_set:
            if entry.key in DECLARATION_KEYS:
                continue
            guess = _WORDS_OF_OTHERS.get(entry.key) or did_you_mean(entry.key, DECLARATION_KEYS)
            if guess:
                self.diagnostics.append(
                    Diagnostic(
                        "unknown-key",
                        f"the declaration of the parameter `{name}` has no key `{entry.key}`",
                        entry.key_span,
                        help=guess,
                        element=self.component_id,
                    )
                )

    def _report(self, message: str, span: Span, help_line: str) -> None:
        self.diagnostics.append(Diagnostic("wrong-value", message, span, help=help_line, element=self.component_id))


def _is_declaration(mapping: MappingNode) -> bool:
    """Whether a mapping declares one parameter; else it is a set of several."""
    return not _TELLING_KEYS.isdisjoint(mapping.entries) and all(key in DECLARATION_KEYS for key in mapping.entries)
