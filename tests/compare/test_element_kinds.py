"""The table of kinds agrees with the description, the model, the resolved record and the cards: what one of them has, all do.

A new field or kind fails here until the table has it. What is left out on purpose stands in the lists below, with the
reason; an entry that is no longer needed fails, too.
"""

from __future__ import annotations

import contextlib
import json
from collections.abc import Iterable, Mapping
from dataclasses import fields
from typing import Any, get_args, get_type_hints

import jsonschema_rs
import pytest

from archgen import pipeline
from archgen.compare.kinds import ELEMENT_KINDS, KIND_ORDER, MATCHING_ORDER, PLAIN_KINDS, Effect, find_effect, find_key
from archgen.compare.kinds.functional_kinds import OWN_KEYS
from archgen.language.language_tables import ENTRIES, KEY_FACTS, KEYS, RECORD_KEYS
from archgen.link.value_readers import list_fields
from archgen.model.architecture import Architecture, ProjectInfo
from archgen.model.component import ComponentType
from archgen.model.declared_timing import Timing
from archgen.views.elements.element_card import make_card
from archgen.views.elements.element_names import kinds_by_id
from archgen.views.lookup import Lookup, make_lookup
from archgen.views.records import resolved_record
from archgen.views.records.record_sources import SOURCES
from archgen.views.records.resolved_record import make_record
from archgen.views.search import make_search_entries
from tests.language_samples import SCHEMA, complete_project, read_data
from tests.running import ROOT

