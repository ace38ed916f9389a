"""What runs where (hosts, containers, resources, links), and what the project says across all of it: chains, policies, views."""

from __future__ import annotations

from archgen.compare.element_likeness import word_set
from archgen.compare.element_relations import ElementRelations
from archgen.compare.kinds.frame_kind import FRAME
from archgen.compare.kinds.key_spec import KeySpec, Worsening
from archgen.compare.kinds.kind_spec import FeatureSpec, KindSpec
from archgen.compare.kinds.shared_features import NAME_FEATURES, mark_values, text_feature
from archgen.model.architecture import Chain
from archgen.model.deployment import Host, Resource


def _mark_containers(relations: ElementRelations, host: Host) -> frozenset[str]:
    containers = relations.architecture.containers.values()
    return relations.common_ids("container", [container.id for container in containers if container.host == host.id])


HOST = KindSpec(
    "host",
    "Hosts",
    elements=lambda version: version.architecture.hosts,
    features=(
        *NAME_FEATURES,
        FeatureSpec(
            "nodes",
            8,
            lambda relations, host: relations.common_ids("node", relations.nodes_by_place[f"host:{host.id}"]),
        ),
        FeatureSpec("containers", 2, _mark_containers),
        FeatureSpec("cores", 1, lambda _, host: mark_values(host.cores)),
        text_feature(1, "description"),
    ),
)


CONTAINER = KindSpec(
    "container",
    "Containers",
    elements=lambda version: version.architecture.containers,
    features=(
        *NAME_FEATURES,
        FeatureSpec(
            "nodes",
            5,
            lambda relations, container: relations.common_ids(
                "node", relations.nodes_by_place[f"container:{container.id}"]
            ),
        ),
        FeatureSpec("host", 1, lambda _, container: mark_values(container.host)),
        FeatureSpec("threads", 1, lambda _, container: mark_values(container.threads)),
    ),
)


def _mark_users(relations: ElementRelations, resource: Resource) -> frozenset[str]:
    return relations.common_ids("node", [node.id for node in relations.architecture.nodes_using(resource.id)])


RESOURCE = KindSpec(
    "resource",
    "Resources",
    elements=lambda version: version.architecture.resources,
    features=(
        *NAME_FEATURES,
        FeatureSpec("users", 5, _mark_users),
        FeatureSpec("host", 1, lambda _, resource: mark_values(resource.host)),
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
        FeatureSpec("connects", 4, lambda relations, link: relations.common_ids("host", link.connects)),
        FeatureSpec(
            "figures", 2, lambda _, link: mark_values(link.bandwidth, f"best {link.best}", f"worst {link.worst}")
        ),
    ),
)


def _mark_waypoints(relations: ElementRelations, chain: Chain) -> frozenset[str]:
    return frozenset[str]().union(*(relations.common_ids(point.kind, [point.id]) for point in chain.through))


CHAIN = KindSpec(
    "chain",
    "Chains",
    elements=lambda version: version.architecture.chains,
    features=(
        *NAME_FEATURES,
        FeatureSpec("through", 6, _mark_waypoints),
        FeatureSpec("deadline", 1, lambda _, chain: mark_values(chain.deadline)),
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
        FeatureSpec("base", 0.5, lambda relations, variant: relations.common_ids("variant", variant.of)),
    ),
)
VIEW = KindSpec(
    "view",
    "Views",
    elements=lambda version: version.architecture.views,
    features=(*NAME_FEATURES, FeatureSpec("show", 5, lambda _, view: word_set(view.show))),
)
SYSTEM_KINDS = (HOST, CONTAINER, RESOURCE, LINK, FRAME, CHAIN, POLICY, VARIANT, VIEW)
