"""Hints are held against what the project's own backends say that they read, with the place of what is wrong."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen.link.hint_checks import list_hint_faults
from archgen.pipeline import check_project
from archgen.syntax.yaml_parser import parse_yaml

MANIFEST = """\
id: orca
title: Orca
emitter: text
view: record
hints_schema:
  component:
    type: object
    additionalProperties: false
    required: [tag]
    properties:
      tag: {type: string, enum: [Car, Ice]}
      untagged: {type: array, items: {type: string}}
      slot: {type: [integer, boolean], minimum: 0, maximum: 7.5}
      wires: {type: object, additionalProperties: {type: number}}
  output: {}
"""


def check(folder: Path, hints: str, manifest: str | None = MANIFEST) -> list[str]:
    (folder / "archgen.yaml").write_text(
        f"archgen: 1\ngroups:\n  g:\n    components:\n      a:\n        functionality: F\n        hints: {hints}\nnodes: {{a: {{implements: a}}}}\n",
        encoding="utf-8",
    )
    if manifest is not None:
        (folder / "backends" / "orca").mkdir(parents=True, exist_ok=True)
        (folder / "backends" / "orca" / "backend.yaml").write_text(manifest, encoding="utf-8")
    return [
        f"{each.span.column}: {each.message.partition(' of the component `g.a` ')[::2]} {each.help or ''}".rstrip()
        for each in check_project(folder).findings
        if each.rule == "wrong-hint"
    ]


@pytest.mark.parametrize(
    ("hints", "found"),
    [
        ("{orca: {tag: Car, untagged: [Ice], slot: 3, wires: {a: 1.5}}, other: {x: 1}}", []),
        ("{orca: {tag: Car, slot: true}}", []),
        ("{orca: {tag: Cat}}", ["24: ('`hints.orca.tag`', 'is `Cat`, but must be `Car` or `Ice`') did you mean `Car`?"]),
        ("{orca: {tags: Car, tag: Car}}", ["24: ('`hints.orca.tags`', 'is no key that the backend reads') did you mean `tag`?"]),
        ("{orca: {slot: 1}}", ["17: ('`hints.orca`', 'lacks `tag`')"]),
        ("{orca: [Car]}", ["17: ('`hints.orca`', 'is a list, but must be a mapping')"]),
        ("{orca: }", ["17: ('`hints.orca`', 'is empty, but must be a mapping')"]),
        ("{orca: {tag: Car, untagged: [Ice, 3]}}", ["50: ('`hints.orca.untagged.1`', 'is `3`, but must be text')"]),
        ("{orca: {tag: Car, slot: -1}}", ["34: ('`hints.orca.slot`', 'is `-1`, but must be at least 0')"]),
        ("{orca: {tag: Car, slot: 8}}", ["34: ('`hints.orca.slot`', 'is `8`, but must be at most 7.5')"]),
        ("{orca: {tag: Car, slot: x}}", ["34: ('`hints.orca.slot`', 'is `x`, but must be a whole number or `true` or `false`')"]),
        ("{orca: {tag: Car, wires: {a: b}}}", ["42: ('`hints.orca.wires.a`', 'is `b`, but must be a number')"]),
    ],
)  # fmt: skip
def test_each_slip_has_its_place_and_words(hints: str, found: list[str], tmp_path: Path) -> None:
    assert check(tmp_path, hints) == found


def test_without_a_schema_hints_are_free(tmp_path: Path) -> None:
    assert check(tmp_path, "{mine: [1]}", None) == []
    # One that ships has a schema.
    assert [each.partition(": ")[0] for each in check(tmp_path, "{orca: [1]}", None)] == ["17"]
    assert check(tmp_path, "{orca: [1]}", "id: orca\n") == []
    assert check(tmp_path, "{orca: [1]}", "hints_schema: text\n") == []
    assert check(tmp_path, "{orca: [1]}", "{no yaml") == []
    assert check(tmp_path, "{orca: [1]}", "hints_schema: {any: {}}\n") == []


def test_a_kind_that_the_backend_does_not_know_is_told(tmp_path: Path) -> None:
    manifest = "hints_schema: {host: {type: object}, any: {type: array}}\n"
    assert check(tmp_path, "{orca: {a: 1}}", manifest) == ["17: ('`hints.orca`', 'is a mapping, but must be a list')"]
    manifest = "hints_schema: {host: {type: object}}\n"
    assert check(tmp_path, "{orca: {a: 1}}", manifest) == [
        "17: ('`hints.orca`', 'is not read: the backend reads hints of `host`')"
    ]


def test_a_slip_in_a_type_is_told_once(tmp_path: Path) -> None:
    assert check(tmp_path, "{orca: {tag: Car}}") == []
    text = """\
