"""The rules of linking: which of them nobody can switch off."""

from __future__ import annotations

from archgen.diagnostics.stage_rules import LINKING_RULES, MERGING_RULES


def test_what_later_stages_rely_on_cannot_be_switched_off() -> None:
    assert {rule.name: (str(rule.severity), rule.fixed) for rule in (*MERGING_RULES, *LINKING_RULES)} == {
        "conflicting-values": ("error", True),
        "undeclared-element": ("error", True),
        "unknown-port": ("error", True),
        "unknown-component": ("error", True),
        "changed-reference": ("error", True),
        "circular-types": ("error", True),
        "abstract-type": ("error", True),
        "narrower-type": ("error", True),
        "too-many-elements": ("error", True),
        "unknown-reference": ("error", True),
        "ambiguous-reference": ("error", True),
        "hidden-reference": ("warning", False),
        "reaches-outside": ("error", True),
        "reaches-inside": ("warning", False),
        "ambiguous-connection": ("warning", False),
        "several-sources": ("warning", False),
        "unused-node": ("note", False),
        "duplicate-port": ("error", True),
        "unknown-field-type": ("error", True),
        "circular-fields": ("error", True),
        "conflicting-message": ("error", True),
        "unbound-generic": ("error", True),
        "unknown-variant": ("error", True),
        "circular-variant": ("error", True),
        "missing-variant-part": ("error", False),
        "empty-variant-selector": ("warning", False),
        "duplicate-frame": ("error", True),
        "missing-chapter": ("error", True),
        "missing-picture": ("warning", False),
        "missing-file": ("warning", False),
        "missing-verification": ("warning", False),
        "shadowed-package": ("warning", False),
        "unlike-program": ("warning", False),
        "missing-parameter-file": ("off", False),
        "wrong-hint": ("error", False),
    }
