"""The functional level: groups, components, their ports, and the connections between these."""

from __future__ import annotations

from archgen.compare.compared_elements import MAPPED_KEY
from archgen.compare.element_likeness import letter_pairs, word_set
from archgen.compare.kinds.component_keys import is_mapped
from archgen.compare.kinds.element_owners import CO_OWNERS, read_owner
from archgen.compare.kinds.key_spec import Effect, KeySpec
from archgen.compare.kinds.kind_spec import FeatureSpec, KindSpec
from archgen.compare.kinds.port_kinds import INPUT, OUTPUT, read_own_output_words
from archgen.compare.kinds.shared_features import (
    NAME_FEATURES,
    list_last_names,
    mark_neighbours,
    mark_performance,
    mark_ports,
    mark_timing,
    mark_values,
    text_feature,
)
from archgen.model.path_resolver import title_from_id

GROUP = KindSpec(
    "group",
    None,
    (CO_OWNERS,),
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
COMPOSED = KindSpec(
    "composed",
    None,
    (CO_OWNERS, KeySpec("outputs.", read_own_output_words, Effect.SYSTEM)),
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
    like="component",
    without=frozenset({"role", "inputs", "outputs"}),
)
COMPONENT = KindSpec(
    "component",
    None,
    # Whether a node implements it follows from the nodes.
    (CO_OWNERS, KeySpec(MAPPED_KEY, is_mapped, Effect.SYSTEM)),
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
