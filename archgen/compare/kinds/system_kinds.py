"""What runs where (hosts, containers, resources, links), and what is said across all of it: frames, chains, policies, views."""

from __future__ import annotations

from archgen.compare.element_likeness import word_set
from archgen.compare.element_relations import ElementRelations
from archgen.compare.kinds.key_spec import KeySpec, ReadContext, Worsening, read_owner
from archgen.compare.kinds.kind_spec import (
    NAME_FEATURES,
    FeatureSpec,
    KindSpec,
    mark_values,
    nodes_feature,
    reference_feature,
    text_feature,
    value_feature,
)
from archgen.model.coordinate_frames import Frame
from archgen.model.deployment import Host


def _mark_containers(relations: ElementRelations, host: Host) -> frozenset[str]:
    containers = relations.architecture.containers.values()
    return relations.common_ids("container", [container.id for container in containers if container.host == host.id])


HOST = KindSpec(
    "host",
    "Hosts",
    elements=lambda version: version.architecture.hosts,
    features=(
        *NAME_FEATURES,
        nodes_feature("host", 8),
        FeatureSpec("containers", 2, _mark_containers),
        value_feature("cores", 1, "cores"),
        text_feature(1, "description"),
    ),
)


CONTAINER = KindSpec(
    "container",
    "Containers",
    elements=lambda version: version.architecture.containers,
    features=(
        *NAME_FEATURES,
        nodes_feature("container", 5),
        value_feature("host", 1, "host"),
        value_feature("threads", 1, "threads"),
    ),
)


RESOURCE = KindSpec(
    "resource",
    "Resources",
    elements=lambda version: version.architecture.resources,
    features=(
        *NAME_FEATURES,
        FeatureSpec(
            "users",
            5,
            lambda relations, resource: relations.common_ids(
                "node", [node.id for node in relations.architecture.nodes_using(resource.id)]
            ),
        ),
        value_feature("host", 1, "host"),
    ),
)
# Those ends in the key `connects` that are components.
_DEVICES = KeySpec(
    "devices",
    lambda link, context: context.common_ids("component", link.devices),
    worsening=Worsening.ALWAYS,
    refers_to="component",
    list_verbs=("now connects", "no longer connects"),
    new_verb="connects",
)
LINK = KindSpec(
    "link",
    "Links",
    (_DEVICES,),
    elements=lambda version: version.architecture.links,
    features=(
        *NAME_FEATURES,
        reference_feature("connects", 4, "host", "connects"),
        FeatureSpec(
            "figures", 2, lambda _, link: mark_values(link.bandwidth, f"best {link.best}", f"worst {link.worst}")
        ),
    ),
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


FRAME = KindSpec(
    "frame",
    "Frames",
    elements=lambda version: version.architecture.frames,
    features=(
        *NAME_FEATURES,
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


CHAIN = KindSpec(
    "chain",
    "Chains",
    elements=lambda version: version.architecture.chains,
    features=(
        *NAME_FEATURES,
        FeatureSpec(
            "through",
            6,
            lambda relations, chain: frozenset[str]().union(
                *(relations.common_ids(point.kind, [point.id]) for point in chain.through)
            ),
        ),
        value_feature("deadline", 1, "deadline"),
    ),
)


POLICY = KindSpec(
    "policy",
    "Policies",
    elements=lambda version: version.architecture.policies,
    features=(
        *NAME_FEATURES,
        FeatureSpec(
            "forbids",
            5,
            lambda _, policy: mark_values(
                f"{policy.forbid_from} > {policy.forbid_to}", policy.require and str(policy.require)
            ),
        ),
    ),
)
VARIANT = KindSpec(
    "variant",
    "Variants",
    elements=lambda version: version.architecture.variants,
    features=(
        *NAME_FEATURES,
        # Where it writes counts more than what it writes: a variant may be renamed and changed at once.
        FeatureSpec("places", 8, lambda _, variant: mark_values(*(each.path for each in variant.changes))),
        FeatureSpec("changes", 2, lambda _, variant: mark_values(*(f"{c.path}: {c.value}" for c in variant.changes))),
        FeatureSpec("leaves out", 3, lambda _, variant: mark_values(variant.without, *variant.drop)),
        reference_feature("base", 0.5, "variant", "of"),
    ),
)
VIEW = KindSpec(
    "view",
    "Views",
    elements=lambda version: version.architecture.views,
    features=(*NAME_FEATURES, FeatureSpec("show", 5, lambda _, view: word_set(view.show))),
)
SYSTEM_KINDS = (HOST, CONTAINER, RESOURCE, LINK, FRAME, CHAIN, POLICY, VARIANT, VIEW)
