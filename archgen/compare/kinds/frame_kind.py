"""Coordinate frames: what each is placed in, and who writes it."""

from __future__ import annotations

from archgen.compare.compared_elements import ElementKey
from archgen.compare.element_relations import ElementRelations
from archgen.compare.kinds.key_spec import ReadContext
from archgen.compare.kinds.kind_spec import FeatureSpec, KindSpec
from archgen.compare.kinds.shared_features import NAME_FEATURES, mark_values
from archgen.model.coordinate_frames import Frame


def _read_owner(frame: Frame, context: ReadContext) -> str | None:
    """Return the partner who owns what writes a frame, else what holds it."""
    architecture = context.architecture
    component = architecture.components.get(
        (frame.by if frame.by_kind == "component" else None) or frame.component or ""
    )
    node = architecture.nodes.get(frame.by or "") if frame.by_kind == "node" else None
    writer = node or component
    return context.common_id("partner", writer.owner) if writer else None


def _list_components(frame: Frame, context: ReadContext) -> tuple[str, ...]:
    component = frame.by if frame.by_kind == "component" else None
    return (context.matched_ids.common_id("component", component),) if component else ()


def _find_parent(frame: Frame, context: ReadContext) -> ElementKey | None:
    return ("component", context.matched_ids.common_id("component", frame.component)) if frame.component else None


def _mark_children(relations: ElementRelations, frame: Frame) -> frozenset[str]:
    return frozenset(relations.users_by_element[f"below:{frame.id}"])


def _mark_ports(relations: ElementRelations, frame: Frame) -> frozenset[str]:
    ports = relations.users_by_element[f"frame:{frame.id}"]
    return relations.common_ids("input", ports) | relations.common_ids("output", ports)


FRAME = KindSpec(
    "frame",
    "Frames",
    elements=lambda version: version.architecture.frames,
    features=(
        *NAME_FEATURES,
        FeatureSpec("ports", 4, _mark_ports),
        FeatureSpec("children", 3, _mark_children),
        FeatureSpec("parent", 2, lambda _, frame: mark_values(frame.parent)),
        FeatureSpec("by", 2, lambda relations, frame: relations.common_ids(frame.by_kind, [frame.by])),
    ),
    parent=_find_parent,
    owner=_read_owner,
    components=_list_components,
)
