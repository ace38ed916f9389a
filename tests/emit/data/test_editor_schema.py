"""The schema of a project for editors: it takes what the language takes, and offers the project's names."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterator
from typing import Any

import jsonschema_rs
import pytest
import yaml

from archgen import resources
from archgen.emit.data.editor_schema import make_editor_schema
from archgen.model.architecture import Architecture
from archgen.views.offered_names import list_offered_names

LANGUAGE = resources.resource_path("schemas", "archgen.schema.json").read_bytes()
LANGUAGE_VALIDATOR = jsonschema_rs.Draft202012Validator(json.loads(LANGUAGE))
RULES = {"unread-output": "An output that nobody reads."}
HOSTILE = (
    'groups: {g: \'x"}], "$ref": "http://evil/" <b> ${1:x} `\'}\ntypes: {\'"}$0 __proto__: {\': std_msgs/msg/Empty}'
)


@pytest.fixture
def schema_of(derived: Callable[[str], Architecture]) -> Callable[[str], Any]:
    """Make the schema of a project in one text."""

    def make(text: str) -> Any:  # noqa: ANN401 - JSON
        return make_editor_schema(LANGUAGE, list_offered_names(derived(text)), RULES)

    return make


def parts(part: Any) -> Iterator[dict[str, Any]]:  # noqa: ANN401 - JSON
    """Give every mapping in a schema."""
    if isinstance(part, dict):
        yield part
    for below in part.values() if isinstance(part, dict) else part if isinstance(part, list) else ():
        yield from parts(below)


@pytest.mark.parametrize(
    "text",
    [
        "groups: {g: {owner: nobody_yet, components: {c: {requirements: [New-1, some free text]}}}}",
        "groups: {g: {components: {c: {inputs: {a: not.there.yet, b: [x.y, z], d: {from: w}, e: }, outputs: {o: Type yet new}}}}}",
        "nodes: {n: {implements: later.one, host: new_pc, tags: [new], kind: [driver, lifecycle], timing: {wcet: }}}",
        "groups: {g: {title: true, tags: , components: {c: {title: 3, role: , owner: [a, b]}}}}",
        "chains: {k: [a, b.c], l: {through: x, deadline: 3 ms}}\nviews: {v: new_group -tag:x}",
        "rules: {unread-output: note, new-rule: warning, late-chain: {severity: error, margin: 20 %}}",
        "nodes: {n: {publishes: {a: /b, c: {topic: [x, y], qos: sensor_data}, d: {qos: {depth: 4}}}}}",
        "ros: {distro: new}\nlinks: {l: [a, b]}\ncontainers: {c: pc}\nhosts:\ntypes: {T: x/msg/Y}",
        "groups: {g: {owner: Foo Bar}}",
        "groups: {g: {components: {c: {role: sauce}}}}",
        "groups: {g: {components: {c: {titel: x}}}}",
        "groups: {g: {components: {c: {requirements: R-1}}}}",
        "groups: {g: {components: {c: {requirements: [null]}}}}",
        "groups: {g: {tags: [a b]}}",
        "nodes: {n: {timing: {wcet: 3}}}",
        "nodes: {n: {timing: {wcet: 3 parsec}}}",
        "rules: {unread-output: sauce}",
        "rules: {late-chain: {margn: 20 %}}",
        "nodes: {n: {publishes: {a: {qos: fast}}}}",
        "sections: {}",
    ],
)
def test_it_takes_and_refuses_what_the_language_takes_and_refuses(text: str, schema_of: Callable[[str], Any]) -> None:
    data = yaml.safe_load(text)
    validator = jsonschema_rs.Draft202012Validator(schema_of("groups: {g: G}\nhosts: {pc: PC}\npartners: {lab: L}"))
    assert validator.is_valid(data) == LANGUAGE_VALIDATOR.is_valid(data)


def test_nothing_that_would_be_offered_is_a_list_a_mapping_or_null(schema_of: Callable[[str], Any]) -> None:
    for part in parts(schema_of("groups: {g: G}")):
        if isinstance(part.get("examples"), list):
            assert all(isinstance(example, str) for example in part["examples"])
        if isinstance(part.get("enum"), list):
            assert None not in part["enum"]


def test_names_cannot_leave_their_strings(schema_of: Callable[[str], Any]) -> None:
    schema = json.loads(json.dumps(schema_of(HOSTILE)))
    assert schema["$defs"]["groups"]["properties"]["g"]["title"] == 'x"}], "$ref": "http://evil/" <b> ${1:x} `'
    assert schema["$defs"]["offered_types"]["enum"] == ['"}$0 __proto__: {']
    assert {part["$ref"][0] for part in parts(schema) if isinstance(part.get("$ref"), str)} == {"#"}


def test_every_reference_leads_somewhere(schema_of: Callable[[str], Any]) -> None:
    schema = schema_of("")
    references = {part["$ref"] for part in parts(schema) if isinstance(part.get("$ref"), str)}
    assert {reference.removeprefix("#/$defs/") for reference in references} <= set(schema["$defs"])


def test_a_rule_is_offered_with_its_summary(schema_of: Callable[[str], Any]) -> None:
    rule = schema_of("")["$defs"]["rules"]["properties"]["unread-output"]
    assert rule["title"] == "unread-output"
    assert rule["description"].startswith("An output that nobody reads.")


def test_names_stand_once_however_many_places_offer_them(schema_of: Callable[[str], Any]) -> None:
    text = json.dumps(schema_of("partners: {a_partner_of_its_own: P}"))
    # As a value, in lists of owners, as a key of the section, and in selectors.
    assert text.count("a_partner_of_its_own") == 4


def test_examples_in_explanations_are_yaml_and_the_languages_own(schema_of: Callable[[str], Any]) -> None:
    language, schema = json.loads(LANGUAGE), schema_of("")
    for name, part in language["$defs"].items():
        examples = [*part.get("examples", ()), *(snippet["body"] for snippet in part.get("defaultSnippets", ()))]
        explanation = schema["$defs"][name]["markdownDescription"]
        written = [yaml.safe_load(block) for block in re.findall(r"```yaml\n(.*?)\n```", explanation, re.DOTALL)]
        # Cores are keys that are numbers in YAML, and a day is a date.
        written = json.loads(json.dumps(written, default=str))
        kept = schema["$defs"][name].get("examples", [])
        assert kept + written == [example for example in examples if example not in ({}, [])], name


def test_declared_properties_are_offered_with_their_choices_and_media(schema_of: Callable[[str], Any]) -> None:
    text = (
        "properties: {maturity: {title: How far, choices: [idea, product]}, mass: Mass}\nlinks: {l: {protocol: ourbus}}"
    )
    definitions = schema_of(text)["$defs"]
    offered = definitions["properties"]["properties"]
    assert list(offered) == ["maturity", "mass"]
    assert offered["maturity"]["title"] == "How far"
    assert [each["enum"] for each in offered["maturity"]["anyOf"] if "enum" in each] == [["idea", "product"]]
    assert {"ourbus", "mqtt"} <= set(definitions["offered_media"]["enum"])
    assert {"$ref": "#/$defs/offered_media"} in definitions["output"]["properties"]["medium"]["anyOf"]