DESCRIBED = {kind: KEY_FACTS[kind] for kind in KEY_FACTS if kind in ELEMENT_KINDS}
"""The kinds of elements that the description lets one write, with what it says of their keys."""
SECTIONS = {kind: field.name for field in fields(Architecture) if (kind := ENTRIES.get(field.name, "")) in DESCRIBED}
"""Each kind with its section of the architecture."""
MODEL_CLASSES: Mapping[str, type] = {
    "project": ProjectInfo,
    **{kind: get_args(get_type_hints(Architecture)[section])[1] for kind, section in SECTIONS.items()},
}
NOT_WRITTEN_KINDS = {
    "chapter": "a file of its own",
    "message": "a file of its own, or a text below `ros: definitions`",
    "connection": "the `from` of an input",
    "port": "an entry of a node's `publishes`, `subscribes`, `serves` or `calls`",
    "composed": "a component with `components`",
}
"""Kinds that are no mapping of the schema."""
_OWN_TYPE_KEYS = {*OWN_KEYS, "functionality", "description"}
READ_OFF_PATTERNS = {
    "node",
    *(key.name.removesuffix(".") for key in ELEMENT_KINDS["component"].keys if key.name not in _OWN_TYPE_KEYS),
}
"""Keys of component types that comparisons read off patterns: they are linked for these."""
_SHOWN_SETTINGS = READ_OFF_PATTERNS & ({field.name for field in fields(ComponentType)} | {"properties", "hints"})
"""Those of them that a type has in the model as well, for its page."""
SCHEMA_ONLY = {"component_type layout": "what its instances have"}
TABLE_ONLY_FOR_SCHEMA = {
    **dict.fromkeys(("group co_owners", "component co_owners", "node co_owners"), "the rest of the list `owner`"),
    "component mapped": "follows from the nodes",
    "link devices": "those ends in the key `connects` that are components",
    "project distro": "below `ros`",
    "project shared_topics": "below `ros`",
    "project parameters": "below `ros`",
    "project environment": "below `ros`",
    "project discovery": "below `ros`",
    "project layout": "a section of its own",
    "project chapters": "below `report`",
    "project review": "a section of its own",
    "project agreements": "a section of its own",
    "project site": "a section of its own",
    "project rules": "a section of its own",
    **dict.fromkeys(("project properties", "project glossary"), "sections of their own"),
}
MODEL_ONLY = {
    "component parent": "the beginning of the id",
    "component children": "elements of their own",
    "component is_reference": "the key `is`",
    "output is_made": "what it gives on, as `autoconnect` follows from all that is written",
    "component_type library": "the beginning of the id",
    "type library": "where it is declared",
    "component_type frames": "those of its instances",
    "node wholes": "its components are in the key `implements`",
    **{f"{kind} id": "the key of the element" for kind in SECTIONS if kind != "type"},
    "type name": "the key of the element",
    "type origin": "where it is declared",
    **dict.fromkeys(("type constants", "type values", "type part_fields"), "the kind `message`"),
    **dict.fromkeys(("component name", "input name", "output name"), "the last part of the id"),
    **dict.fromkeys(("component group", "input component", "output component"), "the beginning of the id"),
    "group components": "elements of their own",
    "input connections": "the kind `connection`",
    "input from_written": "only for rules",
    **dict.fromkeys(("node implements_written", "node written"), "only for rules"),
    **dict.fromkeys(("component inputs_known", "component outputs_known"), "in the keys `inputs` and `outputs`"),
    "component requirements_known": "only for rules",
    "node uses": "the kind `port`",
    "frame component": "where it is written",
}
TABLE_ONLY_FOR_MODEL = {
    **{f"component_type {key}": "the field of its pattern" for key in READ_OFF_PATTERNS - _SHOWN_SETTINGS},
    "component mapped": "follows from the nodes",
    **{
        key: "a field of the architecture or of the version"
        for key in TABLE_ONLY_FOR_SCHEMA
        if key.startswith("project ")
    },
}
RECORD_ONLY = {
    "component_type frames": "those of its instances",
    "component parent": "the beginning of the id",
    "component is_reference": "the key `is`",
    "requirement served_by": "the key `requirements` of components",
    "requirement served_by_chains": "the key `requirements` of chains",
    "group components": "elements of their own",
    "component group": "the beginning of the id",
    "component nodes": "the key `implements` of nodes",
    **dict.fromkeys(("input id", "output id"), "the key of the element"),
    **dict.fromkeys(("type constants", "type values", "type part_fields"), "the kind `message`"),
    **dict.fromkeys(("input sources", "output readers"), "the kind `connection`"),
    "output message": "that of the type",
    "node full_name": "made of name and namespace",
    "node endpoints": "the kind `port`",
    "node effective_parameters": "made of the keys `parameters`",
    **dict.fromkeys(("link best", "link worst"), "the keys below `latency`"),
}
NOT_IN_RECORD = {
    **dict.fromkeys(("group layout", "component layout", "project layout"), "only for pictures"),
    "component mapped": "follows from the nodes",
    **{f"component_type {key}": "what its instances have" for key in READ_OFF_PATTERNS - _SHOWN_SETTINGS},
    "link latency": "the keys `best` and `worst`",
    **{f"project {key}": "a setting" for key in ("shared_topics", "chapters", "review", "rules", "site")},
    "project agreements": "between partners, not a part of the system",
    **dict.fromkeys(("project properties", "project glossary"), "sections of their own"),
}
KINDS_NOT_IN_RECORD = {
    "chapter": "a text, not a part of the system",
    "message": "a name: at types, endpoints and topics",
    "connection": "a list",
    "port": "the endpoints of a node",
    "view": "a picture, not a part of the system",
    "composed": "a component: beside the others",
    "policy": "a rule, not a part of the system",
}
CARD_ONLY = {
    "state": "what serves and verifies it, or whether it runs",
    "clock": "what `use_sim_time` says",
    "domain": "what the environment says",
    "parent": "the beginning of the id",
    "ROS name": "made of name and namespace",
    "group": "the beginning of the id",
    "component": "the beginning of the id",
    "message": "that of the type",
    "values": "the kind `message`",
}
NOT_ON_CARDS = {
    "requirement": "urls",
    "component_type": "autoconnect containers description layout node open performance requirements role tags timing urls",
    "group": "autoconnect layout urls",
    "component": "autoconnect components containers description frames from layout node open performance same_as urls",
    "output": "external from to",
    "input": "external from optional",
    "node": "arguments calls description inner_nodes internal language observed own_name parameter_commands parameter_files plugin publishes remaps "
    "serves subscribes tags urls",
    "type": "constants feedback request response status",
    "host": "environment tags",
    "link": "latency",
    "view": "colour depth layout level",
    "policy": "accepted forbid require",
}
"""Keys that only pages and lists show: a card is short."""
CARD_WORDS = {
    "node name": "ROS name",
    "node namespace": "ROS name",
    "container name": "ROS name",
    "container namespace": "ROS name",
    "requirement verified_by": "verified by",
}
"""Keys that a card calls otherwise."""
NOT_SEARCHED = {"policy": "a rule, not a part of the system"}
SEARCH_WORDS = {"output": "port", "input": "port"}
"""Kinds that the search calls otherwise."""
_ROBOT = """\
archgen: 1
project: {id: robot, title: Robot, version: "1", description: D, license: MIT, middleware: orocos}
ros: {distro: jazzy, parameters: {use_sim_time: true}, environment: {A: "1"}, discovery: peers}
partners: {certh: {title: C, description: D, contact: c@d.eu, reviewers: "@c", properties: {q: 1}, hints: {x: {a: 1}}}, sssa: S}
use_cases: {UC-1: {title: U, description: D, actors: {p: P}, steps: [{from: p, to: a, say: S}, {from: a, to: p}], properties: {q: 1}, hints: {x: {a: 1}}}}
requirements: {R-0: W, R-1: {title: R, description: D, parent: R-0, kind: k, priority: p, rationale: W, source: S, verified_by: [UC-1, c, t.py, by hand], use_cases: [UC-1], tags: [t], urls: {a: "https://a.eu"}, properties: {q: 1}, hints: {x: {a: 1}}}}
properties: {p: {title: P, description: D, of: [component], type: integer, unit: kg, range: [0, 9], choices: [1 kg, 2 kg], required: true}}
glossary: {T: Text}
groups:
  g:
    title: G
    description: D
    owner: [certh, sssa]
    tags: [t]
    urls: {a: "https://a.eu"}
    layout: {direction: top-bottom}
    properties: {q: 1}
    hints: {x: {a: 1}}
    components:
      a:
        title: A
        functionality: F
        description: D
        owner: [certh, sssa]
        role: source
        requirements: [R-1]
        performance: {p: {title: P, accuracy: 90 %, execution_time: 1 ms}}
        timing: {rate: 10 Hz, wcet: {max: 8 ms, p50: 2 ms, measured: true}, uses: {gpu: {max: 2 ms, min: 1 ms}}, deadline: 9 ms, cores: [1, 2]}
        tags: [t]
        urls: {a: "https://a.eu"}
        parameters: {gain: {type: float, value: 1, unit: m, range: [0, 2], choices: [1, 2], description: D, read_only: true, visibility: public, hints: {a: {b: 1}}}}
        open: [plugins]
        status: adapted
        contact: c@d.eu
        image: a.png
        properties: {p: 1 kg}
        hints: {x: {a: [1]}}
        operations: {reset: {title: R, request: {hard: bool}, response: T, call: asynchronous, visibility: private, description: D}}
        inputs: {i: {external: the world, type: T, medium: digital, optional: true, freshness: 1 s, frame: base, description: D, urls: {a: a.dbc}, properties: {q: 1}, hints: {x: {a: 1}}}}
        outputs: {o: {type: T, external: the world, frame: base, promise: {rate: 1 Hz, max_gap: 2 s, max_age: 3 s, unit: m, frame: base, range: [0, 1]}, version: 2, deprecated: {until: 2999-01-01, use: o2}, description: D, urls: {a: a.dbc}, properties: {q: 1}, hints: {x: {a: 1}}}, o2: {external: the world}}
        frames: {base: {title: B, parent: map, by: a, rate: 10 Hz, properties: {q: 1}, hints: {x: {a: 1}}}, eye: {parent: base, static: true}}
      b:
        inputs: {i: {external: the world}, j: {external: the world}, k: {external: the world}}
        outputs: {p: T}
        timing: {behaviour: event, trigger: {match: [i, j], within: 1 ms}, every: 2, dropped: forgotten, inputs: {k: {wcet: 1 ms, bcet: 0 ms}}}
      whole: {requirements: [R-1], components: {part: {is: drum, outputs: {o: {external: the world}}}}}
      copy: {same_as: drum}
  h: {components: {d: {outputs: {q: {medium: mqtt}}}, e: {inputs: {q: d.q}}}}
component_types:
  drum: {is: box<T>, title: D, functionality: F, description: D, owner: certh, version: 3, deprecated: {until: 2999-01-01, use: spare}}
  box: {generic: [X], abstract: true, inputs: {i: {type: X, external: the world}}, outputs: {o: X}, components: {c: C}}
  spare: {status: adapted, contact: c@d.eu, image: a.png, properties: {p: 1 kg}, hints: {x: {a: 1}}, parameters: {p: 1}, open: [q], operations: {r: T}, frames: {u: {parent: map}}, inputs: {u: {}}, outputs: {v: {}}}
types:
  T: {message: sensor_msgs/msg/Image, comment: C, size: 1 kB, status: planned, frame: map, version: 4, deprecated: {until: 2999-01-01, use: V}, properties: {q: 1}, hints: {x: {a: 1}}}
  S: {request: T, response: T, feedback: T}
  F: {fields: {x: {type: float64, default: 0.5, unit: m, comment: C}, y: {type: "int8[]", default: [1, 2]}, t: T}, constants: {A: {type: int8, value: 1, comment: C}}}
  V: {values: [ON, OFF]}
  G: {generic: [P], fields: {p: P}}
  Q: {request: {x: float64}, response: {f: F}, feedback: {}}
nodes:
  n:
    implements: a
    title: N
    description: D
    owner: [certh, sssa]
    name: m
    own_name: m_node
    inner_nodes: {costs: costs/costs}
    namespace: /ns
    kind: [composable, driver]
    package: p
    executable: e
    plugin: p::P
    language: cpp
    arguments: [a]
    remaps: {/tf: tf}
    container: box
    host: pc
    threads: 2
    scheduling: ros2_executor
    callback_groups: {fast: [a]}
    reentrant: true
    status: planned
    parameters: {plugins.x: 1}
    parameter_commands: {plugins.y: [cat, z]}
    parameter_files: [p.yaml]
    command: [stage, w]
    start: {phase: components, after: m, ready: {port: 1, file: f, topic: t, service: s, log: l, wait: 1 s, within: 2 s}, respawn: true, respawn_delay: 1 s, environment: {A: b}, directory: /d, user: u, once: true, state: active, by: m}
    tags: [t]
    urls: {a: "https://a.eu"}
    properties: {q: 1}
    hints: {x: {a: 1}}
    publishes: {o: {topic: /o, own_name: w, named_by: w_topic, when: {publish_w: true}}}
  m: {implements: b, observed: true}
  r: [whole, copy]
  s: {timing: {rate: 1 Hz}}
  t: [d, e]
hosts: {pc: {title: P, cores: 4, address: 10.0.0.2, discovery_server: 11811, environment: {A: "1"}, scheduling: edf, description: D, tags: [t], properties: {q: 1}, hints: {x: {a: 1}}}, arm: {scheduling: {0: fifo}}}
containers: {bare: pc, box: {title: B, host: pc, threads: 2, scheduling: fifo, namespace: /s, name: boxes, package: p, executable: e, parameters: {rate: 5}, properties: {q: 1}, hints: {x: {a: 1}}}}
resources: {gpu: {title: G, host: pc, scheduling: fifo, properties: {q: 1}, hints: {x: {a: 1}}}}
links: {lan: {title: L, connects: [pc, arm, b], owner: certh, protocol: can, bandwidth: 1 Gbit/s, latency: {best: 1 ms, worst: 2 ms}, properties: {q: 1}, hints: {x: {a: 1}}}}
frames: {map: }
chains: {c: {title: C, through: [a, n], deadline: 1 s, requirements: [R-1], properties: {q: 1}, hints: {x: {a: 1}}}}
views: {v: {title: V, show: g, colour: owner, level: implementation, depth: 1, layout: {direction: top-bottom}, properties: {q: 1}, hints: {x: {a: 1}}}}
policies: {p: {title: P, forbid: {from: g, to: g}, require: {of: b, inputs_from: "g.*", guarded_by: q}, accepted: {b.i: because}, properties: {q: 1}, hints: {x: {a: 1}}}}
variants:
  in: {title: I}
  sim: {title: S, description: D, of: [in], without: "g.whole", drop: [links.lan.title], changes: {hosts: {pc: {cores: 2}}}}
"""
"""A project in which every kind has every field that wants a place of its own; `complete_project` adds the others."""


