"""Each place of the language that takes names is known to whoever follows them, or has a reason why not."""

from __future__ import annotations

from archgen.language.language_tables import ENTRIES, KEYS, OFFERS, SECTION_KINDS
from archgen.schema.written_names import (
    DECLARING_PARTS,
    NAMING_PARTS,
    SPELLINGS,
    list_written_places,
)
from archgen.syntax.yaml_parser import parse_yaml

NO_ELEMENTS = {
    "tags": "a tag is declared nowhere",
    "topics": "a topic is a name on the wire, and follows from what is written",
    "media": "a word for what data travels over",
    "distros": "a distribution of ROS",
    "chapters": "a file, or a chapter that archgen writes",
    "topic_messages": "a file of definitions, or a package of ROS",
    "call_messages": "a file of definitions, or a package of ROS",
}
"""What places offer that is no element of the project, and why nothing that names it is a reference."""
UNNAMING_PARTS = {
    "agreements": "two ids of partners in one word: what was signed is not edited",
    "signature.by": "what was signed is not edited",
    "signature.versions": "what was signed is not edited",
    "signature.versions.*": "what was signed is not edited",
    "generate.backends": "names of backends",
    "generate.backends.*": "options of backends",
    "callback_groups": "names of groups of callbacks, which nothing else names",
    "chain_deadline": "shares of reactions",
    "component_parameters": "parameters are names of programs",
    "parameter": "parameters are names of programs",
    "parameter_set": "parameters are names of programs",
    "parameter_commands": "parameters are names of programs",
    "port_conditions": "parameters are names of programs",
    "inner_nodes": "names of programs",
    "remaps": "names of programs",
    "internal_topics": "names of programs",
    "internal_calls": "names of programs",
    "start_environment": "names of programs",
    "fields": "fields of messages, which nothing of a project names",
    "message_part": "fields of messages, which nothing of a project names",
    "operation_fields": "fields of messages, which nothing of a project names",
    "operation.request": "fields of messages, which nothing of a project names",
    "operation.response": "fields of messages, which nothing of a project names",
    "constants": "constants of messages, which nothing of a project names",
    "operations": "operations are not named from elsewhere",
    "performance": "indicators are not named from elsewhere",
    "glossary": "terms of texts",
    "urls": "titles of links",
    "definitions": "files",
    "parameter_texts": "files",
    "report.pictures": "files",
    "report.texts": "chapters",
    "report.abbreviations": "terms of texts",
    "rules": "rules of archgen",
    "conform.accepted": "names on the wire",
    "host_scheduling": "words of the language",
}
"""Further mappings by id, and why their keys name no elements of the project."""


def test_all_that_is_offered_is_spelt_somehow_or_names_no_element() -> None:
    offered = {name for names in OFFERS.values() for name in names}
    assert offered <= SPELLINGS.keys() | NO_ELEMENTS.keys()
    assert not SPELLINGS.keys() & NO_ELEMENTS.keys()


def test_all_mappings_by_id_declare_name_or_have_a_reason() -> None:
    tables = (DECLARING_PARTS, NAMING_PARTS, UNNAMING_PARTS)
    assert sorted(each for table in tables for each in table) == sorted(ENTRIES)
    assert set(SECTION_KINDS.values()) <= set(DECLARING_PARTS.values()) <= KEYS.keys()


def test_keys_and_scalars_are_listed_with_their_parts() -> None:
    text = """\
groups:
  a: {owner: p, components: {x: {inputs: {b: {from: [y, z.out]}}, hints: {c: d}}}}
nodes: {n: a.x}
"""
    document, _ = parse_yaml("one.yaml", text)
    assert document is not None
    listed = [(each.text, each.part, each.is_key) for each in list_written_places(document.root)]
    assert listed == [
        ("a", "groups", True),
        ("p", "owners", False),
        ("x", "components", True),
        ("b", "inputs", True),
        ("y", "input.from", False),
        ("z.out", "input.from", False),
        ("n", "nodes", True),
        ("a.x", "node", False),
    ]
