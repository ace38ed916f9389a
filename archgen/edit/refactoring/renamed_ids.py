"""Which ids an element and all that it holds have before and after it is renamed or moved."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from archgen.checking.reference_index import INNER_KINDS, Element, list_outer_ids
from archgen.frozen import dataclass


@dataclass(slots=True)
class RenamedIds:
    """Old and new ids of elements that change theirs, by kind: those of what they hold follow."""

    pairs: Mapping[Element, Element]

    @property
    def is_move(self) -> bool:
        """Whether elements come to stand in another group."""
        return any(old.rpartition(".")[0] != new.rpartition(".")[0] for (_, old), (_, new) in self.pairs.items())

    def map_element(self, element: Element) -> Element:
        """Return an element as it is called afterwards."""
        if element in self.pairs:
            return self.pairs[element]
        kind, element_id = element
        for outer_id in list_outer_ids(element_id):
            for outer_kind, inner_kinds in INNER_KINDS.items():
                stood = self.pairs.get((outer_kind, outer_id)) if kind in inner_kinds else None
                if stood is not None:
                    return kind, stood[1] + element_id[len(outer_id) :]
            # What stands inside of a type begins with the type's name between brackets.
            type_name = outer_id[1:-1] if outer_id[0] + outer_id[-1] == "<>" else ""
            new_type = self.map_id("component_type", type_name) if type_name else ""
            if new_type != type_name:
                return kind, f"<{new_type}>{element_id[len(outer_id) :]}"
        return element

    def map_id(self, kind: str, element_id: str) -> str:
        """Return the id that an element has afterwards."""
        return self.map_element((kind, element_id))[1]


def rename_last_word(elements: Iterable[Element], new_name: str, *, is_path: bool) -> RenamedIds:
    """Return the ids of elements whose last word is another now; of those that are no path, all is one word."""
    pairs = {}
    for kind, element_id in elements:
        outer = element_id.rpartition(".")[0] if is_path else ""
        pairs[kind, element_id] = (kind, f"{outer}.{new_name}" if outer else new_name)
    return RenamedIds(pairs)
