"""Compare two versions as a whole: changes, findings, chains and the owners concerned."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping
from dataclasses import replace

from archgen.compare.architecture_version import ArchitectureVersion
from archgen.compare.boundary_changes import find_boundary_changes
from archgen.compare.breaking_changes import find_idle_acceptances, mark_breaking_changes, stricter_policy
from archgen.compare.chain_causes import add_chain_causes
from archgen.compare.chain_changes import compare_chains
from archgen.compare.compared_elements import ComparedElement, ElementKey
from archgen.compare.comparison import Change, Comparison
from archgen.compare.concerned_owners import find_concerned_owners
from archgen.compare.connection_maps import map_connections
from archgen.compare.difference_finder import DifferenceFinder
from archgen.compare.element_listing import list_elements
from archgen.compare.figure_changes import BoundaryChange, LoadChange
from archgen.compare.finding_changes import judge_findings
from archgen.compare.load_changes import find_link_users, find_load_changes
from archgen.compare.losses.change_context import ChangeContext
from archgen.compare.match_elements import match_elements
from archgen.compare.matched_ids import MatchedIds
from archgen.compare.partner_titles import title_partners
from archgen.compare.timing_pair import analyse_timing_pair
from archgen.compare.version_pair import VersionPair
from archgen.diagnostics.diagnostic import Severity
from archgen.model.architecture import Architecture
from archgen.model.review_settings import AcceptedChange


def compare_versions(before: ArchitectureVersion, after: ArchitectureVersion) -> Comparison:
    """Compare two versions of an architecture."""
    # Matching comes first: everything below lists the first version under the ids of the second.
    matched_ids = match_elements(before.architecture, after.architecture)
    version_pair, changes = _find_changes(before, after, matched_ids)
    if any(change.element_kind == "link" for change in changes):
        version_pair = replace(version_pair, link_users=find_link_users(before, after, matched_ids))
    judged_findings = judge_findings(before, after, matched_ids)
    timing_pair = analyse_timing_pair(before, after, changes)
    # Chains are needed twice: for the report, and as causes of losses in `mark_breaking_changes`.
    chain_changes = compare_chains(before.architecture, after.architecture, matched_ids, timing_pair)
    change_context = ChangeContext(before.architecture, after.architecture, matched_ids, version_pair, changes)
    chain_changes = add_chain_causes(change_context, chain_changes, timing_pair)
    policy = stricter_policy(before.architecture.review, after.architecture.review)
    idle_acceptances: tuple[AcceptedChange, ...] = ()
    if policy.gravest is not Severity.OFF:
        changes = mark_breaking_changes(
            change_context,
            chain_changes,
            timing_pair,
            policy,
        )
        idle_acceptances = find_idle_acceptances(changes, after.architecture.review)
    boundaries: tuple[BoundaryChange, ...] = ()
    loads: tuple[LoadChange, ...] = ()
    if changes:
        boundaries = find_boundary_changes(before, after, matched_ids, timing_pair, version_pair)
        loads = find_load_changes(after.architecture, matched_ids, timing_pair)
    return Comparison(
        before,
        after,
        matched_ids,
        version_pair,
        changes,
        judged_findings.new_findings,
        judged_findings.cured_findings,
        chain_changes,
        find_concerned_owners(changes, version_pair, (*boundaries, *loads, *chain_changes)),
        judged_findings.silenced_findings,
        policy=policy,
        idle_acceptances=idle_acceptances,
        boundaries=boundaries,
        loads=loads,
    )


def list_changes(before: ArchitectureVersion, after: ArchitectureVersion) -> tuple[Change, ...]:
    """Return what is different in another version, element by element, without whom it breaks or what follows for timing."""
    return _find_changes(before, after, match_elements(before.architecture, after.architecture))[1]


def _find_changes(
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
