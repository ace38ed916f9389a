"""What runs where (hosts, containers, resources, links), and what is said across all of it: frames, chains, policies, views."""

from __future__ import annotations

from archgen.compare.element_likeness import word_set
from archgen.compare.element_relations import ElementRelations
from archgen.compare.kinds.key_spec import KeySpec, ReadContext, Worsening, read_owner
from archgen.compare.kinds.kind_spec import (
    FeatureSpec,
    make_section_kind,
    mark_values,
    nodes_feature,
    reference_feature,
    text_feature,
    value_feature,
)
from archgen.frozen import replace
from archgen.model.architecture import Chain, Policy
from archgen.model.coordinate_frames import Frame
from archgen.model.deployment import Host, Resource


def _mark_containers(relations: ElementRelations, host: Host) -> frozenset[str]:
    containers = relations.architecture.containers.values()
    return relations.common_ids("container", [container.id for container in containers if container.host == host.id])


HOST = make_section_kind(
    "host",
    nodes_feature("host", 8),
    FeatureSpec("containers", 2, _mark_containers),
    value_feature("cores", 1, "cores"),
    text_feature(1, "description"),
)


CONTAINER = make_section_kind(
    "container", nodes_feature("container", 5), value_feature("host", 1, "host"), value_feature("threads", 1, "threads")
)


def _mark_users(relations: ElementRelations, resource: Resource) -> frozenset[str]:
    return relations.common_ids("node", [node.id for node in relations.architecture.nodes_using(resource.id)])


RESOURCE = make_section_kind("resource", FeatureSpec("users", 5, _mark_users), value_feature("host", 1, "host"))
# Those ends in the key `connects` that are components.
_DEVICES = KeySpec(
    "devices",
    lambda link, context: context.common_ids("component", link.devices),
    worsening=Worsening.ALWAYS,
    refers_to="component",
    list_verbs=("now connects", "no longer connects"),
    new_verb="connects",
)
LINK = replace(
    make_section_kind(
        "link",
        reference_feature("connects", 4, "host", "connects"),
        FeatureSpec(
            "figures", 2, lambda _, link: mark_values(link.bandwidth, f"best {link.best}", f"worst {link.worst}")
        ),
    ),
    own_keys=(_DEVICES,),
    owner=read_owner,
)


def _find_writing_owner(frame: Frame, context: ReadContext) -> str | None:
    """Return the partner who owns what writes a frame, else what holds it."""
    architecture = context.architecture
    component = architecture.components.get(
        (frame.by if frame.by_kind == "component" else None) or frame.component or ""
    )
    node = architecture.nodes.get(frame.by or "") if frame.by_kind == "node" else None
    writer = node or component
    return context.common_id("partner", writer.owner) if writer else None


def _list_writers(frame: Frame, context: ReadContext) -> tuple[str, ...]:
    component = frame.by if frame.by_kind == "component" else None
    return (context.matched_ids.common_id("component", component),) if component else ()


def _mark_frame_ports(relations: ElementRelations, frame: Frame) -> frozenset[str]:
    ports = relations.users_by_element[f"frame:{frame.id}"]
    return relations.common_ids("input", ports) | relations.common_ids("output", ports)


FRAME = replace(
    make_section_kind(
        "frame",
        FeatureSpec("ports", 4, _mark_frame_ports),
        FeatureSpec("children", 3, lambda relations, frame: frozenset(relations.users_by_element[f"below:{frame.id}"])),
        value_feature("parent", 2, "parent"),
        FeatureSpec("by", 2, lambda relations, frame: relations.common_ids(frame.by_kind, [frame.by])),
    ),
    parent=lambda frame, context: (
        ("component", context.matched_ids.common_id("component", frame.component)) if frame.component else None
    ),
    owner=_find_writing_owner,
    components=_list_writers,
)


def _mark_waypoints(relations: ElementRelations, chain: Chain) -> frozenset[str]:
    return frozenset[str]().union(*(relations.common_ids(point.kind, [point.id]) for point in chain.through))


CHAIN = make_section_kind("chain", FeatureSpec("through", 6, _mark_waypoints), value_feature("deadline", 1, "deadline"))


def _mark_forbidden(_: ElementRelations, policy: Policy) -> frozenset[str]:
    return mark_values(f"{policy.forbid_from} > {policy.forbid_to}", policy.require and str(policy.require))


POLICY = make_section_kind("policy", FeatureSpec("forbids", 5, _mark_forbidden))
VARIANT = make_section_kind(
    "variant",
    # Where it writes counts more than what it writes: a variant may be renamed and changed at once.
    FeatureSpec("places", 8, lambda _, variant: mark_values(*(each.path for each in variant.changes))),
    FeatureSpec("changes", 2, lambda _, variant: mark_values(*(f"{c.path}: {c.value}" for c in variant.changes))),
    FeatureSpec("leaves out", 3, lambda _, variant: mark_values(variant.without, *variant.drop)),
    reference_feature("base", 0.5, "variant", "of"),
)
VIEW = make_section_kind("view", FeatureSpec("show", 5, lambda _, view: word_set(view.show)))
SYSTEM_KINDS = (HOST, CONTAINER, RESOURCE, LINK, FRAME, CHAIN, POLICY, VARIANT, VIEW)
