"""What runs where (hosts, containers, resources, links), and what the project says across all of it: chains, policies, views."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from operator import attrgetter
from typing import Any

from archgen.compare.element_likeness import word_set
from archgen.compare.element_relations import ElementRelations
from archgen.compare.kinds.frame_kind import FRAME
from archgen.compare.kinds.kind_spec import Effect, FeatureSpec, KeySpec, KindSpec, ReadContext, Worsening
from archgen.compare.kinds.shared_keys import (
    ANNOTATIONS,
    DESCRIPTION,
    LAYOUT,
    NAME_FEATURES,
    TAGS,
    TITLE,
    mark_values,
    requirements_key,
    text_feature,
)
from archgen.compare.kinds.variant_kind import VARIANT
from archgen.compare.normal_values import parameter_leaves
from archgen.model.architecture import Chain, Policy
from archgen.model.deployment import Container, Host, Resource

_HOST_OF = KeySpec(
    "host",
    lambda element, context: context.common_id("host", element.host),
    worsening=Worsening.ALWAYS,
    refers_to="host",
    verb="runs on",
)
_SCHEDULING = KeySpec("scheduling", worsening=Worsening.ALWAYS)


def _mark_containers(relations: ElementRelations, host: Host) -> frozenset[str]:
    containers = relations.architecture.containers.values()
    return relations.common_ids("container", [container.id for container in containers if container.host == host.id])


HOST = KindSpec(
    "host",
    "Hosts",
    (
        TITLE,
        KeySpec("cores", worsening=Worsening.LESS),
        _SCHEDULING,
        KeySpec(
            "scheduling.",
            lambda host, _: {str(core): order for core, order in host.core_scheduling.items()},
            worsening=Worsening.ALWAYS,
        ),
        DESCRIPTION,
        TAGS,
        *ANNOTATIONS,
    ),
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


def _read_parameters(container: Container, _context: ReadContext) -> Mapping[str, object]:
    return dict(leaf for name, value in container.parameters.items() for leaf in parameter_leaves(name, value))


CONTAINER = KindSpec(
    "container",
    "Containers",
    (
        TITLE,
        _HOST_OF,
        KeySpec("threads", worsening=Worsening.LESS),
        _SCHEDULING,
        KeySpec("name", effect=Effect.SYSTEM),
        KeySpec("namespace", lambda each, _: None if each.namespace == "/" else each.namespace, Effect.SYSTEM),
        KeySpec("package", effect=Effect.SYSTEM),
        KeySpec("executable", effect=Effect.SYSTEM),
        KeySpec("parameters.", _read_parameters, Effect.SYSTEM),
        *ANNOTATIONS,
    ),
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
    (TITLE, _HOST_OF, _SCHEDULING, *ANNOTATIONS),
    elements=lambda version: version.architecture.resources,
    features=(
        *NAME_FEATURES,
        FeatureSpec("users", 5, _mark_users),
        FeatureSpec("host", 1, lambda _, resource: mark_values(resource.host)),
    ),
)
LINK = KindSpec(
    "link",
    "Links",
    (
        TITLE,
        KeySpec(
            "connects",
            lambda link, context: context.common_ids("host", link.connects),
            worsening=Worsening.ALWAYS,
            refers_to="host",
            list_verbs=("now connects", "no longer connects"),
            new_verb="connects",
        ),
        KeySpec(
            "devices",
            lambda link, context: context.common_ids("component", link.devices),
            worsening=Worsening.ALWAYS,
            refers_to="component",
            list_verbs=("now connects", "no longer connects"),
            new_verb="connects",
        ),
        KeySpec("protocol", effect=Effect.SYSTEM),
        KeySpec("bandwidth", worsening=Worsening.LESS),
        KeySpec("latency.best", lambda link, _: link.best, worsening=Worsening.MORE, noun="best latency"),
        KeySpec("latency.worst", lambda link, _: link.worst, worsening=Worsening.MORE, noun="worst latency"),
        *ANNOTATIONS,
    ),
    elements=lambda version: version.architecture.links,
    features=(
        *NAME_FEATURES,
        FeatureSpec("connects", 4, lambda relations, link: relations.common_ids("host", link.connects)),
        FeatureSpec(
            "figures", 2, lambda _, link: mark_values(link.bandwidth, f"best {link.best}", f"worst {link.worst}")
        ),
    ),
)


def _read_waypoints(chain: Chain, context: ReadContext) -> tuple[str, ...]:
    return tuple(context.matched_ids.common_id(point.kind, point.id) for point in chain.through)


def _mark_waypoints(relations: ElementRelations, chain: Chain) -> frozenset[str]:
    return frozenset[str]().union(*(relations.common_ids(point.kind, [point.id]) for point in chain.through))


CHAIN = KindSpec(
    "chain",
    "Chains",
    (
        TITLE,
        KeySpec(
            "through",
            _read_waypoints,
            worsening=Worsening.ALWAYS,
            list_verbs=("now leads through", "no longer leads through"),
            new_verb="leads through",
        ),
        KeySpec("deadline", worsening=Worsening.LESS, verb="must end within", new_verb="must end within"),
        requirements_key(lambda chain: chain.requirements),
        *ANNOTATIONS,
    ),
    elements=lambda version: version.architecture.chains,
    features=(
        *NAME_FEATURES,
        FeatureSpec("through", 6, _mark_waypoints),
        FeatureSpec("deadline", 1, lambda _, chain: mark_values(chain.deadline)),
    ),
)


def _read_selector(read_text: Callable[[Any], str]) -> Callable[[Any, ReadContext], str | None]:
    """Return a reader of a selector, with the ids of the second version; None where none is written."""
    return lambda element, context: context.matched_ids.rename_in_text(" ".join(read_text(element).split())) or None


def _read_demand(policy: Policy, context: ReadContext) -> Mapping[str, object]:
    demand = policy.require
    if demand is None:
        return {}
    selectors = {key: _read_selector(attrgetter(key))(demand, context) for key in ("of", "inputs_from")}
    return {**selectors, "guarded_by": demand.guarded_by}


def _read_accepted(policy: Policy, context: ReadContext) -> Mapping[str, object]:
    return {str(context.common_id("input", name)): reason for name, reason in policy.accepted.items()}


POLICY = KindSpec(
    "policy",
    "Policies",
    (
        TITLE,
        KeySpec("forbid.from", _read_selector(lambda policy: policy.forbid_from), noun="forbidden source"),
        KeySpec("forbid.to", _read_selector(lambda policy: policy.forbid_to), noun="forbidden target"),
        KeySpec("require.", _read_demand),
        KeySpec("accepted.", _read_accepted),
        *ANNOTATIONS,
    ),
    Effect.SYSTEM,
    lambda version: version.architecture.policies,
    (
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
VIEW = KindSpec(
    "view",
    "Views",
    (
        TITLE,
        KeySpec("show", _read_selector(lambda view: view.show), noun="selector"),
        KeySpec("colour"),
        KeySpec("level", lambda view, _: None if view.level == "functional" else view.level),
        KeySpec("depth"),
        LAYOUT,
        *ANNOTATIONS,
    ),
    Effect.TEXT,
    lambda version: version.architecture.views,
    (*NAME_FEATURES, FeatureSpec("show", 5, lambda _, view: word_set(view.show))),
)
SYSTEM_KINDS = (HOST, CONTAINER, RESOURCE, LINK, FRAME, CHAIN, POLICY, VARIANT, VIEW)
