"""The functional level: groups, components, their ports, and the connections between these."""

from __future__ import annotations

from operator import attrgetter

from archgen.compare.kinds.component_keys import is_mapped
from archgen.compare.kinds.key_spec import CO_OWNERS, Effect, KeySpec, read_owner
from archgen.compare.kinds.kind_spec import (
    NAME_FEATURES,
    FeatureSpec,
    KindSpec,
    list_last_names,
    mark_neighbours,
    mark_performance,
    mark_ports,
    mark_timing,
    mark_values,
    name_features,
    nodes_feature,
    reference_feature,
    text_feature,
)
from archgen.compare.kinds.port_kinds import INPUT, OUTPUT, read_own_output_words
from archgen.compare.version_pair import MAPPED_KEY

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
        reference_feature("owner", 0.5, "partner", "owner"),
    ),
    owner=read_owner,
)
_LAST_NAME_FEATURES = name_features(attrgetter("name"))
COMPOSED = KindSpec(
    "composed",
    None,
    (CO_OWNERS, KeySpec("outputs.", read_own_output_words, Effect.SYSTEM)),
    Effect.SYSTEM,
    elements=lambda version: version.architecture.shells,
    features=(
        *_LAST_NAME_FEATURES,
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
        *_LAST_NAME_FEATURES,
        FeatureSpec("ports", 4, mark_ports),
        text_feature(3, "functionality", "description"),
        FeatureSpec("near", 3, mark_neighbours),
        nodes_feature("component", 3),
        reference_feature("group", 0.5, "group", "group"),
        reference_feature("owner", 0.5, "partner", "owner"),
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