def _add_plain_kinds(text: str) -> str:
    """Return a project with an element of each kind of which the description says all, with all its keys."""
    whole = complete_project(read_data(text), {kind: KEYS[kind] for kind in PLAIN_KINDS})
    return text + "".join(f"{SECTIONS[kind]}: {json.dumps(whole[SECTIONS[kind]])}\n" for kind in PLAIN_KINDS)


ROBOT = _add_plain_kinds(_ROBOT)


def table_keys(kind: str) -> set[str]:
    """Return the first parts of all keys of a kind, as they are written: `latency` for `latency.best`."""
    return {key.name.partition(".")[0] for key in ELEMENT_KINDS[kind].keys}


def find_fields(kind: str, key: str) -> tuple[str, ...]:
    """Return the fields of the model that hold a key of the table."""
    return list_fields(kind, key) if key in KEYS[kind] else (key,)


def missing(kind: str, names: Iterable[str], exceptions: Mapping[str, str], known: Iterable[str]) -> list[str]:
    """Return the names that are neither known nor excepted."""
    return sorted(name for name in set(names) - set(known) if f"{kind} {name}" not in exceptions)


@pytest.mark.parametrize("kind", DESCRIBED)
def test_what_one_may_write_is_compared(kind: str) -> None:
    written = {name.removesuffix(".") for name in DESCRIBED[kind]}
    assert missing(kind, written, SCHEMA_ONLY, table_keys(kind)) == [], "keys of the description without a KeySpec"
    assert missing(kind, table_keys(kind), TABLE_ONLY_FOR_SCHEMA, KEYS[kind]) == [], "keys that nobody can write"


