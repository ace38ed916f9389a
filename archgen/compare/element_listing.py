"""List one version as flat elements in normal form, with the keys that the table of kinds says they have.

The first version is listed under the ids of the second, so that whatever merely follows a rename is equal.
"""

from __future__ import annotations

from collections.abc import Iterator

from archgen.compare.architecture_version import ArchitectureVersion
from archgen.compare.compared_elements import ComparedElement, ElementKey
from archgen.compare.kinds import ELEMENT_KINDS
from archgen.compare.kinds.key_spec import ReadContext, key_values
from archgen.compare.kinds.kind_spec import KindSpec
from archgen.compare.matched_ids import MatchedIds
from archgen.compare.node_ports import list_node_ports
from archgen.compare.normal_values import drop_unset_values
from archgen.diagnostics.source_span import NO_SPAN


def list_elements(
    before: ArchitectureVersion, after: ArchitectureVersion, matched_ids: MatchedIds
) -> tuple[dict[ElementKey, ComparedElement], dict[ElementKey, ComparedElement]]:
    """List all elements of both versions under the ids of the second one."""
    single_before, single_after = (
        ReadContext(version, MatchedIds()).single_node_components for version in (before, after)
    )
    # Only what both versions have: a component that was added or removed has nothing to be compared with.
    matched_components = matched_ids.new_ids.get("component", {})
    split_components = frozenset(
        new_id for old_id, new_id in matched_components.items() if (old_id in single_before) != (new_id in single_after)
    )
    return (
        _list_version_elements(ReadContext(before, matched_ids, split_components)),
        _list_version_elements(ReadContext(after, MatchedIds(), split_components)),
    )


def _list_version_elements(context: ReadContext) -> dict[ElementKey, ComparedElement]:
    # Values hold no spans: elements that move between files have not changed.
    listed = (element for kind in ELEMENT_KINDS.values() for element in _list_kind(kind, context))
    return {(element.kind, element.id): element for element in (*listed, *list_node_ports(context))}


def _list_kind(kind: KindSpec, context: ReadContext) -> Iterator[ComparedElement]:
    keys = kind.keys
    for own_id, element in kind.elements(context.version).items() if kind.elements else ():
        yield ComparedElement(
            kind.name,
            context.matched_ids.common_id(kind.name, own_id),
            own_id,
            drop_unset_values(key_values(keys, element, context)),
            kind.parent(element, context),
            kind.owner(element, context),
            kind.is_declared(element),
            kind.components(element, context),
            # Chapters and settings have no place in a slice.
            getattr(element, "at", NO_SPAN).file,
        )