archgen: 1
component_types: {motor: {hints: {orca: {slot: 9}}}}
groups: {g: {components: {a: {is: motor, hints: {orca: {tag: Car}}}, b: {is: motor, hints: {orca: {tag: Ice}}}}}}
"""
    (tmp_path / "archgen.yaml").write_text(text, encoding="utf-8")
    manifest = MANIFEST.replace("  output: {}", "  component_type: {}")
    (tmp_path / "backends" / "orca" / "backend.yaml").write_text(manifest, encoding="utf-8")
    found = [(each.span.line, each.element) for each in check_project(tmp_path).findings if each.rule == "wrong-hint"]
    assert found == [(2, "g.a")]


@pytest.mark.parametrize(
    ("number", "faults"),
    [(float("nan"), 3), (float("inf"), 2), (10**5000, 2), (True, 1)],
    ids=["no number", "without end", "of 5,000 digits", "true"],
)
def test_odd_numbers_are_judged(number: float, faults: int) -> None:
    document, _ = parse_yaml("schema", "{minimum: 0, maximum: 5, enum: [a]}")
    assert document is not None
    assert [fault.path for fault in list_hint_faults(document.root, number)] == [()] * faults


PARAMETERS = """\
archgen: 1
component_types:
  Motor: {parameters: {gain: {type: float, hints: {orca: {tag: Gain}}}, limit: {type: float, hints: {orca: {tags: L}}}}}
groups:
  g:
    components:
      left: {is: Motor, parameters: {gain: 1.5, limit: 2.5}}
      right: {is: Motor, parameters: {gain: 1.5, limit: 2.5}}
      a: {functionality: F, parameters: {speed: {value: 3, hints: {orca: [x]}}}}
nodes: {a: {implements: a}, left: {implements: left}, right: {implements: right}}
"""
PARAMETER_MANIFEST = MANIFEST.replace(
    "  output: {}\n", "  parameter: {type: object, additionalProperties: false, properties: {tag: {type: string}}}\n"
)


@pytest.mark.parametrize(
    ("manifest", "found"),
    [
        (
            PARAMETER_MANIFEST,
            [
                "3:109: `hints.orca.tags` of the parameter `Motor.limit` is no key that the backend reads",
                "9:68: `hints.orca` of the parameter `g.a.speed` is a list, but must be a mapping",
            ],
        ),
        (
            MANIFEST,
            [
                "3:52: `hints.orca` of the parameter `Motor.gain` is not read: the backend reads hints of `component`, `output`",
                "3:102: `hints.orca` of the parameter `Motor.limit` is not read: the backend reads hints of `component`, `output`",
                "9:68: `hints.orca` of the parameter `g.a.speed` is not read: the backend reads hints of `component`, `output`",
            ],
        ),
    ],
)
def test_hints_at_parameters_are_judged_once_where_they_are_written(
    tmp_path: Path, manifest: str, found: list[str]
) -> None:
    (tmp_path / "archgen.yaml").write_text(PARAMETERS, encoding="utf-8")
    (tmp_path / "backends" / "orca").mkdir(parents=True)
    (tmp_path / "backends" / "orca" / "backend.yaml").write_text(manifest, encoding="utf-8")
    findings = [each for each in check_project(tmp_path).findings if each.rule == "wrong-hint"]
    assert [f"{each.span.line}:{each.span.column}: {each.message}" for each in findings] == found


@pytest.mark.parametrize(
    ("limits", "faults"),
    [("minimum: 1e3", 1), ("maximum: .5", 1), ("minimum: .nan", 0), ("minimum: -.inf", 0), ("minimum: true", 0)],
)
def test_limits_count_however_they_are_written(limits: str, faults: int) -> None:
    document, _ = parse_yaml("schema", limits)
    assert document is not None
    assert len(list(list_hint_faults(document.root, 7))) == faults