@pytest.mark.parametrize("kind", list(MODEL_CLASSES))
def test_what_the_model_holds_is_compared(kind: str) -> None:
    held = [field.name for field in fields(MODEL_CLASSES[kind]) if field.compare]
    compared = {name for key in table_keys(kind) for name in find_fields(kind, key)}
    assert missing(kind, held, MODEL_ONLY, compared) == [], "fields of the model without a KeySpec"
    known = {key for key in table_keys(kind) if find_fields(kind, key)[0] in held}
    assert missing(kind, table_keys(kind), TABLE_ONLY_FOR_MODEL, known) == [], "keys without a field"


def test_what_timing_can_be_written_is_compared() -> None:
    names = {key.name.partition(".")[0] for key in find_key("component", "timing").inner}
    # A period is compared as the rate that it amounts to.
    assert set(KEYS["timing"]) == names | {"period"}
    # Measured times are below `wcet`.
    assert {field.name for field in fields(Timing) if field.compare} == names | {"period", "measured_times"}


@pytest.fixture(scope="module")
def lookup(tmp_path_factory: pytest.TempPathFactory) -> Lookup:
    file = tmp_path_factory.mktemp("robot") / "robot.yaml"
    whole = complete_project(read_data(ROBOT), {kind: RECORD_KEYS.get(kind, {}) for kind in MODEL_CLASSES})
    file.write_text(json.dumps(whole), encoding="utf-8")
    checked = pipeline.check_project(file)
    assert [str(finding) for finding in checked.findings if finding.severity == "error"] == []
    return make_lookup(checked.architecture)


