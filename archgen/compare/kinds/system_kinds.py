"""The project and its partners, use cases and requirements, what runs where, and what is said across all of it: frames,
chains, views.
"""

from __future__ import annotations

from collections.abc import Mapping

from archgen.compare.element_likeness import letter_pairs, word_set
from archgen.compare.element_relations import ElementRelations
from archgen.compare.kinds.key_spec import Effect, KeySpec, ReadContext, Worsening, read_owner
from archgen.compare.kinds.kind_spec import (
    FeatureSpec,
    KindSpec,
    make_section_kind,
    mark_values,
    nodes_feature,
    reference_feature,
    text_feature,
    users_feature,
    value_feature,
)
from archgen.compare.normal_values import freeze_value, normalize_text, unordered_values
from archgen.frozen import replace
from archgen.model.architecture import Chain, Policy, ProjectInfo
from archgen.model.coordinate_frames import Frame
from archgen.model.deployment import Host, Resource
from archgen.model.element_annotations import describe_range
from archgen.model.path_resolver import title_from_id


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


def _read_review(_project: ProjectInfo, context: ReadContext) -> Mapping[str, object]:
    review = context.architecture.review
    texts_by_element: dict[str, list[str]] = {}
    for entry in review.accepted:
        text = f"{entry.reason} ({entry.key})" if entry.key else entry.reason
        texts_by_element.setdefault(entry.element, []).append(text)
    return {
        "main": review.main,
        "breaking": review.breaking and str(review.breaking),
        "backends": unordered_values(review.backends),
        "passes": unordered_values(review.passes),
        **{f"accepted.{name}": "; ".join(texts) for name, texts in texts_by_element.items()},
    }


def _read_agreements(_project: ProjectInfo, context: ReadContext) -> Mapping[str, object]:
    """Return the terms in words, and under which tag what was signed; what left it is told by itself."""
    values: dict[str, object] = {}
    for agreement in context.architecture.agreements.values():
        terms = {"": agreement.terms, **{f"{key}.": texts for key, texts in agreement.interfaces.items()}}
        values |= {
            f"{agreement.id}.{key}{name}": normalize_text(text)
            for key, texts in terms.items()
            for name, text in texts.items()
        }
        if agreement.signed:
            values[f"{agreement.id}.signed"] = ", ".join(
                [
                    agreement.signed.tag or "without a tag",
                    *(f"{each} by {who}" for each, who in agreement.signed.by.items()),
                ]
            )
    return values


def _read_declared_properties(_project: ProjectInfo, context: ReadContext) -> Mapping[str, object]:
    """Return what is declared of properties: that there is one by its id, what is said of it by `id:key`."""
    values: dict[str, object] = {}
    for name, declared in context.architecture.properties.items():
        values[name] = "declared"
        facets = {
            "title": None if declared.title in {title_from_id(name), name} else declared.title,
            "description": normalize_text(declared.description),
            "of": ", ".join(declared.of) or None,
            "type": declared.type,
            "unit": declared.unit,
            "range": describe_range(declared) or None,
            "choices": ", ".join(declared.choices) or None,
            "required": declared.required or None,
        }
        values |= {f"{name}:{key}": freeze_value(value) for key, value in facets.items() if value is not None}
    return values


def _read_site(_project: ProjectInfo, context: ReadContext) -> Mapping[str, object]:
    repository = context.architecture.repository
    if repository is None:
        return {}
    return {
        "repository": repository.address,
        "branch": repository.branch,
        "folder": repository.folder,
        "forge": repository.forge,
    }


# Sections, and parts of sections, that belong to no other element.
_SETTING_KEYS = (
    KeySpec("distro", lambda _, context: context.architecture.distro, noun="ROS distribution"),
    KeySpec(
        "environment.", lambda _, context: {each.name: each.value for each in context.architecture.ros_environment}
    ),
    KeySpec("discovery", lambda _, context: context.architecture.ros_discovery),
    KeySpec("shared_topics", lambda _, context: unordered_values(context.architecture.shared_topics)),
    KeySpec(
        "parameters.",
        lambda _, context: {value.name: freeze_value(value.value) for value in context.architecture.ros_parameters},
    ),
    KeySpec("layout", lambda _, context: context.architecture.layout.direction, Effect.TEXT),
    KeySpec("chapters", lambda _, context: context.version.chapter_order),
    KeySpec("review.", _read_review),
    KeySpec("agreements.", _read_agreements, noun="agreement"),
    KeySpec("site.", _read_site, Effect.TEXT),
    KeySpec("properties.", _read_declared_properties),
    KeySpec(
        "glossary.",
        lambda _, context: {each.term: normalize_text(each.text) for each in context.architecture.glossary.values()},
        Effect.TEXT,
    ),
    KeySpec("rules.", lambda _, context: context.version.rule_settings),
)
PROJECT = KindSpec(
    "project",
    "Project",
    _SETTING_KEYS,
    elements=lambda version: {version.architecture.project.id: version.architecture.project},
)
CHAPTER = KindSpec(
    "chapter",
    "Chapters",
    (KeySpec("text", lambda text, _: normalize_text(text), is_prose=True),),
    Effect.TEXT,
    lambda version: version.chapters,
)
PARTNER = replace(
    make_section_kind(
        "partner",
        FeatureSpec("owns", 4, lambda relations, partner: frozenset(relations.elements_by_owner[partner.id])),
    ),
    owner=lambda partner, context: context.common_id("partner", partner.id),
)
# Unlike elsewhere the title weighs more than the id: ids of requirements and use cases are mostly numbers.
_NUMBERED_FEATURES = (
    FeatureSpec("name", 1, lambda _, element: letter_pairs(element.id)),
    FeatureSpec("title", 4, lambda _, element: word_set(element.title), lambda element: element.title == element.id),
    text_feature(2, "description"),
)
USE_CASE = make_section_kind("use_case", users_feature("use_case", 3, "requirement"), names=_NUMBERED_FEATURES)
_REQUIREMENT = make_section_kind("requirement", users_feature("requirement", 3, "component"), names=_NUMBERED_FEATURES)
PROJECT_KINDS = (PROJECT, CHAPTER, PARTNER, USE_CASE, _REQUIREMENT)
