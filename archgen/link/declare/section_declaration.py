"""Declare the sections of small elements: project, partners, chains, views, review and so on."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping

from archgen.diagnostics.diagnostic import Severity
from archgen.link import mapping_values, sanity_checks
from archgen.link.reference_resolution import ReferenceResolver
from archgen.model.architecture import Chain, Partner, ProjectInfo, View, Waypoint
from archgen.model.path_resolver import ElementRef
from archgen.model.port_media import ROS
from archgen.model.review_settings import BREAK_CATEGORIES, AcceptedChange, BreakPolicy, ReviewSettings
from archgen.model.source_repository import DEFAULT_BRANCH, SourceRepository
from archgen.syntax.yaml_tree import MappingNode, ScalarNode, SequenceNode

_WAYPOINT_KINDS = ("node", "component", "output")


def declare_project(root: MappingNode, default_id: str, default_title: str) -> ProjectInfo:
    """Declare the project itself, with defaults for its id and title."""
    body = mapping_values.get_mapping(root, "project")
    entry = root.entries.get("project")
    return ProjectInfo(
        id=mapping_values.get_text(body, "id") or default_id,
        title=mapping_values.get_text(body, "title") or default_title,
        version=mapping_values.get_text(body, "version"),
        description=mapping_values.get_text(body, "description"),
        middleware=mapping_values.get_medium(body, "middleware") or ROS,
        # Without the section the field keeps its default, which this module would otherwise have to repeat.
        **({"at": entry.key_span} if entry else {}),
    )


def declare_partners(root: MappingNode) -> dict[str, Partner]:
    """Declare the partners."""
    return {
        name: Partner(
            name,
            mapping_values.get_title(body, name),
            mapping_values.get_text(body, "description"),
            mapping_values.get_text(body, "contact"),
            mapping_values.get_texts(body, "reviewers"),
            annotations=mapping_values.get_annotations(body),
            at=entry.key_span,
        )
        for name, entry, body in mapping_values.iterate_elements(root, "partners")
    }


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
        chains_by_id[name] = Chain(
            id=name,
            title=mapping_values.get_title(body, name),
            through=tuple(_make_waypoint(target, scalar, list_leaf_ports) for target, scalar in waypoints if target),
            deadline=sanity_checks.read_positive(body, "deadline", "duration", name, resolver.diagnostics),
            requirements=mapping_values.get_texts(body, "requirements"),
            annotations=mapping_values.get_annotations(body),
            at=entry.key_span,
            unresolved=tuple(scalar.text for target, scalar in waypoints if target is None),
            requirement_places=tuple(scalar.span for scalar in mapping_values.get_scalars(body, "requirements")),
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


def declare_views(root: MappingNode) -> dict[str, View]:
    """Declare the views, except one without `show`, which merging has reported."""
    views_by_id: dict[str, View] = {}
    for name, entry, body in mapping_values.iterate_elements(root, "views"):
        if body.get("show") is None:
            continue
        level = mapping_values.get_text(body, "level")
        views_by_id[name] = View(
            id=name,
            title=mapping_values.get_title(body, name),
            show=mapping_values.get_text(body, "show") or "",
            colour=mapping_values.get_text(body, "colour"),
            level="implementation" if level == "implementation" else "functional",
            depth=mapping_values.get_integer(body, "depth"),
            layout=mapping_values.get_layout(body),
            annotations=mapping_values.get_annotations(body),
            at=entry.key_span,
            show_at=mapping_values.get_span(body, "show"),
        )
    return views_by_id


def declare_repository(root: MappingNode) -> SourceRepository | None:
    """Declare where the files are on the web; None where the project does not say."""
    body = mapping_values.get_mapping(root, "site")
    address = mapping_values.get_text(body, "repository")
    if address is None:
        return None
    main_line = mapping_values.get_text(mapping_values.get_mapping(root, "review"), "main")
    return SourceRepository(
        address,
        mapping_values.get_text(body, "branch") or main_line or DEFAULT_BRANCH,
        mapping_values.get_text(body, "folder"),
        mapping_values.get_text(body, "forge"),  # type: ignore[arg-type]
    )


def declare_review(root: MappingNode) -> ReviewSettings:
    """Declare how changes are judged, without accepted changes that lack a reason, which merging has reported."""
    body = mapping_values.get_mapping(root, "review")
    return ReviewSettings(
        main=mapping_values.get_text(body, "main"),
        breaking=_read_policy(body),
        guards_margins=mapping_values.get_mapping(body, "breaking").get("promise") is not None,
        accepted=tuple(
            AcceptedChange(entry.key, reason, mapping_values.get_text(item, "key"), item.span)
            for entry in mapping_values.get_mapping(body, "accepted")
            if isinstance(entry.value, SequenceNode)
            for item in entry.value.items
            if isinstance(item, MappingNode) and (reason := mapping_values.get_text(item, "reason"))
        ),
        backends=mapping_values.get_texts(body, "backends"),
        passes=mapping_values.get_texts(body, "passes"),
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