def test_the_record_of_a_project_that_has_everything_follows_its_schema(lookup: Lookup) -> None:
    schema = json.loads((ROOT / "schemas" / "resolved.schema.json").read_text(encoding="utf-8"))
    data = json.loads(json.dumps(make_record(lookup)))
    assert [error.message for error in jsonschema_rs.Draft202012Validator(schema).iter_errors(data)] == []


def test_every_source_of_the_record_is_needed(lookup: Lookup, monkeypatch: pytest.MonkeyPatch) -> None:
    """Without its source a key is read off the field that is called like it: where that gives the same, there is no need."""
    lookups = [lookup, make_lookup(pipeline.check_project(ROOT / "examples" / "first_robot").architecture)]
    whole = [make_record(each) for each in lookups]
    needless = []
    for place in list(SOURCES):
        with monkeypatch.context() as without, contextlib.suppress(AttributeError, TypeError):
            without.setattr(resolved_record, "SOURCES", {each: SOURCES[each] for each in SOURCES if each != place})
            if [make_record(each) for each in lookups] == whole:
                needless.append(place)
    assert needless == []


def record_keys(record: Mapping[str, Any], kind: str) -> set[str]:
    """Return the keys that elements of a kind have in the record."""
    if kind == "project":
        return set(record["project"])
    if kind in {"input", "output"}:
        ports = (port for each in record["components"].values() for port in each.get(SECTIONS[kind], {}).values())
        return {key for port in ports for key in port}
    return {key for element in record[SECTIONS[kind]].values() for key in element}


