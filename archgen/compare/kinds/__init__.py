"""The table of kinds: what elements of each kind have, how it is compared, matched and worded.

A kind has its keys from the description of the language (`derive_keys`), and beside them what is no key of it. What
elements are recognised by is a `FeatureSpec` in the module of their kind. tests/compare/test_element_kinds.py compares the
table with the description, the model, the resolved record and the cards.
"""

from archgen.compare.kinds.functional_kinds import COMPONENT_TYPE, FUNCTIONAL_KINDS
from archgen.compare.kinds.key_spec import Effect, KeySpec, Worsening
from archgen.compare.kinds.kind_spec import KindSpec, make_section_kind, values_feature
from archgen.compare.kinds.ros_kinds import ROS_KINDS
from archgen.compare.kinds.system_kinds import PROJECT_KINDS, SYSTEM_KINDS
from archgen.language.language_tables import KEY_FACTS, KIND_EFFECTS, SECTION_KINDS

_SPECIFIED_KINDS = {
    kind.name: kind for kind in (*PROJECT_KINDS, COMPONENT_TYPE, *FUNCTIONAL_KINDS, *ROS_KINDS, *SYSTEM_KINDS)
}
PLAIN_KINDS = {
    kind: make_section_kind(kind, values_feature(4, KEY_FACTS[kind].keys() - {"title"}))
    for kind in SECTION_KINDS.values()
    if kind in KIND_EFFECTS and kind not in _SPECIFIED_KINDS
}
"""Kinds of which the description says all: they are recognised by their names and by what they say."""
ELEMENT_KINDS: dict[str, KindSpec] = _SPECIFIED_KINDS | PLAIN_KINDS
"""All kinds by name, in the order in which changes are reported."""
KIND_ORDER = {name: position for position, name in enumerate(ELEMENT_KINDS)}
"""The position of each kind in that order."""
MATCHING_ORDER = (
    *(
        *("partner", "component_type", "group", "composed", "component", "output", "input", "type", "message", "node"),
        *("container", "host", "resource", "link"),
    ),
    *("frame", "chain", "requirement", "use_case", "view", "policy", "variant"),
    *PLAIN_KINDS,
)
"""The kinds that are recognised under other ids, each after those that its features refer to: groups before components,
hosts after nodes, links after hosts."""

__all__ = ["ELEMENT_KINDS", "KIND_ORDER", "MATCHING_ORDER", "PLAIN_KINDS", "Effect", "KeySpec", "KindSpec"]
__all__ += ["Worsening", "find_effect", "find_key"]


def find_key(kind: str, key: str) -> KeySpec:
    """Return what the table says of a key of a kind."""
    return ELEMENT_KINDS[kind].find_key(key)


def find_effect(kind: str, key: str | None) -> Effect:
    """Return how far a change of a key reaches; without a key, a change of the whole element."""
    spec = ELEMENT_KINDS[kind]
    return min(spec.effect, spec.find_key(key).effect) if key else spec.effect
