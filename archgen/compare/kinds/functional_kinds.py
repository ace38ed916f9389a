"""The functional level: groups, components, their ports, and the connections between these."""

from __future__ import annotations

from archgen.compare.compared_elements import MAPPED_KEY
from archgen.compare.element_likeness import letter_pairs, word_set
from archgen.compare.kinds.component_keys import (
    describe_ports,
    is_mapped,
    list_last_names,
    mark_neighbours,
    mark_performance,
    mark_ports,
    mark_timing,
    read_claimed_timing,
    read_component_type,
    read_node_timing,
    read_operations,
    read_parameters,
    read_performance,
)
from archgen.compare.kinds.kind_spec import Effect, FeatureSpec, KeySpec, KindSpec
from archgen.compare.kinds.port_kinds import INPUT, OUTPUT
from archgen.compare.kinds.promise_keys import read_own_output_words
from archgen.compare.kinds.shared_keys import (
    ANNOTATIONS,
    CO_OWNERS,
    DESCRIPTION,
    LAYOUT,
    NAME_FEATURES,
    OWNER,
    TAGS,
    TITLE,
    URLS,
    mark_values,
    prose_key,
    read_owner,
    requirements_key,
    text_feature,
    timing_key,
)
from archgen.compare.normal_values import normalize_title, unordered_values
from archgen.model.path_resolver import title_from_id

GROUP = KindSpec(
    "group",
    None,
    (
        TITLE,
        DESCRIPTION,
        OWNER,
        CO_OWNERS,
        TAGS,
        LAYOUT,
        URLS,
        *ANNOTATIONS,
    ),
    elements=lambda version: version.architecture.groups,
    features=(
        *NAME_FEATURES,
        # The names of its components outweigh all else: a group is what it holds.
        FeatureSpec("components", 8, lambda _, group: frozenset(group.components), is_decisive=True),
        text_feature(2, "description"),
        FeatureSpec("owner", 0.5, lambda relations, group: relations.common_ids("partner", [group.owner])),
    ),
    owner=read_owner,
)


_SETTING_KEYS = (
    KeySpec("parameters.", read_parameters, Effect.SYSTEM),
    KeySpec("open", lambda component, _: unordered_values(component.open), Effect.SYSTEM, noun="open sets"),
    KeySpec("operations.", read_operations, Effect.SYSTEM),
)
_PLAIN_KEYS = (
    KeySpec("status", effect=Effect.SYSTEM, verb="is"),
    KeySpec("contact", effect=Effect.TEXT),
    KeySpec("image", effect=Effect.TEXT, noun="picture"),
)
_PERFORMANCE = KeySpec("performance.", read_performance, Effect.SYSTEM)
_IS = KeySpec("is", read_component_type, Effect.SYSTEM, verb="is made from", noun="component type")
COMPOSED = KindSpec(
    "composed",
    None,
    (
        KeySpec("title", lambda shell, _: normalize_title(shell.name, shell.title), Effect.TEXT),
        prose_key("functionality"),
        DESCRIPTION,
        OWNER,
        CO_OWNERS,
        _IS,
        requirements_key(lambda shell: tuple(use.text for use in shell.requirements)),
        TAGS,
        LAYOUT,
        *_SETTING_KEYS,
        URLS,
        *_PLAIN_KEYS,
        _PERFORMANCE,
        timing_key(read_claimed_timing),
        KeySpec("outputs.", read_own_output_words, Effect.SYSTEM),
        *ANNOTATIONS,
    ),
    Effect.SYSTEM,
    elements=lambda version: version.architecture.shells,
    features=(
        FeatureSpec("name", 2, lambda _, shell: letter_pairs(shell.name)),
        FeatureSpec(
            "title",
            2,
            lambda _, shell: word_set(shell.title),
            lambda shell: shell.title in {title_from_id(shell.name), shell.name},
        ),
        # What it holds and passes on. Instances of one type are alike in this: of these the name decides.
        FeatureSpec("components", 6, lambda _, shell: frozenset(list_last_names(shell.children))),
        FeatureSpec("ports", 2, mark_ports),
        text_feature(3, "functionality", "description"),
    ),
    word="composed component",
    has_path_id=True,
    parent_kind="group",
    parent=lambda shell, context: ("group", context.matched_ids.common_id("group", shell.group)),
    owner=read_owner,
)
COMPONENT = KindSpec(
    "component",
    None,
    (
        KeySpec("title", lambda component, _: normalize_title(component.name, component.title), Effect.TEXT),
        prose_key("functionality"),
        DESCRIPTION,
        OWNER,
        CO_OWNERS,
        KeySpec("role", effect=Effect.SYSTEM, verb="is a"),
        _IS,
        requirements_key(lambda component: tuple(use.text for use in component.requirements)),
        TAGS,
        LAYOUT,
        KeySpec("inputs", lambda each, _: describe_ports(is_known=each.inputs_known, ports=each.inputs)),
        KeySpec("outputs", lambda each, _: describe_ports(is_known=each.outputs_known, ports=each.outputs)),
        *_SETTING_KEYS,
        URLS,
        *_PLAIN_KEYS,
        _PERFORMANCE,
        timing_key(read_node_timing),
        KeySpec(MAPPED_KEY, is_mapped, Effect.SYSTEM),
        *ANNOTATIONS,
    ),
    elements=lambda version: version.architecture.components,
    features=(
        FeatureSpec("name", 2, lambda _, component: letter_pairs(component.name)),
        FeatureSpec(
            "title",
            2,
            lambda _, component: word_set(component.title),
            lambda component: component.title in {title_from_id(component.name), component.name},
        ),
        FeatureSpec("ports", 4, mark_ports),
        text_feature(3, "functionality", "description"),
        FeatureSpec("near", 3, mark_neighbours),
        FeatureSpec(
            "nodes",
            3,
            lambda relations, component: relations.common_ids(
                "node", relations.nodes_by_place[f"component:{component.id}"]
            ),
        ),
        FeatureSpec("group", 0.5, lambda relations, component: relations.common_ids("group", [component.group])),
        FeatureSpec("owner", 0.5, lambda relations, component: relations.common_ids("partner", [component.owner])),
        FeatureSpec("requirements", 1, lambda _, component: mark_values(*(use.text for use in component.requirements))),
        FeatureSpec("performance", 1, mark_performance),
        FeatureSpec("timing", 1, mark_timing),
        FeatureSpec("tags", 0.5, lambda _, component: frozenset(component.tags)),
    ),
    has_path_id=True,
    parent_kind="group",
    parent=lambda component, context: ("group", context.matched_ids.common_id("group", component.group)),
    owner=read_owner,
    components=lambda component, context: (context.matched_ids.common_id("component", component.id),),
)


# Which outputs an input reads: compared by `connection_maps`, since it has no keys.
CONNECTION = KindSpec("connection", None)
FUNCTIONAL_KINDS = (GROUP, COMPOSED, COMPONENT, OUTPUT, INPUT, CONNECTION)