@pytest.mark.parametrize("kind", [name for name in ELEMENT_KINDS if name not in KINDS_NOT_IN_RECORD])
def test_what_the_record_gives_is_compared(lookup: Lookup, kind: str) -> None:
    given = record_keys(make_record(lookup), kind)
    assert missing(kind, given, RECORD_ONLY, table_keys(kind)) == [], "keys of the record without a KeySpec"
    assert missing(kind, table_keys(kind), NOT_IN_RECORD, given) == [], "keys that the record does not give"


def test_what_cards_show_is_compared(lookup: Lookup) -> None:
    shown = {
        (kind.replace(" ", "_"), fact)
        for element_id, kinds in kinds_by_id(lookup).items()
        for kind in kinds
        if kind not in {"topic", "channel"}  # made of what nodes say of their ports
        for fact, _ in make_card(lookup, kind, element_id).facts
    }
    assert [(k, fact) for k, fact in sorted(shown) if fact not in {*table_keys(k), *CARD_ONLY}] == []


def test_a_card_shows_each_key_that_is_not_for_pages_alone(lookup: Lookup) -> None:
    shown: dict[str, set[str]] = {}
    for element_id, kinds in kinds_by_id(lookup).items():
        for kind in kinds:
            card = make_card(lookup, kind, element_id)
            shown.setdefault(kind.replace(" ", "_"), set()).update(name for name, _ in (*card.facts, *card.lists))
    hidden = {
        f"{kind} {key}"
        for kind in SECTIONS
        for key in SCHEMA["$defs"][kind]["properties"]
        if key != "title" and CARD_WORDS.get(f"{kind} {key}", key) not in shown[kind]
    }
    assert hidden == {f"{kind} {key}" for kind, keys in NOT_ON_CARDS.items() for key in keys.split()}


def test_the_search_finds_elements_of_each_kind(lookup: Lookup) -> None:
    found = {entry.kind for entry in make_search_entries(lookup, ())}
    # A plain kind has no page yet to which the search could lead.
    paged_kinds = [kind for kind in SECTIONS if kind not in PLAIN_KINDS]
    missing_kinds = [kind for kind in paged_kinds if SEARCH_WORDS.get(kind, kind.replace("_", " ")) not in found]
    assert missing_kinds == list(NOT_SEARCHED)


def test_the_kinds_are_those_of_the_model_and_of_the_cards(lookup: Lookup) -> None:
    kinds = set(ELEMENT_KINDS) - set(NOT_WRITTEN_KINDS)
    assert kinds == set(DESCRIBED)
    assert set(MODEL_CLASSES) == kinds
    assert set(SECTIONS) == kinds - {"project"}
    carded = {kind.replace(" ", "_") for kinds in kinds_by_id(lookup).values() for kind in kinds}
    assert carded - {"topic", "channel", "composed"} == set(SECTIONS)
    # What else an architecture maps from ids: topics follow from nodes.
    mapped = {field.name for field in fields(Architecture) if str(field.type).startswith("Mapping[str, ")}
    # Nor are composed components a kind of their own in files; properties, terms and agreements are the project's.
    others = {"topics", "channels", "shells", "shell_ports", "properties", "glossary", "agreements"}
    assert mapped - others == set(SECTIONS.values())


