"""Every difference between two versions, element by element.

Apart from the whole comparison: what a change breaks, and what follows for timing, is most of the code and of the time.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping

from archgen.compare.architecture_version import ArchitectureVersion
from archgen.compare.compared_elements import ComparedElement, ElementKey
from archgen.compare.comparison import Change
from archgen.compare.connection_maps import map_connections
from archgen.compare.difference_finder import DifferenceFinder
from archgen.compare.element_listing import list_elements
from archgen.compare.match_elements import match_elements
from archgen.compare.matched_ids import MatchedIds
from archgen.compare.partner_titles import title_partners
from archgen.compare.version_pair import VersionPair
from archgen.model.architecture import Architecture


def list_changes(before: ArchitectureVersion, after: ArchitectureVersion) -> tuple[Change, ...]:
    """Return what is different in another version, element by element, without whom it breaks or what follows for timing."""
    return find_changes(before, after, match_elements(before.architecture, after.architecture))[1]


def find_changes(
    before: ArchitectureVersion, after: ArchitectureVersion, matched_ids: MatchedIds
) -> tuple[VersionPair, tuple[Change, ...]]:
    """Return two versions in normal form, and every difference between them."""
    elements = list_elements(before, after, matched_ids)
    old_connections, new_connections = (
        map_connections(before.architecture, matched_ids),
        map_connections(after.architecture, MatchedIds()),
    )
    lost_keys = before.architecture.unread_keys, after.architecture.unread_keys
    version_pair = VersionPair(
        old_connections,
        new_connections,
        *elements,
        (_components_by_requirement(elements[0]), _components_by_requirement(elements[1])),
        lost_keys,
        _find_unnamed_outputs(after.architecture),
        (before.sound_files, after.sound_files),
        (before.broken_files, after.broken_files),
        (before.library_files, after.library_files),
        (before.architecture.untyped_components, after.architecture.untyped_components),
        partner_names=title_partners(before.architecture, after.architecture),
    )
    finder = DifferenceFinder(*elements, matched_ids, version_pair)
    return version_pair, finder.find_all_changes(old_connections, new_connections)


def _find_unnamed_outputs(architecture: Architecture) -> frozenset[str]:
    """Return the outputs of written nodes whose topic, service or action has no written name."""
    # What runs as a whole has the names of the composed component, which stay where leaves inside move.
    written_nodes = {node.id for node in architecture.nodes.values() if node.written and not node.wholes}
    offered_endpoints = (
        endpoint
        for endpoint in architecture.endpoints
        if endpoint.node in written_nodes and endpoint.use in {"publishes", "serves"}
    )
    return frozenset(endpoint.port for endpoint in offered_endpoints if endpoint.port and not endpoint.name_written)


def _components_by_requirement(elements: Mapping[ElementKey, ComparedElement]) -> Mapping[str, frozenset[str]]:
    """Return for each requirement the components that name it."""
    components: dict[str, set[str]] = defaultdict(set)
    for (kind, component_id), element in elements.items():
        requirements = element.values.get("requirements") if kind == "component" else None
        for requirement in requirements if isinstance(requirements, frozenset) else ():
            components[requirement].add(component_id)
    return {requirement: frozenset(component_ids) for requirement, component_ids in components.items()}
