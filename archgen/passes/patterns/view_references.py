"""What the ports of a view take their data from: references resolved to paths, and paths written as references.

What stands beside the writer wins, then what stands around it, then its group, then the rest: as the linker has it
(`link/source_references.py`), for component types too, which the linker sees in their instances only.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping

from archgen.model.path_resolver import PathResolver
from archgen.passes.patterns.pattern_shapes import PortReference
from archgen.passes.patterns.view_elements import ViewElement
from archgen.syntax.yaml_tree import ScalarNode

_KINDS = ("group", "component", "output")
_SELF = "self."
_PORT_PATH_LENGTH = 2


class ViewReferences:
    """Resolves references between the elements of a view; `list_outputs` names the outputs of one."""

    def __init__(self, elements: Mapping[str, ViewElement], list_outputs: Callable[[str], Collection[str]]) -> None:
        """Take the elements by path; changes of the mapping are seen after `forget_names`."""
        self._elements = elements
        self._list_outputs = list_outputs
        self._open_names: PathResolver | None = None

    def forget_names(self) -> None:
        """Look the names up again: components or outputs have come or gone."""
        self._open_names = None

    def resolve(self, text: str, writer: str, *, is_output: bool, at: ScalarNode | None = None) -> PortReference | None:
        """Return what a reference means at an input of a component, or at an output that it passes on; None if unclear."""
        shell = writer if is_output else self._elements[writer].parent
        if text.startswith(_SELF):
            name = text.removeprefix(_SELF)
            return PortReference(shell, name, holder=shell, at=at) if shell else None
        for around in self._list_shells(shell):
            found = self._match_inside(around, text, writer, at)
            if found or is_output:
                return found
        if self._elements[writer].type_name is not None:
            return None
        match = self._resolver().resolve_path(text, _KINDS, component_id=writer).unique_element
        if match is not None:
            return self._make_reference(match.kind, match.id, at)
        if text in self._elements:
            return PortReference(text, None, at=at)
        component, _, port = text.rpartition(".")
        is_port = component in self._elements and port in self._list_outputs(component)
        return PortReference(component, port, at=at) if is_port else None

    def write(self, target: PortReference, writer: str, *, is_output: bool) -> str | None:
        """Return the words that mean a port, or a whole component, where a component writes them; None where nothing does."""
        if target.holder is not None:
            shell = writer if is_output else self._elements[writer].parent
            return str(target) if target.holder == shell else None
        component = self._elements.get(target.component)
        if component is None:
            return None
        words = component.id if target.port is None else f"{component.id}.{target.port}"
        shell = writer if is_output else self._elements[writer].parent
        is_in_type = self._elements[writer].type_name is not None
        if component.parent in tuple(self._list_shells(shell)):
            if self.resolve(words, writer, is_output=is_output) == target:
                return words
        elif component.parent is not None and component.parent == self._elements[writer].parent and not is_output:
            # In a group two words may be a component of another group.
            return str(target) if target.port is None or words in self._elements else words
        # A complete path is never taken for anything else, but nothing outside of a type is seen in it.
        return None if is_output or is_in_type or component.type_name is not None else str(target)

    def _list_shells(self, shell: str | None) -> Iterator[str]:
        """Yield the composed components around, from the inside to the outside: groups are none."""
        while shell is not None and self._elements[shell].kind != "group":
            yield shell
            shell = self._elements[shell].parent

    def _is_open(self, element: ViewElement) -> bool:
        if element.type_name is not None:
            return False
        return element.parent is None or self._elements[element.parent].kind == "group"

    def _match_inside(self, shell: str, text: str, writer: str, at: ScalarNode | None) -> PortReference | None:
        words = text.split(".")
        child = f"{shell}.{words[0]}"
        if len(words) > 1:
            is_port = child in self._elements and len(words) == _PORT_PATH_LENGTH
            found = is_port and words[1] in self._list_outputs(child)
            return PortReference(child, words[1], at=at) if found else None
        if child in self._elements and child != writer:
            return PortReference(child, None, at=at)
        children = [key for key, each in self._elements.items() if each.parent == shell and key != writer]
        owners = [key for key in children if text in self._list_outputs(key)]
        return PortReference(owners[0], text, at=at) if len(owners) == 1 else None

    def _resolver(self) -> PathResolver:
        if self._open_names is None:
            open_keys = [
                each.key for each in self._elements.values() if each.kind == "component" and self._is_open(each)
            ]
            self._open_names = PathResolver(
                {
                    "group": [each.key for each in self._elements.values() if each.kind == "group"],
                    "component": open_keys,
                    "output": [f"{key}.{name}" for key in open_keys for name in self._list_outputs(key)],
                }
            )
        return self._open_names

    def _make_reference(self, kind: str, element_id: str, at: ScalarNode | None) -> PortReference:
        if kind != "output":
            return PortReference(element_id, None, at=at)
        component, _, port = element_id.rpartition(".")
        return PortReference(component, port, at=at)