def test_the_exceptions_are_needed() -> None:
    written = {f"{kind} {name}" for kind in DESCRIBED for name in KEYS[kind]}
    model = {f"{k} {field.name}" for k, each in MODEL_CLASSES.items() for field in fields(each)}
    table = {f"{k} {name}" for k in ELEMENT_KINDS for name in table_keys(k)}
    assert set(SCHEMA_ONLY) <= written - table
    compared = {f"{k} {name}" for k in DESCRIBED for key in table_keys(k) for name in find_fields(k, key)}
    held = {f"{k} {key}" for k in DESCRIBED for key in table_keys(k) if f"{k} {find_fields(k, key)[0]}" in model}
    assert set(MODEL_ONLY) <= model - compared
    assert set(TABLE_ONLY_FOR_SCHEMA) <= table - written
    assert set(TABLE_ONLY_FOR_MODEL) <= table - held
    assert set(NOT_IN_RECORD) <= table
    assert not set(RECORD_ONLY) & table


def test_every_kind_is_recognised_after_those_that_its_features_refer_to() -> None:
    assert sorted(MATCHING_ORDER) == sorted(name for name, kind in ELEMENT_KINDS.items() if kind.features)
    place = MATCHING_ORDER.index
    for earlier, later in (
        *(("group", "component"), ("component", "output"), ("output", "input"), ("type", "message")),
        *(("component", "node"), ("node", "container"), ("node", "host"), ("container", "host"), ("host", "link")),
        *(
            ("node", "chain"),
            ("component", "frame"),
            ("component", "requirement"),
            ("requirement", "use_case"),
            ("partner", "group"),
        ),
    ):
        assert place(earlier) < place(later), (earlier, later)


def test_the_order_of_the_report() -> None:
    order = [
        *("project", "chapter", "partner", "use_case", "requirement", "component_type", "group", "composed"),
        *("component", "output", "input"),
        *("connection", "type", "message", "node", "port", "host", "container", "resource", "link", "frame"),
        *("chain", "policy", "variant", "view"),
    ]
    assert [kind for kind in KIND_ORDER if kind in order] == order
    assert list(KIND_ORDER.values()) == list(range(len(ELEMENT_KINDS)))


def test_the_schema_of_comparisons_knows_every_kind() -> None:
    schema = json.loads((ROOT / "schemas" / "diff.schema.json").read_text(encoding="utf-8"))
    assert schema["$defs"]["change"]["properties"]["sort"]["enum"] == list(KIND_ORDER)


def test_whatever_refers_to_a_kind_names_one() -> None:
    for kind in ELEMENT_KINDS.values():
        for key in kind.keys:
            assert key.refers_to is None or key.refers_to in ELEMENT_KINDS, (kind.name, key.name)


def test_no_key_is_listed_twice() -> None:
    for kind in ELEMENT_KINDS.values():
        names = [key.name for key in kind.keys]
        assert len(names) == len(set(names)), kind.name


@pytest.mark.parametrize(
    ("effect", "keys"),
    [
        (
            Effect.TEXT,
            (
                "group title, group description, group tags, group layout, group urls.docs, component functionality, "
                "type comment, input external, output description, chapter text, "
                "view show, view colour, view level, use_case title, use_case actors.p, use_case steps, requirement title, requirement urls.x, project title, "
                "requirement rationale, requirement source, "
                "project layout, partner description, host tags, node urls.x, frame title, component contact, component image, input urls.x, output urls.x, view properties.x, "
                "use_case hints.x, project glossary.x"
            ),
        ),
        (
            Effect.SYSTEM,
            (
                "group owner, group co_owners, component owner, component co_owners, node co_owners, component role, component performance.p.accuracy, "
                "component requirements, chain requirements, node package, node executable, node plugin, node language, node arguments, node remaps.x, port own_name, node status, "
                "node name, node namespace, node parameter_files, node parameters.x, node parameter_commands.x, node command, node start.after, node start.ready.port, node start.environment.x, project parameters.x, "
                "component parameters.x, component parameters.x:unit, component open, component operations.x, type status, input optional, "
                "project version, project rules.unread-output, project review.main, project shared_topics, "
                "partner contact, partner reviewers, requirement use_cases, policy forbid.from, component timing.wcet.p50, "
                "requirement parent, requirement kind, requirement priority, requirement verified_by, "
                "type generic, type fields.x, component timing.wcet.measured, node timing.wcet.p99, frame parent, frame by, frame rate, frame static, "
                "link protocol, link owner, milestone date, milestone needs, project middleware, "
                "output frame, input frame, type frame, component status, component properties.trl, node hints.a.b, host properties.x, "
                "project properties.trl, output promise.rate, output version, output deprecated.until, type version, "
                "type deprecated.use, component_type version, component_type deprecated.until"
            ),
        ),
        (
            Effect.TIMING,
            (
                "component timing.rate, component timing.outputs.x.max_gap, node timing.g.a.wcet, node host, node kind, "
                "node container, node implements, port qos, port qos.depth, port topic, port message, type size, "
                "type message, type request, message fields, output type, input type, output medium, host cores, "
                "container host, container threads, link connects, link bandwidth, link latency.worst, chain through, "
                "chain deadline, component inputs, node threads, node scheduling, node callback_groups.x, node reentrant, "
                "host scheduling, host scheduling.0, container scheduling, resource host, resource scheduling, "
                "component timing.uses.gpu, component timing.inputs.x.wcet, component timing.cores, input freshness, link devices"
            ),
        ),
    ],
)
def test_how_far_a_changed_key_reaches(effect: Effect, keys: str) -> None:
    for kind, key in (each.split() for each in keys.split(", ")):
        assert find_effect(kind, key) is effect, (kind, key)


