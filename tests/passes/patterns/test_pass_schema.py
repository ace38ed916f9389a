"""The schema of pass files, which editors use, and what archgen reads of them: both take the same."""

from __future__ import annotations

import json

import jsonschema_rs
import pytest
import yaml

from archgen.passes.pass_shape import STATES
from archgen.passes.patterns.expressions import VALUE_FUNCTIONS
from archgen.passes.patterns.pattern_registry import FILE_KEYS, MAX_RULES, list_shipped_passes
from archgen.passes.patterns.rule_reading import RULE_KEYS
from archgen.passes.patterns.view_values import VIEW_KEYS
from tests.passes.patterns.transforming import read
from tests.running import ROOT

SCHEMA = json.loads((ROOT / "schemas" / "pass.schema.json").read_text(encoding="utf-8"))
VALIDATOR = jsonschema_rs.validator_for(SCHEMA)


def test_shipped_passes_follow_the_schema() -> None:
    for shipped in list_shipped_passes(tuple(STATES)):
        assert [error.message for error in VALIDATOR.iter_errors(yaml.safe_load(shipped.text))] == [], shipped.name


def test_the_schema_knows_what_is_read() -> None:
    rule = SCHEMA["$defs"]["rule"]["properties"]
    assert set(SCHEMA["properties"]) == set(FILE_KEYS)
    assert set(rule) == set(RULE_KEYS)
    assert set(SCHEMA["$defs"]["view"]["properties"]) == set(VIEW_KEYS)
    assert set(SCHEMA["$defs"]["negative"]["properties"]) == {*VIEW_KEYS, "where"}
    assert {each["const"] for each in SCHEMA["$defs"]["state"]["oneOf"]} == set(STATES), (
        "write the new states into schemas/pass.schema.json"
    )
    assert SCHEMA["properties"]["rules"]["maxItems"] == MAX_RULES
    assert all(f"`{name}`" in rule["let"]["description"] for name in VALUE_FUNCTIONS)


@pytest.mark.parametrize(
    "text",
    [
        "title: x\n",
        "title: x\nrules: []\n",
        "title: x\nrules: [{find: {components: {$c: }}}]\n",
        "title: x\nrules: [{add: {components: {$c: }}}]\n",
        "title: x\nrules: [{find: {component: {$c: }}, drop: {components: {$c: }}}]\n",
        "title: x\nneeds: [flatt]\nrules: [{find: {components: {$c: }}, drop: {components: {$c: }}}]\n",
        "title: x\nrules: [{find: {components: {$c: }}, let: {n: x}, drop: {components: {$c: }}}]\n",
        "title: x\nrules: [{find: {components: {$c: }}, unless: {compnents: {$c: }}, drop: {components: {$c: }}}]\n",
    ],
)
def test_what_the_schema_refuses_archgen_refuses(text: str) -> None:
    assert list(VALIDATOR.iter_errors(yaml.safe_load(text)))
    assert read(text).read_pass is None
