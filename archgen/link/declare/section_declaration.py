"""Declare the sections of small elements: project, chains, views, review and so on."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping

from archgen.diagnostics.diagnostic import Severity
from archgen.link import mapping_values, sanity_checks
from archgen.link.declare.element_declaration import declare_element
from archgen.link.reference_resolution import ReferenceResolver
from archgen.link.value_readers import read_values
from archgen.model.architecture import Chain, ProjectInfo, View, Waypoint
from archgen.model.path_resolver import ElementRef
from archgen.model.review_settings import BREAK_CATEGORIES, AcceptedChange, BreakPolicy, ReviewSettings
from archgen.model.source_repository import DEFAULT_BRANCH, SourceRepository
from archgen.syntax.yaml_tree import MappingNode, ScalarNode, SequenceNode

_WAYPOINT_KINDS = ("node", "component", "output")


def declare_project(root: MappingNode, default_id: str, default_title: str) -> ProjectInfo:
    """Declare the project itself, with defaults for its id and title."""
    body = mapping_values.get_mapping(root, "project")
    values = {"id": default_id, "title": default_title, **read_values("project", ProjectInfo, body)}
    if entry := root.entries.get("project"):
        values["at"] = entry.key_span
    return ProjectInfo(**values)


def declare_chains(
    root: MappingNode,
    resolver: ReferenceResolver,
    implements: Mapping[str, Collection[str]],
    list_leaf_ports: Callable[[str, str], tuple[str, ...]],
) -> dict[str, Chain]:
    """Declare the chains; a waypoint that cannot be resolved is kept in `unresolved`: the chain then counts as open.

    `implements` holds the components of each node, `list_leaf_ports` returns what stands behind a port of a composed one.
    """
    chains_by_id: dict[str, Chain] = {}
    for name, entry, body in mapping_values.iterate_elements(root, "chains"):
        sanity_checks.report_empty_list(body, "through", "element", name, resolver.diagnostics)
        waypoints = [
            (resolver.resolve_reference(scalar, _WAYPOINT_KINDS, name, implements=implements), scalar)
            for scalar in mapping_values.get_scalars(body, "through")
        ]
        chains_by_id[name] = declare_element(
            "chain",
            Chain,
            entry,
            resolver,
            through=tuple(_make_waypoint(target, scalar, list_leaf_ports) for target, scalar in waypoints if target),
            unresolved=tuple(scalar.text for target, scalar in waypoints if target is None),
        )
    return chains_by_id


def _make_waypoint(
    target: ElementRef, scalar: ScalarNode, list_leaf_ports: Callable[[str, str], tuple[str, ...]]
) -> Waypoint:
    """Return an element of a chain; an output that passes on several is the composed component that it belongs to."""
    if target.kind == "output":
        leaf_ports = list_leaf_ports("output", target.id)
        if len(leaf_ports) > 1:
            return Waypoint("component", target.id.rpartition(".")[0], scalar.span)
        return Waypoint("output", leaf_ports[0], scalar.span)
    return Waypoint(target.kind, target.id, scalar.span)  # type: ignore[arg-type]


def declare_views(root: MappingNode, resolver: ReferenceResolver) -> dict[str, View]:
    """Declare the views, except one without `show`, which merging has reported."""
    return {
        name: declare_element("view", View, entry, resolver)
        for name, entry, body in mapping_values.iterate_elements(root, "views")
        if body.get("show") is not None
    }


def declare_repository(root: MappingNode) -> SourceRepository | None:
    """Declare where the files are on the web; None where the project does not say."""
    main_line = mapping_values.get_text(mapping_values.get_mapping(root, "review"), "main") or DEFAULT_BRANCH
    site = read_values("site", SourceRepository, mapping_values.get_mapping(root, "site"))
    return SourceRepository(**{"branch": main_line, **site}) if "address" in site else None


def declare_review(root: MappingNode) -> ReviewSettings:
    """Declare how changes are judged, without accepted changes that lack a reason, which merging has reported."""
    body = mapping_values.get_mapping(root, "review")
    return ReviewSettings(
        **read_values("review", ReviewSettings, body),
        breaking=_read_policy(body),
        guards_margins=mapping_values.get_mapping(body, "breaking").get("promise") is not None,
        accepted=tuple(
            AcceptedChange(
                entry.key, reason, mapping_values.get_text(item, "key"), item.span, mapping_values.get_text(item, "was")
            )
            for entry in mapping_values.get_mapping(body, "accepted")
            if isinstance(entry.value, SequenceNode)
            for item in entry.value.items
            if isinstance(item, MappingNode) and (reason := mapping_values.get_text(item, "reason"))
        ),
    )


def _read_policy(review: MappingNode) -> BreakPolicy | None:
    """Return how serious it is to break a partner: one severity for all categories, or one for each; None if not written."""
    text = mapping_values.get_text(review, "breaking")
    if text is not None:
        return BreakPolicy.from_severity(Severity(text))
    categories = mapping_values.get_mapping(review, "breaking")
    severities = {category: mapping_values.get_text(categories, category) for category in BREAK_CATEGORIES}
    written = {category: Severity(severity) for category, severity in severities.items() if severity is not None}
    return BreakPolicy(**written) if written else None