_SPECIFIED_KINDS = ELEMENT_KINDS.keys() - PLAIN_KINDS.keys()
"""Those with a table of their own: of the others the description says how far a change of them reaches."""


def test_how_far_a_whole_element_reaches() -> None:
    assert {kind for kind in _SPECIFIED_KINDS if find_effect(kind, None) is Effect.TEXT} == {
        "chapter",
        "view",
        "use_case",
    }
    assert {kind for kind in _SPECIFIED_KINDS if find_effect(kind, None) is Effect.SYSTEM} == {
        *("project", "partner", "requirement", "policy", "component_type", "composed", "frame", "variant")
    }


def test_a_key_that_no_kind_has_may_affect_everything() -> None:
    assert find_effect("host", "colour") is Effect.TIMING
    assert find_effect("partner", "colour") is Effect.SYSTEM
    assert find_key("component", "timing.wcet").name == "wcet"
    assert find_key("component", "timing.outputs.x").name == "outputs."
    assert find_key("component", "timing.colour").name == "timing."
    assert find_key("port", "qos") is find_key("port", "qos.depth")


def test_by_what_elements_are_recognised_under_another_id() -> None:
    """Features with their weights, those that decide alone with `!`; without any, an element is never recognised."""
    lines = [
        f"{name}: " + ", ".join(f"{each.name} {each.weight}{'!' if each.is_decisive else ''}" for each in kind.features)
        for name, kind in ELEMENT_KINDS.items()
        if kind.features and name not in PLAIN_KINDS
    ]
    assert lines == [
        "partner: name 2, title 2, owns 4",
        "use_case: name 1, title 4, text 2, users 3",
        "requirement: name 1, title 4, text 2, users 3",
        "component_type: name 2, title 2, ports 4, components 4, parameters 2, text 3",
        "group: name 2, title 2, components 8!, text 2, owner 0.5",
        "composed: name 2, title 2, components 6, ports 2, text 3",
        "component: name 2, title 2, ports 4, text 3, near 3, nodes 3, group 0.5, owner 0.5, requirements 1, performance 1, timing 1, tags 0.5",
        "output: name 2, type 4, topics 3, text 1, readers 5",
        "input: name 2, type 4, topics 3, text 1, sources 5",
        "type: name 2, message 3, users 5, text 1, size 1, inside 2, fields 3",
        "message: name 2, package 1, fields 5, users 4",
        "node: name 2, title 2, implements 4, package 2, program 2, ports 2, topics 1, place 1, parameters 1, text 1",
        "host: name 2, title 2, nodes 8, containers 2, cores 1, text 1",
        "container: name 2, title 2, nodes 5, host 1, threads 1",
        "resource: name 2, title 2, users 5, host 1",
        "link: name 2, title 2, connects 4, figures 2",
        "frame: name 2, title 2, ports 4, children 3, parent 2, by 2",
        "chain: name 2, title 2, through 6, deadline 1",
        "policy: name 2, title 2, forbids 5",
        "variant: name 2, title 2, places 8, changes 2, leaves out 3, base 0.5",
        "view: name 2, title 2, show 5",
    ]
